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
from smd.recognition.proposals import Proposal, between_rests, explaining
from smd.recognition.recognizer import Span, with_loose_ends
from smd.recognition.segmentation import Segment
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.traits import Traits, traits_of
from smd.recognition.verification import TERMS, WEIGHTS, verifiers
from smd.smoothing import smooth

UNVERIFIED = 4.0
"""What an action without examples costs besides its tokens: as much as a good fit to examples."""

ACTION = 0.3
UNEXPLAINED = 20.0
"""What leaving movement unexplained costs, an edit: more than any gesture within its limit, so
that what looks like an action is taken for one, and what does not is rejected by the limit."""


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
    """

    def __init__(
        self,
        actions: HasActions | Iterable[Action],
        *,
        figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
        costs: Costs = DEFAULT_COSTS,
    ) -> None:
        every = actions if isinstance(actions, Iterable) else actions.actions
        patterns = {action.name: action.pattern for action in every if action.pattern}
        exemplars = {action.name: action.exemplar for action in every if action.pattern}
        self.names = tuple(patterns)
        self._bank = compile_library(patterns)
        self._verifiers = verifiers([exemplars[name] for name in self.names])
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
        return self._matches(motion, runs, moving[0], moving[-1] + 1)

    def spot(self, doodle: Doodle) -> list[Span]:
        """Find the actions in a doodle, in time order.

        Raises
        ------
        DoodleError
            If the doodle is too short to be smoothed.
        """
        motion = smooth(doodle)
        return self.spot_runs(motion, self.runs_of(doodle, motion))

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
        and cost least, all movement between them included.
        """
        prices = run_costs(runs, self._costs)
        movement = _movement(runs, prices)
        explained = np.concatenate([[0.0], np.cumsum(movement)])
        weighed: dict[tuple[int, int], Traits] = {}
        accepted: list[tuple[Proposal, float]] = []
        proposed = explaining(self._bank, runs, prices)
        if any(self._verifiers):
            proposed += between_rests(self._bank, runs, prices)
        for proposal in proposed:
            cost = self._cost(proposal, motion, runs, weighed)
            if cost < np.inf:
                amount = float(explained[proposal.last] - explained[proposal.first])
                accepted.append((proposal, ACTION + cost * amount))
        chosen = best_cut(
            [proposal.first for proposal, _ in accepted],
            [proposal.last for proposal, _ in accepted],
            [cost for _, cost in accepted],
            UNEXPLAINED * movement,
        )
        segments = [
            Segment(accepted[i][0].action, accepted[i][0].first, accepted[i][0].last)
            for i in chosen
        ]
        return [
            self._span(segment, whole, motion, runs)
            for segment, whole in zip(segments, with_loose_ends(segments, runs), strict=True)
        ]

    def _cost(
        self,
        proposal: Proposal,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        weighed: dict[tuple[int, int], Traits],
    ) -> float:
        """Return what a proposal costs; `inf` if it is rejected."""
        verifier = self._verifiers[proposal.action]
        if verifier is None:
            return UNVERIFIED + UNEXPLAINED * (proposal.distance + self._costs.action) / 2.0
        segment = Segment(proposal.action, proposal.first, proposal.last)
        (whole,) = with_loose_ends([segment], runs)
        key = whole.first, whole.last
        if key not in weighed:
            weighed[key] = self._traits(motion, runs, *key)
        wrong = proposal.distance / _strokes(runs[proposal.first : proposal.last])
        cost = verifier.cost(weighed[key], wrong)
        return cost if cost <= verifier.limit else np.inf

    def _traits(
        self, motion: RigidMotion, runs: Sequence[TokenRun], first: int, last: int
    ) -> Traits:
        part = motion.between(runs[first].start_s, runs[last - 1].end_s)
        return traits_of(part, figure_height_m=self._figure_height_m)

    def _matches(
        self, motion: RigidMotion, runs: Sequence[TokenRun], first: int, last: int
    ) -> list[Match]:
        """Weigh every action and none for a stretch of runs, the best first."""
        part = runs[first:last]
        prices = run_costs(part, self._costs)
        read = prices.of_reading(self._bank, part)
        distance = least_costs(self._bank, read=read, skip=prices.skip)
        gesture = self._traits(motion, runs, first, last)
        found: list[tuple[str | None, float, float, FloatArray]] = []
        for name, verifier, edits in zip(
            self.names, self._verifiers, distance.tolist(), strict=True
        ):
            if verifier is None:
                cost = UNVERIFIED + UNEXPLAINED * edits / 2.0
                found.append((name, cost, 2.0 * UNVERIFIED, np.array([edits])))
            else:
                terms = WEIGHTS * verifier.terms(gesture, edits / _strokes(part))
                found.append((name, float(terms.sum()), verifier.limit, terms))
        nearest = min(found, key=lambda one: one[1])
        found.append((None, nearest[2], nearest[2], np.zeros(0)))
        found.sort(key=lambda one: one[1])
        weight = np.exp(found[0][1] - np.array([cost for _, cost, _, _ in found]))
        share = weight / weight.sum()
        return [
            Match(name, cost, float(p), tuple(zip(TERMS, terms.tolist(), strict=False)))
            for (name, cost, _, terms), p in zip(found, share, strict=True)
        ]

    def _span(
        self, segment: Segment, whole: Segment, motion: RigidMotion, runs: Sequence[TokenRun]
    ) -> Span:
        matches = self._matches(motion, runs, whole.first, whole.last)
        name = self.names[segment.index]
        own = next(match for match in matches if match.action == name)
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
                for match in matches
                if match.action not in (None, name)
            ),
        )


def _strokes(runs: Sequence[TokenRun]) -> int:
    """Return how many of some runs move."""
    return max(sum(run.token != STILL for run in runs), 1)


def _movement(runs: Sequence[TokenRun], prices: RunCosts) -> FloatArray:
    """Return how much of the doodle each run is: seconds of movement."""
    return np.array([0.0 if r.token == STILL else r.end_s - r.start_s for r in runs])
