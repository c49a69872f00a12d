"""Hands: how far each finger is closed, and poses with names that key poses refer to.

A pose is twelve numbers, so that one passes smoothly into another. Of a finger there are two: the
bend at its knuckle and at its middle joint (°), with which the last joint goes. Of the thumb there
are three: how far it turns over the palm, how far it swings across, how far its joints bend (°).
The last number is 1 when the fingers are spread as they are bound, 0 when they lie side by side.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from actions_library.authoring.hand_shape import Finger, hand_axes, left_fingers
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import multiply, quaternion_about

HandPose = tuple[float, float, float, float, float, float, float, float, float, float, float, float]

_LAST_SHARE = 0.68
"""Bend of a finger's last joint, as a share of the middle one's."""

_THUMB = ("metacarpal", "proximal", "distal")


def hand_pose(
    thumb: tuple[float, float, float],
    index: tuple[float, float],
    middle: tuple[float, float],
    ring: tuple[float, float],
    little: tuple[float, float],
    spread: float,
) -> HandPose:
    """Return the pose of some fingers."""
    return (*thumb, *index, *middle, *ring, *little, spread)


FLAT = hand_pose((0.0, -4.0, 0.0), (2.0, 4.0), (2.0, 4.0), (2.0, 4.0), (2.0, 5.0), 0.5)
RELAXED = hand_pose((12.0, 2.0, 10.0), (20.0, 24.0), (26.0, 29.0), (31.0, 33.0), (35.0, 35.0), 0.8)
LOOSE = hand_pose((26.0, 4.0, 18.0), (42.0, 48.0), (48.0, 53.0), (52.0, 56.0), (54.0, 56.0), 0.5)
HOLD = hand_pose((50.0, 0.0, 30.0), (58.0, 68.0), (62.0, 72.0), (64.0, 74.0), (64.0, 72.0), 0.2)
FIST = hand_pose((60.0, 0.0, 42.0), (84.0, 102.0), (86.0, 104.0), (88.0, 104.0), (88.0, 102.0), 0.0)
POINT = hand_pose((60.0, 0.0, 42.0), (4.0, 6.0), (84.0, 102.0), (86.0, 102.0), (88.0, 100.0), 0.0)

HAND_POSES: dict[str, HandPose] = {
    "flat": FLAT,
    "relaxed": RELAXED,
    "loose": LOOSE,
    "hold": HOLD,
    "fist": FIST,
    "point": POINT,
}
"""By name: open and straight, hanging, half closed, around a stick, shut, forefinger out."""


def bent_at_knuckles(pose: HandPose, bend_rad: FloatArray) -> FloatArray:
    """Return a pose's numbers ``(n, 12)`` with all four fingers bent more at their knuckles."""
    numbers = np.tile(np.array(pose), (len(bend_rad), 1))
    numbers[:, 3:11:2] += np.degrees(bend_rad)[:, None]
    return numbers


def turn_fingers(
    turn: Callable[[str, FloatArray], None], side: str, out: float, numbers: FloatArray
) -> None:
    """Turn the joints of a hand's fingers.

    Parameters
    ----------
    turn
        Is told each joint, parents first, and its rotations ``(n, 4)`` from its parent's.
    out
        +1 for the left hand, -1 for the right one.
    numbers
        ``(n, 12)`` as in `hand_pose`.
    """
    angles = np.radians(numbers[:, :-1])
    along, front, outer = hand_axes()
    for k, finger in enumerate(left_fingers()):
        names = [f"{side}_{joint}" for joint in finger.joints]
        if finger.name == "thumb":
            over, across, flex = angles[:, :3].T
            root = multiply(_about(outer, across, out), _about(along, over, out))
            there, back = _about(along, over, out), _about(along, -over, out)
            # However far it is turned, its joints bend across the palm, not into it.
            bent = [
                multiply(multiply(back, _about(outer, by, out)), there) for by in (0.8 * flex, flex)
            ]
            turns = [root, *bent]
        else:
            knuckle, middle = angles[:, 1 + 2 * k : 3 + 2 * k].T
            bends = np.stack([knuckle, middle, _LAST_SHARE * middle], axis=1) - finger.bends_rad
            axis = _bend_axis(finger, along, front)
            turns = [_about(axis, bend, out) for bend in bends.T]
            closer = -(1.0 - numbers[:, -1]) * finger.spread_rad
            turns[0] = multiply(_about(outer, -closer, out), turns[0])
        for name, rotation in zip(names, turns, strict=True):
            turn(name, rotation)


def _bend_axis(finger: Finger, along: FloatArray, front: FloatArray) -> FloatArray:
    """Return the axis about which a left finger bends toward the palm."""
    cosine, sine = np.cos(finger.spread_rad), np.sin(finger.spread_rad)
    return np.asarray(sine * along - cosine * front)


def _about(axis: FloatArray, angle: FloatArray, out: float) -> FloatArray:
    """Return rotations about an axis of the left hand, or their mirror images in x = 0."""
    return quaternion_about(axis * np.array([1.0, out, out]), angle)
