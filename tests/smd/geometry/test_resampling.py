from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation, Slerp

from smd.geometry.cubic import (
    MOST_NOISE_GAIN,
    interpolate_cubic,
    interpolate_rotation_cubic,
)
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
)


def uneven(seed: int, n: int = 30) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).uniform(0.6, 1.4, n))


@pytest.mark.parametrize("seed", range(3))
def test_linear_interpolation_agrees_with_numpy_and_holds_the_ends(seed):
    t = uneven(seed)
    value = np.random.default_rng(seed).normal(size=(30, 2))
    at = np.linspace(t[0] - 1, t[-1] + 1, 77)
    expected = np.stack([np.interp(at, t, value[:, i]) for i in range(2)], axis=1)
    assert_allclose(interpolate_linear(t, value, at), expected, atol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_rotations_agree_with_scipys_slerp_and_hold_the_ends(seed):
    t = uneven(seed)
    theirs = Rotation.random(30, random_state=seed)
    at = np.linspace(t[0], t[-1], 77)
    got = interpolate_rotation(t, theirs.as_quat(), at)
    assert_allclose(np.abs(np.sum(got * Slerp(t, theirs)(at).as_quat(), axis=1)), 1.0)
    outside = interpolate_rotation(t, theirs.as_quat(), [t[0] - 1, t[-1] + 1])
    held = np.abs(np.sum(outside * theirs.as_quat()[[0, -1]], axis=1))
    assert_allclose(held, 1.0)


def test_one_sample_is_held_everywhere():
    assert_allclose(interpolate_linear([1.0], [[2.0, 3.0]], [0.0, 5.0]), [[2, 3], [2, 3]])


@pytest.mark.parametrize("seed", range(5))
def test_cubics_are_exact_on_cubics_at_uneven_times(seed):
    t = uneven(seed) / 30
    at = np.linspace(t[0], t[-1], 101)
    polynomial = np.polynomial.Polynomial(np.random.default_rng(seed).normal(size=4))
    got = interpolate_cubic(t, polynomial(t)[:, None], at)[:, 0]
    assert_allclose(got, polynomial(at), atol=1e-12)
    q = quaternion_about([0.6, 0.0, 0.8], polynomial(t))
    off = multiply(
        inverse(quaternion_about([0.6, 0.0, 0.8], polynomial(at))),
        interpolate_rotation_cubic(t, q, at),
    )
    assert_allclose(rotvec_from_quaternion(off), 0.0, atol=1e-7)


def test_cubics_beat_straight_lines_on_a_curve_by_two_orders():
    t = uneven(0, 60) / 60
    at = np.linspace(t[2], t[-3], 200)
    truth = np.sin(2 * np.pi * at)
    wave = np.sin(2 * np.pi * t)[:, None]
    straight = np.abs(interpolate_linear(t, wave, at)[:, 0] - truth).max()
    cubic = np.abs(interpolate_cubic(t, wave, at)[:, 0] - truth).max()
    assert cubic < straight / 100


@pytest.mark.parametrize("seed", range(5))
def test_samples_are_met_and_turning_the_world_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    t = uneven(seed)
    q = Rotation.from_rotvec(np.cumsum(rng.normal(scale=0.1, size=(30, 3)), axis=0)).as_quat()
    met = multiply(inverse(q), interpolate_rotation_cubic(t, q, t))
    assert_allclose(rotvec_from_quaternion(met), 0.0, atol=1e-9)
    world = Rotation.random(random_state=seed).as_quat()
    at = np.linspace(t[0], t[-1], 50)
    before = multiply(world, interpolate_rotation_cubic(t, q, at))
    after = interpolate_rotation_cubic(t, multiply(world, q), at)
    assert_allclose(rotvec_from_quaternion(multiply(inverse(before), after)), 0.0, atol=1e-9)


def test_beside_a_gap_noise_is_bounded():
    """A cubic through four samples around a gap of 20 steps would swing ten times as far."""
    rng = np.random.default_rng(0)
    t = np.r_[0:20, 40:60].astype(float)
    noise = rng.uniform(-1, 1, size=(40, 3))
    at = np.linspace(0, 59, 500)
    assert np.abs(interpolate_cubic(t, noise, at)).max() < 1.2 * MOST_NOISE_GAIN
    turned = interpolate_rotation_cubic(t, quaternion_from_rotvec(0.01 * noise), at)
    assert np.linalg.norm(rotvec_from_quaternion(turned), axis=1).max() < 0.06
