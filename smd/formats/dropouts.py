"""Where tracking was lost: no rows, rows that repeat one pose, poses that are not numbers.

Repeating a pose is no loss by itself. A tracker that reports at 30 Hz into a file of 60 Hz
repeats every second row, and a prop at rest on a table may repeat exactly for as long as it lies
there. What tells a loss is that the pose *jumps* into or out of the repetition, because the prop
moved on meanwhile: see `_is_jump`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.doodle import Dropout, DropoutKind
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.rotations import inverse, multiply

LONGEST_BRIDGE_S = 0.25
"""A longer loss splits the doodle: no one knows what the hand did meanwhile."""

SHORTEST_LOSS_S = 0.1
"""Repetitions and gaps up to this long are the sensor's own unevenness, and not reported.

A stretch of tracking between two splits that is shorter than this holds no gesture; it is counted
as lost with them.
"""

JUMP_RATIO = 3.0
"""A step is a jump when it is this much faster than the steps next to it, and …"""
JUMP_M_S, JUMP_RAD_S = 0.5, 5.0
"""… faster than what a hand reaches in the first instant after a rest."""

LEAP_M_S = 20.0
"""No hand moves so fast: a pose repeated even once beside such a step is a tracker's stand-in."""

_NEIGHBOURS = 3  # steps beside a jump that it is compared with: one alone may be a repeated row

_GOOD, _INVALID, _FROZEN, _ISLAND = range(4)
_KIND: dict[int, DropoutKind] = {_GOOD: "gap", _INVALID: "invalid", _FROZEN: "frozen"}


@dataclass(frozen=True, slots=True, eq=False)
class Tracking:
    """What is left of a device's rows.

    Attributes
    ----------
    stretches : indices of good rows, one array for each doodle; empty when nothing is left.
    dropouts : where rows were lost, in time order.
    """

    stretches: tuple[IntArray, ...]
    dropouts: tuple[Dropout, ...]


def find_dropouts(
    device: str,
    time_s: FloatArray,
    position_m: FloatArray,
    orientation_xyzw: FloatArray,
    valid: BoolArray,
) -> Tracking:
    """Find where tracking was lost.

    Parameters
    ----------
    device
        Its name, for the dropouts.
    time_s
        (n,) increasing.
    position_m, orientation_xyzw
        (n, 3) and (n, 4).
    valid
        (n,) true where a pose is made of numbers.
    """
    state = np.where(valid, _GOOD, _INVALID)
    rows = np.flatnonzero(valid)
    state[rows[_frozen(time_s[rows], position_m[rows], orientation_xyzw[rows])]] = _FROZEN
    stretches = _stretches(time_s, state)
    if len(stretches) > 1:
        for island in stretches:
            if time_s[island[-1]] - time_s[island[0]] < SHORTEST_LOSS_S:
                state[island] = _ISLAND
        stretches = _stretches(time_s, state)
    return Tracking(stretches, tuple(_dropouts(device, time_s, state)))


def _stretches(time_s: FloatArray, state: IntArray) -> tuple[IntArray, ...]:
    """Return the good rows, split where the time between them is too long to bridge."""
    good = np.flatnonzero(state == _GOOD)
    if len(good) == 0:
        return ()
    # + 1e-9: 0.25 s between decimal times may come out a little longer.
    splits = np.flatnonzero(np.diff(time_s[good]) > LONGEST_BRIDGE_S + 1e-9)
    return tuple(np.split(good, splits + 1))


def _dropouts(device: str, time_s: FloatArray, state: IntArray) -> list[Dropout]:
    """Return the losses before, between and after the good rows."""
    good = np.flatnonzero(state == _GOOD)
    steps = np.diff(time_s)
    usual_s = float(np.median(steps)) if len(steps) else 0.0
    unusual_s = min(max(SHORTEST_LOSS_S, 2.0 * usual_s), LONGEST_BRIDGE_S)
    length_s = np.diff(time_s[good])
    lossy = (np.diff(good) > 1) | (length_s > unusual_s + 1e-9)
    pairs = [(int(good[i]), int(good[i + 1])) for i in np.flatnonzero(lossy)]
    if not len(good):
        pairs = [(0, len(state) - 1)]
    elif good[0] > 0:
        pairs.insert(0, (0, int(good[0])))
    if len(good) and good[-1] < len(state) - 1:
        pairs.append((int(good[-1]), len(state) - 1))
    return [
        Dropout(
            device=device,
            start_s=float(time_s[first]),
            end_s=float(time_s[last]),
            kind=_kind(state[first : last + 1]),
            bridged=bool(
                state[first] == state[last] == _GOOD
                and time_s[last] - time_s[first] <= LONGEST_BRIDGE_S + 1e-9
            ),
        )
        for first, last in pairs
    ]


def _kind(state: IntArray) -> DropoutKind:
    """Return what most of the lost rows are; no rows at all are a gap."""
    counts = np.bincount(state, minlength=4)[[_GOOD, _INVALID, _FROZEN]]
    counts[_GOOD] = 0
    return _KIND[int(np.argmax(counts))]


def _frozen(time_s: FloatArray, position_m: FloatArray, orientation_xyzw: FloatArray) -> IntArray:
    """Return the rows that repeat a pose because tracking was lost.

    The first row of a repetition is a measurement, unless the pose jumped there.
    """
    if len(time_s) < 3:
        return np.zeros(0, dtype=np.int64)
    pose = np.concatenate([position_m, orientation_xyzw], axis=1)
    same = np.concatenate([[False], (pose[1:] == pose[:-1]).all(axis=1), [False]])
    first = np.flatnonzero(~same[:-1] & same[1:])  # row whose pose is repeated
    last = np.flatnonzero(same[:-1] & ~same[1:])  # last row of the repetition
    long = (time_s[last] - time_s[first] > SHORTEST_LOSS_S + 1e-9) & (last - first >= 2)
    speeds = _speeds(time_s, position_m, orientation_xyzw)
    after = np.minimum(last + 1, len(time_s) - 1)
    leap = np.maximum(speeds[first, 0], speeds[after, 0]) > LEAP_M_S
    frozen = [np.zeros(0, dtype=np.int64)]
    for a, b in zip(first[long | leap], last[long | leap], strict=True):
        entered = _is_jump(speeds, a, range(a - 1, a - 1 - _NEIGHBOURS, -1))
        left = _is_jump(speeds, b + 1, range(b + 2, b + 2 + _NEIGHBOURS))
        if entered or left:
            frozen.append(np.arange(a if entered else a + 1, b + 1))
    return np.concatenate(frozen)


def _speeds(time_s: FloatArray, position_m: FloatArray, orientation_xyzw: FloatArray) -> FloatArray:
    """Return speed and turning speed of the step into each row, (n, 2); none into the first."""
    # Stamps jitter more than poses do: 19 ms, then 3 ms, for equal steps, is common in browsers.
    step_s = np.maximum(np.diff(time_s), np.median(np.diff(time_s)))
    turn = multiply(inverse(orientation_xyzw[:-1]), orientation_xyzw[1:])
    angle_rad = 2.0 * np.arctan2(np.linalg.norm(turn[:, :3], axis=1), np.abs(turn[:, 3]))
    distance_m = np.linalg.norm(np.diff(position_m, axis=0), axis=1)
    return np.vstack(
        [np.zeros((1, 2)), np.stack([distance_m, angle_rad], axis=1) / step_s[:, None]]
    )


def _is_jump(speeds: FloatArray, row: int, beside: range) -> bool:
    """Return whether the step into ``row`` is out of proportion to the steps beside it.

    A prop that stops or starts abruptly moves just as fast on the far side of that step; one
    that moved on unseen makes up for it in a single step.
    """
    if row >= len(speeds):
        return False
    usual = np.max([speeds[i] for i in beside if 0 < i < len(speeds)] or [[0.0, 0.0]], axis=0)
    limit = np.maximum([JUMP_M_S, JUMP_RAD_S], JUMP_RATIO * usual)
    return bool(speeds[row, 0] > LEAP_M_S or (speeds[row] > limit).any())
