from __future__ import annotations

import numpy as np
import pytest

from smd.geometry.easing import eased_clock, fading, gaussian_smoothed, smootherstep

TINY = 1e-6


def test_smootherstep_rises_from_0_to_1_with_both_ends_at_rest():
    assert smootherstep([-1.0, 0.0, 0.5, 1.0, 2.0]).tolist() == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert smootherstep(TINY) < 1e-11
    assert 1.0 - smootherstep(1.0 - TINY) < 1e-11
    assert (np.diff(smootherstep(np.linspace(0.0, 1.0, 101))) > 0).all()


def test_a_fading_speed_begins_at_1_and_ends_at_rest_where_it_began():
    assert fading(0.0) == 0.0
    assert fading(TINY) / TINY == pytest.approx(1.0, abs=1e-5)
    assert fading([1.0, 1.5]).tolist() == [0.0, 0.0]
    assert abs(fading(1.0 - TINY)) < 1e-11


def test_smoothing_keeps_a_straight_line_and_the_ends_of_any_curve():
    line = np.stack([np.linspace(0.0, 3.0, 50), np.linspace(5.0, -1.0, 50)], axis=-1)
    assert gaussian_smoothed(line, 4.0) == pytest.approx(line, abs=1e-12)
    curve = np.random.default_rng(0).normal(size=80)
    smoothed = gaussian_smoothed(curve, 3.0)
    assert smoothed[[0, -1]] == pytest.approx(curve[[0, -1]], abs=1e-12)


def test_smoothing_damps_a_wave_as_a_gaussian_does():
    frame = np.arange(400)
    wave, sigma = 2.0 * np.pi / 20.0, 3.0
    smoothed = gaussian_smoothed(np.cos(wave * frame), sigma)[100:300]
    damped = np.exp(-0.5 * (wave * sigma) ** 2) * np.cos(wave * frame[100:300])
    # Cut at three sigma, a Gaussian lacks 0.27 % of its weight.
    assert smoothed == pytest.approx(damped, abs=2.7e-3)


@pytest.mark.parametrize("n", [1, 2, 3, 5])
def test_smoothing_leaves_a_short_curve_finite(n):
    assert np.isfinite(gaussian_smoothed(np.arange(float(n)), 10.0)).all()


@pytest.mark.parametrize(("rise_s", "fall_s"), [(0.0, 0.0), (0.3, 0.0), (0.0, 0.2), (0.5, 0.4)])
def test_an_eased_clock_runs_from_start_to_end_and_rests_where_it_should(rise_s, fall_s):
    time_s = np.linspace(2.0, 5.0, 3001)
    clock_s = eased_clock(time_s, rise_s, fall_s)
    assert clock_s[[0, -1]] == pytest.approx([2.0, 5.0])
    pace = np.diff(clock_s) / np.diff(time_s)
    assert (pace > -1e-12).all()
    assert (pace[0] < 0.01) == (rise_s > 0.0)
    assert (pace[-1] < 0.01) == (fall_s > 0.0)
    assert pace.max() == pytest.approx(3.0 / (3.0 - 0.5 * (rise_s + fall_s)), rel=1e-3)
