"""Loose ends: slow runs at the start and stop of a movement belong to the action in between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from smd.recognition.segmentation import Segment
from smd.recognition.tokens import TokenRun


def with_loose_ends(segments: Sequence[Segment], runs: Sequence[TokenRun]) -> list[Segment]:
    """Return the segments with the unexplained runs beside them that belong to them.

    A hand that starts or stops is slow, and its direction uncertain. A run in about the direction
    of its neighbour, unless it is the largest, is part of the same movement.
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
