"""The shipped library, every action of it, as users have it: patterns and exemplars."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.doodle import Doodle
from smd.recognition import Recognizer
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import STEADY, simulated_person
from smd.synthetic.takes import Take


@pytest.fixture(scope="module")
def recognizer() -> Recognizer:
    return Recognizer(load_library().actions)


def take(action: str, person, rng) -> Take:
    heading_rad = rng.uniform(-np.pi, np.pi)
    return Take(person, rng, heading_rad=heading_rad).pause(0.6).play(action).pause(0.6)


def test_every_gesture_that_is_drawn_belongs_to_an_action():
    assert set(GESTURES) == {a.name for a in load_library().actions if a.pattern is not None}


@pytest.mark.parametrize(("factor", "figure_height_m"), [(0.5, 0.175), (1.0, 0.175), (2.0, 0.35)])
def test_a_steady_hand_is_understood_at_any_size(factor, figure_height_m):
    """What is drawn twice as large by chance is rejected; a larger figure is one that is said."""
    recognizer = Recognizer(load_library(), figure_height_m=figure_height_m)
    for action in GESTURES:
        played = take(action, STEADY, np.random.default_rng(0))
        doodle, (meant,) = played.doodle(), played.phrases
        doodle = Doodle(doodle.time_s, factor * doodle.position_m, doodle.orientation_xyzw)
        spans = recognizer.spot(doodle)
        assert [span.action for span in spans] == [action]
        assert abs(spans[0].start_s - meant.start_s) < 0.15
        assert abs(spans[0].end_s - meant.end_s) < 0.15


def test_people_who_are_no_examples_are_understood(recognizer):
    understood = 0
    for seed in range(4):
        person = simulated_person(np.random.default_rng([71, seed]))
        for i, action in enumerate(GESTURES):
            doodle = take(action, person, np.random.default_rng([seed, i])).doodle()
            understood += [span.action for span in recognizer.spot(doodle)] == [action]
    assert understood >= 0.97 * 4 * len(GESTURES)
