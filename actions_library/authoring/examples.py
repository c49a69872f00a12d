"""Examples of the humanoid's gestures: what verification compares a gesture with.

Simulated people perform each action once. They differ in size, speed, aim, grip and unrest, as
`smd.synthetic.strokes` says; nobody real is among them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.recognition.action import Action
from smd.recognition.exemplar import exemplar_of
from smd.recognition.learning import doodle_runs, without_rest
from smd.recognition.traits import Traits, traits_of
from smd.smoothing import smooth
from smd.synthetic.strokes import simulated_person
from smd.synthetic.takes import Take

PEOPLE = 12
"""A dozen differ as much as more of them would, and each one more costs time at every gesture."""

SEED = 5000

REST_S = 0.3
"""Before and after a gesture; it is no part of the example."""


def with_examples(actions: Iterable[Action]) -> tuple[Action, ...]:
    """Return the actions, those that are drawn with an exemplar of simulated performances."""
    return tuple(
        action
        if action.pattern is None
        else replace(
            action, exemplar=exemplar_of([_performed(action.name, k) for k in range(PEOPLE)])
        )
        for action in actions
    )


def _performed(action: str, number: int) -> Traits:
    """Return the traits of an action's gesture as one person performs it."""
    rng = np.random.default_rng([SEED, number])
    take = Take(simulated_person(rng), rng).pause(REST_S).play(action).pause(REST_S)
    doodle = take.doodle()
    runs = without_rest(doodle_runs(doodle, DEFAULT_FIGURE_HEIGHT_M))
    return traits_of(smooth(doodle).between(runs[0].start_s, runs[-1].end_s))
