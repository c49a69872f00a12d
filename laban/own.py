"""OwnMeasure: how somebody moves anyway, which their Effort is read against.

On real people speed orders one person's sudden and sustained takes nearly always right; what
differs is where each person's middle lies. A few takes of the same person, with no word on what
was meant, show it.
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
"""How many takes of a typical person count beside somebody's own."""

FEWEST_TAKES = 3
"""Of somebody, to read them against: fewer show what was played, not how they play."""


@dataclass(frozen=True, slots=True, eq=False)
class OwnMeasure:
    """The mean description of a performer's takes.

    Attributes
    ----------
    mean : (132,), in the order of `laban.description.DESCRIPTION`.
    takes : how many it is of.
    """

    mean: FloatArray
    takes: int

    def beside(self, typical: FloatArray) -> FloatArray:
        """Return what to read against ``(132,)``: the own mean and a few takes of anybody's."""
        whole = self.takes * self.mean + PRIOR_TAKES * typical
        return np.asarray(whole / (self.takes + PRIOR_TAKES))

    def of(self, columns: NDArray[np.int64]) -> OwnMeasure:
        """Return the measure of some entries alone."""
        return OwnMeasure(self.mean[columns], self.takes)


def own_measure(motions: Iterable[RigidMotion]) -> OwnMeasure | None:
    """Return the measure of a performer from takes, or None if there are too few of them.

    Takes with too little movement to read do not count. What was meant by them is not asked; they
    had better be various.
    """
    return measure_of(np.array([describe(motion) for motion in motions if is_readable(motion)]))


def measure_of(descriptions: FloatArray) -> OwnMeasure | None:
    """Return the measure of descriptions ``(n, 132)``; None if n is below `FEWEST_TAKES`."""
    if len(descriptions) < FEWEST_TAKES:
        return None
    return OwnMeasure(descriptions.mean(axis=0), len(descriptions))
