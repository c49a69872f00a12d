"""Proposals: stretches of a doodle that may be an action, as the automata see them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.bank import Bank, least_costs_of_parts
from smd.recognition.costs import RunCosts
from smd.recognition.tokens import TokenRun

MOST_STROKES = 4
"""How many strokes, with rests between them, one gesture has at most (a bow that is held has 2)."""

STIR = 0.05
"""Share of a gesture's largest run below which the runs at its ends are no part of it."""


class Proposal(NamedTuple):
    """Runs ``first`` (included) to ``last`` (excluded) may be action ``action`` of a bank.

    ``distance`` is what it costs to read them so, in edits.
    """

    action: int
    first: int
    last: int
    distance: float


def explaining(bank: Bank, runs: Sequence[TokenRun], prices: RunCosts) -> list[Proposal]:
    """Return, for each action and each end, the stretch that explains most.

    One pass over the runs carries the states of all automata. A stretch explains what its runs
    would cost if they were left unexplained, less what it costs to read them as the action; only
    those that explain anything are proposed.
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


def between_rests(bank: Bank, runs: Sequence[TokenRun], prices: RunCosts) -> list[Proposal]:
    """Return, for every action, each stretch from one rest to another, a few strokes long.

    A pattern learned from three examples does not know all ways to draw its action, and where
    they fall short, a rest still tells where a gesture begins and ends.
    """
    read = prices.of_reading(bank, runs)
    moving = ~np.asarray(prices.is_still)
    steps = np.diff(moving.astype(np.int8), prepend=0, append=0)
    firsts, lasts = np.flatnonzero(steps == 1).tolist(), np.flatnonzero(steps == -1).tolist()
    parts = [
        (first, last) for i, first in enumerate(firsts) for last in lasts[i : i + MOST_STROKES]
    ]
    costs = least_costs_of_parts(bank, parts, read=read, skip=prices.skip).tolist()
    return [
        Proposal(action, first, last, distance)
        for (first, last), distances in zip(parts, costs, strict=True)
        for action, distance in enumerate(distances)
    ]


def without_stir(found: Sequence[Proposal], runs: Sequence[TokenRun]) -> list[Proposal]:
    """Return the proposals without what the hand hardly stirs at their ends, each stretch once.

    That is still or below `STIR`: a rest that is not quite one must not move where a gesture
    begins and ends. Of an action's proposals for one stretch the nearest stays.
    """
    extent = [run.travel_heights + run.turn_rad for run in runs]
    meant: dict[tuple[int, int], tuple[int, int]] = {}
    for whole in dict.fromkeys((one.first, one.last) for one in found):
        first, last = whole
        least = STIR * max(extent[first:last])
        while extent[first] < least:
            first += 1
        while extent[last - 1] < least:
            last -= 1
        meant[whole] = first, last
    tight: dict[tuple[int, int, int], float] = {}
    for action, first, last, distance in found:
        stretch = (action, *meant[first, last])
        tight[stretch] = min(distance, tight.get(stretch, np.inf))
    return [Proposal(*stretch, distance) for stretch, distance in tight.items()]
