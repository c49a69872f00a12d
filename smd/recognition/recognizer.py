"""Recognizer: which actions a doodle draws, and when."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.recognition.acceptance import Intent
from smd.recognition.action import Action
from smd.recognition.choosing import Fits, chosen_stretches
from smd.recognition.compiled_actions import HasActions, compile_actions
from smd.recognition.costs import DEFAULT_COSTS, Costs
from smd.recognition.detection import Detection
from smd.recognition.matching import Match
from smd.recognition.segmentation import Segment
from smd.recognition.streaming import RecognitionStream
from smd.recognition.token_costs import TokenCosts
from smd.recognition.token_spotter import TokenSpotter
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import STILL, TokenRun
from smd.recognition.weighing import Terms, matches
from smd.smoothing import smooth


class Recognizer:
    """Finds a library's actions in doodles.

    Parameters
    ----------
    actions
        The actions, or a library that has them; those without a pattern are not looked for.
    figure_height_m
        Height of the figurine that the prop stands for.
    costs
        The costs of segmentation by tokens.
    token_costs
        The costs of substituting one token for another; the paper's unit costs if absent.
    tolerance
        Factor on every action's threshold: below 1 more is rejected, above it less.
    intent
        Overrides whether movement is meant; by default a doodle that says when the user drew was
        drawn, and any other is free.
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
        every = tuple(actions if isinstance(actions, Iterable) else actions.actions)
        options: dict[str, Any] = {
            "figure_height_m": figure_height_m,
            "costs": costs,
            "token_costs": token_costs,
            "tolerance": tolerance,
        }
        self.intent = intent
        self._made = partial(Recognizer, every, intent=intent, **options)
        self._actions = compile_actions(every, **options)
        self._tokens = TokenSpotter(self._actions.bank, costs)  # where there are no examples

    def __reduce__(self) -> tuple[Callable[[], Recognizer], tuple[()]]:
        """Pickle as what it was made of: what is compiled of it is larger."""
        return self._made, ()

    @property
    def names(self) -> tuple[str, ...]:
        """The actions that are looked for."""
        return self._actions.names

    def rank(self, doodle: Doodle) -> list[Match]:
        """Weigh every action, and none, for a doodle that holds one gesture, the best first.

        Rest before and after the gesture is ignored. A doodle that never moves matches no action.
        The movement counts as meant, since it is a gesture, unless the recognizer has an intent.

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
        intent = self.intent or Intent.DRAWN
        return matches(self._actions, motion, runs, [whole], intent, beyond=np.inf)[0]

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
            When each stretch begins and ends; it is widened to whole runs. Costs above
            `WORTH_NAMING` times the threshold are not computed to the end, and infinite.
        """
        starts_s = np.array([run.start_s for run in runs])
        stretches = []
        for start_s, end_s in spans_s:
            first = max(int(np.searchsorted(starts_s, start_s + 1e-6, side="right")) - 1, 0)
            last = max(int(np.searchsorted(starts_s, end_s - 1e-6)), first + 1)
            stretches.append((first, last))
        if not stretches or not self.names:
            return [[Match(None, 0.0, 1.0)] for _ in stretches]
        return matches(self._actions, motion, runs, stretches, self._meant(intent))

    def spot(self, doodle: Doodle) -> list[Detection]:
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
        """Return a stream that finds the actions while a doodle is drawn, sample by sample.

        The listener is called with each piece of smoothed motion. The intent holds for the whole
        stream; by default it is the recognizer's own, or free.
        """
        return RecognitionStream(
            _Remembering(self, intent),
            figure_height_m=self._actions.figure_height_m,
            listener=listener,
        )

    def runs_of(self, doodle: Doodle, motion: RigidMotion) -> tuple[TokenRun, ...]:
        """Return the tokens of a doodle's smoothed motion; still where it was not drawn."""
        drawing = doodle.drawing_at(motion.time_s)
        return tokenize(motion, figure_height_m=self._actions.figure_height_m, drawing=drawing)

    def intent_of(self, doodle: Doodle) -> Intent:
        """Return whether the movement of a doodle is taken to be meant."""
        said = Intent.FREE if doodle.drawing is None else Intent.DRAWN
        return self.intent or said

    def spot_runs(
        self, motion: RigidMotion, runs: Sequence[TokenRun], intent: Intent | None = None
    ) -> list[Detection]:
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

        By examples (`choosing.chosen_stretches`), or by tokens alone where no action has any; by
        default the intent is the recognizer's own, or free.
        """
        if not self._actions.has_examples.any():
            return self._tokens.chosen(motion, runs)
        known = {} if known is None else known
        return chosen_stretches(self._actions, motion, runs, self._meant(intent), known)

    def named(
        self,
        motion: RigidMotion,
        runs: Sequence[TokenRun],
        segments: Sequence[Segment],
        intent: Intent | None = None,
        known: Terms | None = None,
    ) -> list[Detection]:
        """Return the detections of chosen stretches, with alternatives.

        Each is of the cheapest action below its threshold. ``known`` is a cache of the terms, read
        and extended.
        """
        if not self._actions.has_examples.any():
            return self._tokens.named(motion, runs, segments)
        stretches = [(one.first, one.last) for one in segments]
        weighed = matches(self._actions, motion, runs, stretches, self._meant(intent), known=known)
        return [
            _detection(self._actions.names[one.index], one, runs, ranked)
            for one, ranked in zip(segments, weighed, strict=True)
        ]

    def _meant(self, intent: Intent | None) -> Intent:
        """Return the intent that is said, by the call or else by the recognizer, or free."""
        return intent or self.intent or Intent.FREE


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
    ) -> list[Detection]:
        """Name as the recognizer does."""
        return self._recognizer.named(motion, runs, segments, self._intent, self._terms)


def _detection(
    chosen: str, whole: Segment, runs: Sequence[TokenRun], ranked: Sequence[Match]
) -> Detection:
    """Return the detection of a stretch; ``ranked`` weighs all actions, the best first, for it.

    It is of the best action that may cost so much, else of the one that it was chosen as.
    """
    accepted = (match.action for match in ranked if match.action and match.distance <= match.most)
    name = next(accepted, chosen)
    own = next(match for match in ranked if match.action == name)
    return Detection(
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
