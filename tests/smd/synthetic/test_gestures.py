from __future__ import annotations

import numpy as np
import pytest

from smd.errors import DoodleError
from smd.geometry.rotations import heading_rad
from smd.synthetic.gestures import GESTURES, gesture
from smd.synthetic.person import STEADY
from smd.synthetic.takes import Take


@pytest.mark.parametrize("action", GESTURES)
def test_pace_shortens_a_gesture_and_leaves_its_strokes(action):
    slow, quick = gesture(action), gesture(action, pace=2.0)
    assert quick.duration_s == pytest.approx(slow.duration_s / 2.0)
    assert [s.move_m for s in quick.strokes] == [s.move_m for s in slow.strokes]


def test_walking_and_running_have_figurine_speeds():
    for action, slowest, fastest in (("walk", 0.12, 0.25), ("run", 0.3, 0.45)):
        take = Take(STEADY, np.random.default_rng(0)).play(action)
        doodle = take.exact_doodle()
        ahead = np.gradient(doodle.position_m[:, 2], doodle.time_s)
        assert slowest < ahead.max() < fastest


def test_an_unknown_action_is_refused():
    with pytest.raises(DoodleError, match=r"expected one of walk, run, .*got 'moonwalk'"):
        gesture("moonwalk")


def test_a_turn_changes_the_heading_and_what_follows():
    take = Take(STEADY, np.random.default_rng(0)).play("turn_left").play("walk")
    doodle = take.exact_doodle()
    assert heading_rad(doodle.orientation_xyzw[-1]) == pytest.approx(np.pi / 2.0)
    assert doodle.position_m[-1] == pytest.approx([0.35, 0.0, 0.0], abs=1e-5)


@pytest.mark.parametrize("action", ["punch", "bow", "turn_left", "turn_right"])
def test_gestures_in_place_end_where_they_began(action):
    doodle = Take(STEADY, np.random.default_rng(0)).play(action).exact_doodle()
    assert doodle.position_m[-1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-5)
