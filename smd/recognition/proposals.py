"""Proposals: stretches of a doodle that may be an action according to the automata."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.runs import runs_of_true
from smd.recognition.bank import Bank
from smd.recognition.costs import RunCosts
from smd.recognition.tokens import TokenRun

MOST_STROKES = 4
"""Largest number of strokes, with rests between, in one gesture (a bow that is held has 2)."""

STIR = 0.05
"""Share of a gesture's largest run below which the runs at its ends are cut off."""


class Proposal(NamedTuple):
    """Runs ``first`` (included) to ``last`` (excluded) may be action ``action`` of a bank.

    ``distance`` is what it costs to read them so, in edits.
    """

    action: int
    first: int
    last: int
    distance: float


def explaining(bank: Bank, runs: Sequence[TokenRun], prices: RunCosts) -> list[Proposal]:
    """Return, for each action and each end, the stretch with the largest gain.

    One pass over the runs carries the states of all automata. The gain of a stretch is the cost of
    its runs if left unexplained, less the cost of reading them as the action. Only stretches with
    a positive gain are proposed.
    """
    found: list[Proposal] = []
    if not len(bank):
        return found
    unexplained = np.concatenate([[0.0], np.cumsum(prices.unexplained)])
    front = bank.nowhere()
    reading: FloatArray = prices.of_reading(bank, runs)
    for j, (read, skip) in enumerate(zip(reading, prices.skip.tolist(), strict=True)):
        before, after = float(unexplained[j]), float(unexplained[j + 1])
        front = bank.after(front, entering=before, at=j, read=read, skip=skip)
        if prices.is_still[j]:
            continue
        cost, start = bank.leaving(front)
        for index in np.flatnonzero(cost < after - 1e-9).tolist():
            first = int(start[index])
            distance = float(cost[index] - unexplained[first])
            found.append(Proposal(index, first, j + 1, max(distance, 0.0)))
    return found


def rest_to_rest(is_still: BoolArray) -> list[tuple[int, int]]:
    """Return each stretch of runs from one rest to another, a few strokes long.

    A pattern learned from three examples does not cover all ways to draw its action. Where it
    fails, rests still mark where a gesture begins and ends.
    """
    firsts, lasts = runs_of_true(~is_still).T.tolist()
    return [(first, last) for i, first in enumerate(firsts) for last in lasts[i : i + MOST_STROKES]]


def without_stir(
    stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun]
) -> list[tuple[int, int]]:
    """Return stretches without the stir at their ends.

    Stir is still or below `STIR`: an imperfect rest must not shift the ends of a gesture.
    """
    extent = [run.travel_heights + run.turn_rad for run in runs]
    meant = []
    for first, last in stretches:
        least = STIR * max(extent[first:last])
        while extent[first] < least:
            first += 1
        while extent[last - 1] < least:
            last -= 1
        meant.append((first, last))
    return meant
