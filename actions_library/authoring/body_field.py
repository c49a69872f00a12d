"""Implicit shapes on a grid: distances to simple solids, and how they melt into each other.

A shape gives, for the points of a box of the grid, a signed distance in metres, negative inside.
The distance need only be right near the surface: blending looks at a few centimetres around it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import map_coordinates

from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized

FAR_M = 1.0
"""Distance written where no shape comes near."""

MARGIN_M = 0.06
"""Shapes are evaluated this far around their bounds: more than any blend reaches."""

Box = tuple[FloatArray, FloatArray]
Distances = NDArray[np.floating]
Combine = Callable[[Distances, Distances], Distances]
Point = tuple[float, float, float]


class Shape(Protocol):
    """A solid with bounds."""

    def bounds(self) -> Box:
        """Return the lowest and highest corner of a box that holds the solid."""

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the signed distance at points whose coordinates broadcast together."""


@dataclass(frozen=True)
class RoundCone:
    """The hull of two spheres, or a ball where both are one."""

    start: Point
    end: Point
    start_radius: float
    end_radius: float

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        a, b = np.array(self.start), np.array(self.end)
        ra, rb = self.start_radius, self.end_radius
        return np.minimum(a - ra, b - rb), np.maximum(a + ra, b + rb)

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance to the segment less a radius that changes linearly along it."""
        a, b = np.array(self.start), np.array(self.end)
        along = b - a
        px, py, pz = x - a[0], y - a[1], z - a[2]
        t = (px * along[0] + py * along[1] + pz * along[2]) / max(float(along @ along), 1e-12)
        t = np.clip(t, 0.0, 1.0)
        away = (px - t * along[0]) ** 2 + (py - t * along[1]) ** 2 + (pz - t * along[2]) ** 2
        return np.sqrt(away) - (self.start_radius + t * (self.end_radius - self.start_radius))


@dataclass(frozen=True)
class Ellipsoid:
    """An ellipsoid, its own axes turned by a matrix whose columns are their directions."""

    centre: Point
    radii: Point
    axes: FloatArray = field(default_factory=lambda: np.eye(3))

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        half = np.sqrt(((self.axes * np.array(self.radii)) ** 2).sum(axis=1))
        return np.array(self.centre) - half, np.array(self.centre) + half

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the first-order distance: the scaled radius over its slope."""
        px, py, pz = (c - o for c, o in zip((x, y, z), self.centre, strict=True))
        scaled, slope = 0.0, 0.0
        for direction, radius in zip(self.axes.T, self.radii, strict=True):
            p = (px * direction[0] + py * direction[1] + pz * direction[2]) / radius
            scaled = scaled + p**2
            slope = slope + (p / radius) ** 2
        k0, k1 = np.sqrt(scaled), np.sqrt(slope)
        return k0 * (k0 - 1.0) / np.maximum(k1, 1e-9)


@dataclass(frozen=True)
class Loft:
    """Cross-sections along a straight axis, each an oval of four quarter ellipses.

    Attributes
    ----------
    origin : where the axis starts.
    axis : its direction.
    front : a direction across it, made perpendicular; the third direction, *outer*, is
        ``cross(axis, front)``, or its opposite where ``mirrored``.
    sections : (k, 7): place along the axis in metres, the radii to the front, back, outer and
        inner side, and how far the centre is moved to the front and to the outer side. Between
        sections the values follow a monotone cubic.
    caps : lengths of the rounded ends.
    power : 2 for ovals, more for boxier sections.
    """

    origin: Point
    axis: Point
    front: Point
    sections: ArrayLike
    caps: tuple[float, float] = (0.02, 0.02)
    power: float = 2.0
    mirrored: bool = False

    def frame(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the unit directions along the axis, to the front and to the outer side."""
        axis = normalized(self.axis)
        front = np.asarray(self.front, dtype=np.float64)
        front = normalized(front - (front @ axis) * axis)
        return axis, front, np.cross(axis, front) * (-1.0 if self.mirrored else 1.0)

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        axis, front, outer = self.frame()
        rows = np.asarray(self.sections, dtype=np.float64)
        centre = np.array(self.origin) + np.outer(rows[:, 0], axis)
        corners = [
            centre + np.outer(rows[:, 5] + f, front) + np.outer(rows[:, 6] + o, outer)
            for f in (rows[:, 1], -rows[:, 2])
            for o in (rows[:, 3], -rows[:, 4])
        ]
        corners.append(corners[0][:1] - axis * self.caps[0])
        corners.append(corners[0][-1:] + axis * self.caps[1])
        every = np.concatenate(corners)
        return every.min(axis=0), every.max(axis=0)

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance to the surface along the ray from the section's centre."""
        axis, front, outer = self.frame()
        rows = np.asarray(self.sections, dtype=np.float64)
        place = np.linspace(rows[0, 0], rows[-1, 0], 257)
        table = PchipInterpolator(rows[:, 0], rows[:, 1:])(place)
        px, py, pz = (c - o for c, o in zip((x, y, z), self.origin, strict=True))
        along, f, o = (px * d[0] + py * d[1] + pz * d[2] for d in (axis, front, outer))
        radii = [np.interp(along, place, column) for column in table.T]
        f, o = f - radii[4], o - radii[5]
        rf = np.where(f > 0, radii[0], radii[1])
        ro = np.where(o > 0, radii[2], radii[3])
        n = self.power
        scale = ((np.abs(f) / rf) ** n + (np.abs(o) / ro) ** n) ** (1.0 / n)
        away = np.hypot(f, o)
        radius = np.where(scale > 1e-6, away / np.maximum(scale, 1e-6), np.minimum(rf, ro))
        low = np.maximum(rows[0, 0] - along, 0.0) / self.caps[0]
        high = np.maximum(along - rows[-1, 0], 0.0) / self.caps[1]
        return np.hypot(away, radius * (low + high)) - radius


@dataclass(frozen=True)
class HalfSpace:
    """Everything behind a plane."""

    point: Point
    normal: Point

    def bounds(self) -> Box:
        """Return corners beyond any grid."""
        return np.full(3, -np.inf), np.full(3, np.inf)

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance in front of the plane."""
        n = normalized(self.normal)
        px, py, pz = (c - o for c, o in zip((x, y, z), self.point, strict=True))
        return np.asarray(px * n[0] + py * n[1] + pz * n[2])


def smooth_min(a: Distances, b: Distances, reach_m: float) -> Distances:
    """Return the union of two distances, filleted where they differ by less than ``reach_m``.

    A cubic polynomial: twice continuously differentiable, so that highlights do not break.
    """
    if reach_m <= 0:
        return np.minimum(a, b)
    h = np.maximum(reach_m - np.abs(a - b), 0.0) / reach_m
    return np.minimum(a, b) - h**3 * reach_m / 6.0


def smooth_max(a: Distances, b: Distances, reach_m: float) -> Distances:
    """Return the intersection of two distances, filleted as in `smooth_min`."""
    return -smooth_min(-a, -b, reach_m)


class Field:
    """Distances at the nodes of an even grid; nodes of all fields of one step coincide.

    Attributes
    ----------
    step_m : distance between nodes.
    first : (3,) the first node, counted in steps from the world's origin.
    values : (nx, ny, nz) float32, signed distance in metres.
    """

    def __init__(self, box: tuple[ArrayLike, ArrayLike], step_m: float) -> None:
        low, high = (np.asarray(corner, dtype=np.float64) / step_m for corner in box)
        self.step_m = step_m
        self.first = np.floor(low + 1e-9).astype(int)
        size = np.ceil(high - 1e-9).astype(int) - self.first + 1
        self.values: Distances = np.full(tuple(size), FAR_M, dtype=np.float32)

    @property
    def origin_m(self) -> FloatArray:
        """The first node's place."""
        return self.first * self.step_m

    @property
    def box(self) -> Box:
        """The first and the last node's places."""
        last = self.first + np.array(self.values.shape) - 1
        return self.origin_m, last * self.step_m

    def _block(self, first: IntArray, end: IntArray) -> tuple[slice, ...]:
        """Return the part of the grid from node ``first`` to before ``end``, in its own count."""
        first = np.clip(first - self.first, 0, self.values.shape)
        end = np.clip(end - self.first, first, self.values.shape)
        return tuple(slice(int(a), int(b)) for a, b in zip(first, end, strict=True))

    def _apply(self, shape: Shape, combine: Combine) -> None:
        """Combine a shape's distance with the values around it."""
        low, high = shape.bounds()
        first = np.floor((np.maximum(low, -9.0) - MARGIN_M) / self.step_m).astype(int)
        end = np.ceil((np.minimum(high, 9.0) + MARGIN_M) / self.step_m).astype(int) + 1
        block = self._block(first, end)
        x, y, z = (
            (self.step_m * (np.arange(part.start, part.stop) + start))
            for part, start in zip(block, self.first, strict=True)
        )
        distance = shape.distance(x[:, None, None], y[None, :, None], z[None, None, :])
        self.values[block] = combine(self.values[block], distance)

    def add(self, shape: Shape, reach_m: float) -> None:
        """Unite with a shape, blending over ``reach_m``."""
        self._apply(shape, lambda a, b: smooth_min(a, b, reach_m))

    def carve(self, shape: Shape, reach_m: float) -> None:
        """Take a shape away, rounding the rim over ``reach_m``."""
        self._apply(shape, lambda a, b: smooth_max(a, -b, reach_m))

    def keep(self, shape: Shape, reach_m: float) -> None:
        """Keep what lies inside a shape that reaches past the grid, rounding the rim."""
        self._apply(shape, lambda a, b: smooth_max(a, b, reach_m))

    def grown(self, amount_m: float) -> Field:
        """Return a copy whose solid is larger all around."""
        out = Field(self.box, self.step_m)
        out.merge(self, 0.0, amount_m)
        return out

    def shrink(self, amount_m: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]) -> None:
        """Make the solid slimmer, by an amount that depends on the place (x, y, z)."""
        x, y, z = (
            self.step_m * (start + np.arange(size))
            for start, size in zip(self.first, self.values.shape, strict=True)
        )
        amount = amount_m(x[:, None, None], y[None, :, None], z[None, None, :])
        self.values = self.values + amount.astype(np.float32)

    def merge(self, other: Field, reach_m: float, grown_m: float = 0.0) -> None:
        """Unite with another field of the same step, its solid grown by ``grown_m``."""
        block = self._block(other.first, other.first + other.values.shape)
        first = self.first + [part.start for part in block]
        end = self.first + [part.stop for part in block]
        theirs = other.values[other._block(first, end)] - np.float32(grown_m)
        self.values[block] = smooth_min(self.values[block], theirs, reach_m)

    def sample(self, points_m: FloatArray) -> FloatArray:
        """Return the distance at points ``(p, 3)``, linear between nodes, far off the grid."""
        where = (points_m / self.step_m - self.first).T
        values = map_coordinates(
            self.values, where, order=1, mode="constant", cval=FAR_M, output=np.float64
        )
        return np.asarray(values)

    def slope(self, points_m: FloatArray) -> FloatArray:
        """Return the gradient at points ``(p, 3)``, by differences over two nodes.

        The grid's lowest x is taken as a plane of symmetry: there, the slope across it is 0.
        """
        h = self.step_m
        low = self.origin_m[0]
        ends = []
        for d in h * np.eye(3):
            before = points_m - d
            before[:, 0] = low + np.abs(before[:, 0] - low)
            ends.append(self.sample(points_m + d) - self.sample(before))
        return np.stack(ends, axis=-1) / (2.0 * h)


def united(
    box: tuple[ArrayLike, ArrayLike], step_m: float, shapes: Sequence[tuple[Shape, float]]
) -> Field:
    """Return a field of shapes united in order, each with its reach."""
    field = Field(box, step_m)
    for shape, reach_m in shapes:
        field.add(shape, reach_m)
    return field
