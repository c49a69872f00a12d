"""Reader: a classifier of some entries of a description, and what its log odds are worth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.calibration import Calibration
from laban.classifier import NaiveBayes
from laban.linear import Linear, Softmax
from laban.motion import FloatArray
from laban.own import OwnMeasure


@dataclass(frozen=True, slots=True, eq=False)
class Entries:
    """Which entries of a description are looked at, and how.

    Attributes
    ----------
    columns : (m,) of the description, at least one, none twice.
    lowest, highest : (m,) what training has shown; beyond, a value counts as the end.
    typical : (m,) of a person who is not known; None where values are not read against anybody.
    """

    columns: NDArray[np.int64]
    lowest: FloatArray
    highest: FloatArray
    typical: FloatArray | None = None

    def of(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray:
        """Return the entries of a description, read against somebody's own if they are so."""
        seen = description[self.columns]
        if self.typical is not None:
            assert own is not None
            seen = seen - own.of(self.columns).beside(self.typical)
        return np.clip(seen, self.lowest, self.highest)


@dataclass(frozen=True, slots=True, eq=False)
class Reader:
    """How one axis is read.

    Attributes
    ----------
    family : what the entries have in common, a key of `laban.description.FAMILIES`, or
        ``naive Bayes``.
    entries : what is looked at.
    classifier : tells the poles apart.
    calibration : from its log odds to the reading.
    held_out_accuracy : share of takes whose pole was told by a reader that had not seen the
        performer.
    """

    family: str
    entries: Entries
    classifier: NaiveBayes | Linear
    calibration: Calibration
    held_out_accuracy: float

    def value(self, description: FloatArray, own: OwnMeasure | None = None) -> float:
        """Return the reading of a description ``(129,)``, in [-1, 1]."""
        log_odds = self.classifier.log_odds(self.entries.of(description, own))
        return self.calibration.value(float(log_odds))


@dataclass(frozen=True, slots=True, eq=False)
class StateReader:
    """How two axes are read together, as one decision among `laban.model.STATES`.

    Attributes
    ----------
    entries : what is looked at.
    classifier : of the states.
    held_out_accuracy : share of takes whose state was told without having seen the performer.
    """

    entries: Entries
    classifier: Softmax
    held_out_accuracy: float

    def chances(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray:
        """Return the chance of each state of a description ``(129,)``."""
        return self.classifier.chances(self.entries.of(description, own))
