"""Linear classifiers of standardized features, for two classes or several.

scikit-learn fits the logistic regression; the result is a few numbers that NumPy alone can use.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from laban.motion import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Linear:
    """A linear classifier of two classes.

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

    def times(self, factor: float) -> Linear:
        """Return the classifier whose log odds are these times a factor."""
        return Linear(factor * self.weight, factor * self.bias)

    def among(self, columns: NDArray[np.int64], count: int) -> Linear:
        """Return the same classifier on ``count`` features, of which its own are ``columns``."""
        weight = np.zeros(count)
        weight[columns] = self.weight
        return Linear(weight, self.bias)


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

    def scores(self, features: FloatArray) -> FloatArray:
        """Return the log probability of each class, up to a common term, ``(…, k)``."""
        return np.asarray(features @ self.weight.T + self.bias)

    def chances(self, features: FloatArray) -> FloatArray:
        """Return the probability of each class, ``(…, k)``, for features ``(…, m)``."""
        score = self.scores(features)
        share = np.exp(score - score.max(axis=-1, keepdims=True))
        return np.asarray(share / share.sum(axis=-1, keepdims=True))


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Compute with one thread of BLAS; afterwards it has as many as before.

    The products of a fit are small: more threads mostly wait for each other, the longer the
    busier the cores are.
    """
    import sklearn.linear_model  # noqa: F401  # only libraries that are loaded can be limited
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1, user_api="blas"):
        yield


def fit_linear(features: FloatArray, high: NDArray[np.bool_], ridge: float = 1.0) -> Linear:
    """Fit logistic regression to ``(n, m)`` features; both classes occur.

    ``ridge`` is the strength of the prior on the weights of the standardized features.
    """
    solver = "newton-cholesky" if len(features) > features.shape[1] else "lbfgs"
    fitted, scale = _fitted(features, high.astype(np.int64), solver, ridge)
    weight = fitted.coef_[0] / scale
    return Linear(weight, float(fitted.intercept_[0] - weight @ features.mean(axis=0)))


def fit_softmax(features: FloatArray, labels: NDArray[np.int64], ridge: float = 1.0) -> Softmax:
    """Fit multinomial logistic regression to classes 0 … k - 1, at least 3, all of which occur."""
    fitted, scale = _fitted(features, labels, "lbfgs", ridge)
    weight = fitted.coef_ / scale
    return Softmax(weight, fitted.intercept_ - weight @ features.mean(axis=0))


def fit_shared_variance(features: FloatArray, high: NDArray[np.bool_]) -> Linear:
    """Fit Gaussian naive Bayes whose classes share their variances: a weighted sum too.

    It is the mean of the features' log odds, not the sum, which would count correlated evidence
    several times. The prior is even.
    """
    low_mean, high_mean = features[~high].mean(axis=0), features[high].mean(axis=0)
    within = features - np.where(high[:, None], high_mean, low_mean)
    weight = (high_mean - low_mean) / (np.mean(within**2, axis=0) + 1e-9) / features.shape[1]
    return Linear(weight, float(-0.5 * weight @ (low_mean + high_mean)))


def _fitted(
    features: FloatArray, labels: NDArray[np.int64], solver: str, ridge: float
) -> tuple[Any, FloatArray]:
    """Return scikit-learn's fit of standardized features, and the scale that divided them."""
    from sklearn.linear_model import LogisticRegression

    scale = features.std(axis=0) + 1e-9
    model = LogisticRegression(C=1.0 / ridge, solver=solver, tol=1e-8, max_iter=2000)
    return model.fit((features - features.mean(axis=0)) / scale, labels), scale
