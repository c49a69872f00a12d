"""The area of the ground that carries a body: the hull of what touches it, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.soles import ON_GROUND_M
from smd.geometry.arrays import BoolArray, FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class SupportArea:
    """A convex area of the ground at every frame.

    Attributes
    ----------
    corner_m : (n, c, 2) left and ahead, turning from left to ahead; the last corner is repeated
        where an area has fewer than others.
    carries : (n,) False where nothing touches the ground.
    """

    corner_m: FloatArray
    carries: BoolArray

    def nearest_m(self, point_m: FloatArray) -> FloatArray:
        """Return each frame's nearest place of the area to a point, ``(n, 2)``: itself if inside.

        Where nothing carries, that is the point itself.
        """
        start = self.corner_m
        side = np.roll(start, -1, axis=1) - start
        to = point_m[:, None] - start
        inside = (side[..., 0] * to[..., 1] - side[..., 1] * to[..., 0] >= 0.0).all(axis=1)
        length = np.maximum(np.sum(side * side, axis=-1), 1e-12)
        along = np.clip(np.sum(to * side, axis=-1) / length, 0.0, 1.0)
        foot = start + along[..., None] * side
        distance = np.linalg.norm(point_m[:, None] - foot, axis=-1)
        best = foot[np.arange(len(foot)), np.argmin(distance, axis=1)]
        wide = np.sum(start[..., 0] * side[..., 1] - start[..., 1] * side[..., 0], axis=1) > 1e-9
        kept = (inside & wide) | ~self.carries
        return np.where(kept[:, None], point_m, best)

    def shrunk(self, share: float) -> SupportArea:
        """Return the area made smaller about its middle to a share of its size."""
        middle = 0.5 * (self.corner_m.min(axis=1) + self.corner_m.max(axis=1))[:, None]
        return SupportArea(middle + share * (self.corner_m - middle), self.carries)


def support_of(points_m: FloatArray) -> SupportArea:
    """Return what carries a body that touches the ground with points ``(n, p, 3)``."""
    areas = [_hull(at[at[:, 1] < ON_GROUND_M][:, [0, 2]]) for at in points_m]
    most = max(len(area) for area in areas)
    corner = np.zeros((len(areas), max(most, 1), 2))
    for row, area in zip(corner, areas, strict=True):
        if len(area):
            row[: len(area)], row[len(area) :] = area, area[-1]
    return SupportArea(corner, np.array([len(area) > 0 for area in areas]))


def _hull(points: FloatArray) -> FloatArray:
    """Return the corners of the convex hull of ``(p, 2)``, by Andrew's monotone chain."""
    ordered = sorted({(float(a), float(b)) for a, b in points})
    if len(ordered) < 3:
        return np.array(ordered).reshape(-1, 2)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _chain(ordered: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    chain: list[tuple[float, float]] = []
    for point in ordered:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
