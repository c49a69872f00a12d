"""Acceptance: what an action may cost, from what movement costs that means nothing.

The constants by which costs are judged stand here together: one is traded off against the others.
"""

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

UNVERIFIED, UNVERIFIED_WRONG = 5.0, 10.0
"""What an action without examples costs: as much as a fair fit to examples, and more with the
share of tokens that are wrong. All of them wrong is the most that it may cost."""

PLAINLY = 1.3
"""Another action is plainly meant where it passes, and the one asked for costs more than so many
times as much. ``python -m benchmarks.own_examples`` prints how many takes that refuses."""

WORTH_NAMING = 2.0
"""An action that costs more than so many times what it may is no alternative to another one."""


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
