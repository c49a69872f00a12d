"""OwnMeasure: a performer's usual description, relative to which their Effort is read.

On real people speed separates one person's sudden and sustained takes almost perfectly, but the
threshold differs from person to person. A few unlabelled takes of the same person show it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.description import describe
from laban.motion import FloatArray, RigidMotion
from laban.stillness import is_readable

PRIOR_TAKES = 2.0
"""Number of takes of a typical person that are averaged with a performer's own."""

FEWEST_TAKES = 3
"""Takes that a measure needs: fewer show what was played, not how the performer plays."""


@dataclass(frozen=True, slots=True, eq=False)
class OwnMeasure:
    """The mean description of a performer's takes.

    Attributes
    ----------
    mean : (132,), in the order of `laban.description.DESCRIPTION`.
    takes : number of takes in the mean.
    """

    mean: FloatArray
    takes: int

    def beside(self, typical: FloatArray) -> FloatArray:
        """Return the reference ``(132,)``: the mean of the own and a few typical takes."""
        whole = self.takes * self.mean + PRIOR_TAKES * typical
        return np.asarray(whole / (self.takes + PRIOR_TAKES))

    def of(self, columns: NDArray[np.int64]) -> OwnMeasure:
        """Return the measure of some entries alone."""
        return OwnMeasure(self.mean[columns], self.takes)


def own_measure(motions: Iterable[RigidMotion]) -> OwnMeasure | None:
    """Return the measure of a performer from takes, or None if there are too few of them.

    Takes with too little movement to read do not count. The takes need no labels, but should be
    varied.
    """
    return measure_of(np.array([describe(motion) for motion in motions if is_readable(motion)]))


def measure_of(descriptions: FloatArray) -> OwnMeasure | None:
    """Return the measure of descriptions ``(n, 132)``; None if n is below `FEWEST_TAKES`."""
    if len(descriptions) < FEWEST_TAKES:
        return None
    return OwnMeasure(descriptions.mean(axis=0), len(descriptions))
