from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import savgol_filter
from scipy.spatial.transform import Rotation

from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
)
from smd.geometry.savgol import body_rates, fit_weights, smooth_rotations, smooth_values

STEP_S = 1 / 60


def cubic_derivatives(coefficients: np.ndarray, t: np.ndarray) -> list[np.ndarray]:
    """Value and three derivatives of a polynomial, by NumPy's own class."""
    polynomial = np.polynomial.Polynomial(coefficients)
    return [polynomial(t), *(polynomial.deriv(k)(t) for k in (1, 2, 3))]


@pytest.mark.parametrize("half", [2, 6, 11])
@pytest.mark.parametrize("stride", [1, 3])
def test_cubic_positions_and_their_derivatives_come_back_exactly_ends_included(half, stride):
    rng = np.random.default_rng(half)
    t = np.arange(40) * STEP_S
    columns = [cubic_derivatives(rng.normal(size=4), t) for _ in range(3)]
    truth = np.stack(columns, axis=-1)
    got = smooth_values(truth[0], STEP_S, half, stride)
    for derivative in range(4):
        assert_allclose(got[derivative], truth[derivative][::stride], rtol=1e-6, atol=1e-6)


def test_values_agree_with_scipy_inside_and_at_the_ends():
    value = np.random.default_rng(0).normal(size=(50, 3))
    got = smooth_values(value, STEP_S, 5)
    for derivative in range(4):
        theirs = savgol_filter(value, 11, 3, deriv=derivative, delta=STEP_S, axis=0, mode="interp")
        assert_allclose(got[derivative], theirs, rtol=1e-8, atol=1e-8)


def test_white_noise_is_reduced_by_the_ratio_of_theory():
    """Variance of a cubic (or quadratic) fit at the centre of 2m + 1 samples (Savitzky, Golay)."""
    for m in (3, 6, 9):
        ratio = 3 * (3 * m**2 + 3 * m - 1) / ((2 * m - 1) * (2 * m + 1) * (2 * m + 3))
        assert_allclose(np.sum(fit_weights(m)[0] ** 2), ratio, rtol=1e-12)
    noise = np.random.default_rng(1).normal(size=(40_000, 3))
    smoothed = smooth_values(noise, STEP_S, 6)[0]
    expected = 3 * (3 * 36 + 18 - 1) / (11 * 13 * 15)
    assert_allclose(smoothed.var() / noise.var(), expected, rtol=0.03)


def test_noise_of_rotations_is_reduced_by_the_same_ratio():
    rng = np.random.default_rng(2)
    sigma = 1e-3
    noisy = quaternion_from_rotvec(rng.normal(scale=sigma, size=(40_000, 3)))
    left = rotvec_from_quaternion(smooth_rotations(noisy, STEP_S, 6).orientation_xyzw)
    assert_allclose(left.var() / sigma**2, 3 * (3 * 36 + 18 - 1) / (11 * 13 * 15), rtol=0.03)


@pytest.mark.parametrize("seed", range(5))
def test_cubic_angles_about_one_axis_come_back_exactly_ends_included(seed):
    rng = np.random.default_rng(seed)
    t = np.arange(60) * STEP_S
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = cubic_derivatives(rng.normal(scale=[1.0, 6.0, 5.0, 3.0]), t)
    start = Rotation.random(random_state=seed).as_quat()
    q = multiply(start, quaternion_about(axis, angle[0]))
    got = smooth_rotations(q, STEP_S, 6)
    off = multiply(inverse(q), got.orientation_xyzw)
    assert_allclose(rotvec_from_quaternion(off), 0.0, atol=1e-9)
    for ours, theirs in zip(got[1:], angle[1:], strict=True):
        assert_allclose(ours, theirs[:, None] * axis, rtol=1e-6, atol=1e-5)


def test_a_spin_of_nearly_a_turn_per_half_window_is_followed():
    rate_rad_s = 0.95 * 2 * np.pi / (6 * STEP_S)
    q = quaternion_about([0.0, 1.0, 0.0], np.arange(60) * STEP_S * rate_rad_s)
    assert_allclose(smooth_rotations(q, STEP_S, 6).velocity_rad_s[:, 1], rate_rad_s, rtol=1e-9)


@pytest.mark.parametrize("seed", range(10))
def test_turning_the_world_turns_the_rotations_and_nothing_else(seed):
    rng = np.random.default_rng(seed)
    steps = quaternion_from_rotvec(rng.normal(scale=0.1, size=(50, 3)))
    q = [np.array([0.0, 0.0, 0.0, 1.0])]
    for step in steps:
        q.append(multiply(q[-1], step))
    world = Rotation.random(random_state=seed).as_quat()
    before = smooth_rotations(np.array(q), STEP_S, 5)
    after = smooth_rotations(multiply(world, np.array(q)), STEP_S, 5)
    same = multiply(inverse(multiply(world, before.orientation_xyzw)), after.orientation_xyzw)
    assert_allclose(rotvec_from_quaternion(same), 0.0, atol=1e-9)
    for ours, theirs in zip(after[1:], before[1:], strict=True):
        assert_allclose(ours, theirs, rtol=1e-8, atol=1e-6)


def precession(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A spinning top: its orientation, and its body angular velocity in closed form."""
    turn, tilt, spin = 3.0, 0.6, 5.0
    q = Rotation.from_euler(
        "ZXZ", np.stack([turn * t, np.full_like(t, tilt), spin * t], axis=1)
    ).as_quat()
    omega = np.stack(
        [
            turn * np.sin(tilt) * np.sin(spin * t),
            turn * np.sin(tilt) * np.cos(spin * t),
            np.full_like(t, turn * np.cos(tilt) + spin),
        ],
        axis=1,
    )
    return q, omega


def test_a_precession_gets_its_closed_form_angular_velocity_and_derivatives():
    step_s = 1 / 500
    t = np.arange(400) * step_s
    q, omega = precession(t)
    fine = 1e-4
    alpha = (precession(t + fine)[1] - precession(t - fine)[1]) / (2 * fine)
    jerk = (precession(t + fine)[1] - 2 * omega + precession(t - fine)[1]) / fine**2
    got = smooth_rotations(q, step_s, 8)
    inside = slice(8, -8)
    assert_allclose(got.velocity_rad_s[inside], omega[inside], atol=1e-4)
    assert_allclose(got.acceleration_rad_s2[inside], alpha[inside], atol=0.02)
    assert_allclose(got.jerk_rad_s3[inside], jerk[inside], atol=0.5)
    assert_allclose(got.velocity_rad_s, omega, atol=0.01)  # the ends, one-sided


def test_body_rates_of_a_polynomial_rotation_vector_match_fine_differences():
    """Rotation vectors as large as the ends of a fast window have them, tiny ones included."""
    rng = np.random.default_rng(4)
    for size in (0.0, 1e-9, 0.1, 1.5, 4.0):
        start, *rates = rng.normal(size=(4, 3))
        coefficients = [size * start / np.linalg.norm(start), *rates]

        def phi(t, coefficients=coefficients):
            return sum(c * t**k for k, c in enumerate(coefficients))

        def omega(t, phi=phi, h=1e-5):
            q = [quaternion_from_rotvec(phi(t + s)) for s in (-h, h)]
            return rotvec_from_quaternion(multiply(inverse(q[0]), q[1])) / (2 * h)

        c0, c1, c2, c3 = (np.array([c]) for c in coefficients)
        velocity, acceleration, jerk = body_rates(c0, c1, 2 * c2, 6 * c3)
        h = 1e-3
        assert_allclose(velocity[0], omega(0.0), rtol=1e-6, atol=1e-6)
        assert_allclose(acceleration[0], (omega(h) - omega(-h)) / (2 * h), rtol=1e-3, atol=1e-3)
        second = (omega(h) - 2 * omega(0.0) + omega(-h)) / h**2
        assert_allclose(jerk[0], second, rtol=1e-2, atol=1e-2)


def test_smoothed_rotations_are_the_measured_ones_where_those_are_smooth():
    q, _ = precession(np.arange(100) * STEP_S)
    off = multiply(inverse(q), smooth_rotations(q, STEP_S, 3).orientation_xyzw)
    assert np.abs(rotvec_from_quaternion(off)).max() < 2e-3
    assert_allclose(rotate(off, [0.0, 0.0, 1.0])[:, 2], 1.0, atol=1e-5)


@pytest.mark.parametrize(("n", "half"), [(10, 6), (4, 2), (10, 1)])
def test_a_window_that_does_not_fit_is_refused(n, half):
    with pytest.raises(ValueError, match="expected 5 or more"):
        smooth_values(np.zeros((n, 3)), STEP_S, half)
