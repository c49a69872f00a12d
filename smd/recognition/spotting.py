"""Spotting: which actions a doodle draws, and when."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray
from smd.recognition.action import Action
from smd.recognition.bank import compile_library, least_costs_of_parts
from smd.recognition.costs import DEFAULT_COSTS, Costs, RunCosts, run_costs
from smd.recognition.cutting import best_cut
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import learn_pattern
from smd.recognition.proposals import Proposal, between_rests, explaining, without_stir
from smd.recognition.recognizer import Span, TokenSpotter, with_loose_ends
from smd.recognition.segmentation import Segment
from smd.recognition.streaming import RecognitionStream
from smd.recognition.token_costs import TokenCosts
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.traits import traits_of, traits_of_parts
from smd.recognition.verification import GLANCE, TERMS, WRONG, verification_of
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

Fits: TypeAlias = dict[tuple[int, float, float], float]
"""How well stretches fit an action's examples, by action, start and end in seconds."""

Terms: TypeAlias = dict[tuple[float, float], FloatArray]
"""What stretches are weighed by, tokens apart, ``(a, 9)`` for the actions with examples, by start
and end in seconds."""


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
    most : what the distance may be at most for the action to be recognised; infinite for None.
    """

    action: str | None
    distance: float
    confidence: float
    terms: tuple[tuple[str, float], ...] = ()
    most: float = np.inf


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
    token_costs
        What it costs to take one token for another; the paper's unit costs if absent.
    tolerance
        Factor on every action's limit: below 1 more is rejected, above it less.
    """

    def __init__(
        self,
        actions: HasActions | Iterable[Action],
        *,
        figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
        costs: Costs = DEFAULT_COSTS,
        token_costs: TokenCosts | None = None,
        tolerance: float = 1.0,
    ) -> None:
        every = actions if isinstance(actions, Iterable) else actions.actions
        patterns = {action.name: action.pattern for action in every if action.pattern}
        exemplars = {action.name: action.exemplar for action in every if action.pattern}
        self.names = tuple(patterns)
        self._bank = compile_library(patterns, token_costs)
        self._verification = verification_of(
            [exemplars[name] for name in self.names], tolerance=tolerance
        )
        self._verified = np.array([bool(one) for one in self._verification.exemplars], dtype=bool)
        self._figure_height_m = figure_height_m
        self._costs = costs
        self._tokens = TokenSpotter(self._bank, costs)  # where there are no examples

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

    def weigh(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        spans_s: Sequence[tuple[float, float]],
    ) -> list[list[Match]]:
        """Weigh every action, and none, for stretches of a motion; for each the best first.

        Parameters
        ----------
        motion, runs
            Of one doodle.
        spans_s
            When each stretch begins and ends; it is weighed from the start of the run that is
            there to the end of the one that is. What costs more than `WORTH_NAMING` times what it
            may is not weighed to the end, and infinite.
        """
        starts_s = np.array([run.start_s for run in runs])
        stretches = []
        for start_s, end_s in spans_s:
            first = max(int(np.searchsorted(starts_s, start_s + 1e-6, side="right")) - 1, 0)
            last = max(int(np.searchsorted(starts_s, end_s - 1e-6)), first + 1)
            stretches.append((first, last))
        if not stretches or not self.names:
            return [[Match(None, 0.0, 1.0)] for _ in stretches]
        return self._matches(motion, runs, stretches, WORTH_NAMING)

    def spot(self, doodle: Doodle) -> list[Span]:
        """Find the actions in a doodle, in time order.

        Raises
        ------
        DoodleError
            If the doodle is too short to be smoothed.
        """
        motion = smooth(doodle)
        return self.spot_runs(motion, self.runs_of(doodle, motion))

    def stream(self, listener: Callable[[RigidMotion], None] | None = None) -> RecognitionStream:
        """Return what finds the actions while a doodle is being drawn, sample by sample.

        The listener is called with each piece of smoothed motion.
        """
        return RecognitionStream(
            _Remembering(self), figure_height_m=self._figure_height_m, listener=listener
        )

    def runs_of(self, doodle: Doodle, motion: RigidMotion) -> tuple[TokenRun, ...]:
        """Return the tokens of a doodle's smoothed motion; still where it was not drawn."""
        before = np.searchsorted(doodle.time_s, motion.time_s + 1e-9, side="right") - 1
        return tokenize(
            motion, figure_height_m=self._figure_height_m, drawing=doodle.drawing[before]
        )

    def spot_runs(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Span]:
        """Find the actions in a motion that is cut into tokens already."""
        return self.named(motion, runs, self.chosen(motion, runs))

    def chosen(
        self, motion: RigidMotion, runs: Sequence[TokenRun], known: Fits | None = None
    ) -> list[Segment]:
        """Choose the stretches of runs that are actions, in time order.

        The automata propose, for each action and each end, the stretch that explains most. Each
        proposal is weighed by its tokens and against the action's examples, and left aside where
        it costs more than the action's limit. Of the rest those are chosen that do not overlap
        and cost least, each a second of movement, all movement between them included.

        Parameters
        ----------
        motion, runs
            Of one doodle, or of what is there of it.
        known
            How well stretches fit examples, where that is known, and where it is written down:
            a stretch does not change when more of the doodle comes.
        """
        if not self._verified.any():
            return self._tokens.chosen(motion, runs)
        prices = run_costs(runs, self._costs)
        found = explaining(self._bank, runs, prices)
        found += between_rests(self._bank, runs, prices)
        proposed = without_stir(found, runs)
        cost = self._cost(proposed, motion, runs, prices, {} if known is None else known)
        accepted = np.flatnonzero(np.isfinite(cost)).tolist()
        movement_s = np.array([run.end_s - run.start_s for run in runs]) * ~prices.is_still
        explained_s = np.concatenate([[0.0], np.cumsum(movement_s)])
        first = [proposed[i].first for i in accepted]
        last = [proposed[i].last for i in accepted]
        weight = ACTION + cost[accepted] * (explained_s[last] - explained_s[first])
        best = best_cut(first, last, weight.tolist(), UNEXPLAINED * movement_s)
        return with_loose_ends([Segment(*proposed[accepted[i]][:3]) for i in best], runs)

    def named(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        segments: Sequence[Segment],
        known: Terms | None = None,
    ) -> list[Span]:
        """Return the spans of chosen stretches, with what else each could be.

        Each is of the action that it costs least to see there, of those within their limit.
        What they are weighed by is taken from ``known`` where it is there, and else written down.
        """
        if not self._verified.any():
            return self._tokens.named(motion, runs, segments)
        stretches = [(one.first, one.last) for one in segments]
        limit = dict(zip(self.names, self._verification.limit.tolist(), strict=True))
        spans = []
        for one, ranked in zip(
            segments, self._matches(motion, runs, stretches, WORTH_NAMING, known), strict=True
        ):
            within = (m.action for m in ranked if m.action and m.distance <= limit[m.action])
            spans.append(_span(next(within, self.names[one.index]), one, runs, ranked))
        return spans

    def _cost(
        self,
        proposed: Sequence[Proposal],
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        prices: RunCosts,
        known: Fits,
    ) -> FloatArray:
        """Return what each proposal costs; infinity where it does not fit its action's examples."""
        fits = self._fits(proposed, motion, runs, known)
        limit = self._verification.limit
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        unexplained = np.concatenate([[0.0], np.cumsum(prices.unexplained)])
        action, first, last = np.array([one[:3] for one in proposed], np.int64).reshape(-1, 3).T
        distance = np.array([one.distance for one in proposed])
        wrong = distance / np.maximum(strokes[last] - strokes[first], 1)
        verified = self._verified[action]
        cost = np.where(verified, fits + WRONG * wrong, UNVERIFIED + UNVERIFIED_WRONG * wrong)
        gain = unexplained[last] - unexplained[first] - distance
        accepted = np.where(verified, cost <= limit[action], gain > self._costs.action)
        cost[~accepted] = np.inf
        return cost

    def _fits(
        self,
        proposed: Sequence[Proposal],
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        known: Fits,
    ) -> FloatArray:
        """Return how unlike its action's examples each proposal is, its tokens apart.

        That is infinity where it is beyond the limit or another action fits the same stretch
        better, and 0 where there are no examples.
        """
        span_s: dict[tuple[int, int], tuple[float, float]] = {}
        for first, last in dict.fromkeys((one.first, one.last) for one in proposed):
            (whole,) = with_loose_ends([Segment(0, first, last)], runs)
            span_s[first, last] = runs[whole.first].start_s, runs[whole.last - 1].end_s
        strokes = np.concatenate([[0], np.cumsum([run.token != STILL for run in runs])])
        stretches = [(one.action, *span_s[one.first, one.last]) for one in proposed]
        wrong_of = {
            stretch: one.distance / max(int(strokes[one.last] - strokes[one.first]), 1)
            for stretch, one in zip(stretches, proposed, strict=True)
        }
        missing = [
            each
            for each in dict.fromkeys(stretches)
            if self._verified[each[0]] and each not in known
        ]
        if missing:
            spans_s = list(dict.fromkeys(each[1:] for each in missing))
            place = {span_s: i for i, span_s in enumerate(spans_s)}
            gestures = traits_of_parts(motion, spans_s, figure_height_m=self._figure_height_m)
            action = np.array([each[0] for each in missing])
            gesture = np.array([place[each[1:]] for each in missing])
            terms = self._verification.least_terms(
                gestures,
                action,
                gesture,
                wrong=np.array([wrong_of[each] for each in missing]),
                most=self._verification.limit[action],
                every=GLANCE,
            )
            known.update(zip(missing, terms[:, 1:].sum(axis=1).tolist(), strict=True))
        return np.array([known.get(each, 0.0) for each in stretches])

    def _matches(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        stretches: Sequence[tuple[int, int]],
        beyond: float,
        known: Terms | None = None,
    ) -> list[list[Match]]:
        """Weigh every action, and none, for stretches of runs; for each the best first.

        What costs more than ``beyond`` times its action's limit comes out as infinity, where the
        action has examples.
        """
        prices = run_costs(runs, self._costs)
        read = prices.of_reading(self._bank, runs)
        distance = least_costs_of_parts(self._bank, stretches, read=read, skip=prices.skip)
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        first, last = np.array(stretches, np.int64).reshape(-1, 2).T
        wrong = distance / np.maximum(strokes[last] - strokes[first], 1)[:, None]
        terms = np.zeros((len(stretches), len(self.names), len(TERMS)))
        terms[..., 0] = UNVERIFIED + UNVERIFIED_WRONG * wrong
        limit = np.where(self._verified, self._verification.limit, UNVERIFIED + UNVERIFIED_WRONG)
        if len(stretches) and self._verified.any():
            known = {} if known is None else known
            spans_s = [(runs[first].start_s, runs[last - 1].end_s) for first, last in stretches]
            new = [span_s for span_s in dict.fromkeys(spans_s) if span_s not in known]
            known.update(zip(new, self._weighed(motion, new, beyond * limit), strict=True))
            terms[:, self._verified] = [known[span_s] for span_s in spans_s]
            terms[..., 0] = np.where(self._verified, WRONG * wrong, terms[..., 0])
            terms[self._verified & (terms.sum(axis=-1) > beyond * limit)] = np.inf
        return [self._ranked(each, limit) for each in terms]

    def _weighed(
        self, motion: RigidMotion, spans_s: Sequence[tuple[float, float]], most: FloatArray
    ) -> FloatArray:
        """Return the terms of spans, tokens apart, ``(g, a, 9)`` for the actions with examples."""
        action = np.flatnonzero(self._verified)
        if not spans_s:
            return np.zeros((0, len(action), len(TERMS)))
        terms = self._verification.terms(
            traits_of_parts(motion, spans_s, figure_height_m=self._figure_height_m),
            np.tile(action, len(spans_s)),
            np.repeat(np.arange(len(spans_s)), len(action)),
            wrong=np.zeros(len(spans_s) * len(action)),
            most=np.tile(most[action], len(spans_s)),
        )
        return terms.reshape(len(spans_s), len(action), len(TERMS))

    def _ranked(self, terms: FloatArray, limit: FloatArray) -> list[Match]:
        """Return the matches of one gesture, the best first, from its terms ``(a, 9)``.

        The costs are negative logarithms of likelihoods, up to a constant, so the confidence is
        each one's share of the likelihood; nothing at all is as likely as the best action at its
        limit.
        """
        cost = terms.sum(axis=1)
        nothing = float(limit[int(np.argmin(cost))])
        costs = np.append(cost, nothing)
        weight = np.exp(costs.min() - costs)
        share = (weight / weight.sum()).tolist()
        weighed = np.where(self._verified, len(TERMS), 1).tolist()  # without examples, the tokens
        matches = [
            Match(
                name,
                float(each.sum()),
                p,
                tuple(zip(TERMS, each[:n].tolist(), strict=False)),
                most,
            )
            for name, each, p, n, most in zip(
                self.names, terms, share[:-1], weighed, limit.tolist(), strict=True
            )
        ]
        matches.append(Match(None, nothing, share[-1]))
        return sorted(matches, key=lambda match: match.distance)


class _Remembering:
    """A recognizer that is asked again and again about a doodle as it grows."""

    def __init__(self, recognizer: Recognizer) -> None:
        self._recognizer = recognizer
        self._fits: Fits = {}
        self._terms: Terms = {}

    def chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Segment]:
        """Choose as the recognizer does, and forget what is over."""
        begin_s = motion.time_s[0]
        self._fits = {each: fit for each, fit in self._fits.items() if each[1] >= begin_s}
        self._terms = {each: terms for each, terms in self._terms.items() if each[0] >= begin_s}
        return self._recognizer.chosen(motion, runs, self._fits)

    def named(
        self, motion: RigidMotion, runs: Sequence[TokenRun], segments: Sequence[Segment]
    ) -> list[Span]:
        """Name as the recognizer does."""
        return self._recognizer.named(motion, runs, segments, self._terms)


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
