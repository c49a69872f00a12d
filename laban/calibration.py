"""Calibration: from a classifier's log odds to a reading that can be believed.

Naive Bayes counts every feature as new evidence. Features of movement repeat each other (speed,
acceleration and jerk rise together), so its log odds are far too sure, and lopsided: fast
movements vary more than slow ones. Read as they are, they would sit at -1 and 1. Held-out takes
put this right: sorted by their log odds and gathered in groups, each group's share of the high
pole is what such log odds are worth. Where a group contradicts its neighbours they are pooled
(isotonic regression [1]_), so a reading never falls as the log odds rise.

References
----------
.. [1] B. Zadrozny, C. Elkan, "Transforming Classifier Scores into Accurate Multiclass Probability
   Estimates", KDD 2002.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.motion import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """A rising line through knots, held beyond its ends.

    Attributes
    ----------
    log_odds : (k,) never falling.
    reading : (k,) in [-1, 1], never falling.
    """

    log_odds: FloatArray
    reading: FloatArray

    def value(self, log_odds: float) -> float:
        """Return the reading, in [-1, 1]."""
        return float(np.interp(log_odds, self.log_odds, self.reading))


def fit_calibration(log_odds: FloatArray, meant: FloatArray) -> Calibration:
    """Fit the line to held-out takes.

    Parameters
    ----------
    log_odds
        ``(n,)``, of takes that the classifier did not learn from; at least one.
    meant
        ``(n,)``: -1 for the low pole, 1 for the high, 0 for a take that is neither and so counts
        half for each: neutral movement then reads near 0 where poles are easy to tell apart.
    """
    order = np.argsort(log_odds, kind="stable")
    groups = np.array_split(order, max(1, round(np.sqrt(len(order)))))  # as many as each has
    blocks: list[tuple[float, float, int]] = []  # sum of meant, sum of log odds, takes
    for group in groups:
        block = (float(meant[group].sum()), float(log_odds[group].sum()), len(group))
        while blocks and _reading(blocks[-1]) >= _reading(block):
            last = blocks.pop()
            block = (last[0] + block[0], last[1] + block[1], last[2] + block[2])
        blocks.append(block)
    return Calibration(
        np.array([total / takes for _, total, takes in blocks]),
        np.array([_reading(block) for block in blocks]),
    )


def _reading(block: tuple[float, float, int]) -> float:
    """Return the mean of what was meant, with one more take of either pole (Laplace's rule)."""
    total, _, takes = block
    return total / (takes + 2.0)
