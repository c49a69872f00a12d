"""Verification: how well a gesture fits the examples of an action, term by term."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.exemplar import BAND, Exemplar, faced
from smd.recognition.traits import COURSES, MEASURES, SAMPLES, Traits
from smd.recognition.warping import Examples

TERMS = ("tokens", *COURSES, *MEASURES)
"""What a gesture is weighed by: its distance to the pattern, its courses, its measures."""

WEIGHTS = np.array([1.0, 5.0, 0.5, 2.9, 1.7, 0.6, 0.8, 0.2, 0.3])
"""What each term counts; ``docs/verification.md`` says where they come from."""
WEIGHTS.flags.writeable = False

WRONG = float(WEIGHTS[0])
"""What a gesture costs of whose tokens all are wrong, whatever the examples say."""

USUAL_COST = 8.0
"""Of an example, weighed against the others of its action: in the middle between what simulated
people (4) and people who wave their hands before a camera (10) do."""

PRIOR_COSTS = 3.0
"""How many examples the usual cost counts for, in a library's threshold and in an action's."""

SLACK, SLACK_SHARE = 4.5, 1.6
"""A gesture is rejected where it costs more than so many times an example's cost and a slack. The
slack is for three examples or fewer; it shrinks with the root of their number, as what they leave
open does."""

GLANCE = 2
"""Courses of proposals are warped by every second sample, in a quarter of the time. That is good
enough to choose stretches; what they are called is decided by all samples."""

_MEASURES = slice(1 + len(COURSES), len(TERMS))
_SHAPE = COURSES.index("shape_heading")
_CHEAP_FIRST = (
    *(COURSES.index(name) for name in ("flow_heading", "flow_prop", "shape_prop")),
    _SHAPE,  # is turned to fit first
)
_TELLING_FIRST = (_SHAPE, *_CHEAP_FIRST[:-1])

PAIRS = 2048
"""Of an action and a gesture, that are weighed together: what lies in between takes some 30 MiB
then, however long the recording."""

_FREEDOM = 4.0
"""Of Student's distribution, which measures are taken to follow: what is far out is hardly more
unlikely than what is out."""


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """What gestures must be like to be a library's actions.

    Attributes
    ----------
    exemplars : of each of a actions; None where there are no examples.
    limit : (a,), the cost above which a gesture is rejected; infinite where there are none.
    """

    exemplars: tuple[Exemplar | None, ...]
    limit: FloatArray
    centre: FloatArray = field(init=False)
    spread: FloatArray = field(init=False)
    unit: FloatArray = field(init=False)
    central: FloatArray = field(init=False)
    examples: Mapping[int, tuple[Examples, ...]] = field(init=False)

    def __post_init__(self) -> None:
        some = next((one for one in self.exemplars if one), None)
        # An action without examples borrows some; they are never looked at.
        each = [one or some for one in self.exemplars] if some else []
        stacked = {
            "limit": self.limit,
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
        examples = {
            every: tuple(
                Examples(tuple(c[:, ::every] for c in each), BAND) for each in courses if each
            )
            for every in (1, GLANCE)
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
        """Return how unlike actions' examples gestures are, for p pairs of both.

        A course's term is its distance to the nearest example, as a multiple of what is usual; a
        measure's is the negative logarithm of Student's density about the examples' mean, 0 at
        its peak; the tokens' is the share that is wrong. Each is multiplied by its weight, and
        none is negative. So a pair is left as soon as what is known, and what the rest costs at
        least (`warping.Examples.at_least`), are more than ``most`` together; what was not
        looked for is `inf`.

        Parameters
        ----------
        gestures
            Traits of g gestures.
        action, gesture
            ``(p,)``, the numbers of an action that has examples, and of a gesture.
        wrong
            ``(p,)``, the edits from the action's pattern as a share of the tokens.
        most
            ``(p,)``, a sum above it is of no interest.
        every
            Courses are warped by every so many-th sample: 1 or `GLANCE`.

        Returns
        -------
        ndarray
            ``(p, 9)``, in the order of `TERMS`.
        """
        terms = np.full((len(action), len(TERMS)), np.inf)
        by_action = np.argsort(action, kind="stable")
        for begin in range(0, len(action), PAIRS):
            some = by_action[begin : begin + PAIRS]
            terms[some] = self._some_terms(
                gestures, action[some], gesture[some], wrong[some], most[some], every
            )
        return terms

    def _some_terms(
        self,
        gestures: Traits,
        action: IntArray,
        gesture: IntArray,
        wrong: FloatArray,
        most: FloatArray,
        every: int,
    ) -> FloatArray:
        """Return `terms` of pairs that are ordered by action."""
        terms = np.full((len(action), len(TERMS)), np.inf)
        terms[:, 0] = WEIGHTS[0] * wrong
        deviation = (gestures.measures[gesture] - self.centre[action]) / self.spread[action]
        terms[:, _MEASURES] = WEIGHTS[_MEASURES] * oddness(deviation)
        known = terms[:, 0] + terms[:, _MEASURES].sum(axis=1)
        floor = np.zeros((len(action), len(COURSES)))  # what courses cost that are not warped yet
        left = np.flatnonzero(known <= most)
        shapes = np.zeros((0, SAMPLES // every, 12))
        for i in _CHEAP_FIRST:
            courses = gestures.courses[i][gesture[left], ::every]
            if i == _SHAPE:
                whole = gestures.courses[i][gesture[left]]
                courses = shapes = faced(whole, self.central[action[left]])[:, ::every]
            least = self.examples[every][i].at_least(courses, action[left])
            floor[left, i] = self.unit[action[left], i] * least
            within = known[left] + floor[left].sum(axis=1) <= most[left]
            left = left[within]
        shapes = shapes[within]
        for i in _TELLING_FIRST:
            courses = shapes if i == _SHAPE else gestures.courses[i][gesture[left], ::every]
            unit = self.unit[action[left], i]
            floor[left, i] = 0.0
            room = (most[left] - known[left] - floor[left].sum(axis=1)) / unit
            far = self.examples[every][i].nearest(courses, action[left], room)
            terms[left, 1 + i] = unit * far
            known[left] += terms[left, 1 + i]
            left = left[known[left] + floor[left].sum(axis=1) <= most[left]]
        return terms

    def least_terms(
        self,
        gestures: Traits,
        action: IntArray,
        gesture: IntArray,
        *,
        wrong: FloatArray,
        most: FloatArray,
        every: int = 1,
    ) -> FloatArray:
        """Return `terms`, of which only the least sum for each gesture has to be known.

        For each gesture the action that its tokens and measures speak for is weighed first; others
        are not looked into further (`inf`) once they cost more. The arguments are those of `terms`.
        """
        found = np.full((len(action), len(TERMS)), np.inf)
        if not len(action):
            return found
        deviation = (gestures.measures[gesture] - self.centre[action]) / self.spread[action]
        glance = WEIGHTS[0] * wrong + (WEIGHTS[_MEASURES] * oddness(deviation)).sum(axis=1)
        order = np.lexsort((glance, gesture))
        first = order[np.unique(gesture[order], return_index=True)[1]]
        rest = np.setdiff1d(np.arange(len(action)), first)

        def weigh(pairs: IntArray, bound: FloatArray) -> None:
            found[pairs] = self.terms(
                gestures,
                action[pairs],
                gesture[pairs],
                wrong=wrong[pairs],
                most=bound,
                every=every,
            )

        weigh(first, most[first])
        best = np.full(int(gesture.max()) + 1, np.inf)
        np.minimum.at(best, gesture[first], found[first].sum(axis=1))
        weigh(rest, np.minimum(most[rest], best[gesture[rest]]))
        return found


def verification_of(
    exemplars: Sequence[Exemplar | None], *, tolerance: float = 1.0
) -> Verification:
    """Return what gestures must be like to be each action of a library.

    The limit follows from what examples cost when each is left out in turn: of the action, pooled
    with those of the whole library, which say how alike this user's gestures are, and with a
    usual cost, all as means of logarithms. It is multiplied by ``tolerance``.
    """
    own = [_left_out_costs(one) if one else np.zeros(0) for one in exemplars]
    library = _pooled(np.concatenate([np.zeros(0), *own]), USUAL_COST)
    limits = [
        tolerance * _limit(len(one), _pooled(costs, library)) if one else np.inf
        for one, costs in zip(exemplars, own, strict=True)
    ]
    return Verification(tuple(exemplars), np.array(limits))


def _limit(examples: int, usual: float) -> float:
    """Return the cost above which a gesture is rejected."""
    return SLACK_SHARE * usual + SLACK * float(np.sqrt(3.0 / max(examples, 3)))


def _left_out_costs(exemplar: Exemplar) -> FloatArray:
    """Return ``(n,)``: what each example costs against the others; nothing where n is 1.

    The scales and spreads are those of all examples; a broad prior outweighs a single one.
    """
    n = len(exemplar.apart)
    if n == 0:
        return np.zeros(0)
    others = (exemplar.measures.sum(axis=0) - exemplar.measures) / (n - 1)
    odd = oddness((exemplar.measures - others) / exemplar.spread)
    terms = np.hstack([np.zeros((n, 1)), exemplar.apart / exemplar.scale, odd])
    return np.asarray(terms @ WEIGHTS)


def _pooled(costs: FloatArray, prior: float) -> float:
    """Return the geometric mean of costs, and of a prior that counts for a few more."""
    # Of many examples of many people the nearest is near, which is why no more than 30 count.
    count = min(len(costs), 30)
    mean = float(np.log(costs + 0.1).mean()) if count else 0.0
    return float(np.exp((PRIOR_COSTS * np.log(prior) + count * mean) / (PRIOR_COSTS + count)))


def oddness(deviation: FloatArray) -> FloatArray:
    """Return the negative logarithm of Student's density, 0 at its peak."""
    return 0.5 * (_FREEDOM + 1.0) * np.log1p(np.square(deviation) / _FREEDOM)
