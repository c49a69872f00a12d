"""Acceptance: the threshold of an action, relative to the cost of meaningless movement.

The constants by which costs are judged stand here together: one is traded off against the others.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray


class Intent(StrEnum):
    """Whether movement is known to be meant as a gesture."""

    DRAWN = "drawn"
    """The trigger was held: nearly every stroke is meant."""

    FREE = "free"
    """The recording does not say: most movement is not meant."""


OWN_MARGIN = {Intent.DRAWN: -0.1, Intent.FREE: 0.3}
"""How far the cost of an action must lie below its background, as a logarithm, if some of its
examples are the performer's own."""

OTHERS_MARGIN = {Intent.DRAWN: -0.4, Intent.FREE: 0.35}
"""The same if all examples are other people's: they differ somewhat from the performer's, and a
stroke that is meant is almost always an action."""

UNVERIFIED, UNVERIFIED_WRONG = 5.0, 10.0
"""Cost of an action without examples: that of a fair fit to examples, plus a part proportional to
the share of wrong tokens. The threshold is the cost with all tokens wrong."""

PLAINLY = 1.3
"""Another action is plainly meant if it is accepted, and the one asked for costs more than so many
times as much. ``python -m benchmarks.own_examples`` prints how many takes that refuses."""

WORTH_NAMING = 2.0
"""An action that costs more than so many times its threshold is no alternative to another one."""


def accepted_cost(
    background: FloatArray, has_own: BoolArray, intent: Intent, *, tolerance: float = 1.0
) -> FloatArray:
    """Return the thresholds of ``a`` actions, ``(a,)``: the most that each may cost.

    Parameters
    ----------
    background
        ``(a,)``, the log costs of meaningless movement (`background_of`).
    has_own
        ``(a,)``, whether some of an action's examples are the performer's own.
    intent
        Whether the movement is known to be meant.
    tolerance
        Factor on the result: below 1 more is rejected, above it less.
    """
    margin = np.where(has_own, OWN_MARGIN[intent], OTHERS_MARGIN[intent])
    return np.asarray(tolerance * np.exp(background - margin))
