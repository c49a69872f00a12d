"""Linear classifiers: logistic regression of standardized features, for two classes or several.

Fitting is scikit-learn's; what comes out is a few numbers that NumPy alone can use.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from laban.motion import FloatArray

RIDGE = 1.0
"""Strength of the prior on the weights of standardized features (scikit-learn's C, inverted)."""


@dataclass(frozen=True, slots=True, eq=False)
class Linear:
    """Two classes, told apart by a weighted sum.

    Attributes
    ----------
    weight : (m,) of each feature.
    bias : of the high class.
    """

    weight: FloatArray
    bias: float

    def log_odds(self, features: FloatArray) -> FloatArray:
        """Return the log odds of the high class, of features ``(…, m)``."""
        return np.asarray(features @ self.weight + self.bias)


@dataclass(frozen=True, slots=True, eq=False)
class Softmax:
    """Several classes, each with a weighted sum.

    Attributes
    ----------
    weight : (k, m) of each class and feature.
    bias : (k,) of each class.
    """

    weight: FloatArray
    bias: FloatArray

    def chances(self, features: FloatArray) -> FloatArray:
        """Return the chance of each class, ``(…, k)``, of features ``(…, m)``."""
        score = features @ self.weight.T + self.bias
        share = np.exp(score - score.max(axis=-1, keepdims=True))
        return np.asarray(share / share.sum(axis=-1, keepdims=True))


def fit_linear(features: FloatArray, high: NDArray[np.bool_]) -> Linear:
    """Fit logistic regression with a ridge prior to ``(n, m)`` features; both classes occur."""
    fitted, scale = _fitted(features, high.astype(np.int64), "newton-cholesky")
    weight = fitted.coef_[0] / scale
    return Linear(weight, float(fitted.intercept_[0] - weight @ features.mean(axis=0)))


def fit_softmax(features: FloatArray, labels: NDArray[np.int64]) -> Softmax:
    """Fit multinomial logistic regression to classes 0 … k - 1, at least 3, all of which occur."""
    fitted, scale = _fitted(features, labels, "lbfgs")
    weight = fitted.coef_ / scale
    return Softmax(weight, fitted.intercept_ - weight @ features.mean(axis=0))


def _fitted(features: FloatArray, labels: NDArray[np.int64], solver: str) -> tuple[Any, FloatArray]:
    """Return scikit-learn's fit of standardized features, and what they were divided by."""
    from sklearn.linear_model import LogisticRegression

    scale = features.std(axis=0) + 1e-9
    model = LogisticRegression(C=1.0 / RIDGE, solver=solver, tol=1e-8, max_iter=2000)
    return model.fit((features - features.mean(axis=0)) / scale, labels), scale
