from __future__ import annotations

import numpy as np
import pytest

from smd.acting.footing import CLEARANCE_M, footing
from smd.acting.legs import legs_of
from smd.geometry.rotations import multiply, quaternion_about, rotate

RATE_HZ = 60.0
N = 90


@pytest.fixture(scope="module")
def leg(skeleton):
    return legs_of(skeleton, [4])[0]


@pytest.fixture
def flat(leg):
    """A foot that stands flat at its place for 90 frames."""
    q = np.tile([0.0, 0.0, 0.0, 1.0], (N, 1))
    return q, np.tile([0.1, 0.05, 0.0], (N, 1))


def lifted(ankle, start, end, height_m=0.1):
    """The same, lifted between two frames."""
    ankle = ankle.copy()
    ankle[start:end, 1] += height_m * np.sin(np.linspace(0.0, np.pi, end - start)) ** 2
    return ankle


def put(leg, q, ankle, step):
    """Where heel and ball are once the footing is applied."""
    q = multiply(quaternion_about([0.0, 1.0, 0.0], step.turn_rad), q)
    ankle = ankle + step.shift_m
    return ankle + rotate(q, leg.heel_m), ankle + rotate(q, leg.ball_m)


def zero():
    return np.zeros(N)


def test_a_foot_that_stands_still_is_left_alone(leg, flat):
    q, ankle = flat
    step = footing(leg, q, ankle, np.ones(N, bool), zero(), zero(), RATE_HZ)
    assert step.stands.all()
    assert step.shift_m == pytest.approx(np.zeros((N, 3)), abs=1e-12)
    assert step.turn_rad == pytest.approx(np.zeros(N), abs=1e-12)


@pytest.mark.parametrize("velocity", [(0.8, 0.0), (-0.3, 1.2)])
def test_a_sliding_foot_stands_still_in_the_middle_of_its_slide(leg, flat, velocity):
    q, ankle = flat
    ankle = ankle + np.arange(N)[:, None] / RATE_HZ * [velocity[0], 0.0, velocity[1]]
    step = footing(leg, q, ankle, np.ones(N, bool), zero(), zero(), RATE_HZ)
    for point, raw in zip(put(leg, q, ankle, step), (leg.heel_m, leg.ball_m), strict=True):
        assert np.ptp(point, axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
        assert point[0] == pytest.approx(ankle.mean(axis=0) + raw, abs=1e-9)


def test_a_foot_that_slides_at_first_stands_where_it_comes_to_rest(leg, flat):
    q, ankle = flat
    ankle = ankle + np.minimum(np.arange(N) - 20, 0)[:, None] / RATE_HZ * [0.0, 0.0, 2.0]
    step = footing(leg, q, ankle, np.ones(N, bool), zero(), zero(), RATE_HZ)
    heel, _ = put(leg, q, ankle, step)
    assert heel[0] == pytest.approx(ankle[-1] + leg.heel_m, abs=2e-3)


def test_a_twisting_foot_stands_still(leg, flat):
    q, ankle = flat
    q = quaternion_about([0.0, 1.0, 0.0], np.linspace(-0.4, 0.6, N))
    step = footing(leg, q, ankle, np.ones(N, bool), zero(), zero(), RATE_HZ)
    for point in put(leg, q, ankle, step):
        assert np.ptp(point, axis=0) == pytest.approx(np.zeros(3), abs=1e-9)


def test_a_foot_that_pivots_by_its_clip_s_own_will_pivots_on(leg, flat):
    _, ankle = flat
    pivot = np.linspace(-0.4, 0.6, N)
    q = quaternion_about([0.0, 1.0, 0.0], pivot)
    step = footing(leg, q, ankle, np.ones(N, bool), pivot, zero(), RATE_HZ)
    assert step.turn_rad == pytest.approx(np.zeros(N), abs=1e-12)


def test_a_foot_that_rolls_over_its_ball_keeps_rolling(leg, flat):
    _, ankle = flat
    pitch = np.radians(50.0) * np.linspace(0.0, 1.0, N) ** 2
    q = quaternion_about([1.0, 0.0, 0.0], pitch)
    ankle = ankle + leg.ball_m - rotate(q, leg.ball_m)
    step = footing(leg, q, ankle, np.ones(N, bool), zero(), zero(), RATE_HZ)
    assert np.abs(step.shift_m).max() < 1e-3


def test_a_foot_in_the_ground_is_lifted_onto_it(leg, flat):
    q, ankle = flat
    for stands in (np.ones(N, bool), np.zeros(N, bool)):
        step = footing(leg, q, ankle - [0.0, 0.03, 0.0], stands, zero(), zero(), RATE_HZ)
        assert (ankle[:, 1] - 0.03 + step.shift_m[:, 1]).min() > 0.05 - 0.02


def test_a_swing_leads_smoothly_from_one_stand_to_the_next(leg, flat):
    q, ankle = flat
    ankle = lifted(ankle, 30, 60) + np.arange(N)[:, None] / RATE_HZ * [0.5, 0.0, 0.0]
    stands = np.ones(N, bool)
    stands[30:60] = False
    step = footing(leg, q, ankle, stands, zero(), zero(), RATE_HZ)
    place = (ankle + step.shift_m)[:, [0, 2]]
    assert np.ptp(place[:30], axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
    assert np.ptp(place[60:], axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)
    steps = np.diff(place[:, 0])
    assert (steps > -1e-9).all()
    assert steps.max() * RATE_HZ < 3.0 * (0.5 * 1.5 / 0.5)
    assert np.abs(np.diff(steps)).max() * RATE_HZ**2 < 60.0


def test_a_low_swing_clears_the_ground(leg, flat):
    q, ankle = flat
    stands = np.ones(N, bool)
    stands[30:60] = False
    step = footing(leg, q, ankle, stands, zero(), zero(), RATE_HZ)
    assert step.shift_m[45, 1] > 0.95 * CLEARANCE_M
    assert step.shift_m[[29, 60], 1] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_foot_high_above_the_ground_does_not_stand_whatever_it_is_told(leg, flat):
    q, ankle = flat
    high = ankle + np.array([0.0, 0.3, 0.0])
    step = footing(leg, q, high, np.ones(N, bool), zero(), zero(), RATE_HZ)
    assert not step.stands.any()
    assert step.shift_m == pytest.approx(np.zeros((N, 3)))
