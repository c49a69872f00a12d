"""Strokes: displacements and turns from rest to rest, and ways to put them together.

A stroke follows the minimum-jerk course [1]_ and begins before the one before it has ended, so
that corners are round [2]_. All numbers are ours, in figurine scale, and not measurements of
people.

References
----------
.. [1] T. Flash, N. Hogan, "The Coordination of Arm Movements: An Experimentally Confirmed
   Mathematical Model", Journal of Neuroscience 5(7), 1985.
.. [2] T. Flash, E. Henis, "Arm Trajectory Modifications During Reaching Towards Visual Targets",
   Journal of Cognitive Neuroscience 3(3), 1991: superposed strokes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.synthetic.curves import Vector


@dataclass(frozen=True, slots=True)
class Stroke:
    """A displacement and a turn from rest to rest.

    Attributes
    ----------
    start_s : after the gesture's beginning.
    duration_s : positive.
    move_m : displacement along (left, up, front) of the upright frame faced at the beginning.
    turn_rad : rotation vector in the prop's own frame.
    cruise : share of the duration, in [0, 1), spent at full speed in the middle.
    """

    start_s: float
    duration_s: float
    move_m: Vector = (0.0, 0.0, 0.0)
    turn_rad: Vector = (0.0, 0.0, 0.0)
    cruise: float = 0.0

    @property
    def end_s(self) -> float:
        """When it comes to rest, after the gesture's beginning."""
        return self.start_s + self.duration_s


def progress(u: FloatArray, cruise: float = 0.0) -> FloatArray:
    """Return how much of a stroke is done at the share ``u`` of its duration: 0 to 1.

    The minimum-jerk course, cut in the middle, with a share ``cruise`` of constant speed between.
    """
    bell = 1.0 - cruise
    peak = 1.875 / bell  # speed at which the two halves meet, before the whole is scaled to 1
    u = np.clip(u, 0.0, 1.0)
    s = np.where(u < 0.5, np.minimum(u / bell, 0.5), np.maximum((u - cruise) / bell, 0.5))
    curved = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    straight = peak * np.clip(u - 0.5 * bell, 0.0, cruise)
    return (curved + straight) / (1.0 + peak * cruise)


def chained(overlap: float, *strokes: Stroke) -> tuple[Stroke, ...]:
    """Return strokes one after another, each beginning before the end of the one before it.

    They overlap by a share of the shorter one; the start that a stroke carries is added.
    """
    placed: list[Stroke] = []
    for stroke in strokes:
        if placed:
            before = placed[-1]
            shared_s = overlap * min(before.duration_s, stroke.duration_s)
            stroke = replace(stroke, start_s=stroke.start_s + before.end_s - shared_s)
        placed.append(stroke)
    return tuple(placed)


def gliding(move_m: Vector, speed_m_s: float, *, at_s: float = 0.0) -> Stroke:
    """Return a stroke that cruises for six tenths of its time at about ``speed_m_s``."""
    distance_m = float(np.linalg.norm(move_m))
    return Stroke(at_s, 1.25 * distance_m / speed_m_s, move_m, cruise=0.6)


def bobbing(glide: Stroke, rise_m: float, period_s: float) -> tuple[Stroke, ...]:
    """Return a glide with ups and downs on the way: a whole number of hops."""
    hops = max(round(glide.duration_s / period_s), 1)
    half_s = glide.duration_s / (2 * hops)
    up, down = (0.0, rise_m, 0.0), (0.0, -rise_m, 0.0)
    beats = [Stroke(i * half_s, half_s, down if i % 2 else up) for i in range(2 * hops)]
    return (glide, *beats)


def leaning(
    overlap: float, tilt_deg: float, *middle: Stroke, tilting_s: float = 0.4
) -> tuple[Stroke, ...]:
    """Return a tilt forward about the left axis, strokes, and the tilt back."""
    angle = np.radians(tilt_deg)
    tip = Stroke(0.0, tilting_s, turn_rad=(angle, 0.0, 0.0))
    return chained(overlap, tip, *middle, replace(tip, turn_rad=(-angle, 0.0, 0.0)))


def rocking(axis: int, tilt_deg: float, count: int, each_s: float) -> tuple[Stroke, ...]:
    """Return turns to and fro about an axis of the prop, which end where they began."""
    tilt = np.radians(tilt_deg)
    turns = [tilt, *(2.0 * tilt * (-1.0) ** i for i in range(1, count)), tilt * (-1.0) ** count]
    vectors = [tuple(turn if i == axis else 0.0 for i in range(3)) for turn in turns]
    return tuple(
        Stroke(i * each_s, each_s, turn_rad=(v[0], v[1], v[2])) for i, v in enumerate(vectors)
    )


def later(strokes: tuple[Stroke, ...], by_s: float) -> tuple[Stroke, ...]:
    """Return strokes that begin later."""
    return tuple(replace(stroke, start_s=stroke.start_s + by_s) for stroke in strokes)


def to_and_fro(move_m: Vector, count: int, each_s: float) -> tuple[Stroke, ...]:
    """Return strokes there and back, one after the other."""
    back = (-move_m[0], -move_m[1], -move_m[2])
    return tuple(Stroke(i * each_s, each_s, back if i % 2 else move_m) for i in range(count))
