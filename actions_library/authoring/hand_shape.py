"""The shipped humanoid's left hand: its bones, as they lie in the bind pose, a little curled.

Places in the hand are (along, front, outer): from the wrist toward the fingers, to the thumb's
side, to the back of the hand; in metres.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.geometry.arrays import FloatArray

Point = tuple[float, float, float]

WRIST: Point = (0.553, 1.027, 0.000)
DOWN_45: Point = (2**-0.5, -(2**-0.5), 0.0)
"""Where the hand is in the bind pose, and which way it points."""

FINGERS = ("thumb", "index", "middle", "ring", "little")


@dataclass(frozen=True)
class Finger:
    """A finger.

    Attributes
    ----------
    name : one of `FINGERS`.
    joints : names of its three joints, from the hand to the tip.
    places : (4, 3) in the world, of the joints and of the tip.
    radii : (4,) at these.
    bends_rad : (3,) how far each joint is bent in the bind pose.
    spread_rad : how far it points to the front.
    """

    name: str
    joints: tuple[str, str, str]
    places: FloatArray
    radii: FloatArray
    bends_rad: FloatArray
    spread_rad: float


def hand_axes() -> FloatArray:
    """Return the directions in the world ``(3, 3)`` along, to the front and to the back."""
    return np.array([DOWN_45, (0.0, 0.0, 1.0), (-DOWN_45[1], DOWN_45[0], 0.0)])


def hand_point(along: float, front: float, outer: float) -> FloatArray:
    """Return a place of the left hand in the world."""
    return np.asarray(np.array(WRIST) + np.array([along, front, outer]) @ hand_axes())


# Of each finger: its knuckle (along, front, outer), how far it spreads to the front, the pitch of
# each phalanx (radians), the phalanges' lengths, the radius at the knuckle.
_KNUCKLES = {
    "index": ((0.088, 0.0335, 0.000), 0.13, (0.22, 0.48, 0.72), (0.043, 0.026, 0.019), 0.0098),
    "middle": ((0.092, 0.0120, 0.002), 0.04, (0.25, 0.53, 0.78), (0.047, 0.029, 0.020), 0.0100),
    "ring": ((0.089, -0.0095, 0.001), -0.05, (0.28, 0.58, 0.84), (0.043, 0.027, 0.019), 0.0096),
    "little": ((0.081, -0.0295, -0.002), -0.15, (0.31, 0.63, 0.90), (0.034, 0.021, 0.017), 0.0086),
}


def left_fingers() -> tuple[Finger, ...]:
    """Return the thumb and the fingers, from the index to the little one."""
    found = [_thumb()]
    for name, (knuckle, spread, pitches, lengths, radius) in _KNUCKLES.items():
        at = np.array(knuckle)
        places = [hand_point(*at)]
        for pitch, length in zip(pitches, lengths, strict=True):
            level = np.cos(pitch) * np.array([np.cos(spread), np.sin(spread)])
            at = at + length * np.array([*level, -np.sin(pitch)])
            places.append(hand_point(*at))
        found.append(
            Finger(
                name=name,
                joints=(f"{name}_proximal", f"{name}_intermediate", f"{name}_distal"),
                places=np.array(places),
                radii=radius * np.array([1.0, 0.94, 0.87, 0.76]),
                bends_rad=np.diff(pitches, prepend=0.0),
                spread_rad=spread,
            )
        )
    return tuple(found)


def _thumb() -> Finger:
    """Return the thumb, from its root in the palm."""
    ways = [(0.018, 0.020, -0.006), (0.040, 0.040, -0.008), (0.070, 0.056, -0.013)]
    ways.append((0.094, 0.062, -0.017))
    return Finger(
        name="thumb",
        joints=("thumb_metacarpal", "thumb_proximal", "thumb_distal"),
        places=np.array([hand_point(*way) for way in ways]),
        radii=np.array([0.015, 0.0130, 0.0115, 0.0092]),
        bends_rad=np.zeros(3),
        spread_rad=0.0,
    )
