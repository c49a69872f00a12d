from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from numpy.testing import assert_allclose

from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
)
from smd.smoothing import smooth


def uneven_times(rng: np.random.Generator, duration_s: float, rate_hz: float) -> np.ndarray:
    steps = rng.uniform(0.6, 1.4, int(duration_s * rate_hz)) / rate_hz
    return np.concatenate([[0.0], np.cumsum(steps)])


def cubic_doodle(t: np.ndarray, axis: np.ndarray) -> tuple[Doodle, list[np.ndarray]]:
    position = np.polynomial.Polynomial([0.1, -0.4, 0.8, -0.3])
    angle = np.polynomial.Polynomial([0.3, 2.0, -1.5, 0.4])
    truth = [position, *(position.deriv(k) for k in (1, 2, 3))]
    turning = [angle.deriv(k) for k in (1, 2, 3)]
    doodle = Doodle(t, position(t)[:, None] * [1.0, 2.0, -1.0], quaternion_about(axis, angle(t)))
    return doodle, [*truth, *turning]


def random_doodle(rng: np.random.Generator) -> Doodle:
    t = uneven_times(rng, 1.5, 90.0)
    position = np.cumsum(rng.normal(scale=0.005, size=(len(t), 3)), axis=0)
    q = [quaternion_from_rotvec(rng.normal(size=3))]
    for step in quaternion_from_rotvec(rng.normal(scale=0.05, size=(len(t) - 1, 3))):
        q.append(multiply(q[-1], step))
    return Doodle(t, position, np.array(q))


@pytest.mark.parametrize("rate_hz", [30.0, 60.0, 90.0])
def test_a_cubic_path_sampled_unevenly_comes_back_exactly_with_its_derivatives(rate_hz):
    rng = np.random.default_rng(3)
    axis = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])
    doodle, truth = cubic_doodle(uneven_times(rng, 1.2, 90.0), axis)
    motion = smooth(doodle, rate_hz=rate_hz)
    t = motion.time_s
    for got, polynomial in zip(
        (motion.position_m, motion.velocity_m_s, motion.acceleration_m_s2, motion.jerk_m_s3),
        truth[:4],
        strict=True,
    ):
        assert_allclose(got, polynomial(t)[:, None] * [1.0, 2.0, -1.0], rtol=1e-5, atol=1e-5)
    for got, polynomial in zip(
        (
            motion.angular_velocity_rad_s,
            motion.angular_acceleration_rad_s2,
            motion.angular_jerk_rad_s3,
        ),
        truth[4:],
        strict=True,
    ):
        assert_allclose(got, polynomial(t)[:, None] * axis, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("seed", range(10))
def test_moving_and_turning_the_world_moves_the_motion_and_changes_nothing_of_the_body(seed):
    rng = np.random.default_rng(seed)
    doodle = random_doodle(rng)
    turn, move = quaternion_from_rotvec(rng.normal(size=3)), rng.normal(size=3)
    moved = Doodle(
        doodle.time_s,
        rotate(turn, doodle.position_m) + move,
        multiply(turn, doodle.orientation_xyzw),
    )
    here, there = smooth(doodle), smooth(moved)
    assert_allclose(there.position_m, rotate(turn, here.position_m) + move, atol=1e-9)
    for name in ("velocity_m_s", "acceleration_m_s2", "jerk_m_s3"):
        assert_allclose(getattr(there, name), rotate(turn, getattr(here, name)), atol=1e-6)
    for name in ("velocity_rad_s", "acceleration_rad_s2", "jerk_rad_s3"):
        name = f"angular_{name}"
        assert_allclose(getattr(there, name), getattr(here, name), rtol=1e-7, atol=1e-5)
    off = multiply(inverse(multiply(turn, here.orientation_xyzw)), there.orientation_xyzw)
    assert_allclose(rotvec_from_quaternion(off), 0.0, atol=1e-9)


def test_time_is_even_and_starts_and_ends_with_the_doodle():
    rng = np.random.default_rng(0)
    doodle = random_doodle(rng)
    motion = smooth(doodle, rate_hz=60.0)
    assert motion.time_s[0] == doodle.time_s[0]
    assert_allclose(np.diff(motion.time_s), 1 / 60, rtol=1e-9)
    assert 0 <= doodle.time_s[-1] - motion.time_s[-1] < 1 / 60
    assert len(motion) == int(doodle.duration_s * 60.0) + 1


def test_a_last_period_is_not_lost_to_rounding():
    """0.29 s at 100 Hz is 28.999…96 periods."""
    t = np.linspace(0.0, 0.29, 30)
    q = np.tile([0.0, 0.0, 0.0, 1.0], (30, 1))
    assert len(smooth(Doodle(t, np.zeros((30, 3)), q), rate_hz=100.0)) == 30


def test_a_clock_that_counts_from_1970_costs_no_accuracy():
    doodle = random_doodle(np.random.default_rng(1))
    late = Doodle(np.round(doodle.time_s, 4) + 1.7e9, doodle.position_m, doodle.orientation_xyzw)
    here = smooth(Doodle(np.round(doodle.time_s, 4), doodle.position_m, doodle.orientation_xyzw))
    assert_allclose(smooth(late).velocity_m_s, here.velocity_m_s, atol=1e-3)


def test_stillness_gives_stillness():
    t = np.arange(200) / 90.0
    motion = smooth(Doodle(t, np.ones((200, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (200, 1))))
    for field in fields(motion)[3:]:
        assert np.abs(getattr(motion, field.name)).max() < 1e-8


def test_a_short_stroke_keeps_its_speed_and_a_tremor_fades():
    t = np.arange(180) / 90.0
    s = np.clip((t - 0.9) / 0.2, 0.0, 1.0)
    stroke = 0.3 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    identity = np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1))
    zero = np.zeros_like(t)
    motion = smooth(Doodle(t, np.stack([stroke, zero, zero], 1), identity))
    assert motion.velocity_m_s[:, 0].max() > 0.9 * 0.3 * 1.875 / 0.2
    tremor = 0.001 * np.sin(2 * np.pi * 10.0 * t)
    shaken = smooth(Doodle(t, np.stack([zero, tremor, zero], 1), identity))
    inside = shaken.velocity_m_s[10:-10, 1]
    assert np.abs(inside).max() < 0.1 * 0.001 * 2 * np.pi * 10.0


def test_all_samples_of_a_fast_sensor_take_part():
    rng = np.random.default_rng(5)
    identity = np.array([0.0, 0.0, 0.0, 1.0])
    left = {}
    for rate in (60, 240):
        t = np.arange(60 * rate) / rate
        noise = Doodle(t, rng.normal(size=(len(t), 3)), np.tile(identity, (len(t), 1)))
        left[rate] = smooth(noise).position_m[20:-20].var()
    assert_allclose(left[240] / left[60], (13 / 49), rtol=0.1)


def test_a_bridged_gap_is_crossed_straight_and_does_not_swing():
    rng = np.random.default_rng(6)
    t = np.arange(120) / 90.0
    keep = (t < 0.5) | (t > 0.7)
    position = rng.normal(scale=1e-3, size=(120, 3))
    q = quaternion_from_rotvec(rng.normal(scale=1e-3, size=(120, 3)))
    motion = smooth(Doodle(t[keep], position[keep], q[keep]))
    assert np.abs(motion.position_m).max() < 5e-3
    assert np.abs(rotvec_from_quaternion(motion.orientation_xyzw)).max() < 5e-3


@pytest.mark.parametrize("n", [2, 3, 4, 6, 9])
def test_doodles_shorter_than_the_window_are_smoothed_with_what_they_hold(n):
    t = np.linspace(0.0, 0.1, n)
    doodle = Doodle(t, np.outer(t, [1.0, 2.0, 3.0]), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)))
    assert_allclose(
        smooth(doodle).velocity_m_s, np.broadcast_to([1.0, 2.0, 3.0], (7, 3)), atol=1e-9
    )


@pytest.mark.parametrize("duration_s", [0.0, 0.05])
def test_a_doodle_too_short_for_a_cubic_is_refused_with_its_duration(duration_s):
    n = 1 if duration_s == 0.0 else 5
    t = 2.0 + np.linspace(0.0, duration_s, n)
    doodle = Doodle(t, np.zeros((n, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)))
    with pytest.raises(DoodleError) as caught:
        smooth(doodle)
    assert str(caught.value) == (
        f"device 'prop' at 2.000 s: expected a doodle of at least 0.067 s, got {duration_s:.3f} s"
    )


def test_absurd_times_are_refused_before_memory_runs_out():
    doodle = Doodle([0.0, 1e14], np.zeros((2, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)))
    with pytest.raises(DoodleError, match="at most 166667 s"):
        smooth(doodle)


@pytest.mark.parametrize("option", ["rate_hz", "window_s"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_options_that_are_not_positive_numbers_are_refused(option, value):
    doodle = random_doodle(np.random.default_rng(0))
    with pytest.raises(DoodleError, match=f"{option}: expected a positive number"):
        smooth(doodle, **{option: value})
