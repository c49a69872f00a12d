"""Stepping: small steps where a character's feet stand and its body turns or shifts over them.

A character may turn in place while nothing is performed, or its next clip may stand elsewhere. Its
legs would twist over planted feet, or its feet would slide. It steps instead, one foot after the
other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.easing import smootherstep
from smd.geometry.runs import runs_of_true

TURN_COUNTS_M = 0.3
"""Metres that a turn by one radian counts as: a little more than a foot's length."""

RESTLESS_M_S = 0.12
"""Speed at which the poses move the feet, above which they cannot stay planted."""

FAR_M = 0.12
"""How far the body may move from its planted feet before they step."""

FAR_TURN_RAD = np.radians(100.0)
"""Most that one step of each foot turns the body; a larger turn takes more steps."""

STEP_S = 0.25
"""Least duration of a step, where there is time."""

MOST_ALONE = 4
"""Legs up to which each steps alone; of more, so many groups take turns, spread over the body."""

LIFT_M = 0.045
"""How high a step lifts the foot."""


def stepping(
    place_m: FloatArray,
    yaw_rad: FloatArray,
    stands: BoolArray,
    left_m: FloatArray,
    rate_hz: float,
) -> tuple[BoolArray, FloatArray]:
    """Let standing feet step where the poses move all of them.

    Parameters
    ----------
    place_m, yaw_rad
        ``(n, legs, 2)`` and ``(n, legs)`` position and heading of each foot in the poses.
    stands
        ``(n, legs)`` when it should stand.
    left_m
        ``(legs,)`` how far to the left each foot is at rest: turning left, the left one goes
        first.

    Returns
    -------
    stands
        As given, except during steps.
    lift_m
        ``(n, legs)`` how high each step lifts the foot.
    """
    stands, lift_m = stands.copy(), np.zeros(yaw_rad.shape)
    if len(yaw_rad) < 2 or yaw_rad.shape[1] == 0:
        return stands, lift_m
    shifting = np.linalg.norm(np.gradient(place_m, axis=0), axis=-1) * rate_hz
    turning = np.abs(np.gradient(yaw_rad, axis=0)) * rate_hz
    speed = shifting + TURN_COUNTS_M * turning
    restless = np.asarray(speed.max(axis=1) > RESTLESS_M_S)
    all_stand = np.asarray(stands.all(axis=1))
    for first, last in runs_of_true(all_stand):
        for start, end in runs_of_true(restless[first:last]) + first:
            # Where the feet get going from or come to standing, the clip's own steps do it.
            if start == first or end == last:
                continue
            far_m = speed[start:end].sum(axis=0) / rate_hz
            if far_m.max() < FAR_M:
                continue
            turn = float((yaw_rad[end - 1] - yaw_rad[start]).mean())
            order = np.argsort(-left_m * np.sign(turn), kind="stable")
            order = order[far_m[order] > 0.5 * FAR_M]
            rounds = max(int(np.ceil(abs(turn) / FAR_TURN_RAD)), 1)
            groups = min(len(order), MOST_ALONE)
            steps = [order[i::groups] for i in range(groups)] * rounds
            edges = _widened(start, end, first + 1, last - 1, len(steps) * STEP_S * rate_hz)
            _take(stands, lift_m, steps, edges)
    return stands, lift_m


def _widened(start: int, end: int, low: int, high: int, least: float) -> tuple[int, int]:
    """Return a stretch of at least ``least`` frames around another, as far as there is room."""
    spare = max(int(np.ceil(least)) - (end - start), 0)
    start = max(start - (spare + 1) // 2, low)
    end = min(max(end + spare // 2, start + int(np.ceil(least))), high)
    return start, end


def _take(
    stands: BoolArray, lift_m: FloatArray, steps: Sequence[IntArray], edges: tuple[int, int]
) -> None:
    """Take the steps of some legs each, one after the other, in place.

    The feet stand for a frame in between.
    """
    cuts = np.linspace(*edges, len(steps) + 1).round().astype(int)
    for legs, start, end in zip(steps, cuts[:-1], cuts[1:], strict=True):
        if end - start < 3:
            continue
        way = np.linspace(0.0, 1.0, end - start + 1)[1:-1]
        stands[start + 1 : end, legs] = False
        lifted_m = LIFT_M * smootherstep(2.0 * np.minimum(way, 1.0 - way))
        lift_m[start + 1 : end, legs] = lifted_m[:, None]
