"""Recognizer: from runs of tokens to spans of actions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.automaton import Automaton, compile_automaton, least_cost, wrong_tokens
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import least_cost_segments
from smd.recognition.tokens import STILL, TokenRun


@dataclass(frozen=True, slots=True)
class Costs:
    """What recognition weighs against each other, in edits of a pattern.

    Attributes
    ----------
    action : of seeing an action at all.
    worth : how much movement (figure heights travelled plus radians turned) costs one edit to
        leave unexplained, or out of an action; less costs less in proportion, more no more.
    stroke : movement below which a run is hardly a stroke of its own: taking it for a token of a
        pattern then costs up to one edit, as if the token were missing.
    still_per_s : of stillness within an action, a second. Two like gestures with a pause between
        are two when it is longer than ``action / still_per_s``.
    sharpness : of the confidence, per edit.
    """

    action: float = 0.4
    worth: float = 1.0
    stroke: float = 0.15
    still_per_s: float = 1.0
    sharpness: float = 3.0


DEFAULT_COSTS = Costs()


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
    patterns: Mapping[str, Pattern],
    *,
    costs: Costs = DEFAULT_COSTS,
) -> tuple[Span, ...]:
    """Find the actions in a tokenized doodle.

    The runs are cut into actions and unexplained rest at the least total cost: every action
    costs ``costs.action`` and its runs' edit distance to its pattern, every unexplained run as
    much as there was movement in it, unexplained stillness nothing. Little or aimless movement is
    therefore cheaper to leave alone than to explain.

    The distance is Levenshtein's (section 4.2 of the paper) with two prices that depend on the
    run: leaving a run out costs less than one edit when there is little movement in it, and
    taking it for the token that it is costs something when there is next to none.

    The confidence weighs the chosen action against the other ones and against nothing, over the
    same runs: with the cost d of each, it is ``exp(-s d_chosen) / sum(exp(-s d))``, where s is
    ``costs.sharpness`` and nothing costs its unexplained runs less ``costs.action``. It ranks
    how clear-cut spans are and is not a measured probability.

    Parameters
    ----------
    runs
        Of one doodle, from `tokenize`.
    patterns
        By action; where two explain a span equally well, the earlier one is taken.

    Returns
    -------
    tuple of Span
        In time order, without overlap; each begins and ends with a moving run.
    """
    names = tuple(patterns)
    automata = [compile_automaton(pattern) for pattern in patterns.values()]
    word = [run.token for run in runs]
    extent = np.array([run.travel_heights + run.turn_rad for run in runs])
    is_still = np.array([token == STILL for token in word], dtype=bool)
    still_s = np.array([run.end_s - run.start_s for run in runs])
    unexplained = np.where(is_still, 0.0, np.minimum(extent / costs.worth, 1.0))
    skip = np.where(is_still, costs.still_per_s * still_s, unexplained)
    faint = np.where(is_still, 0.0, np.maximum(1.0 - extent / costs.stroke, 0.0))
    # Stillness taken for a movement costs more than that movement missing, or it would be a way
    # to stretch an action over the rest beside it.
    wrong = np.where(is_still, 1.0 + skip, 1.0)
    read = [np.maximum(wrong_tokens(a, word) * wrong[:, None], faint[:, None]) for a in automata]
    segments = least_cost_segments(
        automata, read=read, skip=skip, unexplained=unexplained, action=costs.action
    )
    spans = []
    for segment in segments:
        part = slice(segment.first, segment.last)
        distance = _distances(automata, [r[part] for r in read], skip[part])
        nothing = float(unexplained[part].sum()) - costs.action
        other = [i for i in np.argsort(distance, kind="stable") if i != segment.index]
        spans.append(
            Span(
                action=names[segment.index],
                first_run=segment.first,
                last_run=segment.last,
                start_s=runs[segment.first].start_s,
                end_s=runs[segment.last - 1].end_s,
                distance=float(distance[segment.index]),
                confidence=_confidence(segment.index, np.append(distance, nothing), costs),
                alternatives=tuple((names[i], float(distance[i])) for i in other),
            )
        )
    return tuple(spans)


def _distances(
    automata: Sequence[Automaton], read: Sequence[FloatArray], skip: FloatArray
) -> FloatArray:
    """Return the distance of one string to each pattern."""
    return np.array(
        [least_cost(one, read=r, skip=skip) for one, r in zip(automata, read, strict=True)]
    )


def _confidence(chosen: int, cost: FloatArray, costs: Costs) -> float:
    """Return the chosen explanation's share among all."""
    return float(1.0 / np.exp(-costs.sharpness * (cost - cost[chosen])).sum())
