"""Examples of the humanoid's gestures: what verification compares a gesture with.

Simulated people perform each action, some with an Effort, some in a small world and some in a
large one. They differ in size, speed, aim, grip and unrest, as `smd.synthetic.person`, `hands`
and `efforts` say; nobody real is among them. Of each group of performances those few become
examples that stand for all of it best.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import cycle, product

import numpy as np

from laban import Effort
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.action import Action
from smd.recognition.alignment import distance_table
from smd.recognition.background import weighed
from smd.recognition.exemplar import BAND, USUAL_DISTANCE, Exemplar, exemplar_of, faced
from smd.recognition.learning import without_rest
from smd.recognition.tokenizer import tokenize
from smd.recognition.traits import COURSES, Traits, traits_of
from smd.recognition.verification import WEIGHTS
from smd.smoothing import smooth
from smd.synthetic.efforts import simulated_player, simulated_take
from smd.synthetic.hands import hand_person
from smd.synthetic.person import Person, simulated_person
from smd.synthetic.takes import Take

TIDY, OTHERS = (6, 2), (72, 18)
"""How many people perform, and how many performances become examples: of tidy people in each of
`SCALES`, and of all others, a quarter of whom mean an Effort and the rest are as various as real
hands."""

SEED = 5000

REST_S = 0.3
"""Before and after a gesture; it is no part of the example."""

SCALES = (1.0, 0.5, 2.0)
"""Of positions: a prop may stand for a figurine of any size, and gestures be drawn so."""

SIZES = (1.0, 1.6, 0.7)
"""Of gestures beside their average: the same turn may be a quarter or nearly a half."""

EFFORTS = tuple(product((-1.0, 0.0, 1.0), repeat=2))


def with_examples(actions: Iterable[Action]) -> tuple[Action, ...]:
    """Return the actions, those that are drawn with an exemplar of simulated performances."""
    return tuple(
        action if action.pattern is None else replace(action, exemplar=_exemplar(action.name))
        for action in actions
    )


def _exemplar(action: str) -> Exemplar:
    """Return an exemplar of the performances that stand for all of their group."""
    examples: list[Traits] = []
    for doodles, count in _groups(action):
        kept = [traits for traits in map(_traits, doodles) if traits]
        examples += [kept[i] for i in medoids(_apart(kept), count)] if kept else []
    return weighed(exemplar_of(examples))


def medoids(apart: FloatArray, count: int) -> IntArray:
    """Return which few of n things all of them are near to: k-medoids [1]_.

    Each is chosen so that the sum of distances to the nearest of those chosen is least; then,
    as long as that changes anything, what is nearest to one of them is given its own middle.

    Parameters
    ----------
    apart
        ``(n, n)``, how far each is from each.
    count
        How many to choose; all of them where there are no more.

    Returns
    -------
    ndarray
        Their numbers, in order.

    References
    ----------
    .. [1] L. Kaufman, P. Rousseeuw, "Clustering by Means of Medoids", 1987.
    """
    n = len(apart)
    if n <= count:
        return np.arange(n)
    chosen: list[int] = []
    nearest = np.full(n, np.inf)
    for _ in range(count):
        left = np.minimum(nearest[:, None], apart).sum(axis=0)
        left[chosen] = np.inf
        chosen.append(int(left.argmin()))
        nearest = np.minimum(nearest, apart[:, chosen[-1]])
    while True:
        of = apart[:, chosen].argmin(axis=1)
        of[chosen] = np.arange(count)  # things that are the same stay with themselves
        groups = [np.flatnonzero(of == k) for k in range(count)]
        middle = [int(g[apart[np.ix_(g, g)].sum(axis=0).argmin()]) for g in groups]
        if _spread(apart, middle) >= _spread(apart, chosen):
            return np.sort(chosen)
        chosen = middle


def _spread(apart: FloatArray, chosen: Sequence[int]) -> float:
    """Return the sum of the distances to the nearest of those chosen."""
    return float(apart[:, list(chosen)].min(axis=1).sum())


def _apart(performances: Sequence[Traits]) -> FloatArray:
    """Return ``(n, n)``: what the courses of each cost, weighed against each alone."""
    n = len(performances)
    whole = np.zeros((n, n))
    for i, name in enumerate(COURSES):
        course = np.stack([one.courses[i] for one in performances])
        own = course
        if name == "shape_heading":
            own = faced(
                course, course[np.square(course - course.mean(axis=0)).sum((1, 2)).argmin()]
            )
        whole += WEIGHTS[1 + i] / USUAL_DISTANCE[i] * distance_table(own, course, band=BAND)
    return 0.5 * (whole + whole.T)


def _groups(action: str) -> Iterator[tuple[Iterator[Doodle], int]]:
    """Yield an action's performances by groups, and how many examples each group gives."""
    people, examples = TIDY
    for group, scale in enumerate(SCALES):
        rngs = (np.random.default_rng([SEED, group, number]) for number in range(people))
        played = (
            _played(action, simulated_person(rng), size, scale, rng)
            for rng, size in zip(rngs, cycle(SIZES), strict=False)
        )
        yield played, examples
    people, examples = OTHERS
    yield (_other(action, number) for number in range(people)), examples


def _other(action: str, number: int) -> Doodle:
    """Return a performance with an Effort, or by somebody as various as real hands."""
    rng = np.random.default_rng([SEED, number])
    turn, kind = divmod(number, 4)
    if kind == 3:
        return _acted(action, Effort(*EFFORTS[turn % len(EFFORTS)]), rng)
    played = 3 * turn + kind
    scale, size = SCALES[played % len(SCALES)], SIZES[played // len(SCALES) % len(SIZES)]
    return _played(action, hand_person(rng), size, scale, rng)


def _traits(doodle: Doodle) -> Traits | None:
    """Return the traits of a performance; None of one that is too faint to be seen."""
    motion = smooth(doodle)
    runs = without_rest(tokenize(motion, figure_height_m=DEFAULT_FIGURE_HEIGHT_M))
    return traits_of(motion.between(runs[0].start_s, runs[-1].end_s)) if runs else None


def _played(
    action: str, person: Person, size: float, scale: float, rng: np.random.Generator
) -> Doodle:
    """Return a performance that means no Effort, in a world of a scale."""
    doodle = Take(person, rng).pause(REST_S).play(action, size=size).pause(REST_S).doodle()
    return replace(doodle, position_m=scale * doodle.position_m)


def _acted(action: str, effort: Effort, rng: np.random.Generator) -> Doodle:
    """Return a performance with an Effort."""
    return simulated_take(action, effort, simulated_player("somebody", rng), rng)
