"""Spotting: which actions a doodle draws, and when."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray
from smd.recognition.action import Action
from smd.recognition.bank import compile_library, least_costs
from smd.recognition.costs import DEFAULT_COSTS, Costs, RunCosts, run_costs
from smd.recognition.cutting import best_cut
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import learn_pattern
from smd.recognition.proposals import Proposal, between_rests, explaining, without_stir
from smd.recognition.recognizer import Span, recognize, with_loose_ends
from smd.recognition.segmentation import Segment
from smd.recognition.streaming import RecognitionStream
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.traits import Traits, traits_of, traits_of_parts
from smd.recognition.verification import TERMS, verifiers
from smd.smoothing import smooth

UNVERIFIED, UNVERIFIED_WRONG = 5.0, 10.0
"""What an action without examples costs: as much as a fair fit to examples, and more with the
share of tokens that are wrong."""

ACTION, UNEXPLAINED = 0.3, 20.0
"""What seeing an action costs, and what a second of movement costs that is left unexplained. That
is more than any gesture within its limit costs: what looks like an action is taken for one, and
what does not is rejected by the limit."""

WORTH_NAMING = 2.0
"""An action that costs more than so many times its limit is no alternative to another one."""


class HasActions(Protocol):
    """A library, as far as recognition is concerned."""

    @property
    def actions(self) -> tuple[Action, ...]:
        """What can be performed."""


@dataclass(frozen=True, slots=True)
class Match:
    """How well a gesture fits one action, or none.

    Attributes
    ----------
    action : its name; None for no action at all.
    distance : what it costs to see the gesture so; for None, what no action may cost.
    confidence : in [0, 1], adding up to 1 over all matches of a gesture.
    terms : what the distance is made of, by name, weights included; empty for None.
    """

    action: str | None
    distance: float
    confidence: float
    terms: tuple[tuple[str, float], ...] = ()


def learn_action(
    name: str,
    doodles: Sequence[Doodle],
    *,
    names: Sequence[str] | None = None,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
) -> Action:
    """Learn an action from examples of its gesture; three are usually enough.

    Parameters
    ----------
    name
        Of the action.
    doodles
        At least one, each with the gesture once, with or without rest around it.
    names
        What to call the examples; ``example 1`` and so on if absent.
    figure_height_m
        Height of the figurine that the prop stands for.

    Raises
    ------
    LearningError
        If there is no example, if one never moves, or if one has nothing in common with the
        others.
    """
    learned = learn_pattern(doodles, names=names or (), figure_height_m=figure_height_m)
    examples = [
        traits_of(smooth(doodle).between(*span), figure_height_m=figure_height_m)
        for doodle, span in zip(doodles, learned.spans_s, strict=True)
    ]
    return Action(name, learned.pattern, learned_from=learned.names, exemplar=exemplar_of(examples))


class Recognizer:
    """Finds a library's actions in doodles.

    Parameters
    ----------
    actions
        The actions, or a library that has them; those without a pattern are not looked for.
    figure_height_m
        Height of the figurine that the prop stands for.
    costs
        What the tokens of a span are weighed by.
    tolerance
        Factor on every action's limit: below 1 more is rejected, above it less.
    """

    def __init__(
        self,
        actions: HasActions | Iterable[Action],
        *,
        figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
        costs: Costs = DEFAULT_COSTS,
        tolerance: float = 1.0,
    ) -> None:
        every = actions if isinstance(actions, Iterable) else actions.actions
        patterns = {action.name: action.pattern for action in every if action.pattern}
        exemplars = {action.name: action.exemplar for action in every if action.pattern}
        self.names = tuple(patterns)
        self._bank = compile_library(patterns)
        self._verifiers = verifiers([exemplars[name] for name in self.names], tolerance=tolerance)
        self._figure_height_m = figure_height_m
        self._costs = costs

    def rank(self, doodle: Doodle) -> list[Match]:
        """Weigh every action, and none, for a doodle that holds one gesture, the best first.

        Rest before and after the gesture is no part of it. A doodle that never moves is none.

        Raises
        ------
        DoodleError
            If the doodle is too short to be smoothed.
        """
        motion = smooth(doodle)
        runs = self.runs_of(doodle, motion)
        moving = [i for i, run in enumerate(runs) if run.token != STILL]
        if not moving or not self.names:
            return [Match(None, 0.0, 1.0)]
        return self._matches(motion, runs, [(moving[0], moving[-1] + 1)], np.inf)[0]

    def spot(self, doodle: Doodle) -> list[Span]:
        """Find the actions in a doodle, in time order.

        Raises
        ------
        DoodleError
            If the doodle is too short to be smoothed.
        """
        motion = smooth(doodle)
        return self.spot_runs(motion, self.runs_of(doodle, motion))

    def stream(self) -> RecognitionStream:
        """Return what finds the actions while a doodle is being drawn, sample by sample."""
        return RecognitionStream(self.spot_runs, figure_height_m=self._figure_height_m)

    def runs_of(self, doodle: Doodle, motion: RigidMotion) -> tuple[TokenRun, ...]:
        """Return the tokens of a doodle's smoothed motion; still where it was not drawn."""
        before = np.searchsorted(doodle.time_s, motion.time_s + 1e-9, side="right") - 1
        return tokenize(
            motion, figure_height_m=self._figure_height_m, drawing=doodle.drawing[before]
        )

    def spot_runs(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Span]:
        """Find the actions in a motion that is cut into tokens already.

        The automata propose, for each action and each end, the stretch that explains most. Each
        proposal is weighed by its tokens and against the action's examples, and left aside where
        it costs more than the action's limit. Of the rest those are chosen that do not overlap
        and cost least, each a second of movement, all movement between them included.
        """
        if not any(self._verifiers):
            return list(recognize(runs, self._bank, costs=self._costs))
        prices = run_costs(runs, self._costs)
        found = explaining(self._bank, runs, prices)
        found += between_rests(self._bank, runs, prices)
        accepted = self._accepted(without_stir(found, runs), motion, runs, prices)
        movement_s = np.array([run.end_s - run.start_s for run in runs]) * ~prices.is_still
        explained_s = np.concatenate([[0.0], np.cumsum(movement_s)])
        chosen = best_cut(
            [one.first for one, _ in accepted],
            [one.last for one, _ in accepted],
            [
                ACTION + cost * float(explained_s[one.last] - explained_s[one.first])
                for one, cost in accepted
            ],
            UNEXPLAINED * movement_s,
        )
        segments = [Segment(*accepted[i][0][:3]) for i in chosen]
        whole = with_loose_ends(segments, runs)
        stretches = [(one.first, one.last) for one in whole]
        matches = self._matches(motion, runs, stretches, WORTH_NAMING)
        return [
            _span(self.names[one.index], one, runs, ranked)
            for one, ranked in zip(whole, matches, strict=True)
        ]

    def _accepted(
        self,
        found: Sequence[Proposal],
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        prices: RunCosts,
    ) -> list[tuple[Proposal, float]]:
        """Return the proposals that fit their action's examples, and what each costs."""
        stretch = {}
        for one in found:
            (whole,) = with_loose_ends([Segment(*one[:3])], runs)
            stretch[one] = whole.first, whole.last
        each = list(dict.fromkeys(stretch.values()))
        traits = dict(zip(each, self._traits(motion, runs, each), strict=True))
        accepted: list[tuple[Proposal, float]] = []
        for action, verifier in enumerate(self._verifiers):
            own = [one for one in found if one.action == action]
            wrong = np.array([one.distance / _strokes(runs[one.first : one.last]) for one in own])
            if verifier is None:
                gain = [float(prices.unexplained[o.first : o.last].sum()) - o.distance for o in own]
                pays = np.array(gain) > self._costs.action
                cost = np.where(pays, UNVERIFIED + UNVERIFIED_WRONG * wrong, np.inf)
            else:
                gestures = [traits[stretch[one]] for one in own]
                cost = verifier.terms(gestures, wrong, verifier.limit).sum(axis=1)
                cost[cost > verifier.limit] = np.inf
            accepted += [(o, c) for o, c in zip(own, cost.tolist(), strict=True) if c < np.inf]
        return accepted

    def _traits(
        self, motion: RigidMotion, runs: Sequence[TokenRun], stretches: Sequence[tuple[int, int]]
    ) -> list[Traits]:
        spans_s = [(runs[first].start_s, runs[last - 1].end_s) for first, last in stretches]
        return traits_of_parts(motion, spans_s, figure_height_m=self._figure_height_m)

    def _matches(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        stretches: Sequence[tuple[int, int]],
        beyond: float,
    ) -> list[list[Match]]:
        """Weigh every action, and none, for stretches of runs; for each the best first.

        What costs more than ``beyond`` times its action's limit may come out as infinity.
        """
        prices = run_costs(runs, self._costs)
        read = prices.of_reading(self._bank, runs)
        parts = [slice(*stretch) for stretch in stretches]
        wrong = np.array(
            [
                least_costs(self._bank, read=read[part], skip=prices.skip[part])
                / _strokes(runs[part])
                for part in parts
            ]
        ).reshape(len(parts), len(self.names))
        gestures = self._traits(motion, runs, stretches)
        terms = [
            np.stack([np.full(len(parts), UNVERIFIED), UNVERIFIED_WRONG * wrong[:, i]], axis=1)
            if verifier is None
            else verifier.terms(gestures, wrong[:, i], beyond * verifier.limit)
            for i, verifier in enumerate(self._verifiers)
        ]
        limits = [
            UNVERIFIED + UNVERIFIED_WRONG if verifier is None else verifier.limit
            for verifier in self._verifiers
        ]
        return [_ranked(self.names, [each[k] for each in terms], limits) for k in range(len(parts))]


def _ranked(
    names: Sequence[str], terms: Sequence[FloatArray], limits: Sequence[float]
) -> list[Match]:
    """Return the matches of one gesture, the best first.

    The costs are negative logarithms of likelihoods, up to a constant, so the confidence is each
    one's share of the likelihood; nothing at all is as likely as the best action at its limit.
    """
    costs = [float(each.sum()) for each in terms]
    nothing = limits[int(np.argmin(costs))]
    weight = np.exp(min(*costs, nothing) - np.array([*costs, nothing]))
    share = (weight / weight.sum()).tolist()
    matches = [
        Match(name, cost, p, tuple(zip(_labels(each), each.tolist(), strict=True)))
        for name, cost, p, each in zip(names, costs, share[:-1], terms, strict=True)
    ]
    matches.append(Match(None, nothing, share[-1]))
    return sorted(matches, key=lambda match: match.distance)


def _labels(terms: FloatArray) -> tuple[str, ...]:
    return TERMS if len(terms) == len(TERMS) else ("no examples", "tokens")


def _span(name: str, whole: Segment, runs: Sequence[TokenRun], ranked: Sequence[Match]) -> Span:
    """Return the span of a chosen stretch; ``ranked`` weighs all actions for it."""
    own = next(match for match in ranked if match.action == name)
    return Span(
        action=name,
        first_run=whole.first,
        last_run=whole.last,
        start_s=runs[whole.first].start_s,
        end_s=runs[whole.last - 1].end_s,
        distance=own.distance,
        confidence=own.confidence,
        alternatives=tuple(
            (match.action, match.distance)
            for match in ranked
            if match.action not in (None, name) and np.isfinite(match.distance)
        ),
    )


def _strokes(runs: Sequence[TokenRun]) -> int:
    """Return how many of some runs move."""
    return max(sum(run.token != STILL for run in runs), 1)
