from __future__ import annotations

import numpy as np
import pytest

from smd.synthetic.tracker import tracker_times


def test_a_tracker_reports_at_uneven_times_and_loses_one_in_a_hundred():
    time_s = tracker_times(5.0, 205.0, 90.0, np.random.default_rng(0))
    steps = np.diff(time_s)
    assert (time_s[0], time_s[-1]) == (5.0, 205.0)
    assert steps.min() > 0.0
    assert np.ptp(steps) > 1e-3
    assert len(time_s) == pytest.approx(0.99 * 200.0 * 90.0, rel=0.003)
