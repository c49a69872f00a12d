from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.curves import eased, smooth_curve

RATE_HZ = 60.0


def test_a_curve_starts_and_ends_at_rest_on_its_first_and_last_key():
    curve = smooth_curve([0.0, 0.5, 1.0], [[0.0], [1.0], [3.0]], 61, RATE_HZ, lag_s=0.04)
    assert curve[[0, -1], 0] == pytest.approx([0.0, 3.0], abs=2e-3)
    assert np.abs(np.diff(curve[:2, 0])).max() < 2e-3
    assert np.abs(np.diff(curve[-2:, 0])).max() < 4e-3


@pytest.mark.parametrize("seed", range(5))
def test_a_curve_never_leaves_the_range_of_its_keys(seed):
    rng = np.random.default_rng(seed)
    value = rng.normal(size=(8, 2))
    curve = smooth_curve(np.linspace(0.0, 2.0, 8), value, 121, RATE_HZ)
    assert (curve >= value.min(axis=0) - 1e-12).all()
    assert (curve <= value.max(axis=0) + 1e-12).all()


def test_a_cyclic_curve_closes_in_value_and_speed():
    curve = smooth_curve([0.0, 0.3, 0.7], [[0.0], [2.0], [-1.0]], 61, RATE_HZ, cyclic=True)
    assert curve[-1, 0] == pytest.approx(curve[0, 0], abs=1e-9)
    around = np.diff(np.concatenate([curve[-3:-1, 0], curve[:3, 0]]), 2)
    assert np.abs(around).max() < np.abs(np.diff(curve[:, 0], 2)).max() * 1.01


def test_a_cyclic_curve_does_not_depend_on_where_the_cycle_is_cut():
    key, value = np.array([0.1, 0.4, 0.8]), np.array([[0.0], [2.0], [-1.0]])
    whole = smooth_curve(key, value, 61, RATE_HZ, cyclic=True)[:-1]

    order = np.argsort((key + 0.5) % 1.0)
    moved = smooth_curve(((key + 0.5) % 1.0)[order], value[order], 61, RATE_HZ, cyclic=True)[:-1]
    np.testing.assert_allclose(np.roll(whole, 30, axis=0), moved, atol=1e-9)


def test_a_lag_shifts_a_cycle_in_time():
    key, value = [0.0, 0.3, 0.7], [[0.0], [2.0], [-1.0]]
    prompt = smooth_curve(key, value, 61, RATE_HZ, cyclic=True)[:-1]
    late = smooth_curve(key, value, 61, RATE_HZ, cyclic=True, lag_s=0.1)[:-1]
    np.testing.assert_allclose(np.roll(prompt, 6, axis=0), late, atol=1e-9)


def test_one_key_is_held():
    assert (smooth_curve([0.4], [[1.0, 2.0]], 10, RATE_HZ) == [1.0, 2.0]).all()


def test_the_eased_way_has_no_speed_or_acceleration_at_its_ends():
    u = np.array([-1.0, 0.0, 1e-3, 0.5, 1.0 - 1e-3, 1.0, 2.0])
    way = eased(u)
    assert way[[0, 1, 3, 5, 6]].tolist() == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert way[2] < 2e-8
    assert 1.0 - way[4] < 2e-8
