"""Suggestions: movement that no detection explains, and the most similar actions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import FloatArray
from smd.recognition.acceptance import WORTH_NAMING, Intent
from smd.recognition.action import Action
from smd.recognition.detection import Detection
from smd.recognition.matching import Match
from smd.recognition.reasons import OUTDONE, reason_of
from smd.recognition.recognizer import Recognizer
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.traits import traits_of_parts

REST_S = 0.25
"""Stillness that separates two movements."""

SHORTEST_S, LONGEST_S = 0.3, 3.0
"""How long what is seen as one gesture lasts; of the shipped actions, 0.8 to 3.0 s is usual."""

MEANT = 0.5
"""Movement (figure heights travelled plus radians turned) from which a stretch may be meant: what
an action needs at least (`smd.recognition.costs.Costs.action`); idle hands tremble below it."""

SHOWN_ACTIONS = 3
"""So many of the likeliest actions are kept."""

MOST_WEIGHED, MOST_SUGGESTED = 32, 12
"""So many stretches a performer are weighed at most, those with most movement in them, and so many
are kept, the likeliest. A stretch takes about 10 ms to weigh."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """An action that a stretch resembles.

    Attributes
    ----------
    action : its name.
    cost : of the stretch as this action.
    most : the threshold of the action.
    reason : what kept it out, in a few words.
    """

    action: str
    cost: float
    most: float
    reason: str


@dataclass(frozen=True, slots=True)
class Unexplained:
    """Movement that no detection explains, and the likeliest actions, the best first."""

    start_s: float
    end_s: float
    likeliest: tuple[Candidate, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Understood:
    """One doodle, with what was recognised in it.

    Attributes
    ----------
    motion : smooth.
    runs : of its tokens.
    detections : of its actions, in time order.
    intent : whether its movement is taken to be meant.
    """

    motion: RigidMotion
    runs: Sequence[TokenRun]
    detections: Sequence[Detection]
    intent: Intent = Intent.FREE


def suggestions(
    recognizer: Recognizer,
    actions: Sequence[Action],
    doodles: Sequence[Understood],
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
) -> list[Unexplained]:
    """Return a performer's movements that no detection explains and that resemble an action.

    Parameters
    ----------
    recognizer
        That found the detections.
    actions
        Those that it looks for.
    doodles
        Of one performer, in time order.
    figure_height_m
        Height of the figurine that the prop stands for.

    Returns
    -------
    list of Unexplained
        In time order, `MOST_SUGGESTED` at most.
    """
    found = [
        (movement, i, span_s)
        for i, doodle in enumerate(doodles)
        for movement, span_s in stretches(doodle, figure_height_m=figure_height_m)
    ]
    largest = sorted(found, key=lambda each: -each[0])[:MOST_WEIGHED]
    by_name = {action.name: action for action in actions}
    suggested: list[Unexplained] = []
    for i, doodle in enumerate(doodles):
        spans_s = sorted(span_s for _, of, span_s in largest if of == i)
        if not spans_s:
            continue
        measures = traits_of_parts(doodle.motion, spans_s, figure_height_m=figure_height_m).measures
        weighed = recognizer.weigh(doodle.motion, doodle.runs, spans_s, doodle.intent)
        for (start_s, end_s), of_stretch, matches in zip(spans_s, measures, weighed, strict=True):
            likeliest = tuple(_candidates(matches, of_stretch, by_name))
            if likeliest:
                suggested.append(Unexplained(start_s, end_s, likeliest))
    nearest = sorted(suggested, key=lambda one: one.likeliest[0].cost / one.likeliest[0].most)
    return sorted(nearest[:MOST_SUGGESTED], key=lambda one: one.start_s)


def _candidates(
    matches: Sequence[Match], measures: FloatArray, actions: dict[str, Action]
) -> Iterator[Candidate]:
    """Yield the likeliest actions of a stretch, each with what kept it out."""
    named = [match for match in matches if match.action is not None]
    named.sort(key=lambda match: match.distance / match.most)
    for i, match in enumerate(named[:SHOWN_ACTIONS]):
        if match.action is not None and match.distance <= WORTH_NAMING * match.most:
            passes = i > 0 and match.distance <= match.most
            reason = OUTDONE if passes else reason_of(match, actions[match.action], measures)
            yield Candidate(match.action, match.distance, match.most, reason)


def stretches(
    doodle: Understood, *, figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M
) -> Iterator[tuple[float, tuple[float, float]]]:
    """Yield the movement in each stretch that no detection explains, with its start and end.

    What lies between rests is one stretch; where that is longer than a gesture, it is cut where
    the prop is slowest.
    """
    runs, time_s = doodle.runs, doodle.motion.time_s
    pace = pace_of(doodle.motion, figure_height_m)
    for first, last in _between_rests(doodle):
        edges_s = [run.start_s for run in runs[first:last]] + [runs[last - 1].end_s]
        at_edges = np.interp(edges_s, time_s, pace)
        for i, j in _cut(np.array(edges_s), at_edges):
            movement = sum(run.travel_heights + run.turn_rad for run in runs[first + i : first + j])
            start_s, end_s = edges_s[i], edges_s[j]
            if movement >= MEANT and end_s - start_s >= SHORTEST_S:
                yield movement, (start_s, end_s)


def pace_of(motion: RigidMotion, figure_height_m: float) -> FloatArray:
    """Return ``(n,)``: how fast a prop moves, in figure heights plus radians a second."""
    speed = np.linalg.norm(motion.velocity_m_s, axis=1) / figure_height_m
    return np.asarray(speed + np.linalg.norm(motion.angular_velocity_rad_s, axis=1))


def _between_rests(doodle: Understood) -> Iterator[tuple[int, int]]:
    """Yield runs ``first`` to ``last`` (excluded) that move, outside of detections and rests."""
    explained = np.zeros(len(doodle.runs), dtype=bool)
    for detection in doodle.detections:
        explained[detection.first_run : detection.last_run] = True
    first = last = None
    for i, run in enumerate(doodle.runs):
        is_still = run.token == STILL
        parts = explained[i] or (is_still and run.end_s - run.start_s >= REST_S)
        if parts and first is not None and last is not None:
            yield first, last
            first = last = None
        elif not parts and not is_still:
            first, last = i if first is None else first, i + 1
    if first is not None and last is not None:
        yield first, last


def _cut(edges_s: FloatArray, pace: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield the pieces of a stretch, by the edges of its runs, none much longer than a gesture."""
    waiting = [(0, len(edges_s) - 1)]
    while waiting:
        i, j = waiting.pop()
        inside = np.arange(i + 1, j)
        far = (edges_s[inside] - edges_s[i] >= SHORTEST_S) & (
            edges_s[j] - edges_s[inside] >= SHORTEST_S
        )
        if edges_s[j] - edges_s[i] <= LONGEST_S or not far.any():
            yield i, j
        else:
            k = int(inside[far][np.argmin(pace[inside[far]])])
            waiting += [(k, j), (i, k)]
