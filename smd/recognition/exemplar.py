"""Exemplar: what verification keeps of an action's examples to compare gestures with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from laban.frozen import Frozen
from smd.errors import DoodleError
from smd.geometry.arrays import BoolArray, FloatArray, frozen_array
from smd.recognition.alignment import distance_table
from smd.recognition.traits import COURSES, FLOORS, MEASURES, SAMPLES, Traits, fitted

BAND = 0.25
"""Band of the time warping, as a share of the gesture."""

FACING_RAD, ASKEW_RAD = np.radians(30.0), np.radians(20.0)
"""Largest errors of facing, and of holding the prop askew, that are removed."""

USUAL_DISTANCE = (0.4, 0.4, 0.9, 0.9)
"""Of each course, from an example to the nearest other one of the same person and action: the
median over the people that the weights were fitted to."""

USUAL_SPREAD = (0.25, 0.25, 0.3, 0.4)
"""Standard deviation of each measure between examples of one person and action; the same people."""

PRIOR_DISTANCES, PRIOR_SPREADS = 30.0, 4.0
"""Number of examples that the priors of distance and spread count for: three examples carry little
information on how much the next one may differ."""

MOST_OWN_DISTANCES = 6
"""Largest number of examples that an action's own distances count for: with many examples, the
nearest one is near because they are many."""

STRANGERS = 1.0
"""Number of own examples that all examples of others together count for, if there are own ones, in
the statistics (size, speed and extent of an action, and their spread): one take of the performer
carries as much information as all other people's."""

FARTHER = 1.1
"""Factor on the distance to an example of somebody else, if there are own ones."""

Ownership: TypeAlias = bool | Sequence[int]
"""Which of an action's examples are the performer's own: all, none, or those of some numbers."""


@dataclass(frozen=True, slots=True, eq=False)
class Exemplar(Frozen):
    """What verification keeps of an action's examples to compare gestures with.

    If some examples are the performer's own and some are others', an own one counts for more
    (`STRANGERS`, `FARTHER`). If all are of one kind, all count the same.

    Attributes
    ----------
    courses : by name, each ``(n, SAMPLES, d)``, of n examples.
    measures : (n, 4), logarithms of duration, extent, path and turning of each.
    apart : (n, 4), distance of each example's courses from the nearest other example's; empty
        ``(0, 4)`` if n is 1.
    own : (n,), which examples are of the person whose gestures are to be recognised.
    scale : (4,), usual distance of a gesture's courses from the nearest example's.
    centre, spread : (4,), mean and standard deviation of the measures, with priors.
    central : (SAMPLES, 12), the course in the heading frame that others are turned to.
    factor : (n,), factor on the distance to each example, at least 1.
    background : log cost of meaningless movement that is weighed as the action
        (`smd.recognition.background`); None if it was not weighed yet.
    """

    courses: Mapping[str, FloatArray]
    measures: FloatArray
    apart: FloatArray
    own: BoolArray
    background: float | None = None
    scale: FloatArray = field(init=False)
    centre: FloatArray = field(init=False)
    spread: FloatArray = field(init=False)
    central: FloatArray = field(init=False)
    factor: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        n = len(self.measures)
        if tuple(self.courses) != COURSES:
            raise DoodleError(
                f"courses: expected {', '.join(COURSES)}, got {', '.join(self.courses)}"
            )
        courses = {
            name: frozen_array(name, course, (n, SAMPLES, None), DoodleError)
            for name, course in self.courses.items()
        }
        measures = frozen_array("measures", self.measures, (n, len(MEASURES)), DoodleError)
        apart = frozen_array("apart", self.apart, (None, len(COURSES)), DoodleError)
        if n == 0 or len(apart) not in ((0,) if n == 1 else (n,)):
            raise DoodleError(f"apart: expected {n if n > 1 else 0} rows, got {len(apart)}")
        if self.background is not None and not np.isfinite(self.background):
            raise DoodleError(f"background: expected a finite number, got {self.background}")
        own = frozen_array("own", self.own, (n,), DoodleError, np.bool_)
        mixed = own.any() and not own.all()
        weight = np.where(own, 1.0, STRANGERS / max(n - own.sum(), 1)) if mixed else np.ones(n)
        count = weight.sum()
        logs = PRIOR_DISTANCES * np.log(USUAL_DISTANCE)
        counted = min(count, MOST_OWN_DISTANCES) if len(apart) else 0.0
        if counted:
            logs = logs + counted * (weight @ np.log(apart + 1e-3)) / count
        scale = np.exp(logs / (PRIOR_DISTANCES + counted))
        centre = weight @ measures / count
        squares = PRIOR_SPREADS * np.square(USUAL_SPREAD) + weight @ np.square(measures - centre)
        # The next example differs from the mean of so many by its own spread and by the mean's.
        spread = np.sqrt(squares / (PRIOR_SPREADS + count - 1.0) * (1.0 + 1.0 / count))
        factor = np.where(own, 1.0, FARTHER) if mixed else np.ones(n)
        for name, value in (("scale", scale), ("centre", centre), ("spread", spread)):
            object.__setattr__(self, name, frozen_array(name, value, (4,), DoodleError))
        object.__setattr__(self, "central", _central(courses["shape_heading"]))
        object.__setattr__(self, "courses", MappingProxyType(courses))
        object.__setattr__(self, "measures", measures)
        object.__setattr__(self, "apart", apart)
        object.__setattr__(self, "own", own)
        object.__setattr__(self, "factor", frozen_array("factor", factor, (n,), DoodleError))

    def __len__(self) -> int:
        return len(self.measures)

    @property
    def duration_s(self) -> float:
        """The usual duration of the action."""
        return float(np.exp(self.centre[MEASURES.index("duration")]) - FLOORS[0])

    def to_arrays(self) -> dict[str, FloatArray]:
        """Return plain arrays by name; with `ownership`, `from_arrays` makes the same again."""
        arrays = {**self.courses, "measures": self.measures, "apart": self.apart}
        known = {} if self.background is None else {"background": np.array(self.background)}
        return {**arrays, **known}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, FloatArray], own: Ownership = False) -> Exemplar:
        """Return the exemplar that `to_arrays` took apart.

        Parameters
        ----------
        arrays
            By name.
        own
            Which examples are the performer's own: all, none, or those of some numbers.

        Raises
        ------
        DoodleError
            If an array is missing or has another shape, or there is no example of some number.
        """
        missing = [name for name in (*COURSES, "measures", "apart") if name not in arrays]
        if missing:
            raise DoodleError(f"exemplar: expected {', '.join(missing)}, found none")
        return cls(
            courses={name: arrays[name] for name in COURSES},
            measures=arrays["measures"],
            apart=arrays["apart"],
            own=_owned(own, len(arrays["measures"])),
            background=_number("background", arrays.get("background")),
        )

    @property
    def ownership(self) -> Ownership:
        """Which examples are the performer's own, in few words; `from_arrays` understands them."""
        if self.own.all() or not self.own.any():
            return bool(self.own[0])
        return tuple(np.flatnonzero(self.own).tolist())

    def examples(self) -> list[Traits]:
        """Return the examples, one by one."""
        return [
            Traits(tuple(self.courses[name][i] for name in COURSES), self.measures[i])
            for i in range(len(self))
        ]


def exemplar_of(examples: Sequence[Traits], *, own: Ownership = False) -> Exemplar:
    """Return the exemplar of an action's examples, at least one.

    Parameters
    ----------
    examples
        The traits of each.
    own
        Which are the performer's own: all, none, or those of some numbers.

    Raises
    ------
    DoodleError
        If there is no example of some number.
    """
    courses = {
        name: np.stack([example.courses[i] for example in examples])
        for i, name in enumerate(COURSES)
    }
    n = len(examples)
    apart = np.zeros((n if n > 1 else 0, len(COURSES)))
    for i in range(len(apart)):
        others = [j for j in range(n) if j != i]
        for k, (name, course) in enumerate(courses.items()):
            one, rest = course[i : i + 1], course[others]
            if name == "shape_heading":
                one = faced(one, _central(rest))
            apart[i, k] = nearest_distances(one, rest)[0]
    measures = np.stack([example.measures for example in examples])
    return Exemplar(courses, measures, apart, _owned(own, n))


def _number(name: str, array: FloatArray | None) -> float | None:
    """Return the number that an array holds, or None where there is none."""
    if array is not None and array.shape != ():
        raise DoodleError(f"{name}: expected one number, got shape {array.shape}")
    return None if array is None else float(array)


def faced(shapes: FloatArray, central: FloatArray) -> FloatArray:
    """Return courses ``(p, SAMPLES, 12)`` of shapes in the heading frame, turned to fit another.

    ``central`` holds the one that each is turned to, ``(p, SAMPLES, 12)`` or ``(SAMPLES, 12)``.
    """
    return fitted(shapes, central, facing_rad=FACING_RAD, askew_rad=ASKEW_RAD)


def nearest_distances(gestures: FloatArray, examples: FloatArray) -> FloatArray:
    """Return ``(p,)``: the warped distance of each of p gestures to the nearest of m examples.

    Both are one course of each, ``(p, SAMPLES, d)`` and ``(m, SAMPLES, d)``.
    """
    return np.asarray(distance_table(gestures, examples, band=BAND).min(axis=1))


def _central(shapes: FloatArray) -> FloatArray:
    """Return the one of several shapes ``(n, SAMPLES, d)`` that is nearest to their mean."""
    far = np.square(shapes - shapes.mean(axis=0)).sum(axis=(1, 2))
    return np.asarray(shapes[int(far.argmin())])


def _owned(own: Ownership, n: int) -> BoolArray:
    """Return ``(n,)``, whether each of n examples is the performer's own."""
    if isinstance(own, bool):
        return np.full(n, own)
    if any(not 0 <= number < n for number in own):
        raise DoodleError(f"own: expected numbers of examples, 0 to {n - 1}, got {list(own)}")
    return np.isin(np.arange(n), own)
