"""A fold that travels along a long body and carries it ahead: how caterpillars crawl.

A caterpillar has no gait in which legs swing under a body that travels: a segment stands still with
its feet, is lifted and shortened as the wave passes, and is put down a stride ahead [1]_, [2]_. So
the body itself is described: in the fold it rises and falls by an angle, and is shortened by a
share. How far each fold takes it, and how high, follow from these two: a body that does not shorten
must rise to get ahead, as an inchworm does.

References
----------
.. [1] B. A. Trimmer, H. Lin, "Bone-free: soft mechanics for adaptive locomotion", Integrative and
   Comparative Biology 54, 2014.
.. [2] L. I. van Griethuijsen, B. A. Trimmer, "Locomotion in caterpillars", Biological Reviews 89,
   2014.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray

BLUR = 0.06
"""Standard deviation, in lengths of the fold, by which its ends are softened."""

_MARGIN = 4.0 * BLUR
_STEPS = 2000


@dataclass(frozen=True, eq=False)
class Fold:
    """A fold that runs from the tail to the head once a cycle.

    Attributes
    ----------
    angle_deg : by which the body rises behind its crest, and falls ahead of it.
    shortening : share of its length that the body loses at the crest.
    part : of the cycle that a place of the body is in the fold.
    lag : how much later the head is in it than the tail, in cycles.
    length_m : of the body at rest.

    Raises
    ------
    ValueError
        If one fold would begin at a place before the one before it has left.
    """

    angle_deg: float
    shortening: float
    part: float
    lag: float
    length_m: float

    def __post_init__(self) -> None:
        if self.part * (1.0 + 2.0 * _MARGIN) > 1.0:
            raise ValueError(
                f"part: expected at most {1.0 / (1.0 + 2.0 * _MARGIN):.2f}, got {self.part}"
            )

    @property
    def stride_m(self) -> float:
        """How far a cycle takes the body."""
        return float(self._table[1][-1])

    @property
    def height_m(self) -> float:
        """How high its crest is."""
        return float(self._table[2].max())

    def moved_m(self, phase: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return how far ahead, and up, a place has been moved: ``(…)`` each.

        Parameters
        ----------
        phase
            ``(…)`` cycles since the fold came to that place first; below 0 before it.
        """
        share, ahead, up = self._table
        phase = np.asarray(phase, dtype=np.float64)
        begun = np.floor(phase + _MARGIN * self.part)
        at = (phase - begun) / self.part
        return begun * self.stride_m + np.interp(at, share, ahead), np.interp(at, share, up)

    def lead_m(self) -> float:
        """Return how far a place is ahead of even travel from phase 0, on average."""
        phase = np.linspace(0.0, 1.0, _STEPS, endpoint=False)
        return float(np.mean(self.moved_m(phase)[0] - phase * self.stride_m))

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return shares of the fold's length, and how far ahead and up it has moved a place."""
        from scipy.ndimage import gaussian_filter1d

        share = np.linspace(-_MARGIN, 1.0 + _MARGIN, _STEPS + 1)
        step = share[1] - share[0]
        inside = (share > 0.0) & (share < 1.0)
        angle = np.where(inside, np.sin(2.0 * np.pi * share), 0.0)
        less = np.where(inside, np.sin(np.pi * share) ** 2, 0.0)
        angle, less = (gaussian_filter1d(curve, BLUR / step) for curve in (angle, less))
        angle *= np.radians(self.angle_deg) / angle.max()  # softening has lowered it
        less *= self.shortening / less.max()
        extent_m = self.part * self.length_m / self.lag
        way = extent_m * np.array(
            [1.0 - (1.0 - less) * np.cos(angle), (1.0 - less) * np.sin(angle)]
        )
        summed = np.concatenate([[[0.0], [0.0]], np.cumsum(0.5 * (way[:, 1:] + way[:, :-1]), 1)], 1)
        ahead, up = step * summed
        return share, ahead, up
