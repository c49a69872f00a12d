"""Choosing: which stretches of a doodle are actions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from laban import RigidMotion
from smd.geometry.arrays import FloatArray
from smd.recognition.acceptance import UNVERIFIED, UNVERIFIED_WRONG, Intent
from smd.recognition.candidates import Stretch
from smd.recognition.compiled_actions import CompiledActions
from smd.recognition.costs import RunCosts, run_costs
from smd.recognition.cutting import best_cut
from smd.recognition.proposals import Proposal, explaining, without_stir
from smd.recognition.segmentation import Segment
from smd.recognition.stretches import are_alike_long
from smd.recognition.tokens import TokenRun
from smd.recognition.verification import GLANCE, GLIMPSE, WRONG

TOGETHER = 1024
"""Stretches whose courses are held in memory at a time."""

Fits: TypeAlias = dict[tuple[float, float, bool], FloatArray]
"""Costs of stretches against actions' examples, without tokens, ``(a,)``: by start and end in
seconds, and whether a stretch is proposed by its length alone. Infinite above the threshold."""


def chosen_stretches(
    actions: CompiledActions,
    motion: RigidMotion,
    runs: Sequence[TokenRun],
    intent: Intent,
    known: Fits,
) -> list[Segment]:
    """Choose the stretches of runs that are actions, in time order.

    Each candidate is weighed by its tokens and against examples, and rejected above the threshold
    of an action. The gain of a stretch, for each second of movement, is the logarithm of its
    threshold over its cost. The non-overlapping stretches with the largest total gain are chosen.

    Parameters
    ----------
    actions
        Of which some have examples.
    motion, runs
        Of one doodle, or of its part so far.
    intent
        Whether the movement is meant.
    known
        Cache of the costs of stretches against examples, read and extended: they do not change
        when more of the doodle comes.
    """
    prices = run_costs(runs, actions.costs)
    most = actions.most[intent]
    proposed = explaining(actions.bank, runs, prices)
    stretches = actions.candidates(proposed, runs, prices, intent)
    cost = _fits(actions, stretches, motion, runs, most, known)
    some = np.flatnonzero(np.isfinite(cost).any(axis=1))
    parts = [stretches[i][:2] for i in some.tolist()]
    cost[some] += WRONG * actions.wrong_share(parts, runs, prices)
    _add_unverified(cost, actions, stretches, proposed, runs, prices)
    share = cost / most
    action = share.argmin(axis=1) if len(share) else np.zeros(0, np.int64)
    least = share.min(axis=1, initial=np.inf)
    accepted = np.flatnonzero(least < 1.0)
    movement_s = np.array([run.end_s - run.start_s for run in runs]) * ~prices.is_still
    until_s = np.concatenate([[0.0], np.cumsum(movement_s)])
    first, last, _ = np.array(stretches, np.int64).reshape(-1, 3)[accepted].T
    loss = np.log(least[accepted]) * (until_s[last] - until_s[first])
    best = best_cut(first.tolist(), last.tolist(), loss.tolist(), np.zeros(len(runs)))
    return [Segment(int(action[accepted[i]]), int(first[i]), int(last[i])) for i in best]


def _fits(
    actions: CompiledActions,
    stretches: Sequence[Stretch],
    motion: RigidMotion,
    runs: Sequence[TokenRun],
    most: FloatArray,
    known: Fits,
) -> FloatArray:
    """Return ``(g, a)``, the costs of stretches against actions' examples, without tokens."""
    spans = [(runs[i].start_s, runs[j - 1].end_s, dense) for i, j, dense in stretches]
    new = [span for span in dict.fromkeys(spans) if span not in known]
    for begin in range(0, len(new), TOGETHER):
        some = new[begin : begin + TOGETHER]
        start_s, end_s, is_dense = np.array(some).T
        spans_s = [(start, end) for start, end, _ in some]
        alike = are_alike_long(end_s - start_s, actions.durations_s) | (is_dense == 0)[:, None]
        gesture, action = np.nonzero(actions.has_examples & alike)
        glimpse = actions.traits(motion, spans_s, every=GLIMPSE)
        promising = actions.verification.promising(glimpse, action, gesture, most[action])
        gesture, action = gesture[promising], action[promising]
        fits = np.full((len(some), len(actions.names)), np.inf)
        if len(gesture):
            looked_at, which = np.unique(gesture, return_inverse=True)
            terms = actions.verification.terms(
                actions.traits(motion, [spans_s[i] for i in looked_at.tolist()]),
                action,
                which,
                wrong=np.zeros(len(action)),
                most=most[action],
                every=GLANCE,
            )
            fits[gesture, action] = terms.sum(axis=1)
        known.update(zip(some, fits, strict=True))
    return np.array([known[span] for span in spans]).reshape(len(spans), len(actions.names))


def _add_unverified(
    cost: FloatArray,
    actions: CompiledActions,
    stretches: Sequence[Stretch],
    proposed: Sequence[Proposal],
    runs: Sequence[TokenRun],
    prices: RunCosts,
) -> None:
    """Write into the costs those of proposals of actions that have no examples."""
    unexplained = np.concatenate([[0.0], np.cumsum(prices.unexplained)])
    place = {(first, last): i for i, (first, last, _) in enumerate(stretches)}
    for one in proposed:
        if not actions.has_examples[one.action]:
            (tight,) = without_stir([(one.first, one.last)], runs)
            strokes = int(np.count_nonzero(~prices.is_still[tight[0] : tight[1]]))
            gain = unexplained[tight[1]] - unexplained[tight[0]] - one.distance
            if gain > actions.costs.action:
                wrong = one.distance / max(strokes, 1)
                cost[place[tight], one.action] = UNVERIFIED + UNVERIFIED_WRONG * wrong
