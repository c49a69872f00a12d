"""Training: from labelled feature vectors to an `EffortModel`.

Per axis [1]_ (section 5): rank the features by relevance, try the best 1, 2, … 50 of them, and
keep the number that tells most takes right. Every take is judged by a classifier that has not
seen its performer, for choosing that number, for the calibration, and, once more from outside,
for the accuracy that is reported: there the number itself is chosen without the performer.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from laban.calibration import Calibration, fit_calibration
from laban.classifier import NaiveBayes, fit_naive_bayes, relevance, telling_range
from laban.effort import AXES, LabanError
from laban.features import FEATURES
from laban.model import POLES, AxisModel, EffortModel
from laban.motion import FloatArray

FEWEST_PERFORMERS = 3
"""Of each pole: leaving one out to judge and one to choose leaves one to learn from."""

SIGNIFICANT_DIGITS = 9
"""Of a model's numbers: far finer than any measurement, short enough to read."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisReport:
    """How well one axis is told on performers that were left out.

    Attributes
    ----------
    reading : (n,) of each labelled take, by a model that had not seen its performer.
    meant : (n,) -1 low pole, 1 high pole, 0 neither.
    sweep : (50,) accuracy of the bare classifier with the best 1, 2, … 50 features.
    """

    reading: FloatArray
    meant: FloatArray
    sweep: FloatArray

    @property
    def accuracy(self) -> float:
        """Share of the takes of a pole whose reading has the pole's sign."""
        at_pole = self.meant != 0
        return float(np.mean((self.reading[at_pole] > 0) == (self.meant[at_pole] > 0)))

    @property
    def brier_score(self) -> float:
        """Mean squared error of the chance given to a take's pole: 0 best, 0.25 for no idea."""
        at_pole = self.meant != 0
        return float(np.mean((0.5 * (self.reading[at_pole] - self.meant[at_pole])) ** 2))


@dataclass(frozen=True, slots=True)
class Training:
    """A trained model and, per axis, how well it does."""

    model: EffortModel
    reports: Mapping[str, AxisReport]


def train(
    features: FloatArray,
    meant: Mapping[str, FloatArray],
    performers: Sequence[str],
    *,
    trained_on: str,
    seed: int | None = None,
) -> Training:
    """Train every axis that is labelled.

    Parameters
    ----------
    features
        ``(n, 50)`` as `laban.features.effort_features` gives.
    meant
        By axis, ``(n,)``: -1 low pole, 1 high pole, 0 neither, NaN not labelled. Takes of
        neither pole serve the calibration alone. An axis without a label is left out.
    performers
        ``n`` names; takes of one performer are never on both sides.
    trained_on
        What the takes are, in words, kept in the model.
    seed
        Of the takes, where they were simulated, kept in the model.

    Raises
    ------
    LabanError
        If nothing is labelled, or a labelled axis has too few performers of a pole.
    """
    names = np.asarray(performers)
    labelled = {axis: meant[axis] for axis in AXES if axis in meant}
    labelled = {axis: goal for axis, goal in labelled.items() if np.isfinite(goal).any()}
    check_labels(labelled, performers)
    parts, reports = {}, {}
    for axis, goal in labelled.items():
        known = np.isfinite(goal)
        parts[axis], reports[axis] = _train_axis(features[known], goal[known], names[known])
    return Training(EffortModel(parts, trained_on, seed), reports)


def check_labels(meant: Mapping[str, FloatArray], performers: Sequence[str]) -> None:
    """Raise LabanError unless every labelled axis has enough performers of both poles."""
    labelled = False
    for axis, goal in meant.items():
        if not np.isfinite(goal).any():
            continue
        labelled = True
        for word, pole in zip(POLES[axis], (-1.0, 1.0), strict=True):
            people = sorted({name for name, g in zip(performers, goal, strict=True) if g == pole})
            if len(people) < FEWEST_PERFORMERS:
                raise LabanError(
                    f"{axis}: expected {word!r} takes of at least {FEWEST_PERFORMERS} performers, "
                    f"got {len(people)}" + (f" ({', '.join(people)})" if people else "")
                )
    if not labelled:
        raise LabanError("labels: expected at least one take with an Effort word, got none")


def _train_axis(
    features: FloatArray, meant: FloatArray, performers: np.ndarray
) -> tuple[AxisModel, AxisReport]:
    """Train one axis on labelled takes."""
    at_pole = meant != 0
    reading = np.zeros(len(meant))
    for performer in np.unique(performers):
        inside = performers != performer
        reading[~inside] = _readings(
            features[inside], meant[inside], performers[inside], features[~inside]
        )
    odds = _held_out_log_odds(features, meant, performers)
    sweep = _accuracy_by_count(odds, meant)
    count = _best_count(sweep)

    poles, high = features[at_pole], meant[at_pole] > 0
    columns = np.argsort(-relevance(poles, high), kind="stable")[:count]
    bayes = fit_naive_bayes(poles, high).only(columns)
    lowest, highest = telling_range(bayes, poles[:, columns])
    calibration = fit_calibration(odds[:, count - 1], meant)
    report = AxisReport(reading, meant, sweep)
    part = AxisModel(
        columns=columns,
        lowest=_rounded(lowest),
        highest=_rounded(highest),
        bayes=NaiveBayes(_rounded(bayes.mean), _rounded(bayes.variance), _short(bayes.prior_high)),
        calibration=Calibration(_rounded(calibration.log_odds), _rounded(calibration.reading)),
        examples=(int(np.sum(meant < 0)), int(np.sum(meant == 0)), int(np.sum(meant > 0))),
        performers=len(np.unique(performers)),
        held_out_accuracy=_short(report.accuracy),
    )
    return part, report


def _held_out_log_odds(
    features: FloatArray, meant: FloatArray, performers: np.ndarray
) -> FloatArray:
    """Return log odds ``(n, 50)`` with the best 1 … 50 features, each performer left out."""
    odds = np.zeros((len(meant), len(FEATURES)))
    for performer in np.unique(performers):
        inside = performers != performer
        odds[~inside] = _log_odds_by_count(features[inside], meant[inside], features[~inside])
    return odds


def _log_odds_by_count(features: FloatArray, meant: FloatArray, asked: FloatArray) -> FloatArray:
    """Learn from takes; return the log odds of others with the best 1 … 50 features."""
    at_pole = meant != 0
    poles, high = features[at_pole], meant[at_pole] > 0
    bayes = fit_naive_bayes(poles, high)
    order = np.argsort(-relevance(poles, high), kind="stable")
    terms = bayes.log_odds_terms(np.clip(asked, *telling_range(bayes, poles)))
    return np.cumsum(terms[:, order], axis=1) + bayes.prior_log_odds


def _readings(
    features: FloatArray, meant: FloatArray, performers: np.ndarray, asked: FloatArray
) -> FloatArray:
    """Choose, learn and calibrate on some takes; return the readings of others."""
    odds = _held_out_log_odds(features, meant, performers)
    count = _best_count(_accuracy_by_count(odds, meant))
    calibration = fit_calibration(odds[:, count - 1], meant)
    asked_odds = _log_odds_by_count(features, meant, asked)[:, count - 1]
    return np.array([calibration.value(value) for value in asked_odds])


def _accuracy_by_count(odds: FloatArray, meant: FloatArray) -> FloatArray:
    """Return the share of poles told right by the sign of log odds, by number of features."""
    at_pole = meant != 0
    return np.mean((odds[at_pole] > 0) == (meant[at_pole] > 0)[:, None], axis=0)


def _best_count(sweep: FloatArray) -> int:
    """Return the number of features with the best accuracy, the fewest among equals."""
    return int(np.argmax(sweep)) + 1


def _short(value: float) -> float:
    """Return a number with `SIGNIFICANT_DIGITS`."""
    return float(f"{value:.{SIGNIFICANT_DIGITS}g}")


def _rounded(values: FloatArray) -> FloatArray:
    """Return an array of numbers with `SIGNIFICANT_DIGITS`."""
    return np.reshape([_short(value) for value in values.ravel()], values.shape)
