"""Training: from labelled descriptions to an `EffortModel`.

There are two readers: for unknown performers, and for performers whose own measure is known. For
each, a committee per axis (`laban.committee`) and a classifier of the joint states of Time and
Weight are trained. The reported accuracy is cross-validated: all of that is repeated for each
performer without any take of theirs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from laban.committee import COUNT, ENTRY_NAMES, FACTORS, PAIRS, Committee, convened, folds
from laban.description import DESCRIPTION_NAMES, FAMILIES
from laban.effort import AXES, POLES, LabanError
from laban.linear import Linear, Softmax, fit_softmax, one_blas_thread
from laban.model import STATE_AXES, STATES, EffortModel, Taught
from laban.motion import FloatArray
from laban.own import OwnMeasure
from laban.reader import AxisReader, Entries, Reader, StateReader, known_at, reading_of
from laban.size import DIAGONAL, Sizes, resized, sizes_of

IntArray = NDArray[np.int64]

FEWEST_PERFORMERS = 3
"""Performers of each pole: with one left out to test and one to choose, one is left to train on."""

SIGNIFICANT_DIGITS = 6
"""Digits of a model's numbers: far finer than any measurement, short enough to read."""

MOST_SPREADS = 3.0
"""Values are clipped at so many standard deviations from the mean, since products would grow on."""

REACHED = 0.95
"""Share of held-out takes that is within a reader's reach."""

STATES_RIDGE = 10.0
"""Ridge penalty of the joint states' own weights."""

_COLUMNS = np.array([DESCRIPTION_NAMES.index(name) for name in ENTRY_NAMES], dtype=np.int64)

_OF_STATES = np.concatenate(
    [
        np.array([ENTRY_NAMES.index(name) for name in FAMILIES["everything"]], dtype=np.int64),
        np.arange(len(ENTRY_NAMES), COUNT),
    ]
)
"""Input of the classifier of joint states."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisReport:
    """Cross-validated readings of one axis, on performers left out of training.

    Attributes
    ----------
    reading : (n,) of each labelled take, by a reader trained without its performer.
    meant : (n,) labels: -1 low pole, 1 high pole, 0 neither.
    """

    reading: FloatArray
    meant: FloatArray

    @property
    def accuracy(self) -> float:
        """Share of the takes labelled with a pole whose reading has the pole's sign."""
        at_pole = self.meant != 0
        return float(np.mean((self.reading[at_pole] > 0) == (self.meant[at_pole] > 0)))

    @property
    def brier_score(self) -> float:
        """Mean squared error of the probability of a take's pole: 0 best, 0.25 at even odds."""
        at_pole = self.meant != 0
        return float(np.mean((0.5 * (self.reading[at_pole] - self.meant[at_pole])) ** 2))


@dataclass(frozen=True, slots=True)
class Training:
    """A trained model and its cross-validated accuracy on held-out performers.

    Attributes
    ----------
    model : trained on all takes.
    alone : by axis, for unknown performers.
    own : by axis, for performers with known, unlabelled takes.
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
    """Train every axis that is labelled, with one thread of BLAS.

    Parameters
    ----------
    descriptions
        ``(n, 132)`` as `laban.description.describe` gives.
    meant
        By axis, ``(n,)``: -1 low pole, 1 high pole, 0 neither, NaN not labelled. Takes of
        neither pole are used for calibration only. An axis without a label is left out.
    performers
        ``n`` names; takes of one performer are never in both training and test.
    trained_on
        What the takes are, in words, kept in the model.
    seed
        Of the takes, if they were simulated, kept in the model.

    Raises
    ------
    LabanError
        If nothing is labelled, or a labelled axis has too few performers of a pole.
    """
    whose = np.unique(np.asarray(performers), return_inverse=True)[1]
    labelled = {axis: meant[axis] for axis in AXES if axis in meant}
    labelled = {axis: goal for axis, goal in labelled.items() if np.isfinite(goal).any()}
    check_labels(labelled, performers)
    taught = {
        axis: Taught(
            examples=(int(np.sum(goal < 0)), int(np.sum(goal == 0)), int(np.sum(goal > 0))),
            performers=len(np.unique(whose[np.isfinite(goal)])),
        )
        for axis, goal in labelled.items()
    }
    state = _states(labelled, whose)
    with one_blas_thread():
        (alone, reports), (own, own_reports) = (
            _trained(descriptions, labelled, state, whose, against) for against in (False, True)
        )
    return Training(EffortModel(taught, alone, own, trained_on, seed), reports, own_reports)


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


def _trained(
    descriptions: FloatArray,
    labelled: Mapping[str, FloatArray],
    state: IntArray | None,
    whose: IntArray,
    against: bool,
) -> tuple[Reader, dict[str, AxisReport]]:
    """Return the reader trained on all takes, and its cross-validated readings by axis."""
    odds = {axis: np.full(len(whose), np.nan) for axis in labelled}
    scores = np.zeros((len(whose), len(STATES)))
    distance = np.zeros(len(whose))
    for out in folds(whose):
        entries, learned, states = _learned(descriptions, labelled, state, whose, against, ~out)
        values = values_in(entries, descriptions[out], whose[out])
        distance[out] = entries.distance(values)
        seen = entries.seen(values)
        for axis, committee in learned.items():
            odds[axis][out] = committee.classifier.log_odds(seen)
        if states is not None:
            scores[out] = states.scores(seen)
    reach = _short(float(np.quantile(distance, REACHED)))
    within = known_at(distance, reach)
    reports = {}
    for axis, goal in labelled.items():
        known = np.isfinite(goal)
        reading = np.array([reading_of(o) for o in odds[axis][known].tolist()])
        reports[axis] = AxisReport(within[known] * reading, goal[known])

    entries, learned, states = _learned(
        descriptions, labelled, state, whose, against, np.ones(len(whose), bool)
    )
    axes = {
        axis: AxisReader(
            committee.classifier, _rounded_shares(committee.shares), _short(reports[axis].accuracy)
        )
        for axis, committee in learned.items()
    }
    reader = None
    if state is not None and states is not None:
        told = state >= 0
        sure = _sureness(scores[told], state[told])
        right = float(np.mean(scores[told].argmax(axis=1) == state[told]))
        reader = StateReader(Softmax(sure * states.weight, sure * states.bias), _short(right))
    return _short_reader(Reader(entries, axes, reach, reader)), reports


def _learned(
    descriptions: FloatArray,
    labelled: Mapping[str, FloatArray],
    state: IntArray | None,
    whose: IntArray,
    against: bool,
    among: NDArray[np.bool_],
) -> tuple[Entries, dict[str, Committee], Softmax | None]:
    """Train on some takes: the entries that are used, each axis, and the joint states."""
    descriptions, whose = descriptions[among], whose[among]
    entries = entries_of(descriptions, whose, against)
    seen = seen_in(entries, descriptions, whose)
    axes = {}
    for axis, labels in labelled.items():
        goal = labels[among]
        known = np.isfinite(goal)
        axes[axis] = convened(seen[known], goal[known], whose[known])
    if state is None:
        return entries, axes, None
    state = state[among]
    told = state >= 0
    if len(np.unique(state[told])) < len(STATES):
        return entries, axes, None
    own = fit_softmax(seen[told][:, _OF_STATES], state[told], STATES_RIDGE)
    return entries, axes, _one_decision(own, *(axes[axis].classifier for axis in STATE_AXES))


def entries_of(descriptions: FloatArray, whose: IntArray, against: bool) -> Entries:
    """Return the entries to use of descriptions ``(n, 132)``, standardized on these takes.

    ``against``: relative to the performer's own takes or not; ``whose (n,)`` are the performers.
    """
    sizes = sizes_of(descriptions, _COLUMNS)
    m = len(_COLUMNS)
    entries = Entries(
        columns=_COLUMNS,
        lowest=np.full(m, -np.inf),
        highest=np.full(m, np.inf),
        centre=np.zeros(m),
        scale=np.ones(m),
        pairs=PAIRS,
        unlike=np.eye(m),
        sizes=sizes,
        typical=np.zeros(m) if against else None,
    )
    if against:
        entries = replace(entries, typical=_typical_of(sizes, descriptions, whose))
    seen = values_in(entries, descriptions, whose)
    centre, scale = seen.mean(axis=0), seen.std(axis=0) + 1e-9
    standard = (seen - centre) / scale
    covariance = (1.0 - DIAGONAL) * (standard.T @ standard) / len(seen) + DIAGONAL * np.eye(m)
    return replace(
        entries,
        lowest=np.maximum(seen.min(axis=0), centre - MOST_SPREADS * scale),
        highest=np.minimum(seen.max(axis=0), centre + MOST_SPREADS * scale),
        centre=centre,
        scale=scale,
        unlike=np.linalg.cholesky(np.linalg.inv(covariance)),
    )


def _typical_of(sizes: Sizes, descriptions: FloatArray, whose: IntArray) -> FloatArray:
    """Return the mean over people of each one's mean description, at the usual size."""
    means = np.array([descriptions[whose == person].mean(axis=0) for person in np.unique(whose)])
    return np.asarray(resized(means, -sizes.of(means))[:, sizes.columns].mean(axis=0))


def values_in(entries: Entries, descriptions: FloatArray, whose: IntArray) -> FloatArray:
    """Return the entries ``(n, m)`` of descriptions ``(n, 132)``.

    They are relative to the mean of the performer's takes (``whose (n,)``) if the entries are so.
    """
    if entries.typical is None:
        return entries.values(descriptions)
    values = np.empty((len(descriptions), len(entries.columns)))
    for person in np.unique(whose):
        mine = whose == person
        own = OwnMeasure(descriptions[mine].mean(axis=0), int(mine.sum()))
        values[mine] = entries.values(descriptions[mine], own)
    return values


def seen_in(entries: Entries, descriptions: FloatArray, whose: IntArray) -> FloatArray:
    """Return entries and products ``(n, COUNT)`` of descriptions ``(n, 132)``, as `values_in`."""
    return entries.seen(values_in(entries, descriptions, whose))


def _states(labelled: Mapping[str, FloatArray], whose: IntArray) -> IntArray | None:
    """Return each take's joint state, -1 for none; None if too few people have all of them."""
    if not set(STATE_AXES) <= set(labelled):
        return None
    state = np.full(len(whose), -1, dtype=np.int64)
    both = np.stack([labelled[axis] for axis in STATE_AXES], axis=1)
    for i, poles in enumerate(STATES):
        state[(both == poles).all(axis=1)] = i
    people = [len(np.unique(whose[state == i])) for i in range(len(STATES))]
    return None if min(people) < FEWEST_PERFORMERS else state


def _one_decision(states: Softmax, first: Linear, second: Linear) -> Softmax:
    """Return the average of the states' own classifier and of both axes' log odds.

    From the axes, the log probability of a state is, up to a common term, half of each axis's log
    odds, with the state's signs. Both have the same weight.
    """
    signs = 0.5 * np.array(STATES)
    own = np.zeros((len(STATES), COUNT))
    own[:, _OF_STATES] = states.weight
    return Softmax(
        own + signs @ np.stack([first.weight, second.weight]),
        states.bias + signs @ np.array([first.bias, second.bias]),
    )


def _sureness(scores: FloatArray, state: IntArray) -> float:
    """Return the factor that calibrates held-out scores ``(n, k)``, as `temperature` does."""
    scaled = FACTORS[:, None, None] * (scores - scores.max(axis=1, keepdims=True))
    chance = scaled[:, np.arange(len(state)), state] - np.log(np.exp(scaled).sum(axis=-1))
    return float(FACTORS[int(np.argmax(chance.sum(axis=-1)))])


def _rounded_shares(shares: Mapping[str, float]) -> dict[str, float]:
    return {name: round(share, 3) for name, share in shares.items()}


def _short_reader(reader: Reader) -> Reader:
    """Return a reader without products of weight 0, its numbers with `SIGNIFICANT_DIGITS`."""
    weights = [part.classifier.weight[None] for part in reader.axes.values()]
    if reader.states is not None:
        weights.append(reader.states.classifier.weight)
    used = np.abs(np.concatenate(weights)).max(axis=0) > 0.0
    m = len(reader.entries.columns)
    pairs = reader.entries.pairs[used[m:]]
    both = np.concatenate([np.arange(m), m + np.flatnonzero(used[m:])])
    entries, states = reader.entries, reader.states
    sizes = entries.sizes
    return Reader(
        replace(
            entries,
            lowest=_rounded(entries.lowest),
            highest=_rounded(entries.highest),
            centre=_rounded(entries.centre),
            scale=_rounded(entries.scale),
            pairs=pairs,
            unlike=_rounded(entries.unlike),
            sizes=Sizes(
                sizes.columns,
                _rounded(sizes.centre),
                _rounded(sizes.weight),
                _short(sizes.spread),
            ),
            typical=None if entries.typical is None else _rounded(entries.typical),
        ),
        {
            axis: replace(
                part,
                classifier=Linear(
                    _rounded(part.classifier.weight[both]), _short(part.classifier.bias)
                ),
            )
            for axis, part in reader.axes.items()
        },
        reader.reach,
        states
        and replace(
            states,
            classifier=Softmax(
                _rounded(states.classifier.weight[:, both]), _rounded(states.classifier.bias)
            ),
        ),
    )


def _short(value: float) -> float:
    """Return a number with `SIGNIFICANT_DIGITS`."""
    return float(f"{value:.{SIGNIFICANT_DIGITS}g}")


def _rounded(values: FloatArray) -> FloatArray:
    """Return an array of numbers with `SIGNIFICANT_DIGITS`."""
    return np.reshape([_short(value) for value in values.ravel()], values.shape)
