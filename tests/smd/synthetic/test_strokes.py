from __future__ import annotations

import numpy as np
import pytest

from smd.synthetic.strokes import progress

U = np.linspace(0.0, 1.0, 20_001)


@pytest.mark.parametrize("cruise", [0.0, 0.3, 0.6, 0.9])
def test_a_stroke_goes_from_rest_to_rest_and_is_symmetric(cruise):
    done = progress(U, cruise)
    speed = np.gradient(done, U)
    assert (done[0], done[-1]) == pytest.approx((0.0, 1.0))
    assert done + done[::-1] == pytest.approx(1.0)
    assert np.diff(done).min() >= 0.0
    assert abs(speed[[0, -1]]).max() < 1e-3


def test_a_stroke_without_cruise_is_the_minimum_jerk_course():
    assert progress(U) == pytest.approx(10 * U**3 - 15 * U**4 + 6 * U**5)


def test_a_stroke_cruises_at_its_peak_speed_for_its_share():
    speed = np.gradient(progress(U, 0.6), U)
    at_peak = speed > speed.max() * (1.0 - 1e-6)
    assert np.ptp(U[at_peak]) == pytest.approx(0.6, abs=0.01)
