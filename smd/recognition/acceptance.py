"""Acceptance: what an action may cost, from what movement costs that means nothing."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray


class Intent(StrEnum):
    """Whether something says that movement was meant as a gesture."""

    DRAWN = "drawn"
    """The trigger was held: nearly every stroke is meant."""

    FREE = "free"
    """Nothing says so: most movement is not."""


OWN_MARGIN = {Intent.DRAWN: -0.1, Intent.FREE: 0.3}
"""How far below its background the cost of an action must lie, as a logarithm, where some of its
examples are the performer's own."""

OTHERS_MARGIN = {Intent.DRAWN: -0.4, Intent.FREE: 0.35}
"""The same where all examples are other people's: their way is not quite the performer's, and a
stroke that is meant is hardly ever nothing."""


def accepted_cost(
    background: FloatArray, has_own: BoolArray, intent: Intent, *, tolerance: float = 1.0
) -> FloatArray:
    """Return ``(a,)``, the most that each of a actions may cost.

    Parameters
    ----------
    background
        ``(a,)``, the logarithms of what movement costs that means nothing (`background_of`).
    has_own
        ``(a,)``, whether some of an action's examples are the performer's own.
    intent
        Whether something says that movement is meant.
    tolerance
        Factor on the result: below 1 more is rejected, above it less.
    """
    margin = np.where(has_own, OWN_MARGIN[intent], OTHERS_MARGIN[intent])
    return np.asarray(tolerance * np.exp(background - margin))
