from __future__ import annotations

import numpy as np
import pytest

from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.synthetic.person import STEADY, Person, simulated_person
from smd.synthetic.takes import Take


def test_a_take_turned_about_is_the_same_take_elsewhere():
    rng = np.random.default_rng(3)
    person = simulated_person(rng)
    doodles = [
        Take(person, np.random.default_rng(4), heading_rad=h).play("jump").play("bow").doodle()
        for h in (0.0, 1.2)
    ]
    turn = quaternion_about([0.0, 1.0, 0.0], 1.2)
    unrest_m = 2.0 * (person.drift_m + person.tremor_m) * np.sqrt(15.0)
    assert rotate(turn, doodles[0].position_m) == pytest.approx(doodles[1].position_m, abs=unrest_m)
    assert multiply(turn, doodles[0].orientation_xyzw) == pytest.approx(
        doodles[1].orientation_xyzw, abs=1e-9
    )


def test_the_hand_turns_the_prop_about_its_grip():
    person = Person(grip_m=(0.0, 0.08, 0.0))
    doodle = Take(person, np.random.default_rng(0)).play("bow").exact_doodle()
    pivot = doodle.position_m - rotate(
        doodle.orientation_xyzw, np.broadcast_to(person.grip_m, doodle.position_m.shape)
    )
    assert np.ptp(pivot, axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)


def test_phrases_are_what_was_played():
    take = Take(STEADY, np.random.default_rng(0)).pause(1.0).play("walk").pause(0.5).play("bow")
    walk, bow = take.phrases
    assert (walk.action, bow.action) == ("walk", "bow")
    assert walk.start_s == 1.0
    assert bow.start_s == pytest.approx(walk.end_s + 0.5)
    assert bow.end_s == pytest.approx(take.now_s)


def test_waiting_for_a_time_that_has_passed_goes_on_at_once():
    take = Take(STEADY, np.random.default_rng(0)).until(2.0).until(1.0)
    assert take.now_s == 2.0


def test_a_resting_hand_trembles_as_much_as_its_person():
    person = Person(tremor_m=3e-4)
    doodle = Take(person, np.random.default_rng(0)).pause(20.0).exact_doodle()
    assert doodle.position_m.std(axis=0) == pytest.approx([3e-4 / np.sqrt(2.0)] * 3, rel=0.1)
