"""A camera placed so that given points fill a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import normalized

NEAREST_M = 0.2
"""Least distance from the camera to a point."""


@dataclass(frozen=True, slots=True, eq=False)
class Viewpoint:
    """A perspective camera.

    Attributes
    ----------
    eye_m, target_m : (3,) where it stands, and what it looks at.
    view_angle_rad : from the picture's lower edge to its upper one.
    width_m : of what the picture shows at the target's distance.
    """

    eye_m: FloatArray
    target_m: FloatArray
    view_angle_rad: float
    width_m: float


def fitted(
    points_m: ArrayLike,
    away: ArrayLike,
    *,
    aspect: float,
    view_angle_rad: float = 0.35,
    fill: float = 0.88,
) -> Viewpoint:
    """Return the nearest viewpoint in a direction from which all points are in the picture.

    A point at x to the right, y above and z towards a camera that stands at (a, b, d) is in
    the picture if ``|x - a| <= (d - z) t``, t the tangent of half the view angle. With the
    extremes ``h = max(x + z t)`` and ``l = min(x - z t)`` that is ``d >= (h - l) / 2t``, then
    at ``a = (h + l) / 2``; the same upwards, and the larger of both d.

    Parameters
    ----------
    points_m
        ``(p, 3)``, at least one.
    away
        From the target to the camera, ``(3,)``; any length, not straight up or down.
    aspect
        Of the picture, width over height.
    view_angle_rad
        From its lower edge to its upper one.
    fill
        Part of the width and height that the points may fill.
    """
    points = np.asarray(points_m, dtype=np.float64)
    back = normalized(away)
    right = normalized(np.cross([0.0, 1.0, 0.0], back))
    up = np.cross(back, right)
    x, y, z = points @ right, points @ up, points @ back
    tangent_y = fill * np.tan(0.5 * view_angle_rad)
    centre, distances = [], [float(z.max()) + NEAREST_M]
    for across, tangent in ((x, tangent_y * aspect), (y, tangent_y)):
        high, low = (across + z * tangent).max(), (across - z * tangent).min()
        centre.append(0.5 * (high + low))
        distances.append(0.5 * (high - low) / tangent)
    distance = max(distances)
    middle = right * centre[0] + up * centre[1]
    depth = 0.5 * (z.max() + z.min())
    width = 2.0 * (distance - depth) * np.tan(0.5 * view_angle_rad) * aspect
    return Viewpoint(middle + back * distance, middle + back * depth, view_angle_rad, float(width))
