"""Composed sessions are what they say they are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from benchmarks.composed import (
    FASTEST_M_S,
    FASTEST_RAD_S,
    FEW_CLASSES,
    FRAME,
    MOST_TAKES,
    OTHERS_SHARE,
    PAUSE_S,
    RATE_HZ,
    SENSOR_HZ,
    SLACK_S,
    Teaching,
    compose,
    idle_files,
    read_idle,
    resampled,
    session_of,
    sessions_of,
)
from benchmarks.gestures import read_gestures
from smd.doodle import Doodle
from smd.geometry.rotations import inverse, multiply, rotvec_from_quaternion

OWN_2 = Teaching(own=2)


def speeds(doodle: Doodle):
    """Return speed and rate of turning between samples."""
    steps = multiply(inverse(doodle.orientation_xyzw[:-1]), doodle.orientation_xyzw[1:])
    speed_m_s = np.linalg.norm(np.diff(doodle.position_m, axis=0), axis=1) * RATE_HZ
    return speed_m_s, np.linalg.norm(rotvec_from_quaternion(steps), axis=1) * RATE_HZ


def composed(people, idle, seed=5, count=8):
    takes = [(str(people.label[i]), people.doodles[i]) for i in range(0, 5 * count, 5)]
    return takes, *compose(takes, idle, np.random.default_rng(seed))


def test_a_seed_gives_one_session(people, idle):
    one, same, other = (list(sessions_of(people, idle, [OWN_2], seed=seed)) for seed in (1, 1, 2))
    assert len(one) == len(same) == 4  # of two people, with a small and a full library
    for a, b in zip(one, same, strict=True):
        assert_array_equal(a.free.position_m, b.free.position_m)
        assert_array_equal(a.free.orientation_xyzw, b.free.orientation_xyzw)
        assert_array_equal(a.held, b.held)
        assert a.gestures == b.gestures
    assert one[0].free.duration_s != other[0].free.duration_s


def test_sampling_is_even_and_everything_in_one_frame(people, idle):
    for session in sessions_of(people, idle, [OWN_2], seed=1):
        assert session.free.drawing is None
        assert_allclose(np.diff(session.free.time_s), 1.0 / RATE_HZ, atol=1e-9)
        for own in session.examples.values():
            assert all(np.allclose(np.diff(one.time_s), 1.0 / RATE_HZ) for one in own)


def test_truth_is_where_the_takes_are(people, idle):
    takes, free, _, gestures = composed(people, idle)
    assert [one.action for one in gestures] == [name for name, _ in takes]
    for one, (_, take) in zip(gestures, takes, strict=True):
        first = round(one.start_s * RATE_HZ)
        step = round(RATE_HZ / SENSOR_HZ)
        rows = first + step * np.arange(len(take))
        assert one.end_s - one.start_s == pytest.approx(take.duration_s)
        assert_allclose(free.position_m[rows], take.position_m, atol=1e-9)
        same = np.abs(np.sum(free.orientation_xyzw[rows] * take.orientation_xyzw, axis=1))
        assert_allclose(same, 1.0, atol=1e-9)


def test_between_takes_a_hand_goes_back_and_pauses(people, idle):
    _, _, _, gestures = composed(people, idle)
    for before, after in pairwise(gestures):
        assert after.start_s - before.end_s > PAUSE_S[0] + 0.4  # and two movements


@pytest.mark.parametrize("seed", range(10))
def test_no_step_is_above_what_the_parts_have(people, idle, seed):
    takes, free, _, _ = composed(people, idle, seed)
    speed_m_s, turning_rad_s = speeds(free)
    own_m_s, own_rad_s = zip(*(speeds(resampled(take, RATE_HZ)) for _, take in takes), strict=True)
    # Movements between parts may be faster than these slow takes, not than a hand.
    assert speed_m_s.max() < max(np.concatenate(own_m_s).max(), 2.0)
    assert turning_rad_s.max() < max(np.concatenate(own_rad_s).max(), 5.0)
    assert np.abs(np.diff(speed_m_s)).max() < 0.5  # no sudden start or stop at a splice


def test_the_trigger_is_held_during_takes_with_a_hands_slack(people, idle):
    for session in sessions_of(people, idle, [OWN_2], seed=3):
        time_s, held = session.free.time_s, session.held
        assert_array_equal(session.drawn.drawing, held)
        near = np.zeros(len(time_s), bool)
        for one in session.gestures:
            assert held[(time_s >= one.start_s) & (time_s <= one.end_s)].all()
            near |= (time_s >= one.start_s - SLACK_S) & (time_s <= one.end_s + SLACK_S)
        assert not held[~near].any()
        assert 0.0 < held.mean() < 1.0


def test_one_gesture_in_five_is_of_a_class_that_was_not_taught(people, idle):
    for session in sessions_of(people, idle, [OWN_2], seed=4):
        names = [one.action for one in session.gestures]
        known = [name for name in names if name is not None]
        assert set(known) == set(session.examples)
        assert max(map(known.count, known)) == min(MOST_TAKES, 5 - OWN_2.own)
        assert len(names) - len(known) == round(OTHERS_SHARE * len(names))
    small, full = sessions_of(people, idle, [OWN_2], seed=4), 6
    assert [len(each.examples) for each in small] == [FEW_CLASSES, full] * 2


def test_what_is_taught_is_not_played(people, idle):
    for session in sessions_of(people, idle, [OWN_2], seed=5):
        for one in session.gestures:
            rows = slice(round(one.start_s * RATE_HZ), round(one.end_s * RATE_HZ) + 1)
            played_m = session.free.position_m[rows]
            for example in (each for own in session.examples.values() for each in own):
                same = len(example) == len(played_m)
                assert not (same and np.allclose(example.position_m, played_m))


def test_teachings_that_differ_in_own_examples_are_tried_on_the_same_session(people, idle):
    none, two = (
        session_of(people, 1, Teaching(own, others=3, set_aside=3), idle, np.random.default_rng(6))
        for own in (0, 2)
    )
    assert_array_equal(none.free.position_m, two.free.position_m)
    assert none.gestures == two.gestures
    for name, own in two.examples.items():
        assert len(own) == 5
        for a, b in zip(own[2:], none.examples[name], strict=True):
            assert_array_equal(a.position_m, b.position_m)


def test_people_with_few_gestures_are_left_out(people, idle):
    rng = np.random.default_rng(0)
    assert session_of(people, 3, Teaching(others=2), idle, rng) is None


def test_a_time_belongs_to_the_nearest_take(people, idle):
    session = next(sessions_of(people, idle, [OWN_2], seed=7))
    for i, one in enumerate(session.gestures):
        assert session.window_of(0.5 * (one.start_s + one.end_s)) == i
    first, second = session.gestures[:2]
    between_s = 0.5 * (first.end_s + second.start_s)
    assert session.window_of(between_s - 1e-6) == 0
    assert session.window_of(between_s + 1e-6) == 1
    assert session.window_of(-1.0) == 0
    assert session.window_of(1e9) == len(session.gestures) - 1


@pytest.mark.parametrize(
    ("teaching", "told"),
    [
        (Teaching(own=2), "own 2"),
        (Teaching(others=10), "others' 10"),
        (Teaching(own=1, others=5), "own 1, others' 5"),
    ],
)
def test_a_teaching_says_what_it_is(teaching, told):
    assert str(teaching) == told


@pytest.mark.parametrize(
    "bad", [{}, {"own": -1, "others": 5}, {"own": 3, "set_aside": 2}, {"others": -1, "own": 1}]
)
def test_a_teaching_needs_examples(bad):
    with pytest.raises(ValueError, match="expected"):
        Teaching(**bad)


def test_hands_do_not_jump_where_real_parts_meet(shared_data):
    paths, _ = idle_files(shared_data / "idle")
    data = read_gestures((1, 2), FRAME)
    sessions = list(sessions_of(data, read_idle(paths), [OWN_2], seed=8))
    assert len(sessions) == 4
    for session in sessions:
        speed_m_s, turning_rad_s = speeds(session.free)
        at_s = session.free.time_s[:-1]
        taken = np.zeros(len(at_s), bool)  # a camera that loses a hand's joints is another matter
        for one in session.gestures:
            taken |= (at_s > one.start_s - 1e-6) & (at_s < one.end_s - 1e-6)
        assert speed_m_s[~taken].max() < FASTEST_M_S
        assert turning_rad_s[~taken].max() < FASTEST_RAD_S


def test_idle_hands_to_choose_on_are_not_those_to_report_on(shared_data):
    chosen, reported = idle_files(shared_data / "idle")
    assert len(chosen) == len(reported) == 9
    assert max(chosen) < min(reported)
