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
from laban.size import Sizes, resized
from laban.steps import Steps, finished

SUREST = 0.995
"""No reading is surer than this: so much has not been tried."""

FADING = 2.0
"""Power of the distance by which a reading falls where nothing was learned."""


@dataclass(frozen=True, slots=True, eq=False)
class Entries:
    """Which entries of a description are looked at, and how.

    Attributes
    ----------
    columns : (m,) of the description, at least one, none twice.
    lowest, highest : (m,) what training has shown; beyond, a value counts as the end.
    centre, scale : (m,) what is taken off a value, and what the rest is divided by.
    pairs : (p, 2) of the m: whose products are looked at as well.
    unlike : (m, m) lower triangular: times this, standardized values of takes as they were
        learned from are independent and of variance 1 (half of their covariance taken as diagonal).
    sizes : at which movements are looked at.
    typical : (m,) of a person who is not known; None where values are not read against anybody.
    """

    columns: NDArray[np.int64]
    lowest: FloatArray
    highest: FloatArray
    centre: FloatArray
    scale: FloatArray
    pairs: NDArray[np.int64]
    unlike: FloatArray
    sizes: Sizes
    typical: FloatArray | None = None

    def values(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray:
        """Return the entries ``(m,)`` of a description, or ``(n, m)`` of n, at the usual size.

        They are read against somebody's own takes if these entries are so.
        """
        return finished(self.values_in_steps(description, own))

    def values_in_steps(
        self, description: FloatArray, own: OwnMeasure | None = None
    ) -> Steps[FloatArray]:
        """Do what `values` does, in steps."""
        if self.typical is None:
            size = yield from self.sizes.in_steps(description)
            return resized(description, -self.sizes.beyond(size))[..., self.columns]
        assert own is not None
        size = yield from self.sizes.in_steps(own.mean)
        mean = resized(own.mean, -size)[self.columns]
        yield
        values = resized(description, np.broadcast_to(-size, description.shape[:-1]))
        return values[..., self.columns] - OwnMeasure(mean, own.takes).beside(self.typical)

    def distance(self, values: FloatArray) -> FloatArray:
        """Return how unlike what training has shown values ``(…, m)`` are: Mahalanobis, RMS."""
        apart = ((values - self.centre) / self.scale) @ self.unlike
        return np.asarray(np.sqrt(np.mean(apart**2, axis=-1)))

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
    reach : the distance (`Entries.distance`) to which people who were left out came, 19 of 20.
    states : of Time and Weight together; None where too few takes had a pole on both.
    """

    entries: Entries
    axes: Mapping[str, AxisReader]
    reach: float
    states: StateReader | None = None

    def effort(self, description: FloatArray, own: OwnMeasure | None = None) -> Effort:
        """Return the Effort of a description ``(132,)``."""
        return finished(self.effort_in_steps(description, own))

    def effort_in_steps(
        self, description: FloatArray, own: OwnMeasure | None = None
    ) -> Steps[Effort]:
        """Do what `effort` does, in steps."""
        values = yield from self.entries.values_in_steps(description, own)
        yield
        known = self.known(values)
        seen = self.entries.seen(values)
        return Effort(
            **{
                axis: known * reading_of(float(part.classifier.log_odds(seen)))
                for axis, part in self.axes.items()
            }
        )

    def known(self, values: FloatArray) -> float:
        """Return how far values ``(m,)`` are of a kind that was learned from, in (0, 1].

        A movement of that kind is read as it was learned; of another, nothing is known, and either
        pole is as likely.
        """
        return float(known_at(self.entries.distance(values), self.reach))

    def chances(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray | None:
        """Return the chance of each joint state ``(4,)``; None where none are known."""
        if self.states is None:
            return None
        values = self.entries.values(description, own)
        known = self.known(values)
        chances = self.states.classifier.chances(self.entries.seen(values))
        return known * chances + (1.0 - known) / len(chances)


def known_at(distance: FloatArray, reach: float) -> FloatArray:
    """Return how far what lies at a distance is of a kind that was learned from."""
    return np.asarray((reach / np.maximum(distance, reach)) ** FADING)


def reading_of(log_odds: float) -> float:
    """Return the reading of calibrated log odds: twice the chance of the high pole, less 1."""
    return min(max(math.tanh(0.5 * log_odds), -SUREST), SUREST)
