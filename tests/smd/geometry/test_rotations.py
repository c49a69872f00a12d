from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation, Slerp

from smd.geometry import rotations as ours

SEEDS = range(5)


def some(seed: int, n: int = 50) -> Rotation:
    """Rotations with identity and half turns among them."""
    special = [[0, 0, 0], [np.pi, 0, 0], [0, 0, -np.pi], [1e-9, 0, 0]]
    return Rotation.concatenate(
        [Rotation.random(n, random_state=seed), Rotation.from_rotvec(special)]
    )


def assert_same_rotation(q: np.ndarray, theirs: Rotation) -> None:
    assert_allclose(np.abs(np.sum(q * theirs.as_quat(), axis=-1)), 1.0, atol=1e-12)
    assert_allclose(np.linalg.norm(q, axis=-1), 1.0, atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_products_inverses_and_turned_vectors_agree_with_scipy(seed):
    a, b = some(seed), some(seed + 100)
    v = np.random.default_rng(seed).normal(size=(len(a), 3))
    assert_same_rotation(ours.multiply(a.as_quat(), b.as_quat()), a * b)
    assert_same_rotation(ours.inverse(a.as_quat()), a.inv())
    assert_allclose(ours.rotate(a.as_quat(), v), a.apply(v), atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_rotation_vectors_and_matrices_agree_with_scipy(seed):
    a = some(seed)
    q = a.as_quat()
    r = ours.rotvec_from_quaternion(q)
    assert (np.linalg.norm(r, axis=-1) <= np.pi + 1e-12).all()
    assert_same_rotation(ours.quaternion_from_rotvec(r), a)
    assert_same_rotation(ours.quaternion_from_rotvec(a.as_rotvec()), a)
    assert_allclose(ours.matrix_from_quaternion(q), a.as_matrix(), atol=1e-12)


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "YXZ", "ZXZ", "xyz"])
def test_euler_angles_agree_with_scipy_over_any_leading_axes(order):
    angles = np.random.default_rng(1).uniform(-3, 3, size=(2, 5, 3))
    expected = Rotation.from_euler(order, angles.reshape(-1, 3))
    got = ours.quaternion_from_euler(order, angles)
    assert got.shape == (2, 5, 4)
    assert_same_rotation(got.reshape(-1, 4), expected)


@pytest.mark.parametrize("seed", SEEDS)
def test_slerp_agrees_with_scipy(seed):
    pair = Rotation.random(2, random_state=seed)
    fraction = np.linspace(0.0, 1.0, 11)
    start, end = pair.as_quat()
    got = ours.slerp(np.tile(start, (11, 1)), np.tile(-end, (11, 1)), fraction)
    assert_same_rotation(got, Slerp([0.0, 1.0], pair)(fraction))


def test_every_function_takes_leading_axes_of_any_number():
    q = Rotation.random(12, random_state=0).as_quat()
    v = np.random.default_rng(0).normal(size=(12, 3))
    whole = ours.rotate(q.reshape(3, 4, 4), v.reshape(3, 4, 3))
    assert_allclose(whole.reshape(12, 3), ours.rotate(q, v))
    assert_allclose(
        ours.rotvec_from_quaternion(q.reshape(3, 4, 4)).reshape(12, 3),
        ours.rotvec_from_quaternion(q),
    )
    assert_allclose(ours.matrix_from_quaternion(q[0]), ours.matrix_from_quaternion(q)[0])


@pytest.mark.parametrize("seed", SEEDS)
def test_the_turn_between_two_directions_is_the_shortest(seed):
    a, b = np.random.default_rng(seed).normal(size=(2, 20, 3))
    q = ours.quaternion_between(a, b)
    assert_allclose(ours.rotate(q, ours.normalized(a)), ours.normalized(b), atol=1e-12)
    angle = np.arccos(np.clip(np.sum(ours.normalized(a) * ours.normalized(b), axis=-1), -1, 1))
    got = np.linalg.norm(ours.rotvec_from_quaternion(q), axis=-1)
    assert_allclose(got, angle, atol=1e-7)


@pytest.mark.parametrize("axis", np.vstack([np.eye(3), -np.eye(3), [[0.6, 0.8, 0.0]]]))
def test_the_turn_to_the_opposite_direction_is_half_a_turn(axis):
    q = ours.quaternion_between(axis, -axis)
    assert_allclose(ours.rotate(q, axis), -axis, atol=1e-12)


def test_signs_become_continuous_and_rotations_stay():
    q = Rotation.from_rotvec(np.linspace(0, 7, 50)[:, None] * [0.0, 1.0, 0.0]).as_quat()
    flipped = q * np.random.default_rng(0).choice([-1.0, 1.0], 50)[:, None]
    got = ours.sign_continuous(flipped)
    assert (np.sum(got[1:] * got[:-1], axis=1) > 0).all()
    assert_allclose(np.abs(np.sum(got * q, axis=1)), 1.0)
    assert_array_equal(got[0], flipped[0])


def test_normalizing_keeps_zero_and_direction():
    assert_array_equal(ours.normalized([[0, 0, 0], [0, -2, 0]]), [[0, 0, 0], [0, -1, 0]])


@pytest.mark.parametrize("angle", np.linspace(-3.0, 3.0, 13))
def test_heading_is_the_turn_about_up_whatever_the_prop_does_besides(angle):
    turned = ours.quaternion_about([0, 1, 0], angle)
    assert_allclose(ours.heading_rad(turned), angle, atol=1e-12)
    nodding = ours.multiply(turned, ours.quaternion_about([1, 0, 0], 0.7))
    assert_allclose(ours.heading_rad(nodding), angle, atol=1e-12)
    rolling = ours.multiply(turned, ours.quaternion_about([0, 0, 1], 1.2))
    assert_allclose(ours.heading_rad(rolling), angle, atol=1e-12)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_a_front_straight_up_or_down_keeps_the_heading_it_came_with(pitch):
    q = ours.multiply(
        ours.quaternion_about([0, 1, 0], 0.8), ours.quaternion_about([1, 0, 0], pitch)
    )
    assert_allclose(ours.heading_rad(q), 0.8, atol=1e-6)
