"""The pose that gestures start from and return to, and the ground under it."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.curves import eased
from actions_library.authoring.feet import ALWAYS_S, Plant
from actions_library.authoring.keys import ArmKey, Key, Place, Turn
from actions_library.authoring.posing import RATE_HZ, RootCourse

LEFT_STANCE = Plant(-ALWAYS_S, ALWAYS_S, left=0.1025, ahead=0.0225, yaw=9.0)
RIGHT_STANCE = Plant(-ALWAYS_S, ALWAYS_S, left=-0.1025, ahead=-0.0225, yaw=-12.0)

STAND = Key(
    0.0,
    place=Place(left=0.012, up=-0.008, ahead=0.0),
    hips=Turn(yaw=-2.0, lean=2.0, tilt=1.5),
    chest=Turn(yaw=1.5, lean=0.5, tilt=-1.0),
    head=Turn(yaw=0.0, lean=3.0, tilt=0.0),
    left_arm=ArmKey(to=(0.17, -1.0, 0.05), bend=15.0),
    right_arm=ArmKey(to=(0.175, -1.0, 0.08), bend=21.0),
)
"""Weight a little on the left leg, arms hanging, eyes ahead."""


def standing_still(duration_s: float) -> RootCourse:
    """Return a ground path that stays where it is."""
    zero = np.zeros(frame_count(duration_s))
    return RootCourse(zero, zero, zero)


def moved_in_one_go(
    duration_s: float, start_s: float, end_s: float, *, ahead: float = 0.0, yaw: float = 0.0
) -> RootCourse:
    """Return a ground path that goes ``ahead`` metres and turns ``yaw`` degrees between times."""
    time_s = np.arange(frame_count(duration_s)) / RATE_HZ
    way = eased((time_s - start_s) / (end_s - start_s))
    return RootCourse(np.zeros_like(way), ahead * way, np.radians(yaw) * way)


def steady_travel(duration_s: float, *, left: float = 0.0, ahead: float = 0.0) -> RootCourse:
    """Return a ground path at constant speed over so many metres."""
    way = np.linspace(0.0, 1.0, frame_count(duration_s))
    return RootCourse(left * way, ahead * way, np.zeros_like(way))


def frame_count(duration_s: float) -> int:
    """Return how many frames a duration takes, both ends included."""
    return round(duration_s * RATE_HZ) + 1
