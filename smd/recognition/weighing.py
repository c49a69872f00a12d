"""Weighing: the cost of a stretch of a doodle as each action, or as none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from laban import RigidMotion
from smd.geometry.arrays import FloatArray
from smd.recognition.acceptance import UNVERIFIED, UNVERIFIED_WRONG, WORTH_NAMING, Intent
from smd.recognition.compiled_actions import CompiledActions
from smd.recognition.costs import run_costs
from smd.recognition.matching import Match
from smd.recognition.tokens import TokenRun
from smd.recognition.verification import TERMS, WRONG

Terms: TypeAlias = dict[tuple[float, float], FloatArray]
"""Terms of stretches, without tokens, ``(a, 9)`` for the actions with examples, by start and end in
seconds."""


def matches(
    actions: CompiledActions,
    motion: RigidMotion,
    runs: Sequence[TokenRun],
    stretches: Sequence[tuple[int, int]],
    intent: Intent,
    *,
    beyond: float = WORTH_NAMING,
    known: Terms | None = None,
) -> list[list[Match]]:
    """Weigh every action, and none, for stretches of runs; for each the best first.

    Parameters
    ----------
    actions
        At least one.
    motion, runs
        Of one doodle.
    stretches
        Each the number of its first run and of the one after its last.
    intent
        Whether the movement is meant.
    beyond
        Costs above so many times the action's threshold come out as infinity, if the action has
        examples.
    known
        Cache of the terms of stretches, read and extended.
    """
    most = actions.most[intent]
    wrong = actions.wrong_share(stretches, runs, run_costs(runs, actions.costs))
    terms = np.zeros((len(stretches), len(actions.names), len(TERMS)))
    terms[..., 0] = UNVERIFIED + UNVERIFIED_WRONG * wrong
    some = actions.has_examples
    if len(stretches) and some.any():
        known = {} if known is None else known
        spans_s = [(runs[first].start_s, runs[last - 1].end_s) for first, last in stretches]
        new = [span_s for span_s in dict.fromkeys(spans_s) if span_s not in known]
        known.update(zip(new, _terms(actions, motion, new, beyond * most), strict=True))
        terms[:, some] = [known[span_s] for span_s in spans_s]
        terms[..., 0] = np.where(some, WRONG * wrong, terms[..., 0])
        terms[some & (terms.sum(axis=-1) > beyond * most)] = np.inf
    return [_ranked(actions, each, most) for each in terms]


def _terms(
    actions: CompiledActions,
    motion: RigidMotion,
    spans_s: Sequence[tuple[float, float]],
    most: FloatArray,
) -> FloatArray:
    """Return the terms of spans, without tokens, ``(g, a, 9)`` for the actions with examples."""
    action = np.flatnonzero(actions.has_examples)
    if not spans_s:
        return np.zeros((0, len(action), len(TERMS)))
    terms = actions.verification.terms(
        actions.traits(motion, spans_s),
        np.tile(action, len(spans_s)),
        np.repeat(np.arange(len(spans_s)), len(action)),
        wrong=np.zeros(len(spans_s) * len(action)),
        most=np.tile(most[action], len(spans_s)),
    )
    return terms.reshape(len(spans_s), len(action), len(TERMS))


def _ranked(actions: CompiledActions, terms: FloatArray, most: FloatArray) -> list[Match]:
    """Return the matches of one gesture, the best first, from its terms ``(a, 9)``.

    The costs are negative log likelihoods, up to a constant, so the confidence is each one's share
    of the likelihood; no action is as likely as the best action at its threshold.
    """
    cost = terms.sum(axis=1)
    nothing = float(most[int(np.argmin(cost))])
    costs = np.append(cost, nothing)
    weight = np.exp(costs.min() - costs)
    share = (weight / weight.sum()).tolist()
    weighed = np.where(actions.has_examples, len(TERMS), 1).tolist()  # without them, the tokens
    found = [
        Match(name, float(each.sum()), p, own, tuple(zip(TERMS, each[:n].tolist(), strict=False)))
        for name, each, p, own, n in zip(
            actions.names, terms, share[:-1], most.tolist(), weighed, strict=True
        )
    ]
    found.append(Match(None, nothing, share[-1]))
    return sorted(found, key=lambda match: match.distance)
