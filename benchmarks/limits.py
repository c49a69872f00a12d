"""The recogniser before it knew a background: proposals of automata and rests, and a limit.

What the automata and the rests propose is weighed against the examples, and left aside where it
costs more than the action's limit; the best cut of the rest is named. The limit follows from what
the examples cost when each is left out in turn. Kept to measure against.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from benchmarks.tally import Named
from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.action import Action
from smd.recognition.bank import compile_library, least_costs_of_parts
from smd.recognition.costs import DEFAULT_COSTS, run_costs
from smd.recognition.cutting import best_cut
from smd.recognition.exemplar import Exemplar
from smd.recognition.loose_ends import with_loose_ends
from smd.recognition.proposals import Proposal, explaining, rest_to_rest, without_stir
from smd.recognition.segmentation import Segment
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import TokenRun
from smd.recognition.traits import COURSES, traits_of_parts
from smd.recognition.verification import GLANCE, WEIGHTS, WRONG, Verification
from smd.smoothing import smooth

ACTION, UNEXPLAINED = 0.3, 20.0
"""What seeing an action costs, and what a second of movement costs that is left unexplained."""

USUAL_COST, PRIOR_COSTS = 8.0, 3.0
"""What an example costs against the others of its action, before any was seen, and how many
examples that counts for."""

SLACK, SLACK_SHARE = 4.5, 1.6
"""The limit is so many times an example's cost and a slack, which is for three examples."""

MOST_COUNTED = 30
FREEDOM = 4.0


class LimitRecognizer:
    """Finds the actions in doodles, as the recogniser did when it had limits.

    Parameters
    ----------
    actions
        Each with a pattern and with examples.
    tolerance
        Factor on every limit.
    """

    def __init__(self, actions: Iterable[Action], *, tolerance: float = 1.0) -> None:
        learned = [(one.name, one.pattern, one.exemplar) for one in actions]
        patterns = {name: pattern for name, pattern, _ in learned if pattern}
        exemplars = [exemplar for _, pattern, exemplar in learned if pattern and exemplar]
        if len(exemplars) != len(patterns):
            raise ValueError("limits: expected examples of every action")
        self.names = tuple(patterns)
        self.limit = tolerance * limits(exemplars)
        self._bank = compile_library(patterns, None)
        self._verification = Verification(tuple(exemplars))

    def spot(self, doodle: Doodle) -> list[Named]:
        """Find the actions in a doodle, in time order."""
        motion = smooth(doodle)
        runs = tokenize(motion, drawing=doodle.drawing_at(motion.time_s))
        chosen = self._chosen(motion, runs)
        if not chosen:
            return []
        stretches = [(one.first, one.last) for one in chosen]
        every = np.arange(len(self.names))
        terms = self._terms(
            motion,
            [_span_s(first, last, runs) for first, last in stretches],
            np.tile(every, len(stretches)),
            np.repeat(np.arange(len(stretches)), len(every)),
            self._wrong(runs, stretches).ravel(),
            glance=1,
        )
        cost = terms.sum(axis=1).reshape(len(stretches), len(every))
        cost[cost > self.limit] = np.inf
        return [
            Named(self.names[one.index if np.isinf(row.min()) else int(row.argmin())], *span_s)
            for one, row, span_s in zip(
                chosen, cost, (_span_s(*each, runs) for each in stretches), strict=True
            )
        ]

    def _chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Segment]:
        """Return the best cut of the proposals that are within their action's limit."""
        prices = run_costs(runs, DEFAULT_COSTS)
        found = explaining(self._bank, runs, prices)
        rests = rest_to_rest(prices.is_still)
        read = prices.of_reading(self._bank, runs)
        edits = least_costs_of_parts(self._bank, rests, read=read, skip=prices.skip).tolist()
        found += [
            Proposal(action, *stretch, distance)
            for stretch, distances in zip(rests, edits, strict=True)
            for action, distance in enumerate(distances)
        ]
        proposed = _without_stir(found, runs)
        if not proposed:
            return []
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        action, first, last = np.array([one[:3] for one in proposed], np.int64).T
        distance = np.array([one.distance for one in proposed])
        spans_s, which = _unique_spans_s([(one.first, one.last) for one in proposed], runs)
        wrong = distance / np.maximum(strokes[last] - strokes[first], 1)
        # Stretches that are one with their loose ends were looked at once, with the last's tokens.
        pairs = list(zip(action.tolist(), which.tolist(), strict=True))
        last_wrong = dict(zip(pairs, wrong.tolist(), strict=True))
        looked_at = np.array([last_wrong[pair] for pair in pairs])
        terms = self._terms(motion, spans_s, action, which, looked_at, glance=GLANCE)
        cost = terms.sum(axis=1)
        glance = terms[:, 0] + terms[:, 1 + len(COURSES) :].sum(axis=1)
        order = np.lexsort((glance, which))
        spoken_for = order[np.unique(which[order], return_index=True)[1]]
        # Of a stretch's actions only those stay that fit no worse than the one a glance speaks for.
        cost[cost > cost[spoken_for][which]] = np.inf
        cost += WRONG * (wrong - looked_at)
        within = np.flatnonzero(cost <= self.limit[action])
        movement_s = np.array([run.end_s - run.start_s for run in runs]) * ~prices.is_still
        explained_s = np.concatenate([[0.0], np.cumsum(movement_s)])
        first, last = first[within], last[within]
        weight = ACTION + cost[within] * (explained_s[last] - explained_s[first])
        best = best_cut(first.tolist(), last.tolist(), weight.tolist(), UNEXPLAINED * movement_s)
        return with_loose_ends([Segment(*proposed[within[i]][:3]) for i in best], runs)

    def _wrong(self, runs: Sequence[TokenRun], stretches: Sequence[tuple[int, int]]) -> FloatArray:
        """Return ``(g, a)``, the share of each stretch's tokens that is wrong for each action."""
        prices = run_costs(runs, DEFAULT_COSTS)
        read = prices.of_reading(self._bank, runs)
        distance = least_costs_of_parts(self._bank, stretches, read=read, skip=prices.skip)
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        first, last = np.array(stretches, np.int64).reshape(-1, 2).T
        return np.asarray(distance / np.maximum(strokes[last] - strokes[first], 1)[:, None])

    def _terms(
        self,
        motion: RigidMotion,
        spans_s: Sequence[tuple[float, float]],
        action: IntArray,
        gesture: IntArray,
        wrong: FloatArray,
        *,
        glance: int,
    ) -> FloatArray:
        """Return ``(p, 9)``, terms of pairs of an action and a stretch, infinite beyond limits."""
        return self._verification.terms(
            traits_of_parts(motion, spans_s, figure_height_m=DEFAULT_FIGURE_HEIGHT_M),
            action,
            gesture,
            wrong=wrong,
            most=self.limit[action],
            every=glance,
        )


def limits(exemplars: Sequence[Exemplar]) -> FloatArray:
    """Return ``(a,)``, the cost above which a gesture is none of an action's.

    What examples cost when each is left out in turn is pooled: of the action, with those of the
    whole library, and with a usual cost, as means of logarithms.
    """
    own = [_left_out_costs(one) for one in exemplars]
    library = _pooled(np.concatenate([np.zeros(0), *own]), USUAL_COST)
    return np.array(
        [
            SLACK_SHARE * _pooled(costs, library) + SLACK * np.sqrt(3.0 / max(len(costs), 3))
            for costs in own
        ]
    )


def _left_out_costs(exemplar: Exemplar) -> FloatArray:
    """Return ``(n,)``: what each example costs against the others; nothing where there is one."""
    n = len(exemplar.apart)
    if n == 0:
        return np.zeros(0)
    others = (exemplar.measures.sum(axis=0) - exemplar.measures) / (n - 1)
    deviation = (exemplar.measures - others) / exemplar.spread
    odd = 0.5 * (FREEDOM + 1.0) * np.log1p(np.square(deviation) / FREEDOM)
    terms = np.hstack([np.zeros((n, 1)), exemplar.apart / exemplar.scale, odd])
    return np.asarray(terms @ WEIGHTS)


def _pooled(costs: FloatArray, prior: float) -> float:
    """Return the geometric mean of costs, and of a prior that counts for a few more."""
    count = min(len(costs), MOST_COUNTED)
    mean = float(np.log(costs + 0.1).mean()) if count else 0.0
    return float(np.exp((PRIOR_COSTS * np.log(prior) + count * mean) / (PRIOR_COSTS + count)))


def _without_stir(found: Sequence[Proposal], runs: Sequence[TokenRun]) -> list[Proposal]:
    """Return proposals without stir at their ends; of an action's for one stretch the nearest."""
    tight: dict[tuple[int, int, int], float] = {}
    meant = without_stir([(one.first, one.last) for one in found], runs)
    for one, stretch in zip(found, meant, strict=True):
        key = (one.action, *stretch)
        tight[key] = min(one.distance, tight.get(key, np.inf))
    return [Proposal(*key, distance) for key, distance in tight.items()]


def _span_s(first: int, last: int, runs: Sequence[TokenRun]) -> tuple[float, float]:
    """Return where runs begin and end."""
    return runs[first].start_s, runs[last - 1].end_s


def _unique_spans_s(
    stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun]
) -> tuple[list[tuple[float, float]], IntArray]:
    """Return each stretch's time with its loose ends, once, and which one is whose."""
    of: dict[tuple[int, int], tuple[float, float]] = {}
    for first, last in dict.fromkeys(stretches):
        (whole,) = with_loose_ends([Segment(0, first, last)], runs)
        of[first, last] = _span_s(whole.first, whole.last, runs)
    place = {span_s: i for i, span_s in enumerate(dict.fromkeys(of.values()))}
    return list(place), np.array([place[of[each]] for each in stretches])
