"""Recognizer: which actions a doodle draws, and when."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol, TypeAlias

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray
from smd.recognition.acceptance import Intent, accepted_cost
from smd.recognition.action import Action
from smd.recognition.background import weighed
from smd.recognition.bank import compile_library, least_costs_of_parts
from smd.recognition.costs import DEFAULT_COSTS, Costs, RunCosts, run_costs
from smd.recognition.cutting import best_cut
from smd.recognition.matching import Match
from smd.recognition.proposals import Proposal, explaining, rest_to_rest, without_stir
from smd.recognition.segmentation import Segment
from smd.recognition.streaming import RecognitionStream
from smd.recognition.stretches import are_alike_long, dense_stretches
from smd.recognition.token_costs import TokenCosts
from smd.recognition.token_spotter import Span, TokenSpotter, with_loose_ends
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.traits import Traits, traits_of_parts
from smd.recognition.verification import GLANCE, GLIMPSE, TERMS, WRONG, Verification
from smd.smoothing import smooth

UNVERIFIED, UNVERIFIED_WRONG = 5.0, 10.0
"""What an action without examples costs: as much as a fair fit to examples, and more with the
share of tokens that are wrong."""

TOGETHER = 1024
"""Stretches whose courses are held in memory at a time."""

WORTH_NAMING = 2.0
"""An action that costs more than so many times what it may is no alternative to another one."""

Fits: TypeAlias = dict[tuple[float, float, bool], FloatArray]
"""How unlike actions' examples stretches are, tokens apart, ``(a,)``, by start and end in seconds
and whether only their lengths speak for them; infinite where that is more than an action may
cost."""

Stretch: TypeAlias = tuple[int, int, bool]
"""A stretch's first run, the one after its last, and whether only its length speaks for it."""

Terms: TypeAlias = dict[tuple[float, float], FloatArray]
"""What stretches are weighed by, tokens apart, ``(a, 9)`` for the actions with examples, by start
and end in seconds."""


class HasActions(Protocol):
    """A library, as far as recognition is concerned."""

    @property
    def actions(self) -> tuple[Action, ...]:
        """What can be performed."""


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
        Factor on what every action may cost: below 1 more is rejected, above it less.
    intent
        Whether movement is meant, whatever doodles say; by default a doodle that says when the
        user drew was drawn, and any other is free.
    """

    def __init__(
        self,
        actions: HasActions | Iterable[Action],
        *,
        figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
        costs: Costs = DEFAULT_COSTS,
        token_costs: TokenCosts | None = None,
        tolerance: float = 1.0,
        intent: Intent | None = None,
    ) -> None:
        every = actions if isinstance(actions, Iterable) else actions.actions
        drawable = [action for action in every if action.pattern]
        exemplars = [one.exemplar and weighed(one.exemplar) for one in drawable]
        self.names = tuple(action.name for action in drawable)
        self.intent = intent
        self._bank = compile_library(
            {action.name: action.pattern for action in drawable if action.pattern}, token_costs
        )
        self._verification = Verification(tuple(exemplars))
        self._verified = np.array([bool(one) for one in exemplars], dtype=bool)
        self._durations_s = np.array([one.duration_s if one else np.nan for one in exemplars])
        background = np.array([one.background if one else np.nan for one in exemplars], float)
        has_own = np.array([bool(one and one.own.any()) for one in exemplars], bool)
        self._most = {
            each: np.where(
                self._verified,
                accepted_cost(background, has_own, each, tolerance=tolerance),
                UNVERIFIED + UNVERIFIED_WRONG,
            )
            for each in Intent
        }
        self._figure_height_m = figure_height_m
        self._costs = costs
        self._tokens = TokenSpotter(self._bank, costs)  # where there are no examples

    def rank(self, doodle: Doodle) -> list[Match]:
        """Weigh every action, and none, for a doodle that holds one gesture, the best first.

        Rest before and after the gesture is no part of it. A doodle that never moves is none. That
        it holds a gesture says that it was meant, unless the recognizer's intent is another.

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
        whole = (moving[0], moving[-1] + 1)
        return self._matches(motion, runs, [whole], np.inf, self.intent or Intent.DRAWN)[0]

    def weigh(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        spans_s: Sequence[tuple[float, float]],
        intent: Intent | None = None,
    ) -> list[list[Match]]:
        """Weigh every action, and none, for stretches of a motion; for each the best first.

        Parameters
        ----------
        motion, runs
            Of one doodle.
        intent
            Whether the movement is meant; by default the recognizer's own, or free.
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
        intent = intent or self.intent or Intent.FREE
        return self._matches(motion, runs, stretches, WORTH_NAMING, intent)

    def spot(self, doodle: Doodle) -> list[Span]:
        """Find the actions in a doodle, in time order.

        Raises
        ------
        DoodleError
            If the doodle is too short to be smoothed.
        """
        motion = smooth(doodle)
        return self.spot_runs(motion, self.runs_of(doodle, motion), self.intent_of(doodle))

    def stream(
        self,
        listener: Callable[[RigidMotion], None] | None = None,
        *,
        intent: Intent | None = None,
    ) -> RecognitionStream:
        """Return what finds the actions while a doodle is being drawn, sample by sample.

        The listener is called with each piece of smoothed motion. Whether the movement is meant is
        said once; by default it is the recognizer's own intent, or free.
        """
        return RecognitionStream(
            _Remembering(self, intent), figure_height_m=self._figure_height_m, listener=listener
        )

    def runs_of(self, doodle: Doodle, motion: RigidMotion) -> tuple[TokenRun, ...]:
        """Return the tokens of a doodle's smoothed motion; still where it was not drawn."""
        drawing = doodle.drawing_at(motion.time_s)
        return tokenize(motion, figure_height_m=self._figure_height_m, drawing=drawing)

    def intent_of(self, doodle: Doodle) -> Intent:
        """Return whether the movement of a doodle is taken to be meant."""
        said = Intent.FREE if doodle.drawing is None else Intent.DRAWN
        return self.intent or said

    def spot_runs(
        self, motion: RigidMotion, runs: Sequence[TokenRun], intent: Intent | None = None
    ) -> list[Span]:
        """Find the actions in a motion that is cut into tokens already."""
        return self.named(motion, runs, self.chosen(motion, runs, intent), intent)

    def chosen(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        intent: Intent | None = None,
        known: Fits | None = None,
    ) -> list[Segment]:
        """Choose the stretches of runs that are actions, in time order.

        Stretches come from the automata, which propose for each action and each end the one that
        explains most, and from rest to rest. Where nothing says that movement is meant, hands
        hardly rest, and stretches come from everywhere besides, at the lengths that actions have.
        Each is weighed by its tokens and against examples, and left aside where it costs more
        than an action may. A stretch gains, a second of movement, the logarithm of how many times
        less it costs than it may; of those that do not overlap the ones are chosen that gain most
        together.

        Parameters
        ----------
        motion, runs
            Of one doodle, or of what is there of it.
        intent
            Whether the movement is meant; by default the recognizer's own, or free.
        known
            How well stretches fit examples, where that is known, and where it is written down:
            a stretch does not change when more of the doodle comes.
        """
        if not self._verified.any():
            return self._tokens.chosen(motion, runs)
        prices = run_costs(runs, self._costs)
        intent = intent or self.intent or Intent.FREE
        most = self._most[intent]
        proposed = explaining(self._bank, runs, prices)
        stretches = self._stretches(proposed, runs, prices, intent)
        cost = self._fits(stretches, motion, runs, most, {} if known is None else known)
        some = np.flatnonzero(np.isfinite(cost).any(axis=1))
        parts = [stretches[i][:2] for i in some.tolist()]
        cost[some] += WRONG * self._wrong(parts, runs, prices)
        self._add_unverified(cost, stretches, proposed, runs, prices)
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

    def named(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        segments: Sequence[Segment],
        intent: Intent | None = None,
        known: Terms | None = None,
    ) -> list[Span]:
        """Return the spans of chosen stretches, with what else each could be.

        Each is of the action that it costs least to see there, of those that may cost so much.
        What they are weighed by is taken from ``known`` where it is there, and else written down.
        """
        if not self._verified.any():
            return self._tokens.named(motion, runs, segments)
        stretches = [(one.first, one.last) for one in segments]
        intent = intent or self.intent or Intent.FREE
        spans = []
        for one, ranked in zip(
            segments,
            self._matches(motion, runs, stretches, WORTH_NAMING, intent, known),
            strict=True,
        ):
            within = (
                match.action for match in ranked if match.action and match.distance <= match.most
            )
            spans.append(_span(next(within, self.names[one.index]), one, runs, ranked))
        return spans

    def _stretches(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        """Return the stretches that may be an action, without stir at their ends."""
        found = [*((one.first, one.last) for one in proposed), *rest_to_rest(prices.is_still)]
        spoken_for = dict.fromkeys(_as_meant(found, runs))
        if intent is Intent.DRAWN:
            return [(*one, False) for one in spoken_for]
        durations_s = self._durations_s[self._verified]
        anywhere = dense_stretches(runs, prices.is_still, durations_s)
        dense = dict.fromkeys(without_stir(anywhere, runs))  # others of them have the loose ends
        return [
            *((*one, False) for one in spoken_for),
            *((*one, True) for one in dense if one not in spoken_for),
        ]

    def _wrong(
        self, stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun], prices: RunCosts
    ) -> FloatArray:
        """Return ``(g, a)``, the share of the strokes of stretches that is wrong as actions."""
        read = prices.of_reading(self._bank, runs)
        distance = least_costs_of_parts(self._bank, stretches, read=read, skip=prices.skip)
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        first, last = np.array(stretches, np.int64).reshape(-1, 2).T
        return np.asarray(distance / np.maximum(strokes[last] - strokes[first], 1)[:, None])

    def _add_unverified(
        self,
        cost: FloatArray,
        stretches: Sequence[Stretch],
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
    ) -> None:
        """Write into the costs what proposals cost of actions that have no examples."""
        unexplained = np.concatenate([[0.0], np.cumsum(prices.unexplained)])
        place = {(first, last): i for i, (first, last, _) in enumerate(stretches)}
        for one in proposed:
            if not self._verified[one.action]:
                (tight,) = without_stir([(one.first, one.last)], runs)
                strokes = int(np.count_nonzero(~prices.is_still[tight[0] : tight[1]]))
                gain = unexplained[tight[1]] - unexplained[tight[0]] - one.distance
                if gain > self._costs.action:
                    wrong = one.distance / max(strokes, 1)
                    cost[place[tight], one.action] = UNVERIFIED + UNVERIFIED_WRONG * wrong

    def _fits(
        self,
        stretches: Sequence[Stretch],
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        most: FloatArray,
        known: Fits,
    ) -> FloatArray:
        """Return ``(g, a)``, how unlike actions' examples stretches are, their tokens apart."""
        spans = [(runs[i].start_s, runs[j - 1].end_s, dense) for i, j, dense in stretches]
        new = [span for span in dict.fromkeys(spans) if span not in known]
        for begin in range(0, len(new), TOGETHER):
            some = new[begin : begin + TOGETHER]
            start_s, end_s, is_dense = np.array(some).T
            spans_s = [(start, end) for start, end, _ in some]
            alike = are_alike_long(end_s - start_s, self._durations_s) | (is_dense == 0)[:, None]
            gesture, action = np.nonzero(self._verified & alike)
            glimpse = self._traits(motion, spans_s, every=GLIMPSE)
            promising = self._verification.promising(glimpse, action, gesture, most[action])
            gesture, action = gesture[promising], action[promising]
            fits = np.full((len(some), len(self.names)), np.inf)
            if len(gesture):
                looked_at, which = np.unique(gesture, return_inverse=True)
                terms = self._verification.terms(
                    self._traits(motion, [spans_s[i] for i in looked_at.tolist()]),
                    action,
                    which,
                    wrong=np.zeros(len(action)),
                    most=most[action],
                    every=GLANCE,
                )
                fits[gesture, action] = terms.sum(axis=1)
            known.update(zip(some, fits, strict=True))
        return np.array([known[span] for span in spans]).reshape(len(spans), len(self.names))

    def _matches(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        stretches: Sequence[tuple[int, int]],
        beyond: float,
        intent: Intent,
        known: Terms | None = None,
    ) -> list[list[Match]]:
        """Weigh every action, and none, for stretches of runs; for each the best first.

        What costs more than ``beyond`` times what its action may comes out as infinity, where the
        action has examples.
        """
        most = self._most[intent]
        wrong = self._wrong(stretches, runs, run_costs(runs, self._costs))
        terms = np.zeros((len(stretches), len(self.names), len(TERMS)))
        terms[..., 0] = UNVERIFIED + UNVERIFIED_WRONG * wrong
        if len(stretches) and self._verified.any():
            known = {} if known is None else known
            spans_s = [(runs[first].start_s, runs[last - 1].end_s) for first, last in stretches]
            new = [span_s for span_s in dict.fromkeys(spans_s) if span_s not in known]
            known.update(zip(new, self._weighed(motion, new, beyond * most), strict=True))
            terms[:, self._verified] = [known[span_s] for span_s in spans_s]
            terms[..., 0] = np.where(self._verified, WRONG * wrong, terms[..., 0])
            terms[self._verified & (terms.sum(axis=-1) > beyond * most)] = np.inf
        return [self._ranked(each, most) for each in terms]

    def _weighed(
        self, motion: RigidMotion, spans_s: Sequence[tuple[float, float]], most: FloatArray
    ) -> FloatArray:
        """Return the terms of spans, tokens apart, ``(g, a, 9)`` for the actions with examples."""
        action = np.flatnonzero(self._verified)
        if not spans_s:
            return np.zeros((0, len(action), len(TERMS)))
        terms = self._verification.terms(
            self._traits(motion, spans_s),
            np.tile(action, len(spans_s)),
            np.repeat(np.arange(len(spans_s)), len(action)),
            wrong=np.zeros(len(spans_s) * len(action)),
            most=np.tile(most[action], len(spans_s)),
        )
        return terms.reshape(len(spans_s), len(action), len(TERMS))

    def _traits(
        self, motion: RigidMotion, spans_s: Sequence[tuple[float, float]], *, every: int = 1
    ) -> Traits:
        """Return the traits of spans of a motion."""
        return traits_of_parts(motion, spans_s, figure_height_m=self._figure_height_m, every=every)

    def _ranked(self, terms: FloatArray, most: FloatArray) -> list[Match]:
        """Return the matches of one gesture, the best first, from its terms ``(a, 9)``.

        The costs are negative logarithms of likelihoods, up to a constant, so the confidence is
        each one's share of the likelihood; nothing at all is as likely as the best action at the
        most that it may cost.
        """
        cost = terms.sum(axis=1)
        nothing = float(most[int(np.argmin(cost))])
        costs = np.append(cost, nothing)
        weight = np.exp(costs.min() - costs)
        share = (weight / weight.sum()).tolist()
        weighed = np.where(self._verified, len(TERMS), 1).tolist()  # without examples, the tokens
        matches = [
            Match(
                name, float(each.sum()), p, own, tuple(zip(TERMS, each[:n].tolist(), strict=False))
            )
            for name, each, p, own, n in zip(
                self.names, terms, share[:-1], most.tolist(), weighed, strict=True
            )
        ]
        matches.append(Match(None, nothing, share[-1]))
        return sorted(matches, key=lambda match: match.distance)


class _Remembering:
    """A recognizer that is asked again and again about a doodle as it grows."""

    def __init__(self, recognizer: Recognizer, intent: Intent | None) -> None:
        self._recognizer = recognizer
        self._intent = intent
        self._fits: Fits = {}
        self._terms: Terms = {}

    def chosen(self, motion: RigidMotion, runs: Sequence[TokenRun]) -> list[Segment]:
        """Choose as the recognizer does, and forget what is over."""
        begin_s = motion.time_s[0]
        self._fits = {each: fit for each, fit in self._fits.items() if each[0] >= begin_s}
        self._terms = {each: terms for each, terms in self._terms.items() if each[0] >= begin_s}
        return self._recognizer.chosen(motion, runs, self._intent, self._fits)

    def named(
        self, motion: RigidMotion, runs: Sequence[TokenRun], segments: Sequence[Segment]
    ) -> list[Span]:
        """Name as the recognizer does."""
        return self._recognizer.named(motion, runs, segments, self._intent, self._terms)


def _as_meant(
    stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun]
) -> list[tuple[int, int]]:
    """Return stretches without stir at their ends, and then as well with their loose ends."""
    tight = list(dict.fromkeys(without_stir(stretches, runs)))
    grown = [with_loose_ends([Segment(0, *one)], runs)[0] for one in tight]
    return [*tight, *((one.first, one.last) for one in grown)]


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
