"""Reader: entries of a description, and products of some, weighed to tell the poles apart."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.effort import Effort
from laban.linear import Linear, Softmax
from laban.motion import FloatArray
from laban.own import OwnMeasure

SUREST = 0.995
"""No reading is surer than this: so much has not been tried."""


@dataclass(frozen=True, slots=True, eq=False)
class Entries:
    """Which entries of a description are looked at, and how.

    Attributes
    ----------
    columns : (m,) of the description, at least one, none twice.
    lowest, highest : (m,) what training has shown; beyond, a value counts as the end.
    centre, scale : (m,) what is taken off a value, and what the rest is divided by.
    pairs : (p, 2) of the m: whose products are looked at as well.
    typical : (m,) of a person who is not known; None where values are not read against anybody.
    """

    columns: NDArray[np.int64]
    lowest: FloatArray
    highest: FloatArray
    centre: FloatArray
    scale: FloatArray
    pairs: NDArray[np.int64]
    typical: FloatArray | None = None

    def of(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray:
        """Return entries and products ``(m + p,)`` of a description, or ``(n, m + p)`` of n.

        They are read against somebody's own takes if these entries are so.
        """
        seen = description[..., self.columns]
        if self.typical is not None:
            assert own is not None
            seen = seen - own.of(self.columns).beside(self.typical)
        return self.seen(seen)

    def seen(self, values: FloatArray) -> FloatArray:
        """Return entries and products of the values ``(…, m)`` of these columns."""
        z = (np.minimum(np.maximum(values, self.lowest), self.highest) - self.centre) / self.scale
        first, second = self.pairs.T
        return np.concatenate([z, z[..., first] * z[..., second]], axis=-1)


@dataclass(frozen=True, slots=True, eq=False)
class AxisReader:
    """How one axis is read from entries and products.

    Attributes
    ----------
    classifier : its log odds are calibrated.
    members : share of each member of the committee that it is made of (`laban.committee`).
    held_out_accuracy : share of takes whose pole was told by a reader that had not seen the
        performer.
    """

    classifier: Linear
    members: Mapping[str, float]
    held_out_accuracy: float


@dataclass(frozen=True, slots=True, eq=False)
class StateReader:
    """How the joint states of two axes, `laban.model.STATES`, are read, as one decision.

    Attributes
    ----------
    classifier : of the states.
    held_out_accuracy : share of takes whose state was told without having seen the performer.
    """

    classifier: Softmax
    held_out_accuracy: float


@dataclass(frozen=True, slots=True, eq=False)
class Reader:
    """How Effort is read, of performers who are not known, or against their own takes.

    Attributes
    ----------
    entries : what is looked at.
    axes : by name.
    states : of Time and Weight together; None where too few takes had a pole on both.
    """

    entries: Entries
    axes: Mapping[str, AxisReader]
    states: StateReader | None = None

    def effort(self, description: FloatArray, own: OwnMeasure | None = None) -> Effort:
        """Return the Effort of a description ``(132,)``."""
        seen = self.entries.of(description, own)
        return Effort(
            **{
                axis: reading_of(float(part.classifier.log_odds(seen)))
                for axis, part in self.axes.items()
            }
        )

    def chances(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray | None:
        """Return the chance of each joint state ``(4,)``; None where none are known."""
        if self.states is None:
            return None
        return self.states.classifier.chances(self.entries.of(description, own))


def reading_of(log_odds: float) -> float:
    """Return the reading of calibrated log odds: twice the chance of the high pole, less 1."""
    return min(max(math.tanh(0.5 * log_odds), -SUREST), SUREST)
