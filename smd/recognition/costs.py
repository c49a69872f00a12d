"""Costs: those of reading a run, of deleting it from an action, and of leaving it unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray
from smd.recognition.bank import Bank
from smd.recognition.tokens import STILL, TokenRun


@dataclass(frozen=True, slots=True)
class Costs:
    """The costs that segmentation minimizes, in edits of a pattern.

    Attributes
    ----------
    action : of every action. Together with ``unexplained`` it sets how much movement an action
        needs if nothing is wrong: half of ``worth``, which is 9 cm or 29 degrees.
    worth : amount of movement (figure heights travelled plus radians turned) whose deletion from
        an action costs one edit; less costs proportionally less, more costs no more.
    unexplained : of leaving a run outside of all actions, as a share of deleting it from one.
        At 1, an action could extend over any amount of other movement at no cost.
    still_per_s : of stillness within an action, a second. Two equal gestures are two if the pause
        between them costs more than another action (`pause_s`); a bow may be held while that costs
        less than leaving its two strokes unexplained.
    faint, faint_beside : movement below which a run hardly counts as a stroke of its own: an
        amount, or if that is less, a share of a run beside it (squared for the next but one, and
        so on up to a pause). Matching such a run to a token of a pattern costs up to one edit, as
        if the token were missing.
    sharpness : of the confidence, per edit.
    """

    action: float = 0.25
    worth: float = 1.0
    unexplained: float = 0.5
    still_per_s: float = 0.625
    faint: float = 0.5
    faint_beside: float = 1.0 / 3.0
    sharpness: float = 3.0

    @property
    def pause_s(self) -> float:
        """The shortest stillness that separates two equal gestures."""
        return self.action / self.still_per_s


DEFAULT_COSTS = Costs()


@dataclass(frozen=True, slots=True, eq=False)
class RunCosts:
    """The costs of each of n runs.

    Attributes
    ----------
    skip : (n,), deleted from an action around it.
    unexplained : (n,), left outside of all actions.
    faintness : (n,), from 0 for a stroke of its own to 1 for a run far smaller than its neighbours.
    is_still : (n,) bool.
    """

    skip: FloatArray
    unexplained: FloatArray
    faintness: FloatArray
    is_still: BoolArray

    def of_reading(self, bank: Bank, runs: Sequence[TokenRun]) -> FloatArray:
        """Return ``(n, s)``, the cost of taking each run for a token that a state reads."""
        mistaken = bank.reading(run.token for run in runs)
        # Stillness taken for a movement costs more than that movement missing, or it would be a
        # way to stretch an action over the rest beside it.
        still = np.flatnonzero(self.is_still)
        mistaken[still] = np.sign(mistaken[still]) * (1.0 + self.skip[still, None])
        return np.maximum(mistaken, self.faintness[:, None])


def run_costs(runs: Sequence[TokenRun], costs: Costs) -> RunCosts:
    """Return the costs of each run that do not depend on the token it is matched to."""
    extent = np.array([run.travel_heights + run.turn_rad for run in runs])
    is_still = np.array([run.token == STILL for run in runs], dtype=bool)
    duration_s = np.array([run.end_s - run.start_s for run in runs])
    movement = np.where(is_still, 0.0, np.minimum(extent / costs.worth, 1.0))
    is_pause = is_still & (duration_s >= costs.pause_s)
    enough = np.minimum(costs.faint, _shadows(extent, is_pause, costs.faint_beside))
    return RunCosts(
        skip=np.where(is_still, costs.still_per_s * duration_s, movement),
        unexplained=costs.unexplained * movement,
        faintness=np.where(
            is_still, 0.0, np.maximum(1.0 - extent / np.maximum(enough, 1e-12), 0.0)
        ),
        is_still=is_still,
    )


def _shadows(extent: FloatArray, is_pause: BoolArray, share: float) -> FloatArray:
    """Return the largest movement before or after each run, times ``share`` for each run away.

    A pause casts no shadow and lets none through.
    """
    shadow = np.zeros(len(extent))
    for order in (range(len(extent)), range(len(extent) - 1, -1, -1)):
        falling = 0.0
        for i in order:
            shadow[i] = max(shadow[i], falling)
            falling = 0.0 if is_pause[i] else share * max(falling, float(extent[i]))
    return shadow
