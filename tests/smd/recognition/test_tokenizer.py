from __future__ import annotations

import time
from itertools import pairwise, product

import numpy as np
import pytest

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.rotations import multiply, quaternion_about, quaternion_from_rotvec, rotate
from smd.recognition.tokenizer import DEFAULT_THRESHOLDS, tokenize
from smd.recognition.tokens import STILL, Token
from smd.smoothing import smooth
from smd.synthetic.curves import circle, helix, spin, straight_line
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

DIRECTIONS = [d for d in product((-1, 0, 1), repeat=3) if any(d)]
STILL_M_S = np.sqrt(DEFAULT_THRESHOLDS.still) * DEFAULT_FIGURE_HEIGHT_M


def motion(*, n=60, velocity=(0.0, 0.0, 0.0), turning=(0.0, 0.0, 0.0), orientation=None):
    """A motion with the given velocity (in the prop's frame) and turning at each sample.

    The derivatives are what is read; positions and orientations need not agree with them.
    """
    velocity = np.broadcast_to(np.asarray(velocity, float), (n, 3))
    turning = np.broadcast_to(np.asarray(turning, float), (n, 3))
    facing = np.broadcast_to([0.0, 0.0, 0.0, 1.0] if orientation is None else orientation, (n, 4))
    zero = np.zeros((n, 3))
    return RigidMotion(
        np.arange(n) / 60.0, zero, facing, rotate(facing, velocity), zero, zero, turning, zero, zero
    )


def names(runs):
    return [str(run.token) for run in runs]


def moved(m, rotation, shift):
    """The same movement in another place of the world."""
    return RigidMotion(
        m.time_s,
        rotate(rotation, m.position_m) + shift,
        multiply(rotation, m.orientation_xyzw),
        rotate(rotation, m.velocity_m_s),
        rotate(rotation, m.acceleration_m_s2),
        rotate(rotation, m.jerk_m_s3),
        m.angular_velocity_rad_s,
        m.angular_acceleration_rad_s2,
        m.angular_jerk_rad_s3,
    )


def played(seed, *actions):
    rng = np.random.default_rng(seed)
    take = Take(simulated_person(rng), rng).pause(0.5)
    for action in actions or GESTURES:
        take.play(action).pause(0.5)
    return take.doodle()


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_a_straight_line_is_the_token_of_its_direction(direction):
    line = straight_line(length_m=0.4, duration_s=2.0, direction=direction)
    (run,) = tokenize(smooth(line))
    assert run.token == Token(translation=direction)
    assert run.travel_heights == pytest.approx(0.4 / DEFAULT_FIGURE_HEIGHT_M, rel=0.02)
    assert run.turn_rad == 0.0


@pytest.mark.parametrize("axis", DIRECTIONS)
def test_a_spin_is_the_token_of_its_axis(axis):
    (run,) = tokenize(smooth(spin(angle_rad=3.0, duration_s=2.0, axis=axis)))
    assert run.token == Token(rotation=axis)
    assert run.turn_rad == pytest.approx(3.0, rel=0.02)
    assert run.travel_heights == 0.0


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("seed", range(3))
def test_every_direction_within_a_bin_has_its_token(direction, seed):
    rng = np.random.default_rng(seed)
    unit = np.array(direction) / np.linalg.norm(direction)
    # the nearest two bin centres are 35.26 degrees apart
    small = quaternion_about(rng.normal(size=3), np.radians(17.0))
    assert names(tokenize(motion(velocity=0.2 * rotate(small, unit)))) == [
        str(Token(translation=direction))
    ]


def test_a_tight_circle_moves_and_turns_and_a_wide_one_only_moves():
    tight = circle(radius_m=0.2, duration_s=4.0)
    assert names(tokenize(smooth(tight))) == ["T_Z/R_Y"]
    wide = circle(radius_m=1.0, duration_s=16.0)
    assert names(tokenize(smooth(wide))) == ["T_Z"]


def test_a_rising_helix_moves_ahead_and_up():
    rising = helix(radius_m=0.2, rise_m=2.0 * np.pi * 0.2, duration_s=4.0)
    assert names(tokenize(smooth(rising))) == ["T_Y_Z/R_Y"]


@pytest.mark.parametrize("seed", range(6))
def test_where_the_user_stands_and_faces_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    m = smooth(played(seed))
    rotation = quaternion_from_rotvec(rng.normal(size=3) * 2.0)
    there = tokenize(moved(m, rotation, rng.normal(size=3) * 10.0))
    here = tokenize(m)
    assert [(run.token, run.first, run.last) for run in there] == [
        (run.token, run.first, run.last) for run in here
    ]


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_a_larger_figurine_that_glides_further_gives_the_same_tokens(factor):
    m = smooth(played(1, "walk", "jump", "side_step_left"))
    still_turned = motion(n=len(m), velocity=m.velocity_m_s, orientation=[0.0, 0.0, 0.0, 1.0])
    larger = motion(n=len(m), velocity=factor * m.velocity_m_s, orientation=[0.0, 0.0, 0.0, 1.0])
    height_m = factor * DEFAULT_FIGURE_HEIGHT_M
    expected = tokenize(still_turned)
    found = tokenize(larger, figure_height_m=height_m)
    assert [(run.token, run.first) for run in found] == [(run.token, run.first) for run in expected]


@pytest.mark.parametrize("seed", range(4))
def test_runs_cover_every_sample_once_and_neighbours_differ(seed):
    m = smooth(played(seed))
    runs = tokenize(m)
    assert runs[0].first == 0
    assert runs[-1].last == len(m)
    assert runs[0].start_s == m.time_s[0]
    for before, after in pairwise(runs):
        assert before.last == after.first
        assert before.end_s == after.start_s == m.time_s[after.first]
        assert before.token != after.token


@pytest.mark.parametrize("seed", range(4))
def test_every_run_is_longer_than_two_sixtieths_of_a_second(seed):
    for run in tokenize(smooth(played(seed)))[1:-1]:
        assert run.last - run.first >= 3


def test_movement_at_the_still_level_is_still():
    below = motion(velocity=(0.0, 0.0, 0.99 * STILL_M_S))
    above = motion(velocity=(0.0, 0.0, 1.01 * STILL_M_S))
    assert names(tokenize(below)) == ["STILL"]
    assert names(tokenize(above)) == ["T_Z"]


def test_a_wobble_is_still_and_a_turn_is_not():
    assert names(tokenize(motion(turning=(0.0, 0.79, 0.0)))) == ["STILL"]
    assert names(tokenize(motion(turning=(0.0, 0.81, 0.0)))) == ["R_Y"]


@pytest.mark.parametrize("seed", range(5))
def test_turning_about_any_point_of_the_figurine_moves_nothing(seed):
    rng = np.random.default_rng(seed)
    turning = rng.normal(size=3)
    turning *= 3.0 / np.linalg.norm(turning)
    lever = rng.normal(size=3)
    lever *= 0.49 * DEFAULT_FIGURE_HEIGHT_M / np.linalg.norm(lever)
    (run,) = tokenize(motion(velocity=np.cross(turning, lever), turning=turning))
    assert run.token.translation == (0, 0, 0)
    assert run.token.rotation != (0, 0, 0)


def test_turning_about_a_far_point_moves():
    lever = np.array([0.0, 2.0 * DEFAULT_FIGURE_HEIGHT_M, 0.0])
    runs = tokenize(motion(velocity=np.cross([3.0, 0.0, 0.0], lever), turning=(3.0, 0.0, 0.0)))
    assert names(runs) == ["T_Z/R_X"]


def test_moving_along_the_axis_of_a_turn_is_not_explained_by_it():
    assert names(tokenize(motion(velocity=(0.0, 0.0, 0.1), turning=(0.0, 0.0, 3.0)))) == ["T_Z/R_Z"]


def test_the_swing_of_an_arm_turns_nothing():
    speed = 0.6
    swinging = (0.9 * speed / DEFAULT_THRESHOLDS.swing_m, 0.0, 0.0)
    assert names(tokenize(motion(velocity=(0.0, 0.0, speed), turning=swinging))) == ["T_Z"]


def test_a_direction_on_the_edge_of_two_bins_does_not_chatter():
    angle = np.radians(22.5 + 3.0 * np.sin(np.arange(120) * 0.9))
    velocity = 0.2 * np.stack([np.zeros(120), np.sin(angle), np.cos(angle)], axis=-1)
    assert len(tokenize(motion(n=120, velocity=velocity))) == 1


def test_a_speed_on_the_edge_of_stillness_does_not_chatter():
    speed = STILL_M_S * (1.0 + 0.3 * np.sin(np.arange(120) * 0.9))
    assert len(tokenize(motion(n=120, velocity=speed[:, None] * [0.0, 0.0, 1.0]))) == 1


def test_a_blip_of_two_samples_is_absorbed_and_one_of_three_is_kept():
    velocity = np.tile([0.0, 0.0, 0.2], (60, 1))
    velocity[30:32] = (0.2, 0.0, 0.0)
    assert names(tokenize(motion(velocity=velocity))) == ["T_Z"]
    velocity[30:33] = (0.2, 0.0, 0.0)
    assert names(tokenize(motion(velocity=velocity))) == ["T_Z", "T_X", "T_Z"]


def test_short_runs_between_two_long_ones_are_shared():
    velocity = np.tile([0.0, 0.0, 0.2], (60, 1))
    velocity[28:30] = (0.2, 0.0, 0.0)
    velocity[30:32] = (0.0, 0.2, 0.0)
    velocity[32:] = (-0.2, 0.0, 0.0)
    first, second = tokenize(motion(velocity=velocity))
    assert (first.last, second.first) == (30, 30)


def test_chatter_without_a_long_run_is_one_run():
    velocity = np.tile([[0.2, 0.0, 0.0], [0.0, 0.0, 0.2]], (20, 1))
    assert len(tokenize(motion(n=40, velocity=velocity))) == 1


def test_a_stroke_begins_and_ends_where_its_speed_is_a_twentieth_of_its_peak():
    s = np.linspace(0.0, 1.0, 121)
    speed = 0.3 * 16.0 * (s * (1.0 - s)) ** 2  # the minimum-jerk bell of a stroke of 2 s
    still = np.zeros(60)
    speed = np.concatenate([still, speed, still])
    runs = tokenize(motion(n=len(speed), velocity=speed[:, None] * [0.0, 0.0, 1.0]))
    assert names(runs) == ["STILL", "T_Z", "STILL"]
    over = np.flatnonzero(speed > 0.05 * speed.max())
    assert (runs[1].first, runs[1].last) == (over[0], over[-1] + 1)


def test_what_is_not_drawn_is_still():
    drawing = np.ones(60, bool)
    drawing[20:40] = False
    runs = tokenize(motion(velocity=(0.0, 0.0, 0.2)), drawing=drawing)
    assert names(runs) == ["T_Z", "STILL", "T_Z"]
    assert (runs[1].first, runs[1].last) == (20, 40)


def test_a_motion_of_one_sample_or_none_is_tokenized():
    assert tokenize(motion(n=0)) == ()
    assert names(tokenize(motion(n=1, velocity=(0.0, 0.0, 1.0)))) == ["T_Z"]


def test_rest_is_one_still_run():
    rest = Doodle(np.arange(90) / 90.0, np.zeros((90, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (90, 1)))
    (run,) = tokenize(smooth(rest))
    assert (run.token, run.travel_heights, run.turn_rad) == (STILL, 0.0, 0.0)


def test_three_minutes_are_tokenized_in_a_fraction_of_a_second():
    rng = np.random.default_rng(0)
    velocity = np.cumsum(rng.normal(size=(10_800, 3)), axis=0) * 0.01
    turning = np.cumsum(rng.normal(size=(10_800, 3)), axis=0) * 0.05
    restless = motion(n=10_800, velocity=velocity, turning=turning)
    started = time.perf_counter()
    tokenize(restless)
    assert time.perf_counter() - started < 1.0  # 0.04 s on an idle machine
