"""The moon's mouth: where its lips are, and how lips that are modelled apart are closed.

Lips that touch have no gap for a grid to find. So the face is modelled with its lips a few
millimetres apart, and its mesh is closed afterwards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.body_field import Box, RoundCone
from actions_library.authoring.displacement import step
from smd.geometry.arrays import FloatArray

MOUTH_M = (0.050, 0.106, 0.1090)
"""Corner of the mouth to the left; height and front of the middle of the lips."""

PARTED_M = 0.0045
"""Half the gap between the lips in the middle, as modelled."""

LIPS_M = (0.0085, 0.0105)
"""Radii of the upper and the lower lip in the middle."""

DEPTH_M = 0.026
"""How far back the gap reaches."""


def lip_line_m(x: FloatArray) -> FloatArray:
    """Return the height of the line between the lips: its corners are a little higher."""
    return MOUTH_M[1] + 0.0035 * np.minimum(np.abs(x) / MOUTH_M[0], 1.6) ** 2


def lip_front_m(x: FloatArray) -> FloatArray:
    """Return how far to the front the face reaches at the line between the lips."""
    return MOUTH_M[2] - 5.2 * x**2


def parting(x: FloatArray) -> FloatArray:
    """Return how open the mouth is along the lips: 1 in the middle, 0 from the corners on."""
    return np.maximum(1.0 - (x / MOUTH_M[0]) ** 2, 0.0)


@dataclass(frozen=True)
class MoonLipGap:
    """The gap between the lips as modelled."""

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        x, y, z = MOUTH_M
        return np.array([-x, y - 0.01, z - 0.05]), np.array([x, y + 0.012, z + 0.03])

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance across the gap, or from its back."""
        half = PARTED_M * (1.0 - (x / MOUTH_M[0]) ** 2)
        across = np.abs(y - lip_line_m(x)) - half
        return np.maximum(across, lip_front_m(x) - DEPTH_M - z)


def lips(grown_m: float = 0.0) -> list[RoundCone]:
    """Return the left half of both lips, apart as modelled."""
    x = np.linspace(0.0, MOUTH_M[0], 9)
    share = x / MOUTH_M[0]
    cones = []
    for up, thick in zip((1.0, -1.0), LIPS_M, strict=True):
        radius = thick * (1.0 - 0.62 * share**2) + grown_m
        y = lip_line_m(x) + up * (PARTED_M * parting(x) + 0.85 * (radius - grown_m))
        z = lip_front_m(x) - 0.004 - 0.002 * share
        at = [(float(a), float(b), float(c)) for a, b, c in zip(x, y, z, strict=True)]
        cones += [
            RoundCone(at[k], at[k + 1], float(radius[k]), float(radius[k + 1])) for k in range(8)
        ]
    return cones


def closed(modelled_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return points with the lips closed, and to which lip each belongs.

    Returns
    -------
    points_m : (p, 3)
    side : (p,)
        1 from the line between the lips up, -1 below it; in the mouth from the one to the other.
    """
    x, y, z = modelled_m.T
    above = y - lip_line_m(x)
    gap = PARTED_M * parting(x)
    side = np.clip(above / np.maximum(0.3 * gap, 1e-9), -1.0, 1.0)
    deep = step(lip_front_m(x) - z, 0.012, 0.024)
    moved = np.minimum(gap, 0.985 * np.abs(above)) * (1.0 - deep)
    moved = moved * (1.0 - step(np.abs(above), gap + 0.018, 0.055))
    return modelled_m - np.outer(np.sign(above) * moved, [0.0, 1.0, 0.0]), side
