"""Calibration: from a classifier's log odds to a reading that can be believed.

A classifier that was fitted to a few people is too sure of the next one. How sure it may be is
learned from takes of people that it has not seen: their log odds are multiplied by the one
number that makes what was meant most likely ("temperature" [1]_), so that the sign, and with it
the decision, stays.

References
----------
.. [1] C. Guo, G. Pleiss, Y. Sun, K. Q. Weinberger, "On Calibration of Modern Neural Networks",
   ICML 2017.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.motion import FloatArray

FACTORS = np.geomspace(0.02, 10.0, 125)
"""What log odds may be multiplied by."""

KNOTS = np.linspace(-6.0, 6.0, 25)
"""Calibrated log odds at which the rising line has its knots; beyond, a reading is 0.995."""


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
    """Fit the line to held-out takes: twice the chance of the high pole, less 1.

    Parameters
    ----------
    log_odds
        ``(n,)``, of takes that the classifier did not learn from; at least one.
    meant
        ``(n,)``: -1 for the low pole, 1 for the high, 0 for a take that is neither and so counts
        half for each: neutral movement then reads near 0 where poles are easy to tell apart.
        One more take of either pole at even odds is counted with them (Laplace's rule).
    """
    odds = np.append(log_odds, [0.5, 0.5])
    high = 0.5 * (1.0 + np.append(meant, [1.0, -1.0]))
    scaled = FACTORS[:, None] * odds
    loss = (np.logaddexp(0.0, scaled) - high * scaled).sum(axis=1)
    factor = float(FACTORS[int(np.argmin(loss))])
    return Calibration(KNOTS / factor, np.tanh(0.5 * KNOTS))
