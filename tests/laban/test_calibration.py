from __future__ import annotations

import numpy as np
import pytest

from laban.calibration import fit_calibration


def readings(calibration, low=-50.0, high=50.0):
    return np.array([calibration.value(x) for x in np.linspace(low, high, 201)])


@pytest.mark.parametrize("seed", range(10))
def test_readings_never_fall_as_log_odds_rise_and_stay_within_the_poles(seed):
    rng = np.random.default_rng(seed)
    meant = rng.choice([-1.0, 0.0, 1.0], 70)
    values = readings(fit_calibration(rng.normal(3.0 * meant, 10.0), meant))
    assert (np.diff(values) >= 0).all()
    assert np.abs(values).max() < 1.0


def test_log_odds_that_were_too_sure_are_read_as_often_right_as_they_are():
    rng = np.random.default_rng(0)
    chance = rng.uniform(0.05, 0.95, 20_000)
    meant = np.where(rng.random(len(chance)) < chance, 1.0, -1.0)
    calibration = fit_calibration(20.0 * np.log(chance / (1.0 - chance)), meant)
    for p in (0.2, 0.5, 0.8):
        found = calibration.value(20.0 * np.log(p / (1.0 - p)))
        assert found == pytest.approx(2.0 * p - 1.0, abs=0.03)


def test_the_sign_stays():
    rng = np.random.default_rng(3)
    meant = np.repeat([1.0, -1.0], 40)
    values = readings(fit_calibration(rng.normal(2.0 + meant, 1.0), meant))
    assert (np.sign(values) == np.sign(np.linspace(-50.0, 50.0, 201))).all()


def test_useless_log_odds_are_read_as_nothing():
    rng = np.random.default_rng(1)
    meant = rng.choice([-1.0, 1.0], 5000)
    assert np.abs(readings(fit_calibration(rng.normal(size=5000), meant), -1, 1)).max() < 0.15


def test_misleading_log_odds_are_hardly_followed():
    meant = np.repeat([1.0, -1.0], 40)
    assert np.abs(readings(fit_calibration(np.linspace(-9, 9, 80), meant), -9, 9)).max() < 0.1


def test_neutral_takes_between_two_clear_poles_read_near_zero():
    rng = np.random.default_rng(2)
    meant = np.repeat([-1.0, 0.0, 1.0], 60)
    calibration = fit_calibration(rng.normal(20.0 * meant, 1.0), meant)
    assert calibration.value(0.0) == pytest.approx(0.0, abs=0.1)
    assert calibration.value(-20.0) < -0.8
    assert calibration.value(20.0) > 0.8


def test_few_takes_leave_room_for_doubt():
    """Four takes, all told right, against a hundred."""
    odds, meant = np.array([-0.6, -0.3, 0.3, 0.6]), np.array([-1.0, -1.0, 1.0, 1.0])
    few, many = fit_calibration(odds, meant), fit_calibration(np.tile(odds, 25), np.tile(meant, 25))
    assert 0.0 < few.value(0.5) < many.value(0.5) < 1.0
