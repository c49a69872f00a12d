"""Ours with a part taken away, to tell what each part is worth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent
from smd.recognition.action import Action
from smd.recognition.costs import RunCosts
from smd.recognition.proposals import Proposal
from smd.recognition.recognizer import Stretch
from smd.recognition.tokens import TokenRun


class WithoutProposals(Recognizer):
    """Weighs what lies between rests, and dense stretches; the automata propose nothing."""

    def _stretches(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        return super()._stretches((), runs, prices, intent)


class WithoutDense(Recognizer):
    """Weighs what automata and rests propose, whatever is said of intent."""

    def _stretches(
        self,
        proposed: Sequence[Proposal],
        runs: Sequence[TokenRun],
        prices: RunCosts,
        intent: Intent,
    ) -> list[Stretch]:
        return super()._stretches(proposed, runs, prices, Intent.DRAWN)


class WithoutTokens(Recognizer):
    """Does not count how much of the tokens is wrong."""

    def _wrong(
        self, stretches: Sequence[tuple[int, int]], runs: Sequence[TokenRun], prices: RunCosts
    ) -> FloatArray:
        return np.zeros((len(stretches), len(self.names)))


VARIANTS: Mapping[str, Callable[[Sequence[Action]], Recognizer]] = {
    "no automata": WithoutProposals,
    "no tokens": WithoutTokens,
    "no dense": WithoutDense,
}
