"""Footing: foot contacts without foot sliding.

A clip's planted feet do not slide as long as its ground root travels as it did in the clip. On a
doodle's path it goes faster, slower, sideways or around a bend, and between clips poses are
blended. So while a foot should stand, the sliding of its sole is subtracted, frame by frame; while
it swings, the corrections before and after are interpolated, as in [1]_.

References
----------
.. [1] L. Kovar, J. Schreiner, M. Gleicher, "Footskate Cleanup for Motion Capture Editing",
   Symposium on Computer Animation 2002.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.acting.legs import Leg, yaw_of
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.easing import fading, smootherstep
from smd.geometry.rotations import quaternion_about, rotate
from smd.geometry.runs import runs_of_true

LOW_M = 0.01
"""Height up to which a sole counts as on the ground, where the clip says that it stands."""

ROLLING_M = 0.005
"""Difference in height of heel and ball over which a foot rolls from one onto the other."""

STILL_M_S = 0.05
"""Speed of a sole below which its weight hardly depends on the speed."""


CLEARANCE_M = 0.02
"""Least height of a swinging foot; blended with standing, a step may be lower than that."""

CLEARING_S = 0.1
"""Time in which it reaches that height, and comes down; never more than half the swing."""

SHORTEST_PLANT = 2
"""Least number of frames of a plant; in one frame alone a foot cannot slide."""

LETTING_GO_S = 0.25
"""Longest time over which the velocity of a correction decays in a swing."""

FORGETTING_S = 0.8
"""Time over which a foot in the air returns to its position in the poses; a stride is shorter."""


@dataclass(frozen=True, slots=True, eq=False)
class Footing:
    """The correction of a foot's motion in the poses.

    Attributes
    ----------
    stands : (n,) when it stands.
    shift_m : (n, 3) added to the ankle's place in the world.
    turn_rad : (n,) turned about +Y at the ankle.
    """

    stands: BoolArray
    shift_m: FloatArray
    turn_rad: FloatArray


def footing(
    leg: Leg,
    foot_xyzw: FloatArray,
    ankle_m: FloatArray,
    stands: BoolArray,
    pivot_rad: FloatArray,
    lift_m: FloatArray,
    rate_hz: float,
) -> Footing:
    """Remove the sliding of a foot, and keep it above the ground.

    Parameters
    ----------
    foot_xyzw, ankle_m
        ``(n, 4)`` and ``(n, 3)`` the foot in the world, in the poses.
    stands
        ``(n,)`` when it should stand; it does while it is low enough.
    pivot_rad
        ``(n,)`` how far the clips themselves pivot it; this is kept.
    lift_m
        ``(n,)`` how much higher it goes.
    """
    heel, ball = rotate(foot_xyzw, leg.heel_m), rotate(foot_xyzw, leg.ball_m)
    heel_up = ankle_m[:, 1] + heel[:, 1]
    ball_up = ankle_m[:, 1] + ball[:, 1] - leg.ball_height_m
    above = np.minimum(heel_up, ball_up)
    plants = plants_of(stands & (above < LOW_M))
    down = np.zeros(len(stands), dtype=bool)
    for start, end in plants:
        down[start:end] = True

    on_ball = 1.0 / (1.0 + np.exp(np.clip((ball_up - heel_up) / ROLLING_M, -50.0, 50.0)))
    slide = _slide(ankle_m + heel, ankle_m + ball, on_ball)
    speed = rate_hz * np.linalg.norm(slide, axis=-1)
    speed[1:] = np.maximum(speed[1:], speed[:-1])  # of both steps, before the frame and after
    weight = 1.0 / (STILL_M_S**2 + speed**2)
    twist = yaw_of(leg, foot_xyzw) - pivot_rad
    turn = _evened(_about_mean(-twist[:, None], weight, plants), plants, rate_hz)[:, 0]

    about = quaternion_about([0.0, 1.0, 0.0], turn)
    slide = _slide(ankle_m + rotate(about, heel), ankle_m + rotate(about, ball), on_ball)
    back = np.concatenate([[[0.0, 0.0]], -np.cumsum(slide, axis=0)[:-1]])
    back = _about_mean(back, weight, plants)
    aside = _evened(back, plants, rate_hz)
    # Upward, a foot may leave the ground at once: carried on, its speed would press it down.
    up = np.maximum(_evened(-above[:, None], plants, 0.0)[:, 0], -above) + lift_m
    up += _cleared(above + up, plants, rate_hz)
    return Footing(down, np.stack([aside[:, 0], up, aside[:, 1]], axis=-1), turn)


def plants_of(stands: BoolArray) -> IntArray:
    """Return when a foot stands: first frame and one past the last of each plant, ``(p, 2)``."""
    plants = runs_of_true(stands)
    return plants[plants[:, 1] - plants[:, 0] >= SHORTEST_PLANT]


def _slide(heel_m: FloatArray, ball_m: FloatArray, on_ball: FloatArray) -> FloatArray:
    """Return how far the part that bears weight slides until the next frame."""
    share = 0.5 * (on_ball[1:] + on_ball[:-1])[:, None]
    step = share * np.diff(ball_m, axis=0) + (1.0 - share) * np.diff(heel_m, axis=0)
    return np.concatenate([step[:, [0, 2]], [[0.0, 0.0]]])


def _about_mean(value: FloatArray, weight: FloatArray, plants: IntArray) -> FloatArray:
    """Return ``value (n, k)`` less its weighted mean in each plant.

    So a foot stands at its mean position in the poses, mostly of the frames in which it is still.
    """
    value = value.copy()
    for start, end in plants:
        share = weight[start:end] / weight[start:end].sum()
        value[start:end] -= share @ value[start:end]
    return value


def _cleared(above_m: FloatArray, plants: IntArray, rate_hz: float) -> FloatArray:
    """Return how much higher ``(n,)`` each swing between two plants must go to clear the ground."""
    more = np.zeros_like(above_m)
    for leave, land in zip(plants[:-1, 1], plants[1:, 0], strict=True):
        way = np.arange(1, land - leave + 1)
        edge = np.minimum(way, way[::-1])
        full = max(min(CLEARING_S * rate_hz, 0.5 * (land - leave + 1)), 1.0)
        share = smootherstep(edge / full)
        short = CLEARANCE_M * share - above_m[leave:land]
        blunt = 0.2 * CLEARANCE_M * share + 1e-6  # no kink where the swing's own height takes over
        more[leave:land] = blunt * np.logaddexp(0.0, short / blunt)
    return more


def _evened(value: FloatArray, plants: IntArray, rate_hz: float) -> FloatArray:
    """Return ``value (n, k)`` unchanged in plants, and interpolated smoothly between them.

    The derivative is continuous at the ends of plants. Before the first plant and after the last,
    it comes from rest and goes to rest.
    """
    n = len(value)
    if len(plants) == 0:
        return np.zeros_like(value)
    frames = np.arange(n)
    after = np.searchsorted(plants[:, 0], frames, side="right")  # plants begun by each frame
    left, right = np.maximum(after - 1, 0), np.minimum(after, len(plants) - 1)
    leave, land = plants[left, 1] - 1, plants[right, 0]
    leave = np.where(after == 0, land, leave)
    land = np.where(after == len(plants), leave, land)

    speed = np.zeros_like(value)  # at either end of a plant, per frame
    first, last = plants[:, 0], plants[:, 1] - 1
    speed[first], speed[last] = value[first + 1] - value[first], value[last] - value[last - 1]

    passed, left_over = frames - leave, land - frames
    whole = np.maximum(land - leave, 1)
    within = min(LETTING_GO_S * rate_hz, float(n))
    # In a long flight what was taken out on either side is forgotten on the way.
    led = np.minimum(whole, FORGETTING_S * rate_hz) if rate_hz else whole
    outside = (after == 0) | (after == len(plants))
    start, end = (
        1.0 - smootherstep(np.where(outside, 0.0, away / led))[:, None]
        for away in (passed, left_over)
    )
    room = np.where(outside, within, np.minimum(whole, within))
    room = np.maximum(room, 1e-9)
    way = np.where(outside[:, None], value[leave], start * value[leave] + end * value[land])
    way = way + (room * fading(np.abs(passed) / room))[:, None] * speed[leave]
    way = way - (room * fading(np.abs(left_over) / room))[:, None] * speed[land]
    inside = (frames < plants[left, 1]) & (after > 0)
    return np.where(inside[:, None], value, way)
