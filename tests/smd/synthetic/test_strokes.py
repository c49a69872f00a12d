from __future__ import annotations

import numpy as np
import pytest

from smd.errors import DoodleError
from smd.geometry.rotations import heading_rad, multiply, quaternion_about, rotate
from smd.synthetic.strokes import (
    GESTURES,
    STEADY,
    Person,
    gesture,
    progress,
    simulated_person,
    tracker_times,
)
from smd.synthetic.takes import Take

U = np.linspace(0.0, 1.0, 20_001)


@pytest.mark.parametrize("cruise", [0.0, 0.3, 0.6, 0.9])
def test_a_stroke_goes_from_rest_to_rest_and_is_symmetric(cruise):
    done = progress(U, cruise)
    speed = np.gradient(done, U)
    assert (done[0], done[-1]) == pytest.approx((0.0, 1.0))
    assert done + done[::-1] == pytest.approx(1.0)
    assert np.diff(done).min() >= 0.0
    assert abs(speed[[0, -1]]).max() < 1e-3


def test_a_stroke_without_cruise_is_the_minimum_jerk_course():
    assert progress(U) == pytest.approx(10 * U**3 - 15 * U**4 + 6 * U**5)


def test_a_stroke_cruises_at_its_peak_speed_for_its_share():
    speed = np.gradient(progress(U, 0.6), U)
    at_peak = speed > speed.max() * (1.0 - 1e-6)
    assert np.ptp(U[at_peak]) == pytest.approx(0.6, abs=0.01)


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


def test_a_tracker_reports_at_uneven_times_and_loses_one_in_a_hundred():
    time_s = tracker_times(5.0, 205.0, 90.0, np.random.default_rng(0))
    steps = np.diff(time_s)
    assert (time_s[0], time_s[-1]) == (5.0, 205.0)
    assert steps.min() > 0.0
    assert np.ptp(steps) > 1e-3
    assert len(time_s) == pytest.approx(0.99 * 200.0 * 90.0, rel=0.003)


def test_people_differ_and_the_same_seed_gives_the_same_person():
    people = [simulated_person(np.random.default_rng(seed)) for seed in (1, 1, 2)]
    assert people[0] == people[1]
    assert people[0] != people[2]


def test_a_resting_hand_trembles_as_much_as_its_person():
    person = Person(tremor_m=3e-4)
    doodle = Take(person, np.random.default_rng(0)).pause(20.0).exact_doodle()
    assert doodle.position_m.std(axis=0) == pytest.approx([3e-4 / np.sqrt(2.0)] * 3, rel=0.1)
