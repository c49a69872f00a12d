"""The paper's method for Effort, to compare with: naive Bayes for two classes [1]_.

It also computes the relevance of a feature for separating the classes.

The two classes of an axis are its poles: *low* (sustained, light, …) and *high* (sudden,
strong, …). Densities are multiplied in log space: 50 factors would underflow.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, sections 5.3, 5.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.motion import FloatArray

BoolArray = NDArray[np.bool_]

VARIANCE_FLOOR = 1e-9
"""Added to every variance, as a share of the largest one: otherwise a feature that is constant
within a class would decide alone. scikit-learn's default."""


def relevance(features: FloatArray, high: BoolArray) -> FloatArray:
    """Return each feature's variance between the classes over that within them (eq. 2 to 5).

    Parameters
    ----------
    features
        ``(n, d)``.
    high
        ``(n,)``, true for the high pole; both classes occur.

    Returns
    -------
    ``(d,)`` not negative; 0 for a constant feature.
    """
    share = np.array([np.mean(~high), np.mean(high)])[:, None]
    mean, variance = _moments(features, high)
    between = np.sum(share * (mean - features.mean(axis=0)) ** 2, axis=0)
    within = np.sum(share * variance, axis=0)
    tiny = np.finfo(np.float64).tiny
    return np.asarray(between / np.maximum(within, tiny))


@dataclass(frozen=True, slots=True, eq=False)
class NaiveBayes:
    """Two classes, each with independent Gaussian features.

    Attributes
    ----------
    mean, variance : (2, d), row 0 for the low class and row 1 for the high; variances positive.
    prior_high : prior probability of the high class, in (0, 1).
    """

    mean: FloatArray
    variance: FloatArray
    prior_high: float

    def log_odds_terms(self, features: FloatArray) -> FloatArray:
        """Return each feature's contribution to the log odds of the high class, ``(…, d)``."""
        spread = (features[..., None, :] - self.mean) ** 2 / self.variance + np.log(self.variance)
        return np.asarray(0.5 * (spread[..., 0, :] - spread[..., 1, :]))

    def log_odds(self, features: FloatArray) -> FloatArray:
        """Return ``log P(high | features) - log P(low | features)`` of ``(…, d)``."""
        return self.log_odds_terms(features).sum(axis=-1) + self.prior_log_odds

    @property
    def prior_log_odds(self) -> float:
        """The prior log odds of the high class."""
        return float(np.log(self.prior_high) - np.log1p(-self.prior_high))

    def only(self, columns: NDArray[np.int64]) -> NaiveBayes:
        """Return the same classifier for some of its features, in the given order."""
        return NaiveBayes(self.mean[:, columns], self.variance[:, columns], self.prior_high)


def fit_naive_bayes(features: FloatArray, high: BoolArray) -> NaiveBayes:
    """Fit class means, variances (of the population) and the prior of ``(n, d)`` features."""
    mean, variance = _moments(features, high)
    floor = VARIANCE_FLOOR * float(features.var(axis=0).max())
    floor = max(floor, float(np.finfo(np.float64).tiny))
    return NaiveBayes(mean, variance + floor, float(np.mean(high)))


@dataclass(frozen=True, slots=True, eq=False)
class PapersMethod:
    """The paper's classifier: naive Bayes of the most relevant features.

    Attributes
    ----------
    columns : (m,) indices of the 50 features, the most relevant first.
    bayes : classifier of these features.
    """

    columns: NDArray[np.int64]
    bayes: NaiveBayes

    def log_odds(self, features: FloatArray) -> FloatArray:
        """Return the log odds of the high class of all 50 features ``(…, 50)``."""
        return self.bayes.log_odds(features[..., self.columns])


def fit_papers_method(
    features: FloatArray, high: BoolArray, left_out: Sequence[BoolArray]
) -> PapersMethod:
    """Rank features by `relevance`, take the best M, multiply their probabilities [1]_.

    Parameters
    ----------
    features
        ``(n, 50)``.
    high
        ``(n,)``, true for the high pole; both classes occur.
    left_out
        Folds, as masks of takes. M has the best cross-validated accuracy; among equals it is the
        smallest.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, sections 5.3, 5.4.
    """
    right = np.zeros(features.shape[1])
    for out in left_out:
        if high[~out].all() or not high[~out].any():
            continue
        order = np.argsort(-relevance(features[~out], high[~out]), kind="stable")
        bayes = fit_naive_bayes(features[~out], high[~out])
        terms = bayes.log_odds_terms(features[out])[:, order]
        odds = np.cumsum(terms, axis=1) + bayes.prior_log_odds
        right += ((odds > 0) == high[out][:, None]).sum(axis=0)
    best = int(np.argmax(right)) + 1
    columns = np.argsort(-relevance(features, high), kind="stable")[:best]
    return PapersMethod(columns, fit_naive_bayes(features, high).only(columns))


def _moments(features: FloatArray, high: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return the mean and variance of each class, each ``(2, d)``."""
    classes = (features[~high], features[high])
    return np.stack([c.mean(axis=0) for c in classes]), np.stack([c.var(axis=0) for c in classes])
