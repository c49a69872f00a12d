"""Segmentation: the cheapest way to cut a token string into actions and nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from smd.geometry.arrays import FloatArray
from smd.recognition.bank import Bank, Front
from smd.recognition.costs import Costs, run_costs
from smd.recognition.tokens import TokenRun


@dataclass(frozen=True, slots=True)
class Segment:
    """Tokens ``first`` (included) to ``last`` (excluded) are like action ``index``'s pattern."""

    index: int
    first: int
    last: int


Segmenter: TypeAlias = Callable[[Bank, Sequence[TokenRun], Costs], tuple[Segment, ...]]
"""Cuts runs into segments of a bank's actions, in order and without overlap."""


def least_cost_segments(bank: Bank, runs: Sequence[TokenRun], costs: Costs) -> tuple[Segment, ...]:
    """Cut runs into actions and unexplained rest at the least total cost (a `Segmenter`).

    Every action costs ``costs.action`` and its runs' edit distance to its pattern, every run
    outside of actions in proportion to the movement in it (`Costs`).
    """
    prices = run_costs(runs, costs)
    return cheapest_cut(
        bank,
        read=prices.of_reading(bank, runs),
        skip=prices.skip,
        unexplained=prices.unexplained,
        action=costs.action,
    )


def cheapest_cut(
    bank: Bank,
    *,
    read: FloatArray,
    skip: FloatArray,
    unexplained: FloatArray,
    action: float,
) -> tuple[Segment, ...]:
    """Cut a string of n tokens into segments and unexplained tokens at the least total cost.

    A segment costs ``action`` and its distance to its pattern. Since both add up token by token,
    one pass over the string that carries the states of all automata is exact (Viterbi's algorithm
    [1]_); no pair of ends is tried by itself. Where several ways cost the same, less is explained,
    then the earlier action is taken.

    Parameters
    ----------
    read
        ``(n, s)``: the cost of reading token i at each state of the bank.
    skip
        ``(n,)``, the cost of deleting token i from a segment around it.
    unexplained
        ``(n,)``, the cost of leaving token i outside of all segments; at most ``skip``.
    action
        The cost of each segment besides its distance.

    References
    ----------
    .. [1] A. J. Viterbi, "Error Bounds for Convolutional Codes and an Asymptotically Optimum
       Decoding Algorithm", IEEE Transactions on Information Theory 13(2), 1967.
    """
    if not len(bank):
        return ()
    front = bank.nowhere()
    best = 0.0
    ending: list[Segment | None] = []
    prices = zip(read, skip.tolist(), unexplained.tolist(), strict=True)
    for j, (reading, skipping, leaving) in enumerate(prices):
        front = bank.after(front, entering=best + action, at=j, read=reading, skip=skipping)
        best, segment = _ended(bank.leaving(front), best + leaving, j + 1)
        ending.append(segment)
    return _traced(ending)


def _ended(ending: Front, unexplained: float, last: int) -> tuple[float, Segment | None]:
    """Return the least cost up to a token, and the segment that ends there if it costs less."""
    index = int(ending.cost.argmin())
    cost = float(ending.cost[index])
    if cost < unexplained:
        return cost, Segment(index, int(ending.start[index]), last)
    return unexplained, None


def _traced(ending: Sequence[Segment | None]) -> tuple[Segment, ...]:
    """Return the segments on the best way, followed back from the string's end.

    ``ending[j]`` is the segment that ends after token j on the best way there, if one does.
    """
    segments = []
    j = len(ending)
    while j:
        segment = ending[j - 1]
        if segment is None:
            j -= 1
        else:
            segments.append(segment)
            j = segment.first
    return tuple(reversed(segments))
