"""CompiledActions: a library's actions, compiled once for recognition."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np

from laban import RigidMotion
from laban.frozen import Frozen
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import BoolArray, FloatArray
from smd.recognition.acceptance import UNVERIFIED, UNVERIFIED_WRONG, Intent, accepted_cost
from smd.recognition.action import Action
from smd.recognition.background import weighed
from smd.recognition.bank import Bank, compile_library, least_costs_of_parts
from smd.recognition.candidates import Stretch, candidate_stretches
from smd.recognition.costs import DEFAULT_COSTS, Costs, RunCosts
from smd.recognition.proposals import Proposal
from smd.recognition.token_costs import TokenCosts
from smd.recognition.tokens import TokenRun
from smd.recognition.traits import Traits, traits_of_parts
from smd.recognition.verification import Verification


class HasActions(Protocol):
    """A library, as far as recognition is concerned."""

    @property
    def actions(self) -> tuple[Action, ...]:
        """What can be performed."""


@dataclass(frozen=True, slots=True, eq=False)
class CompiledActions(Frozen):
    """The a actions of a library that have a pattern, compiled.

    Attributes
    ----------
    names : of the actions.
    bank : their automata.
    verification : their examples.
    has_examples : (a,) bool.
    durations_s : (a,), usual duration of each; NaN without examples.
    most : thresholds, (a,), by intent.
    figure_height_m : height of the figurine that the prop stands for.
    costs : what the tokens of a stretch are weighed by.
    """

    names: tuple[str, ...]
    bank: Bank
    verification: Verification
    has_examples: BoolArray
    durations_s: FloatArray
    most: Mapping[Intent, FloatArray]
    figure_height_m: float
    costs: Costs

    def __post_init__(self) -> None:
        for array in (self.has_examples, self.durations_s, *self.most.values()):
            array.flags.writeable = False
        object.__setattr__(self, "most", MappingProxyType(dict(self.most)))

    def candidates(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        """Return the stretches that may be one of the actions; some action has examples."""
        durations_s = self.durations_s[self.has_examples]
        return candidate_stretches(proposed, runs, prices.is_still, durations_s, intent)

    def wrong_share(
        self, stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun], prices: RunCosts
    ) -> FloatArray:
        """Return ``(g, a)``, the share of the strokes of g stretches that is wrong as actions."""
        read = prices.of_reading(self.bank, runs)
        distance = least_costs_of_parts(self.bank, stretches, read=read, skip=prices.skip)
        strokes = np.concatenate([[0], np.cumsum(~prices.is_still)])
        first, last = np.array(stretches, np.int64).reshape(-1, 2).T
        return np.asarray(distance / np.maximum(strokes[last] - strokes[first], 1)[:, None])

    def traits(
        self, motion: RigidMotion, spans_s: Sequence[tuple[float, float]], *, every: int = 1
    ) -> Traits:
        """Return the traits of spans of a motion, with courses of every n-th sample."""
        return traits_of_parts(motion, spans_s, figure_height_m=self.figure_height_m, every=every)


def compile_actions(
    actions: HasActions | Iterable[Action],
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    costs: Costs = DEFAULT_COSTS,
    token_costs: TokenCosts | None = None,
    tolerance: float = 1.0,
) -> CompiledActions:
    """Compile actions, or those of a library; parameters are those of `Recognizer`."""
    every = actions if isinstance(actions, Iterable) else actions.actions
    drawable = [action for action in every if action.pattern]
    exemplars = [one.exemplar and weighed(one.exemplar) for one in drawable]
    has_examples = np.array([bool(one) for one in exemplars], dtype=bool)
    background = np.array([one.background if one else np.nan for one in exemplars], float)
    has_own = np.array([bool(one and one.own.any()) for one in exemplars], bool)
    return CompiledActions(
        names=tuple(action.name for action in drawable),
        bank=compile_library(
            {action.name: action.pattern for action in drawable if action.pattern}, token_costs
        ),
        verification=Verification(tuple(exemplars)),
        has_examples=has_examples,
        durations_s=np.array([one.duration_s if one else np.nan for one in exemplars]),
        most={
            each: np.where(
                has_examples,
                accepted_cost(background, has_own, each, tolerance=tolerance),
                UNVERIFIED + UNVERIFIED_WRONG,
            )
            for each in Intent
        },
        figure_height_m=figure_height_m,
        costs=costs,
    )
