"""Candidates: the classifiers that training may choose from, behind one face."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from laban.classifier import NaiveBayes, fit_naive_bayes, relevance, telling_range
from laban.description import DESCRIPTION_NAMES, FAMILIES
from laban.features import FEATURES
from laban.linear import Linear, fit_linear
from laban.motion import FloatArray

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

MOST_FOLDS = 12
"""Up to so many performers each is left out alone; more are left out in `GROUPS` groups."""

GROUPS = 5

PAPERS = "naive Bayes"


@dataclass(frozen=True, slots=True, eq=False)
class Fitted:
    """A classifier of some columns of a description.

    Attributes
    ----------
    columns : (m,) of the description.
    lowest, highest : (m,) beyond which values count as the end.
    classifier : of these m values.
    """

    columns: IntArray
    lowest: FloatArray
    highest: FloatArray
    classifier: NaiveBayes | Linear

    def log_odds(self, descriptions: FloatArray) -> FloatArray:
        """Return the log odds of the high pole of descriptions ``(n, d)``."""
        seen = np.clip(descriptions[:, self.columns], self.lowest, self.highest)
        return self.classifier.log_odds(seen)


Candidate: TypeAlias = Callable[[FloatArray, BoolArray, IntArray], Fitted]
"""Learns from descriptions ``(n, d)``, whether each is of the high pole, and whose each is."""


def folds(performers: IntArray) -> list[BoolArray]:
    """Return masks of takes to leave out together: performers, or groups of them."""
    names = np.unique(performers)
    groups = np.arange(len(names)) % (len(names) if len(names) <= MOST_FOLDS else GROUPS)
    return [np.isin(performers, names[groups == g]) for g in np.unique(groups)]


def linear_of(names: tuple[str, ...]) -> Candidate:
    """Return the candidate that weighs some entries of the description."""
    columns = np.array([DESCRIPTION_NAMES.index(name) for name in names], dtype=np.int64)

    def fit(descriptions: FloatArray, high: BoolArray, _: IntArray) -> Fitted:
        seen = descriptions[:, columns]
        return Fitted(columns, seen.min(axis=0), seen.max(axis=0), fit_linear(seen, high))

    return fit


def papers_naive_bayes(descriptions: FloatArray, high: BoolArray, performers: IntArray) -> Fitted:
    """Learn as the paper does [1]_: rank the 50 features, take the M that tell best, multiply.

    M is the one with the best accuracy on performers left out, the fewest among equals.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, sections 5.3, 5.4.
    """
    features = descriptions[:, : len(FEATURES)]
    right = np.zeros(len(FEATURES))
    for out in folds(performers):
        if high[~out].all() or not high[~out].any():
            continue
        odds = _odds_by_count(features[~out], high[~out], features[out])
        right += ((odds > 0) == high[out, None]).sum(axis=0)
    count = int(np.argmax(right)) + 1
    columns = np.argsort(-relevance(features, high), kind="stable")[:count]
    bayes = fit_naive_bayes(features, high).only(columns)
    lowest, highest = telling_range(bayes, features[:, columns])
    return Fitted(columns, lowest, highest, bayes)


def _odds_by_count(features: FloatArray, high: BoolArray, asked: FloatArray) -> FloatArray:
    """Learn from takes; return the log odds of others with the best 1 … 50 features."""
    bayes = fit_naive_bayes(features, high)
    order = np.argsort(-relevance(features, high), kind="stable")
    terms = bayes.log_odds_terms(np.clip(asked, *telling_range(bayes, features)))
    return np.cumsum(terms[:, order], axis=1) + bayes.prior_log_odds


CANDIDATES: Mapping[str, Candidate] = MappingProxyType(
    {
        **{family: linear_of(names) for family, names in FAMILIES.items()},
        PAPERS: papers_naive_bayes,
    }
)
"""By name, those of few entries first; `EAGER` ones have to earn their place."""

EAGER = ("everything", PAPERS)
"""Of so many entries that few takes cannot judge them: chosen only where they are clearly better,
by more than the standard error of the difference (L. Breiman et al., 1984)."""
