"""TokenSpotter: from runs of tokens to spans of actions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from laban import RigidMotion
from smd.geometry.arrays import FloatArray
from smd.recognition.bank import Bank, compile_library, least_costs_of_parts
from smd.recognition.costs import DEFAULT_COSTS, Costs, run_costs
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segment, Segmenter, least_cost_segments
from smd.recognition.tokens import TokenRun


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of runs that is one action.

    Attributes
    ----------
    action : its name.
    first_run, last_run : runs ``first_run`` (included) to ``last_run`` (excluded).
    start_s, end_s : where the first of them begins and the last one ends.
    distance : from the runs to the action's pattern, in edits.
    confidence : in [0, 1], see `recognize`.
    alternatives : the other actions and their distances, nearest first.
    """

    action: str
    first_run: int
    last_run: int
    start_s: float
    end_s: float
    distance: float
    confidence: float
    alternatives: tuple[tuple[str, float], ...]


def recognize(
    runs: Sequence[TokenRun],
    library: Bank | Mapping[str, Pattern],
    *,
    costs: Costs = DEFAULT_COSTS,
    segments: Segmenter = least_cost_segments,
) -> tuple[Span, ...]:
    """Find the actions in a tokenized doodle.

    The runs are cut into actions and unexplained rest, by default at the least total cost: every
    action costs ``costs.action`` and its runs' edit distance to its pattern, every unexplained run
    in proportion to the movement in it, unexplained stillness nothing. Little or aimless movement
    is therefore cheaper to leave alone than to explain. An action then takes in the small runs
    that lead into it or out of it.

    The distance is Levenshtein's (section 4.2 of the paper [1]_) with two prices that depend on
    the run: leaving a run out costs less than one edit when there is little movement in it, and
    taking it for the token that it is costs something when it is faint.

    The confidence weighs the chosen action against the other ones and against nothing, over the
    same runs: with the cost d of each it is ``exp(-s d_chosen) / sum(exp(-s d))``, where s is
    ``costs.sharpness``, and nothing costs its unexplained runs less ``costs.action``. It ranks
    how clear-cut spans are; it is not a measured probability.

    Parameters
    ----------
    runs
        Of one doodle, from `tokenize`.
    library
        Patterns by action, or the bank they were compiled to; where two explain a span equally
        well, the earlier one is taken.
    costs
        What is weighed against what.
    segments
        How the runs are cut: `least_cost_segments`, or the paper's `longest_match_segments`.

    Returns
    -------
    tuple of Span
        In time order, without overlap; each begins and ends with a moving run.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    """
    bank = library if isinstance(library, Bank) else compile_library(library)
    whole = with_loose_ends(segments(bank, runs, costs), runs)
    return tuple(spans_of(bank, runs, whole, costs))


@dataclass(frozen=True, slots=True)
class TokenSpotter:
    """Finds a bank's actions as `recognize` does, for `smd.recognition.streaming`.

    Attributes
    ----------
    bank : the patterns, compiled.
    costs : what is weighed against what.
    """

    bank: Bank
    costs: Costs = DEFAULT_COSTS

    def chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Segment]:
        """Return the stretches of runs that are actions; the motion is not looked at."""
        return with_loose_ends(least_cost_segments(self.bank, runs, self.costs), runs)

    def named(
        self, motion: RigidMotion, runs: Sequence[TokenRun], segments: Sequence[Segment]
    ) -> list[Span]:
        """Return the spans of stretches of runs; the motion is not looked at."""
        return spans_of(self.bank, runs, segments, self.costs)


def spans_of(
    bank: Bank, runs: Sequence[TokenRun], segments: Sequence[Segment], costs: Costs
) -> list[Span]:
    """Return the spans of segments that have their loose ends, weighed by tokens alone."""
    prices = run_costs(runs, costs)
    read = prices.of_reading(bank, runs)
    parts = [(one.first, one.last) for one in segments]
    distances = least_costs_of_parts(bank, parts, read=read, skip=prices.skip)
    spans = []
    for one, distance in zip(segments, distances, strict=True):
        nothing = float(prices.unexplained[one.first : one.last].sum()) - costs.action
        nearest = np.argsort(distance, kind="stable").tolist()
        spans.append(
            Span(
                action=bank.names[one.index],
                first_run=one.first,
                last_run=one.last,
                start_s=runs[one.first].start_s,
                end_s=runs[one.last - 1].end_s,
                distance=float(distance[one.index]),
                confidence=_share(one.index, np.append(distance, nothing), costs.sharpness),
                alternatives=tuple(
                    (bank.names[i], float(distance[i])) for i in nearest if i != one.index
                ),
            )
        )
    return spans


def _share(chosen: int, cost: FloatArray, sharpness: float) -> float:
    """Return the weight of one explanation among all."""
    return float(1.0 / np.exp(-sharpness * (cost - cost[chosen])).sum())


def with_loose_ends(segments: Sequence[Segment], runs: Sequence[TokenRun]) -> list[Segment]:
    """Return the segments with the unexplained runs beside them that belong to them.

    A hand that sets out or arrives is slow, and its direction uncertain: a run that goes the way
    of the one it leads to, and is not the largest, is of one movement with the rest.
    """
    grown: list[Segment] = []
    for i, segment in enumerate(segments):
        first, last = segment.first, segment.last
        start = grown[-1].last if grown else 0
        end = segments[i + 1].first if i + 1 < len(segments) else len(runs)
        largest = max(_extent(run) for run in runs[first:last])
        while first > start and _leads_into(runs[first - 1], runs[first], largest):
            first -= 1
        while last < end and _leads_into(runs[last], runs[last - 1], largest):
            last += 1
        grown.append(replace(segment, first=first, last=last))
    return grown


def _leads_into(run: TokenRun, neighbour: TokenRun, largest: float) -> bool:
    """Tell whether a run is within a right angle of its neighbour's way, and not too large."""
    a, b = run.token, neighbour.token
    ours, theirs = (*a.translation, *a.rotation), (*b.translation, *b.rotation)
    same_way = sum(x * y for x, y in zip(ours, theirs, strict=True)) > 0
    return same_way and _extent(run) < largest


def _extent(run: TokenRun) -> float:
    """Return how much movement is in a run."""
    return run.travel_heights + run.turn_rad
