"""The shipped humanoid's head, with lids that part and lips that open, as one distance field.

Lips that are closed have no gap for a grid to find. So the head is modelled with its lips a few
millimetres apart, and its mesh is then closed (`face_motion.resting`). The left half is described,
x from 0 up; an eye's own directions are outward, up and ahead.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.body_field import Box, Ellipsoid, Field, RoundCone, united
from actions_library.authoring.body_shape import Parts, skull, trunk, with_features
from smd.geometry.arrays import FloatArray

HEAD_BOX = ((0.0, 1.37, -0.13), (0.115, 1.77, 0.14))
HEAD_STEP_M = 0.00125
"""Lids are thin: the head has a finer grid than the body."""

EYE_M = np.array([0.033, 1.624, 0.0715])
EYE_RADIUS_M = 0.0150
"""The left eyeball."""

LID_INNER_M, LID_OUTER_M = 0.0008, 0.0028
"""How far the inside and the outside of a lid are from the eyeball."""

EYE_HALF_WIDTH = 0.80
"""How far out the corners of the eye are, as a share of its radius."""

UPPER_LID_RAD, LOWER_LID_RAD = np.radians(25.0), np.radians(-23.0)
"""Elevation of the lids' margins over the middle of the open eye."""

SLANT_RAD = np.radians(3.0)
"""How much higher the outer corner is than the middle, an eye's radius away."""

MOUTH_M = (0.025, 1.5640, 0.0905)
"""Corner of the mouth to the left; height and front of the middle of the lips."""

PARTED_M = 0.0030
"""Half the gap between the lips in the middle, as modelled."""

LIPS_M = (0.0041, 0.0050)
"""Thickness of the upper and the lower lip in the middle, as radii."""

NECK_CUT = ((0.0, 1.495, -0.005), (0.0, 1.66, 0.020))
"""From the one to the other the head's mesh reaches around the neck, below the collar."""


def lid_elevations(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how high the upper and lower lids' margins are (rad), over the share ``u`` outward.

    Beyond the corners of the eye the upper one is the lower.
    """
    bow = 1.0 - (u / EYE_HALF_WIDTH) ** 2
    return SLANT_RAD * u + UPPER_LID_RAD * bow, SLANT_RAD * u + LOWER_LID_RAD * bow


def in_eye(points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return where points ``(…, 3)`` are, seen from the left eye.

    Returns
    -------
    outward : share of its radius.
    elevation : in radians, about its axis outward.
    away : from its centre, in metres.
    """
    x, y, z = np.moveaxis(points - EYE_M, -1, 0)
    return x / EYE_RADIUS_M, np.arctan2(y, z), np.sqrt(x**2 + y**2 + z**2)


def lip_line_m(x: FloatArray) -> FloatArray:
    """Return the height of the line between the lips."""
    return MOUTH_M[1] + 0.0010 * np.minimum(x / MOUTH_M[0], 1.5) ** 2


def lip_front_m(x: FloatArray) -> FloatArray:
    """Return how far to the front the face reaches at the line between the lips."""
    return MOUTH_M[2] - 9.5 * x**2


def parting(x: FloatArray) -> FloatArray:
    """Return how open the mouth is along the lips: 1 in the middle, 0 from the corners on."""
    return np.maximum(1.0 - (x / MOUTH_M[0]) ** 2, 0.0)


@dataclass(frozen=True)
class EyeOpening:
    """What lies between the lids, from the eye to the front."""

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        reach = EYE_RADIUS_M + 0.010
        return EYE_M - [reach, reach, 0.0], EYE_M + reach

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance along a circle about the eye's axis outward."""
        u = (x - EYE_M[0]) / EYE_RADIUS_M
        up, ahead = y - EYE_M[1], z - EYE_M[2]
        elevation, away = np.arctan2(up, ahead), np.hypot(up, ahead)
        upper, lower = lid_elevations(u)
        outside = away * np.maximum(elevation - upper, lower - elevation)
        return np.maximum(outside, 0.003 - ahead)


@dataclass(frozen=True)
class EyeSpace:
    """The room for the eyeball under the lids, as far back as it can be seen."""

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        reach = EYE_RADIUS_M + LID_INNER_M
        return EYE_M - reach, EYE_M + reach

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance from the ball, or from the plane that cuts it."""
        ahead = z - EYE_M[2]
        away = np.sqrt((x - EYE_M[0]) ** 2 + (y - EYE_M[1]) ** 2 + ahead**2)
        return np.maximum(away - (EYE_RADIUS_M + LID_INNER_M), 0.002 - ahead)


@dataclass(frozen=True)
class LipGap:
    """The gap between the lips as modelled, from the front to behind the teeth.

    Attributes
    ----------
    depth_m : how far back it reaches.
    wider_m : how much wider it is at either lip: what the lips' own colour fills.
    """

    depth_m: float = 0.014
    wider_m: float = 0.0

    def bounds(self) -> Box:
        """Return the lowest and highest corner."""
        x, y, z = MOUTH_M
        return np.array([-x, y - 0.005, z - 0.03]), np.array([x, y + 0.006, z + 0.02])

    def distance(self, x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        """Return the distance across the gap."""
        half = PARTED_M * (1.0 - (x / MOUTH_M[0]) ** 2) + self.wider_m
        across = np.abs(y - lip_line_m(x)) - half
        return np.maximum(across, lip_front_m(x) - self.depth_m - z)


def lips(grown_m: float = 0.0) -> tuple[Parts, Parts]:
    """Return the left half of the upper and of the lower lip, apart as modelled."""
    x = np.linspace(0.0, MOUTH_M[0], 8)
    share = x / MOUTH_M[0]
    found: list[Parts] = []
    for side, thick in zip((1.0, -1.0), LIPS_M, strict=True):
        radius = thick * (1.0 - 0.60 * share**2)
        # The upper lip has its bow, and a dip in the middle.
        bow = 0.0012 * np.exp(-(((x - 0.006) / 0.004) ** 2)) if side > 0 else 0.0 * x
        y = lip_line_m(x) + side * (PARTED_M * parting(x) + 0.85 * radius) + bow
        z = lip_front_m(x) - 0.0015 - 0.0010 * share
        tube = np.column_stack([x, y, z])
        radius = radius + grown_m
        found.append(
            [
                (RoundCone(tuple(tube[k]), tuple(tube[k + 1]), radius[k], radius[k + 1]), 0.002)
                for k in range(len(x) - 1)
            ]
        )
    return found[0], found[1]


def head_field() -> Field:
    """Return the head and neck with its sockets, lids and lips, cut off below the collar."""
    head = with_features(united(HEAD_BOX, HEAD_STEP_M, skull()))
    eye = (float(EYE_M[0]), float(EYE_M[1]), float(EYE_M[2]))

    def ball(more_m: float) -> Ellipsoid:
        return Ellipsoid(eye, (EYE_RADIUS_M + more_m,) * 3)

    head.carve(ball(0.0035), 0.016)
    head.add(ball(LID_OUTER_M), 0.009)
    head.carve(EyeSpace(), 0.001)
    head.carve(EyeOpening(), 0.0015)
    for lip in lips(-0.0006):
        for part, _ in lip:
            head.add(part, 0.005)
    head.carve(LipGap(wider_m=0.0005), 0.0012)
    head.carve(Ellipsoid((0.0, MOUTH_M[1], 0.0745), (0.020, 0.0080, 0.0085)), 0.003)
    whole = united(HEAD_BOX, HEAD_STEP_M, trunk())
    whole.merge(head, 0.030)
    whole.keep(RoundCone(*NECK_CUT, 0.100, 0.170), 0.0)
    return whole
