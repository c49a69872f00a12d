"""Ours with a part taken away, to tell what each part is worth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from functools import partial

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent
from smd.recognition.action import Action
from smd.recognition.candidates import Stretch
from smd.recognition.compiled_actions import CompiledActions
from smd.recognition.costs import RunCosts
from smd.recognition.proposals import Proposal
from smd.recognition.tokens import TokenRun


class WithoutProposals(CompiledActions):
    """Weighs what lies between rests, and dense stretches; the automata propose nothing."""

    def candidates(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        """Return those of rests and lengths."""
        return super().candidates((), runs, prices, intent)


class WithoutDense(CompiledActions):
    """Weighs what automata and rests propose, whatever is said of intent."""

    def candidates(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        """Return those of automata and rests."""
        return super().candidates(proposed, runs, prices, Intent.DRAWN)


class WithoutTokens(CompiledActions):
    """Does not count how much of the tokens is wrong."""

    def wrong_share(
        self, stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun], prices: RunCosts
    ) -> FloatArray:
        """Return that none are."""
        return np.zeros((len(stretches), len(self.names)))


class Variant(Recognizer):
    """A recognizer whose actions are compiled into something else."""

    def __init__(self, kind: type[CompiledActions], actions: Sequence[Action]) -> None:
        super().__init__(actions)
        compiled = self._actions
        self._actions = kind(*(getattr(compiled, each.name) for each in fields(compiled)))


VARIANTS: Mapping[str, Callable[[Sequence[Action]], Recognizer]] = {
    "no automata": partial(Variant, WithoutProposals),
    "no tokens": partial(Variant, WithoutTokens),
    "no dense": partial(Variant, WithoutDense),
}
