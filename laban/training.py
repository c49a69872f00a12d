"""Training: from labelled descriptions to an `EffortModel`.

Per axis, for people who are not known and for people whose own measure is: every candidate is
judged on performers that it has not learned from, the best is taken, and how sure it may be is
learned from the same held-out takes. For the accuracy that is reported all of that is done once
more for each performer without any take of theirs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from laban.calibration import Calibration, fit_calibration
from laban.candidates import CANDIDATES, EAGER, Candidate, Fitted, folds
from laban.classifier import NaiveBayes
from laban.description import DESCRIPTION_NAMES, FAMILIES
from laban.effort import AXES, LabanError
from laban.linear import Linear, Softmax, fit_softmax
from laban.model import POLES, STATES, AxisModel, EffortModel, JointModel
from laban.motion import FloatArray
from laban.own import OwnMeasure
from laban.reader import Entries, Reader, StateReader

IntArray = NDArray[np.int64]

FEWEST_PERFORMERS = 3
"""Of each pole: leaving one out to judge and one to choose leaves one to learn from."""

SIGNIFICANT_DIGITS = 6
"""Of a model's numbers: far finer than any measurement, short enough to read."""

_EVERYTHING = np.array([DESCRIPTION_NAMES.index(name) for name in FAMILIES["everything"]])


@dataclass(frozen=True, slots=True, eq=False)
class AxisReport:
    """How well one axis is told on performers that were left out.

    Attributes
    ----------
    reading : (n,) of each labelled take, by a reader that had not seen its performer.
    meant : (n,) -1 low pole, 1 high pole, 0 neither.
    families : what was chosen each time, in the order in which performers were left out.
    """

    reading: FloatArray
    meant: FloatArray
    families: tuple[str, ...] = ()

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
    """A trained model and how well it does on performers that were left out.

    Attributes
    ----------
    model : of all takes.
    alone : by axis, where nothing else is known of a performer.
    own : by axis, where a performer's takes are known, but not what was meant by them.
    """

    model: EffortModel
    alone: Mapping[str, AxisReport]
    own: Mapping[str, AxisReport]


def train(
    descriptions: FloatArray,
    meant: Mapping[str, FloatArray],
    performers: Sequence[str],
    *,
    trained_on: str,
    seed: int | None = None,
) -> Training:
    """Train every axis that is labelled.

    Parameters
    ----------
    descriptions
        ``(n, 129)`` as `laban.description.describe` gives.
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
    whose = np.unique(np.asarray(performers), return_inverse=True)[1]
    labelled = {axis: meant[axis] for axis in AXES if axis in meant}
    labelled = {axis: goal for axis, goal in labelled.items() if np.isfinite(goal).any()}
    check_labels(labelled, performers)
    parts: dict[str, AxisModel] = {}
    alone: dict[str, AxisReport] = {}
    own: dict[str, AxisReport] = {}
    for axis, goal in labelled.items():
        known = np.isfinite(goal)
        readers = []
        for reports, against in ((alone, False), (own, True)):
            reports[axis] = _held_out_report(descriptions, goal, whose, against)
            readers.append(_reader(descriptions, goal, whose, against, reports[axis].accuracy))
        parts[axis] = AxisModel(
            alone=readers[0],
            own=readers[1],
            examples=(int(np.sum(goal < 0)), int(np.sum(goal == 0)), int(np.sum(goal > 0))),
            performers=len(np.unique(whose[known])),
        )
    joint = _joint(descriptions, labelled, whose)
    return Training(EffortModel(parts, trained_on, seed, joint), alone, own)


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


def typical_of(descriptions: FloatArray, whose: IntArray) -> FloatArray:
    """Return the mean over people of each one's mean description."""
    return np.mean([descriptions[whose == p].mean(axis=0) for p in np.unique(whose)], axis=0)


def against_own(descriptions: FloatArray, whose: IntArray, typical: FloatArray) -> FloatArray:
    """Return descriptions less what each performer's takes, all of them, are read against."""
    relative = np.empty_like(descriptions)
    for person in np.unique(whose):
        mine = whose == person
        own = OwnMeasure(descriptions[mine].mean(axis=0), int(mine.sum()))
        relative[mine] = descriptions[mine] - own.beside(typical)
    return relative


def _held_out_report(
    descriptions: FloatArray, goal: FloatArray, whose: IntArray, against: bool
) -> AxisReport:
    """Choose, learn and calibrate without some performers, read theirs; all in turn."""
    known = np.isfinite(goal)
    reading = np.full(len(goal), np.nan)
    families = []
    for out in folds(whose):
        inside, asked = ~out & known, out & known
        if not asked.any():
            continue
        seen = descriptions
        if against:
            seen = against_own(descriptions, whose, typical_of(descriptions[~out], whose[~out]))
        name, odds = _chosen(seen[inside], goal[inside], whose[inside])
        fitted = _fitted(CANDIDATES[name], seen[inside], goal[inside], whose[inside])
        calibration = fit_calibration(odds, goal[inside])
        reading[asked] = [calibration.value(o) for o in fitted.log_odds(seen[asked]).tolist()]
        families.append(name)
    return AxisReport(reading[known], goal[known], tuple(families))


def _reader(
    descriptions: FloatArray, goal: FloatArray, whose: IntArray, against: bool, accuracy: float
) -> Reader:
    """Choose, learn and calibrate on all performers."""
    typical = typical_of(descriptions, whose)
    seen = against_own(descriptions, whose, typical) if against else descriptions
    known = np.isfinite(goal)
    name, odds = _chosen(seen[known], goal[known], whose[known])
    fitted = _fitted(CANDIDATES[name], seen[known], goal[known], whose[known])
    calibration = fit_calibration(odds, goal[known])
    return Reader(
        family=name,
        entries=Entries(
            fitted.columns,
            _rounded(fitted.lowest),
            _rounded(fitted.highest),
            _rounded(typical[fitted.columns]) if against else None,
        ),
        classifier=_short_classifier(fitted.classifier),
        calibration=Calibration(_rounded(calibration.log_odds), _rounded(calibration.reading)),
        held_out_accuracy=_short(accuracy),
    )


def _chosen(seen: FloatArray, goal: FloatArray, whose: IntArray) -> tuple[str, FloatArray]:
    """Return the best candidate on performers left out, and its log odds of each take then."""
    at_pole = goal != 0
    best, best_loss, best_odds = "", np.full(int(at_pole.sum()), np.inf), np.zeros(len(goal))
    for name, candidate in CANDIDATES.items():
        odds = np.zeros(len(goal))
        for out in folds(whose):
            poles = goal[~out & at_pole]
            if (poles > 0).all() or (poles < 0).all():
                continue
            odds[out] = _fitted(candidate, seen[~out], goal[~out], whose[~out]).log_odds(seen[out])
        loss = np.logaddexp(0.0, -odds[at_pole] * goal[at_pole])
        better = best_loss - loss
        margin = float(better.std() / np.sqrt(len(better))) if name in EAGER else 0.0
        if not better.mean() <= margin:
            best, best_loss, best_odds = name, loss, odds
    return best, best_odds


def _fitted(candidate: Candidate, seen: FloatArray, goal: FloatArray, whose: IntArray) -> Fitted:
    """Learn from the takes of either pole."""
    at_pole = goal != 0
    return candidate(seen[at_pole], goal[at_pole] > 0, whose[at_pole])


def _joint(
    descriptions: FloatArray, labelled: Mapping[str, FloatArray], whose: IntArray
) -> JointModel | None:
    """Train the states of Time and Weight together, where enough takes have a pole on both."""
    if not {"time", "weight"} <= set(labelled):
        return None
    time, weight = labelled["time"], labelled["weight"]
    state = np.full(len(time), -1, dtype=np.int64)
    for i, (t, w) in enumerate(STATES):
        state[(time == t) & (weight == w)] = i
    both = state >= 0
    people = [len(np.unique(whose[state == i])) for i in range(len(STATES))]
    if min(people) < FEWEST_PERFORMERS:
        return None
    readers = []
    for against in (False, True):
        right = 0
        for out in folds(whose):
            seen = _seen(descriptions, whose, typical_of(descriptions[~out], whose[~out]), against)
            fitted = fit_softmax(seen[both & ~out], state[both & ~out])
            right += int(
                (fitted.chances(seen[both & out]).argmax(axis=1) == state[both & out]).sum()
            )
        typical = typical_of(descriptions, whose)
        seen = _seen(descriptions, whose, typical, against)[both]
        fitted = fit_softmax(seen, state[both])
        readers.append(
            StateReader(
                Entries(
                    _EVERYTHING,
                    _rounded(seen.min(axis=0)),
                    _rounded(seen.max(axis=0)),
                    _rounded(typical[_EVERYTHING]) if against else None,
                ),
                Softmax(_rounded(fitted.weight), _rounded(fitted.bias)),
                _short(right / int(both.sum())),
            )
        )
    return JointModel(*readers)


def _seen(
    descriptions: FloatArray, whose: IntArray, typical: FloatArray, against: bool
) -> FloatArray:
    """Return what states are read from."""
    whole = against_own(descriptions, whose, typical) if against else descriptions
    return whole[:, _EVERYTHING]


def _short_classifier(classifier: NaiveBayes | Linear) -> NaiveBayes | Linear:
    """Return a classifier with numbers of `SIGNIFICANT_DIGITS`."""
    if isinstance(classifier, Linear):
        return Linear(_rounded(classifier.weight), _short(classifier.bias))
    return NaiveBayes(
        _rounded(classifier.mean), _rounded(classifier.variance), _short(classifier.prior_high)
    )


def _short(value: float) -> float:
    """Return a number with `SIGNIFICANT_DIGITS`."""
    return float(f"{value:.{SIGNIFICANT_DIGITS}g}")


def _rounded(values: FloatArray) -> FloatArray:
    """Return an array of numbers with `SIGNIFICANT_DIGITS`."""
    return np.reshape([_short(value) for value in values.ravel()], values.shape)
