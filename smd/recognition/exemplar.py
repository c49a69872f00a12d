"""Exemplar: what verification remembers of an action's examples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.recognition.alignment import distance_table
from smd.recognition.traits import COURSES, FLOORS, MEASURES, SAMPLES, Traits, fitted

BAND = 0.25
"""How far warping may shift, as a share of the gesture."""

FACING_RAD, ASKEW_RAD = np.radians(30.0), np.radians(20.0)
"""How far a hand may face beside where the user means to, and hold the prop askew."""

USUAL_DISTANCE = (0.4, 0.4, 0.9, 0.9)
"""Of each course, from an example to the nearest other one of the same person and action: the
median over the people that the weights were fitted to."""

USUAL_SPREAD = (0.25, 0.25, 0.3, 0.4)
"""Standard deviation of each measure between examples of one person and action; the same people."""

PRIOR_DISTANCES, PRIOR_SPREADS = 30.0, 4.0
"""How many examples the usual distances and spreads count for. Three examples say little about
how much the next one may differ."""

MOST_OWN_DISTANCES = 6
"""How many examples an action's own distances count for at most: where there are many, the
nearest one is near because they are many."""


@dataclass(frozen=True, slots=True, eq=False)
class Exemplar:
    """What verification remembers of an action's examples.

    Attributes
    ----------
    courses : by name, each ``(n, SAMPLES, d)``, of n examples.
    measures : (n, 4), logarithms of how long, how large, how far and how much turned each is.
    apart : (n, 4), from each example's courses to the nearest other example's; empty ``(0, 4)``
        where n is 1.
    background : what movement that means nothing costs, seen as the action, as a logarithm
        (`smd.recognition.background`); None where it was not weighed yet.
    """

    courses: Mapping[str, FloatArray]
    measures: FloatArray
    apart: FloatArray
    background: float | None = None
    scale: FloatArray = field(init=False)
    centre: FloatArray = field(init=False)
    spread: FloatArray = field(init=False)
    central: FloatArray = field(init=False)

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
        own = min(len(apart), MOST_OWN_DISTANCES)
        logs = PRIOR_DISTANCES * np.log(USUAL_DISTANCE)
        if own:
            logs = logs + own * np.log(apart + 1e-3).mean(axis=0)
        centre = measures.mean(axis=0)
        squares = PRIOR_SPREADS * np.square(USUAL_SPREAD) + np.square(measures - centre).sum(axis=0)
        # The next example differs from the mean of n by its own spread and by the mean's.
        spread = np.sqrt(squares / (PRIOR_SPREADS + n - 1.0) * (1.0 + 1.0 / n))
        scale = np.exp(logs / (PRIOR_DISTANCES + own))
        for name, value in (("scale", scale), ("centre", centre), ("spread", spread)):
            object.__setattr__(self, name, frozen_array(name, value, (4,), DoodleError))
        object.__setattr__(self, "central", _central(courses["shape_heading"]))
        object.__setattr__(self, "courses", MappingProxyType(courses))
        object.__setattr__(self, "measures", measures)
        object.__setattr__(self, "apart", apart)

    def __len__(self) -> int:
        return len(self.measures)

    @property
    def duration_s(self) -> float:
        """How long the action usually takes."""
        return float(np.exp(self.centre[MEASURES.index("duration")]) - FLOORS[0])

    def to_arrays(self) -> dict[str, FloatArray]:
        """Return plain arrays by name, from which `from_arrays` makes the same again."""
        arrays = {**self.courses, "measures": self.measures, "apart": self.apart}
        known = {} if self.background is None else {"background": np.array(self.background)}
        return {**arrays, **known}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, FloatArray]) -> Exemplar:
        """Return the exemplar that `to_arrays` took apart.

        Raises
        ------
        DoodleError
            If an array is missing or has another shape.
        """
        missing = [name for name in (*COURSES, "measures", "apart") if name not in arrays]
        if missing:
            raise DoodleError(f"exemplar: expected {', '.join(missing)}, found none")
        return cls(
            courses={name: arrays[name] for name in COURSES},
            measures=arrays["measures"],
            apart=arrays["apart"],
            background=float(arrays["background"]) if "background" in arrays else None,
        )


def exemplar_of(examples: Sequence[Traits]) -> Exemplar:
    """Return what verification remembers of an action's examples, at least one."""
    courses = {
        name: np.stack([example.courses[i] for example in examples])
        for i, name in enumerate(COURSES)
    }
    n = len(examples)
    apart = np.zeros((n if n > 1 else 0, len(COURSES)))
    for i in range(len(apart)):
        others = [j for j in range(n) if j != i]
        for k, (name, course) in enumerate(courses.items()):
            own, rest = course[i : i + 1], course[others]
            if name == "shape_heading":
                own = faced(own, _central(rest))
            apart[i, k] = nearest_distances(own, rest)[0]
    measures = np.stack([example.measures for example in examples])
    return Exemplar(courses, measures, apart)


def faced(shapes: FloatArray, central: FloatArray) -> FloatArray:
    """Return courses ``(p, SAMPLES, 12)`` of shapes in the heading frame, turned to fit another.

    ``central`` holds the one that each is turned to, ``(p, SAMPLES, 12)`` or ``(SAMPLES, 12)``.
    """
    return fitted(shapes, central, facing_rad=FACING_RAD, askew_rad=ASKEW_RAD)


def nearest_distances(gestures: FloatArray, examples: FloatArray) -> FloatArray:
    """Return ``(p,)``: how far each of p gestures is from the nearest of m examples, warped.

    Both are one course of each, ``(p, SAMPLES, d)`` and ``(m, SAMPLES, d)``.
    """
    return np.asarray(distance_table(gestures, examples, band=BAND).min(axis=1))


def _central(shapes: FloatArray) -> FloatArray:
    """Return the one of several shapes ``(n, SAMPLES, d)`` that is nearest to their mean."""
    far = np.square(shapes - shapes.mean(axis=0)).sum(axis=(1, 2))
    return np.asarray(shapes[int(far.argmin())])
