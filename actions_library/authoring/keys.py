"""Key poses: what an animator sets, in words a person can read.

Lengths are metres and angles degrees, for they are typed by hand. A key names only the parts it
poses; each part runs smoothly through its own keys. Keys stand in the clip's world, which a
cyclic clip's steady travel carries along. Arms, legs and hands are written alike for both sides:
`out` is away from the body's middle.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

import numpy as np

from actions_library.authoring.curves import smooth_curve
from actions_library.authoring.hand_poses import RELAXED, HandPose
from smd.geometry.arrays import FloatArray

Vector = tuple[float, float, float]

Numbers = dict[str, FloatArray]
"""Values over time, by name."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where the hips are: to the left, above standing upright, ahead (m)."""

    left: float = 0.0
    up: float = 0.0
    ahead: float = 0.0


@dataclass(frozen=True, slots=True)
class Turn:
    """How a part of the trunk is turned: first to the left, then forward, then to its right (°)."""

    yaw: float = 0.0
    lean: float = 0.0
    tilt: float = 0.0


@dataclass(frozen=True, slots=True)
class Gaze:
    """Where the eyes look from the head: to the left, then up (°)."""

    left: float = 0.0
    up: float = 0.0


@dataclass(frozen=True, slots=True)
class ArmKey:
    """An arm and its hand.

    Attributes
    ----------
    to : direction from shoulder to wrist (out, up, ahead), of any length.
    bend : of the elbow, 0 when straight (°).
    elbow : direction in which the elbow points (out, up, ahead), of any length.
    follow : 1 when these directions turn with the chest, 0 when they stay with the world.
    shrug : lifts the shoulder (°).
    twist : turns the forearm, thumb inward (°).
    flex : bends the wrist toward the palm (°).
    fingers : how far each is closed: a pose of `authoring.hand_poses`.
    """

    to: Vector = (0.16, -1.0, 0.05)
    bend: float = 20.0
    elbow: Vector = (0.35, 0.0, -1.0)
    follow: float = 1.0
    shrug: float = 0.0
    twist: float = 10.0
    flex: float = 6.0
    fingers: HandPose = RELAXED


@dataclass(frozen=True, slots=True)
class Hand:
    """A hand that is put somewhere, whatever its arm's own key says.

    Attributes
    ----------
    place : of the wrist in the clip's world (out, up, ahead; m).
    fingers : direction in which they point (out, up, ahead), of any length.
    palm : direction in which the palm faces.
    hold : 1 when the hand is there, 0 when the arm's own key has it, mixed between.
    """

    place: Vector = (0.2, 1.0, 0.3)
    fingers: Vector = (0.0, 0.0, 1.0)
    palm: Vector = (0.0, -1.0, 0.0)
    hold: float = 1.0


@dataclass(frozen=True, slots=True)
class LegKey:
    """A leg that touches nothing: directions (out, up, ahead) turn with the hips.

    Attributes
    ----------
    to : direction from hip joint to ankle.
    bend : of the knee, 0 when straight (°).
    knee : direction in which the knee points.
    point : stretches the foot away from the shin, from a right angle (°).
    """

    to: Vector = (0.0, -1.0, 0.0)
    bend: float = 10.0
    knee: Vector = (0.0, 0.0, 1.0)
    point: float = 0.0


@dataclass(frozen=True, slots=True)
class Key:
    """A pose, or part of one, at a time: seconds, or a fraction of the cycle in a cyclic clip."""

    at: float
    place: Place | None = None
    hips: Turn | None = None
    chest: Turn | None = None
    head: Turn | None = None
    gaze: Gaze | None = None
    left_arm: ArmKey | None = None
    right_arm: ArmKey | None = None
    left_hand: Hand | None = None
    right_hand: Hand | None = None
    left_leg: LegKey | None = None
    right_leg: LegKey | None = None


PARTS = tuple(field.name for field in fields(Key) if field.name != "at")

LAG_S = {"chest": 0.025, "left_arm": 0.04, "right_arm": 0.04}
"""How late a part follows what carries it: the hips lead, the chest and then the arms follow."""


def at(time: float, key: Key) -> Key:
    """Return the key at another time."""
    return replace(key, at=time)


def mirrored(key: Key) -> Key:
    """Return the key with left and right exchanged."""

    def other_way(turn: Turn | None) -> Turn | None:
        return turn and Turn(-turn.yaw, turn.lean, -turn.tilt)

    return Key(
        at=key.at,
        place=key.place and replace(key.place, left=-key.place.left),
        hips=other_way(key.hips),
        chest=other_way(key.chest),
        head=other_way(key.head),
        gaze=key.gaze and replace(key.gaze, left=-key.gaze.left),
        left_arm=key.right_arm,
        right_arm=key.left_arm,
        left_hand=key.right_hand,
        right_hand=key.left_hand,
        left_leg=key.right_leg,
        right_leg=key.left_leg,
    )


def both_sides(half: Iterable[Key]) -> tuple[Key, ...]:
    """Return a whole cycle from the keys of its first half, the second being its mirror image."""
    half = tuple(half)
    return half + tuple(replace(mirrored(key), at=key.at + 0.5) for key in half)


def carried(key: Key, *, ahead: float = 0.0, yaw: float = 0.0) -> Key:
    """Return the key as seen after walking ``ahead`` metres and turning by ``yaw`` degrees."""
    sine, cosine = np.sin(np.radians(yaw)), np.cos(np.radians(yaw))

    def turned(turn: Turn | None) -> Turn | None:
        return turn and replace(turn, yaw=turn.yaw + yaw)

    place = key.place and Place(
        left=float(cosine * key.place.left + sine * key.place.ahead),
        up=key.place.up,
        ahead=float(cosine * key.place.ahead - sine * key.place.left) + ahead,
    )
    return replace(
        key,
        place=place,
        hips=turned(key.hips),
        chest=turned(key.chest),
        head=turned(key.head),
    )


def part_curve(
    keys: Iterable[Key], part: str, frames: int, rate_hz: float, *, cyclic: bool
) -> FloatArray | None:
    """Sample one part's numbers, in its fields' order, ``(frames, c)``; None if it has no key."""
    posed = sorted((k for k in keys if getattr(k, part) is not None), key=lambda k: k.at)
    if not posed:
        return None
    values = [
        np.hstack([getattr(v, f.name) for f in fields(v)]) for k in posed if (v := getattr(k, part))
    ]
    scale = (frames - 1) / rate_hz if cyclic else 1.0
    return smooth_curve(
        [k.at * scale for k in posed],
        values,
        frames,
        rate_hz,
        lag_s=LAG_S.get(part, 0.0),
        cyclic=cyclic,
    )


def columns_of(part: ArmKey | Hand | LegKey, numbers: FloatArray) -> Numbers:
    """Return a part's numbers ``(n, c)`` by its fields' names; directions have three columns."""
    widths = {field.name: np.size(getattr(part, field.name)) for field in fields(part)}
    ends = np.cumsum(list(widths.values()))
    return {
        name: numbers[:, end - width : end] if width > 1 else numbers[:, end - 1]
        for (name, width), end in zip(widths.items(), ends, strict=True)
    }
