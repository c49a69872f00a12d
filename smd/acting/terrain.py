"""Terrain: the surface that characters walk on, and how high and steep it is at any place."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from laban.frozen import Frozen
from smd.errors import TransferError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray, frozen_array

STEEPEST = 0.05
"""Upward part of a triangle's unit normal below which it is a wall: nobody stands on it."""

SAME_M = 0.01
"""Heights of two surfaces over one place up to which they are one: meshes overlap at seams."""

_EDGE = 1e-9
"""Share of a triangle beyond its edge that still counts: neighbours leave no slit between them."""

_MOST_PAIRS = 20_000_000
"""Cells times triangles in them up to which the grid is made finer."""


@dataclass(frozen=True, slots=True, eq=False)
class Terrain(Frozen):
    """A surface made of triangles, in metres, +Y up.

    Attributes
    ----------
    points_m : (v, 3).
    triangles : (t, 3) indices into the points, counter-clockwise from above.
    name : what messages call it.
    """

    points_m: FloatArray
    triangles: IntArray
    name: str = "ground"
    _grid: _Grid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        points = frozen_array("points_m", self.points_m, (None, 3), TransferError)
        triangles = np.array(self.triangles, dtype=np.int64)
        if triangles.ndim != 2 or triangles.shape[1] != 3 or len(triangles) == 0:
            raise TransferError(f"{self.name}: expected triangles, got none")
        if triangles.min() < 0 or triangles.max() >= len(points):
            raise TransferError(f"{self.name}: expected triangles of its points, got others")
        triangles.flags.writeable = False
        object.__setattr__(self, "points_m", points)
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "_grid", _grid_of(points, triangles, self.name))

    def height_at(self, place_m: FloatArray) -> FloatArray:
        """Return how high the surface is ``(…)`` at places ``(…, 2)``, x and z; NaN beside it.

        Where there are several, it is the highest.
        """
        return self._at(place_m)[1]

    def normal_at(self, place_m: FloatArray) -> FloatArray:
        """Return the surface's upward unit normal ``(…, 3)`` at places; NaN beside it."""
        triangle = self._at(place_m)[2]
        normal = self._grid.normal[triangle]
        normal[triangle < 0] = np.nan
        return normal

    def storeys_at(self, place_m: FloatArray) -> BoolArray:
        """Return whether there are several surfaces over one another ``(…)`` at places."""
        low, high, _ = self._at(place_m)
        return np.asarray(high - low > SAME_M)

    def _at(self, place_m: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
        """Return the lowest and highest surface at places, and the triangle of the highest."""
        place_m = np.asarray(place_m, dtype=np.float64)
        flat = place_m.reshape(-1, 2)
        low, high = np.full(len(flat), np.inf), np.full(len(flat), -np.inf)
        triangle = np.full(len(flat), -1, dtype=np.int64)
        place, candidate = self._grid.candidates(flat)
        height, inside = self._grid.heights(flat[place], candidate)
        place, candidate, height = place[inside], candidate[inside], height[inside]
        np.minimum.at(low, place, height)
        np.maximum.at(high, place, height)
        top = height == high[place]
        triangle[place[top]] = candidate[top]
        found = triangle >= 0
        shape = place_m.shape[:-1]
        return (
            np.where(found, low, np.nan).reshape(shape),
            np.where(found, high, np.nan).reshape(shape),
            triangle.reshape(shape),
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Grid:
    """Triangles by the cells of a grid over the ground that they reach into.

    Attributes
    ----------
    origin_m, cell_m, shape : of the grid.
    first : (cells + 1,) where each cell's triangles begin in ``held``.
    held : triangles, cell by cell.
    corner_m, edge_a, edge_b, normal : (t, 3) of each triangle.
    """

    origin_m: FloatArray
    cell_m: float
    shape: tuple[int, int]
    first: IntArray
    held: IntArray
    corner_m: FloatArray
    edge_a: FloatArray
    edge_b: FloatArray
    normal: FloatArray

    def candidates(self, place_m: FloatArray) -> tuple[IntArray, IntArray]:
        """Return pairs of a place's index and a triangle that may be there."""
        cell = np.floor((place_m - self.origin_m) / self.cell_m)
        known = np.flatnonzero(np.all((cell >= 0) & (cell < self.shape), axis=-1))
        at = (cell[known, 0] * self.shape[1] + cell[known, 1]).astype(np.int64)
        count = self.first[at + 1] - self.first[at]
        return np.repeat(known, count), self.held[_ranges(self.first[at], count)]

    def heights(self, place_m: FloatArray, triangle: IntArray) -> tuple[FloatArray, BoolArray]:
        """Return how high triangles' planes are at places, and whether they reach there."""
        to = place_m - self.corner_m[triangle][:, [0, 2]]
        a, b = self.edge_a[triangle], self.edge_b[triangle]
        area = a[:, 0] * b[:, 2] - a[:, 2] * b[:, 0]
        u = (to[:, 0] * b[:, 2] - to[:, 1] * b[:, 0]) / area
        v = (a[:, 0] * to[:, 1] - a[:, 2] * to[:, 0]) / area
        inside = (u >= -_EDGE) & (v >= -_EDGE) & (u + v <= 1.0 + _EDGE)
        return self.corner_m[triangle, 1] + u * a[:, 1] + v * b[:, 1], inside


def _grid_of(points_m: FloatArray, triangles: IntArray, name: str) -> _Grid:
    """Sort the triangles that face up into the cells of a grid."""
    corners = points_m[triangles]
    edge_a, edge_b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(edge_a, edge_b)
    length = np.linalg.norm(normal, axis=-1)
    steep = normal[:, 1] / np.maximum(length, 1e-300)
    if not (steep > STEEPEST).any():  # wound the other way round
        steep, normal = -steep, -normal
    kept = np.flatnonzero((steep > STEEPEST) & (length > 0.0))
    if len(kept) == 0:
        raise TransferError(f"{name}: expected a surface to stand on, found none")
    corners, edge_a, edge_b = corners[kept], edge_a[kept], edge_b[kept]
    normal = normal[kept] / length[kept, None]
    over_ground = corners[..., [0, 2]]
    low, high = over_ground.min(axis=1), over_ground.max(axis=1)
    origin, size = low.min(axis=0), np.maximum(np.ptp(over_ground.reshape(-1, 2), axis=0), 1e-6)
    cell_m = float(np.sqrt(size.prod() / len(kept)))
    cell_m = max(cell_m, size.max() / 4096.0)
    while True:
        first_cell = np.floor((low - origin) / cell_m).astype(np.int64)
        last_cell = np.floor((high - origin) / cell_m).astype(np.int64)
        spans = last_cell - first_cell + 1
        if spans.prod(axis=-1).sum() <= _MOST_PAIRS:
            break
        cell_m *= 2.0
    shape = last_cell.max(axis=0) + 1
    cells, held = _cells(first_cell, spans, int(shape[1]))
    order = np.argsort(cells, kind="stable")
    count = np.bincount(cells, minlength=int(shape.prod()))
    return _Grid(
        origin_m=origin,
        cell_m=cell_m,
        shape=(int(shape[0]), int(shape[1])),
        first=np.concatenate([[0], np.cumsum(count)]),
        held=held[order],
        corner_m=corners[:, 0],
        edge_a=edge_a,
        edge_b=edge_b,
        normal=normal,
    )


def _cells(first: IntArray, spans: IntArray, width: int) -> tuple[IntArray, IntArray]:
    """Return pairs of a cell and a triangle that reaches into it."""
    count = spans.prod(axis=-1)
    triangle = np.repeat(np.arange(len(count)), count)
    within = _ranges(np.zeros_like(count), count)
    row, column = np.divmod(within, spans[triangle, 1])
    return (first[triangle, 0] + row) * width + first[triangle, 1] + column, triangle


def _ranges(start: IntArray, count: IntArray) -> IntArray:
    """Return the indices ``start … start + count - 1`` of each, one after the other."""
    ends = np.cumsum(count)
    return np.arange(int(count.sum())) - np.repeat(ends - count, count) + np.repeat(start, count)
