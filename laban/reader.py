"""Reader: classifies the poles by weights on entries of a description and on products of some."""

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
"""Largest probability of a reading: more would need more training data."""

FADING = 2.0
"""Power of the distance by which a reading falls outside of the training data."""


@dataclass(frozen=True, slots=True, eq=False)
class Entries:
    """The entries of a description that are used, and how they are standardized.

    Attributes
    ----------
    columns : (m,) indices into the description, at least one, none twice.
    lowest, highest : (m,) range of the training data; values beyond are clipped.
    centre, scale : (m,) subtracted from a value, then the divisor.
    pairs : (p, 2) indices of the m, whose products are used as well.
    unlike : (m, m) lower triangular whitening matrix: it makes standardized values of the training
        takes independent and of variance 1 (half of their covariance taken as diagonal).
    sizes : of the training movements; a movement is brought to one of them.
    typical : (m,) values of a typical person; None if values are not relative to a performer.
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

        They are relative to the performer's own takes if `typical` is given.
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
        """Return the Mahalanobis distance (RMS) of values ``(…, m)`` from the training data."""
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
    members : share of each member of its committee (`laban.committee`).
    held_out_accuracy : accuracy on takes of performers that were left out of training.
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
    held_out_accuracy : accuracy on takes of performers that were left out of training.
    """

    classifier: Softmax
    held_out_accuracy: float


@dataclass(frozen=True, slots=True, eq=False)
class Reader:
    """How Effort is read, of unknown performers or relative to their own takes.

    Attributes
    ----------
    entries : the input.
    axes : by name.
    reach : the distance (`Entries.distance`) that holds 19 of 20 held-out takes.
    states : of Time and Weight together; None if too few takes had a pole on both.
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
        """Return the probability that values ``(m,)`` are of a kind in the training data, (0, 1].

        A movement of that kind is read as trained. Of any other kind nothing is known, and either
        pole is as likely.
        """
        return float(known_at(self.entries.distance(values), self.reach))

    def chances(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray | None:
        """Return the probability of each joint state ``(4,)``; None if none were trained."""
        if self.states is None:
            return None
        values = self.entries.values(description, own)
        known = self.known(values)
        chances = self.states.classifier.chances(self.entries.seen(values))
        return known * chances + (1.0 - known) / len(chances)


def known_at(distance: FloatArray, reach: float) -> FloatArray:
    """Return the probability that a movement at a distance is of a kind in the training data."""
    return np.asarray((reach / np.maximum(distance, reach)) ** FADING)


def reading_of(log_odds: float) -> float:
    """Return the reading of calibrated log odds: 2 p - 1, p the probability of the high pole."""
    return min(max(math.tanh(0.5 * log_odds), -SUREST), SUREST)
