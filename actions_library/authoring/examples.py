"""Examples of the humanoid's gestures: what verification compares a gesture with.

Simulated people perform each action once, every other one with an Effort, some in a small world
and some in a large one. They differ in size, speed, aim, grip and unrest, as
`smd.synthetic.strokes` and `smd.synthetic.efforts` say; nobody real is among them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import product

import numpy as np

from laban import Effort
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.recognition.action import Action
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import doodle_runs, without_rest
from smd.recognition.traits import Traits, traits_of
from smd.smoothing import smooth
from smd.synthetic.efforts import simulated_player, simulated_take
from smd.synthetic.strokes import simulated_person
from smd.synthetic.takes import Take

PEOPLE = 18
"""So that every pairing of Time and Weight is played once; each one more costs time at every
gesture that is weighed."""

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
        action
        if action.pattern is None
        else replace(action, exemplar=exemplar_of(_performances(action.name)))
        for action in actions
    )


def _performances(action: str) -> list[Traits]:
    """Return the traits of an action's gesture as each person performs it."""
    found = []
    for number in range(PEOPLE):
        rng = np.random.default_rng([SEED, number])
        doodle = _acted(action, number // 2, rng) if number % 2 else _played(action, number, rng)
        runs = without_rest(doodle_runs(doodle, DEFAULT_FIGURE_HEIGHT_M))
        if runs:  # the lightest are too faint to be seen
            found.append(traits_of(smooth(doodle).between(runs[0].start_s, runs[-1].end_s)))
    return found


def _played(action: str, number: int, rng: np.random.Generator) -> Doodle:
    """Return a performance that means no Effort, in one of `SCALES`."""
    size = SIZES[number // 6 % len(SIZES)]
    take = Take(simulated_person(rng), rng).pause(REST_S).play(action, size=size).pause(REST_S)
    doodle = take.doodle()
    return replace(doodle, position_m=SCALES[number // 2 % len(SCALES)] * doodle.position_m)


def _acted(action: str, number: int, rng: np.random.Generator) -> Doodle:
    """Return a performance with one of `EFFORTS`."""
    effort = Effort(*EFFORTS[number % len(EFFORTS)])
    return simulated_take(action, effort, simulated_player("somebody", rng), rng)
