"""Acceptance: what an action may cost, from what movement costs that means nothing."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from smd.geometry.arrays import FloatArray


class Intent(StrEnum):
    """Whether something says that movement was meant as a gesture."""

    DRAWN = "drawn"
    """The trigger was held: nearly every stroke is meant."""

    FREE = "free"
    """Nothing says so: most movement is not."""


MARGIN = {Intent.DRAWN: 0.0, Intent.FREE: 0.35}
"""How far below its background an action's cost must lie, as a logarithm."""


def accepted_cost(background: FloatArray, intent: Intent, *, tolerance: float = 1.0) -> FloatArray:
    """Return ``(a,)``, the most that each of a actions may cost.

    Parameters
    ----------
    background
        ``(a,)``, the logarithms of what movement costs that means nothing (`background_of`).
    intent
        Whether something says that movement is meant.
    tolerance
        Factor on the result: below 1 more is rejected, above it less.
    """
    return np.asarray(tolerance * np.exp(background - MARGIN[intent]))
