"""Verification: how well a gesture fits the examples of an action, term by term."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from laban.frozen import Frozen
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.recognition.exemplar import BAND, Exemplar, faced
from smd.recognition.traits import COURSES, MEASURES, SAMPLES, Traits
from smd.recognition.warping import Templates

TERMS = ("tokens", *COURSES, *MEASURES)
"""The terms of a cost: the distance to the pattern, the courses, the measures."""

WEIGHTS = np.array([1.0, 5.0, 0.5, 2.9, 1.7, 0.6, 0.8, 0.2, 0.3])
"""Weight of each term; ``docs/verification.md`` says where they come from."""
WEIGHTS.flags.writeable = False

WRONG = float(WEIGHTS[0])
"""Cost of the tokens if all are wrong."""

GLANCE = 2
"""Courses of proposals are warped at every second sample, in a quarter of the time. That suffices
to choose stretches; their names are decided with all samples."""

GLIMPSE = 4
"""Most stretches resemble no action. Two courses at every fourth sample suffice to reject them."""

GLIMPSE_COURSES = ("shape_heading", "flow_heading")
"""The two that weigh most."""

GLIMPSE_ROOM = 1.1
"""Factor on the threshold for courses at every fourth sample.
``docs/verification.md`` says how rarely that loses a stretch."""

_COURSES = slice(1, 1 + len(COURSES))
_MEASURES = slice(1 + len(COURSES), len(TERMS))
_SHAPE = COURSES.index("shape_heading")
_BY_WEIGHT = ("shape_heading", "flow_heading", "flow_prop", "shape_prop")
"""The order in which courses are warped: the first of them reject most."""

PAIRS = 1024
"""Pairs of an action and a gesture that are weighed together: intermediate arrays take some 15 MiB
then, for any length of recording."""

_FREEDOM = 4.0
"""Degrees of freedom of Student's t, which measures are assumed to follow: its heavy tails
penalize far outliers hardly more than near ones."""


@dataclass(frozen=True, slots=True, eq=False)
class Verification(Frozen):
    """Compares gestures with the examples of a library's actions.

    Attributes
    ----------
    exemplars : one for each of ``a`` actions; None for an action without examples.
    """

    exemplars: tuple[Exemplar | None, ...]
    centre: FloatArray = field(init=False)
    spread: FloatArray = field(init=False)
    unit: FloatArray = field(init=False)
    central: FloatArray = field(init=False)
    examples: Mapping[int, tuple[Templates, ...]] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exemplars", tuple(self.exemplars))
        some = next((one for one in self.exemplars if one), None)
        # An action without examples borrows some; they are never looked at.
        each = [one or some for one in self.exemplars] if some else []
        stacked = {
            "centre": [one.centre for one in each if one],
            "spread": [one.spread for one in each if one],
            "unit": [WEIGHTS[1 : 1 + len(COURSES)] / one.scale for one in each if one],
            "central": [one.central for one in each if one],
        }
        for name, value in stacked.items():
            array = np.array(value, dtype=np.float64)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        courses = [[one.courses[name] for one in each if one] for name in COURSES]
        factors = tuple(one.factor for one in each if one)
        examples = {
            every: tuple(
                Templates(tuple(c[:, ::every] for c in each), BAND, factors)
                for each in courses
                if each
            )
            for every in (1, GLANCE, GLIMPSE)
        }
        object.__setattr__(self, "examples", MappingProxyType(examples))

    def terms(
        self,
        gestures: Traits,
        action: IntArray,
        gesture: IntArray,
        *,
        wrong: FloatArray,
        most: FloatArray,
        every: int = 1,
    ) -> FloatArray:
        """Return the terms of the costs of p pairs of an action and a gesture.

        A course's term is its distance to the nearest example, as a multiple of the usual one; a
        measure's is the negative logarithm of Student's density about the examples' mean, 0 at
        its peak; the tokens' is the share that is wrong. Each is multiplied by its weight, and
        none is negative. So a pair is dropped as soon as its known terms, plus a lower bound of
        the rest (`warping.Templates.at_least`), exceed ``most``; terms that were not computed are
        `inf`.

        Parameters
        ----------
        gestures
            Traits of g gestures.
        action, gesture
            ``(p,)``, the numbers of an action that has examples, and of a gesture.
        wrong
            ``(p,)``, the edits from the action's pattern as a share of the tokens.
        most
            ``(p,)``, thresholds; pairs with a larger sum are dropped.
        every
            Courses are warped by every so many-th sample: 1 or `GLANCE`.

        Returns
        -------
        ndarray
            ``(p, 9)``, in the order of `TERMS`.
        """
        terms = np.empty((len(action), len(TERMS)))
        terms[:, 0] = WEIGHTS[0] * wrong
        deviation = (gestures.measures[gesture] - self.centre[action]) / self.spread[action]
        terms[:, _MEASURES] = WEIGHTS[_MEASURES] * oddness(deviation)
        room = most - terms[:, 0] - terms[:, _MEASURES].sum(axis=1)
        terms[:, _COURSES] = self._warped(gestures, action, gesture, room, every, COURSES)
        return terms

    def promising(
        self, gestures: Traits, action: IntArray, gesture: IntArray, most: FloatArray
    ) -> BoolArray:
        """Return ``(p,)``, which pairs of an action and a gesture are to be weighed in full.

        Their cost at a glimpse is at most `GLIMPSE_ROOM` times ``most``: that of the measures, and
        of `GLIMPSE_COURSES` at every fourth sample. The gestures have only these samples;
        parameters are those of `terms`.
        """
        room = GLIMPSE_ROOM * most - self.measured(gestures.measures)[gesture, action]
        terms = self._warped(gestures, action, gesture, room, GLIMPSE, GLIMPSE_COURSES)
        return np.asarray(np.isfinite(terms).all(axis=1))

    def _warped(
        self,
        gestures: Traits,
        action: IntArray,
        gesture: IntArray,
        room: FloatArray,
        every: int,
        courses: Sequence[str],
    ) -> FloatArray:
        """Return ``(p, 4)``, the terms of some courses, infinite where they exceed ``room (p,)``.

        Those of the other courses are 0. The heaviest course is warped first, and with each the
        pairs are dropped that it and the bounds of the rest put above the room.
        """
        terms = np.full((len(action), len(COURSES)), np.inf)
        by_action = np.argsort(action, kind="stable")
        by_action = by_action[room[by_action] >= 0.0]
        numbers = [COURSES.index(name) for name in _BY_WEIGHT if name in courses]
        for begin in range(0, len(by_action), PAIRS):
            some = by_action[begin : begin + PAIRS]
            terms[some] = self._some_warped(
                gestures, action[some], gesture[some], room[some], every, numbers
            )
        return terms

    def _some_warped(
        self,
        gestures: Traits,
        action: IntArray,
        gesture: IntArray,
        room: FloatArray,
        every: int,
        courses: Sequence[int],
    ) -> FloatArray:
        """Return `_warped` of pairs that are ordered by action.

        The shape in the heading frame is the first of the courses, which are warped in turn.
        """
        given = SAMPLES // gestures.courses[_SHAPE].shape[1]  # every so many-th sample is known
        step = every // given
        terms = np.zeros((len(action), len(COURSES)))  # at least so much, until they are warped
        left = np.arange(len(action))
        for i in reversed(courses):  # the shape last: it has to be turned to fit
            course = gestures.courses[i][gesture[left]]
            if i == _SHAPE:
                course = faced(course, self.central[action[left], ::given])
            course = course[:, ::step]
            least = self.examples[every][i].at_least(course, action[left])
            terms[left, i] = self.unit[action[left], i] * least
            within = terms[left].sum(axis=1) <= room[left]
            left = left[within]
        shapes = course[within]
        for i in courses:
            course = shapes if i == _SHAPE else gestures.courses[i][gesture[left], ::step]
            unit = self.unit[action[left], i]
            terms[left, i] = 0.0
            most = (room[left] - terms[left].sum(axis=1)) / unit
            terms[left, i] = unit * self.examples[every][i].nearest(course, action[left], most)
            left = left[terms[left].sum(axis=1) <= room[left]]
        left_out = np.ones(len(terms), bool)
        left_out[left] = False
        terms[left_out] = np.inf
        return terms

    def measured(self, measures: FloatArray) -> FloatArray:
        """Return ``(g, a)``, the cost of the measures ``(g, 4)`` alone of g gestures, by action."""
        deviation = (measures[:, None] - self.centre) / self.spread
        return np.asarray(oddness(deviation) @ WEIGHTS[_MEASURES])


def oddness(deviation: FloatArray) -> FloatArray:
    """Return the negative logarithm of Student's density, 0 at its peak."""
    return 0.5 * (_FREEDOM + 1.0) * np.log1p(np.square(deviation) / _FREEDOM)
