"""Stretches: the parts of a doodle that are weighed against the actions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.recognition.tokens import TokenRun

SHORTEST, LONGEST = 0.7, 1.4
"""The lengths of dense stretches, as shares of the shortest and the longest action's duration."""

RATIO = 1.25
"""Each length is so many times the one before, at most."""

STEP = 0.1
"""Stretches of one length end so far apart, as a share of it."""


def dense_stretches(
    runs: Sequence[TokenRun], is_still: BoolArray, durations_s: FloatArray
) -> list[tuple[int, int]]:
    """Return stretches of n runs of all lengths that actions have, close together.

    Real hands hardly rest between gestures, and a pattern learned from a few examples does not
    cover every way into one. So a gesture may be anywhere. Ends lie at multiples of a step from the
    clock's zero, so that a doodle that is still growing is cut like the whole one. A stretch has
    the runs whose middles lie in it, without the stillness at its ends.

    Parameters
    ----------
    runs
        Of one doodle.
    is_still
        ``(n,)``.
    durations_s
        ``(a,)``, how long each action usually takes, at least one.

    Returns
    -------
    list of pairs
        First run and the one after the last, each pair once.
    """
    if not len(runs):
        return []
    start_s, end_s = runs[0].start_s, runs[-1].end_s
    middle_s = np.array([0.5 * (run.start_s + run.end_s) for run in runs])
    after, before = _moving(is_still)
    pairs = []
    for length_s in _lengths(durations_s):
        step_s = STEP * length_s
        end = step_s * np.arange(np.ceil(start_s / step_s), np.floor(end_s / step_s + 1.0) + 1.0)
        first = after[np.searchsorted(middle_s, end - length_s)]
        last = before[np.searchsorted(middle_s, end)]
        pairs.append(np.stack([first, last], axis=1)[first < last])
    return [(int(first), int(last)) for first, last in np.unique(np.concatenate(pairs), axis=0)]


def are_alike_long(length_s: FloatArray, durations_s: FloatArray) -> BoolArray:
    """Return ``(g, a)``, whether stretches may be actions of some durations by their lengths alone.

    Where a stretch ends is moved to the ends of runs: a length more to either side is allowed.
    """
    times = length_s[:, None] / durations_s
    return np.asarray((times >= SHORTEST / RATIO) & (times <= LONGEST * RATIO))


def _lengths(durations_s: FloatArray) -> FloatArray:
    """Return the lengths of stretches in seconds."""
    low, high = np.log([SHORTEST * durations_s.min(), LONGEST * durations_s.max()])
    return np.exp(np.linspace(low, high, int(np.ceil((high - low) / np.log(RATIO))) + 1))


def _moving(is_still: BoolArray) -> tuple[IntArray, IntArray]:
    """Return, ``(n + 1,)``, the first moving run from each on, and the end of the last before."""
    n = len(is_still)
    at = np.arange(n + 1)
    moving = np.append(~is_still, False)
    after = np.minimum.accumulate(np.where(moving, at, n)[::-1])[::-1]
    before = np.maximum.accumulate(np.concatenate([[0], np.where(moving, at + 1, 0)[:-1]]))
    return after, before
