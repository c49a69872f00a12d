from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    rotate,
    rotvec_from_quaternion,
)
from smd.recognition.average import average_doodle
from smd.recognition.embedding import extent_m, heading_frame, sample_poses, seen_from
from smd.recognition.tokenizer import tokenize
from smd.smoothing import smooth
from smd.synthetic.efforts import ACTIONS
from smd.synthetic.person import STEADY, simulated_person
from smd.synthetic.takes import Take

UP = [0.0, 1.0, 0.0]


def exact(action, **how):
    return Take(STEADY, np.random.default_rng(0)).play(action, **how).exact_doodle(rate_hz=60.0)


def played(action, seed):
    rng = np.random.default_rng(seed)
    take = Take(simulated_person(rng), rng, heading_rad=rng.uniform(-3.0, 3.0))
    return take.pause(0.2).play(action).pause(0.2).doodle()


def moved(doodle, angle, by_m):
    turn = quaternion_about(UP, angle)
    return replace(
        doodle,
        position_m=np.add(rotate(turn, doodle.position_m), by_m),
        orientation_xyzw=multiply(turn, doodle.orientation_xyzw),
    )


def upright(doodle, samples=60):
    poses = sample_poses(doodle, samples)
    return seen_from(poses, heading_frame(poses))


def apart(a, b):
    """Largest distance and largest angle between two doodles brought to one place and heading."""
    a, b = upright(a), upright(b)
    angle = rotvec_from_quaternion(multiply(inverse(a.orientation_xyzw), b.orientation_xyzw))
    return (
        np.linalg.norm(a.position_m - b.position_m, axis=-1).max(),
        np.linalg.norm(angle, axis=-1).max(),
    )


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("count", [1, 3])
def test_the_average_of_equal_doodles_is_the_doodle(action, count):
    doodle = exact(action)
    average = average_doodle([doodle] * count)
    assert average.duration_s == pytest.approx(doodle.duration_s, abs=1e-9)
    distance, angle = apart(average, doodle)
    assert distance < 1e-3
    assert angle < 5e-3


@pytest.mark.parametrize("action", ACTIONS)
def test_where_the_examples_are_and_face_does_not_matter(action):
    doodle = exact(action)
    average = average_doodle(
        [doodle, moved(doodle, 2.0, [1.0, 0.0, 5.0]), moved(doodle, -0.7, [0.0, 3.0, 0.0])]
    )
    distance, angle = apart(average, doodle)
    assert distance < 1e-3
    assert angle < 5e-3


@pytest.mark.parametrize("action", ["punch", "throw", "jump", "walk"])
def test_a_copy_that_hurries_and_lingers_leaves_the_path_and_shares_the_time(action):
    doodle = exact(action)
    share = doodle.time_s / doodle.duration_s
    warped = replace(doodle, time_s=1.6 * doodle.duration_s * (0.6 * share + 0.4 * share**2))
    average = average_doodle([doodle, warped])
    assert average.duration_s == pytest.approx(1.3 * doodle.duration_s, rel=1e-6)
    path = doodle.position_m - doodle.position_m.mean(axis=0)
    drawn = average.position_m - average.position_m.mean(axis=0)
    shift = drawn[0] - path[0]  # the means differ, since each lingers elsewhere
    off = np.linalg.norm((drawn - shift)[:, None] - path[None], axis=-1).min(axis=1)
    assert off.max() < 0.1 * extent_m(upright(doodle))


def test_sizes_and_durations_are_averaged():
    # Warping pairs the turning point of the small one with several samples of the large one.
    average = average_doodle([exact("punch", size=0.5), exact("punch", size=1.5)])
    assert np.ptp(average.position_m[:, 2]) == pytest.approx(0.15, rel=0.1)
    slow = average_doodle([exact("bow", pace=0.5), exact("bow", pace=1.0)])
    assert slow.duration_s == pytest.approx(1.5 * exact("bow").duration_s, rel=0.02)


def test_rotations_are_averaged():
    average = average_doodle([exact("bow", size=0.6), exact("bow", size=1.4)])
    tipped = rotvec_from_quaternion(average.orientation_xyzw)[:, 0].max()
    assert tipped == pytest.approx(np.radians(55.0), rel=0.1)


@pytest.mark.parametrize("action", ["throw", "turn_left", "fly"])
def test_the_order_of_the_examples_does_not_matter(action):
    doodles = [played(action, seed) for seed in range(5)]
    a, b = average_doodle(doodles), average_doodle(doodles[::-1])
    distance, angle = apart(a, b)
    assert distance < 1e-9
    assert angle < 1e-6


@pytest.mark.parametrize(
    ("action", "tokens"),
    [
        ("walk", "T_Z"),
        ("side_step_left", "T_X"),
        ("turn_right", "R_N_Y"),
        ("punch", "T_Z T_N_Z"),
        ("throw", "T_N_Z T_Y_Z T_Z T_N_Y_Z"),
        ("bow", "R_X R_N_X"),
    ],
)
def test_the_average_of_ten_people_draws_the_gesture_cleanly(action, tokens):
    average = average_doodle([played(action, seed) for seed in range(10)])
    runs = tokenize(smooth(average))
    moving = [str(run.token) for run in runs if str(run.token) != "STILL"]
    assert " ".join(moving) == tokens


def test_a_long_average_is_sampled_more_coarsely():
    slow = exact("walk", pace=0.1)
    average = average_doodle([slow, slow])
    assert len(average) == 600
    assert average.duration_s == pytest.approx(slow.duration_s)


def test_it_begins_at_zero_with_the_mean_place_at_the_origin():
    average = average_doodle([played("punch", 0), played("punch", 1)])
    assert average.time_s[0] == 0.0
    np.testing.assert_allclose(average.position_m.mean(axis=0), 0.0, atol=1e-9)


def test_too_little_is_refused():
    with pytest.raises(DoodleError, match="at least one doodle, got none"):
        average_doodle([])
    single = Doodle([0.0], np.zeros((1, 3)), [[0.0, 0.0, 0.0, 1.0]])
    with pytest.raises(DoodleError, match="doodle 2: expected at least 2 samples, got 1"):
        average_doodle([exact("walk"), single])
