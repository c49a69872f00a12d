from __future__ import annotations

import numpy as np
import pytest

from laban import EffortStream, effort_over_time, load_effort_model, read_effort


@pytest.fixture(scope="module")
def model():
    return load_effort_model()


@pytest.mark.parametrize("piece", [1, 7, 60])
def test_a_stream_says_what_the_whole_says_whatever_the_pieces(piece, model, random_motion):
    motion = random_motion(np.random.default_rng(0), pace=0.5)
    curve = effort_over_time(motion, model)
    stream, found = EffortStream(model), []
    for i in range(0, len(motion), piece):
        last = min(i + piece, len(motion)) - 1
        found += stream.push(motion.between(motion.time_s[i], motion.time_s[last]))
    found += stream.finish()
    np.testing.assert_allclose([time_s for time_s, _ in found], curve.time_s)
    np.testing.assert_allclose([effort.time for _, effort in found], curve.values[:, 0])


def test_each_window_is_read_by_itself(model, random_motion):
    motion = random_motion(np.random.default_rng(1), pace=0.4)
    curve = effort_over_time(motion, model, window_s=1.5, step_s=0.5)
    assert len(curve.time_s) == int((motion.time_s[-1] - 1.5) / 0.5 + 1e-9) + 1
    for time_s, values in zip(curve.time_s, curve.values, strict=True):
        effort = read_effort(motion.between(time_s - 0.75, time_s + 0.75), model)
        assert values[1] == effort.weight


def test_what_is_still_or_too_short_has_no_effort(model, motion_of, random_motion):
    still = motion_of(lambda t: [np.zeros((len(t), 3))] * 4, duration_s=3.0)
    assert np.isnan(effort_over_time(still, model).values).all()
    short = random_motion(np.random.default_rng(0), pace=4.0)
    assert effort_over_time(short, model).values.shape == (0, 4)


def test_a_long_stream_does_not_grow(model, random_motion):
    motion = random_motion(np.random.default_rng(0), pace=0.1)
    stream = EffortStream(model, step_s=2.0)
    for i in range(len(motion)):
        stream.push(motion.between(motion.time_s[i], motion.time_s[i]))
        assert len(stream._arrays[0]) <= 60 * 2 + 2
        assert len(stream._reading) <= 1


def test_a_reading_is_told_within_a_step_of_its_windows_end(model, random_motion):
    motion = random_motion(np.random.default_rng(0), pace=0.2)
    stream = EffortStream(model)
    for i in range(len(motion)):
        now_s = motion.time_s[i]
        for middle_s, _ in stream.push(motion.between(now_s, now_s)):
            assert middle_s + 0.5 <= now_s < middle_s + 0.75
