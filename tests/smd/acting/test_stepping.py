from __future__ import annotations

import numpy as np
import pytest

from smd.acting.stepping import stepping

RATE_HZ, N = 60.0, 300
LEFT_M = np.array([0.1, -0.1])


def turned_by(angle_rad: float, first: int = 120, last: int = 180):
    """Two feet 0.2 m apart whose body turns over them."""
    yaw = angle_rad * np.clip((np.arange(N) - first) / (last - first), 0.0, 1.0)
    place = np.stack([0.1 * np.cos(yaw), -0.1 * np.sin(yaw)], axis=-1)
    return np.stack([place, -place], axis=1), np.stack([yaw, yaw], axis=-1)


def standing():
    return np.ones((N, 2), dtype=bool)


def runs(off: np.ndarray) -> int:
    return int((np.diff(np.concatenate([[0], off.astype(int)])) == 1).sum())


def test_feet_that_are_left_in_peace_stay():
    place, yaw = turned_by(0.0)
    stands, lift = stepping(place, yaw, standing(), LEFT_M, RATE_HZ)
    assert stands.all()
    assert not lift.any()


def test_feet_stay_under_a_body_that_hardly_turns():
    stands, _ = stepping(*turned_by(np.radians(15.0)), standing(), LEFT_M, RATE_HZ)
    assert stands.all()


@pytest.mark.parametrize(("angle_deg", "each"), [(60, 1), (-90, 1), (150, 2), (-250, 3)])
def test_a_turn_is_stepped_one_foot_after_the_other(angle_deg, each):
    place, yaw = turned_by(np.radians(angle_deg))
    stands, lift = stepping(place, yaw, standing(), LEFT_M, RATE_HZ)
    assert stands.any(axis=1).all()
    assert [runs(~stands[:, leg]) for leg in (0, 1)] == [each, each]
    assert ((lift > 0.0) <= ~stands).all()
    first = int(np.argmin(stands.all(axis=1)))
    assert not stands[first, 0 if angle_deg > 0 else 1]


def test_a_foot_that_need_not_step_does_not():
    place, yaw = turned_by(0.0)
    place[:, 0, 0] += 0.2 * np.clip((np.arange(N) - 120) / 30, 0.0, 1.0)
    stands, _ = stepping(place, yaw, standing(), LEFT_M, RATE_HZ)
    assert runs(~stands[:, 0]) == 1
    assert stands[:, 1].all()


def test_a_clip_s_own_steps_are_left_to_it():
    place, yaw = turned_by(1.5)
    given = standing()
    given[110:150, 0] = given[150:190, 1] = False
    stands, lift = stepping(place, yaw, given, LEFT_M, RATE_HZ)
    assert (stands == given).all()
    assert not lift.any()


@pytest.mark.parametrize("n", [0, 1])
def test_no_time_and_no_legs_are_no_trouble(n):
    for legs in (0, 2):
        shape = (n, legs)
        stands, lift = stepping(
            np.zeros((*shape, 2)), np.zeros(shape), np.ones(shape, bool), np.zeros(legs), RATE_HZ
        )
        assert stands.shape == lift.shape == shape
