from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.smoothing import smooth
from smd.smoothing_stream import SmoothingStream, arrays_of
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take


def take(seed, **how):
    rng = np.random.default_rng(seed)
    return Take(simulated_person(rng), rng).pause(0.3).play("throw").play("fly").doodle(**how)


def streamed(doodle, every):
    stream = SmoothingStream()
    parts = []
    for i, sample in enumerate(
        zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True)
    ):
        stream.push(*sample)
        if i % every == 0:
            parts.append(stream.ready())
    parts.append(stream.finish())
    return [np.concatenate(arrays) for arrays in zip(*filter(None, parts), strict=True)]


def assert_as_offline(doodle, every=7):
    for now, whole in zip(streamed(doodle, every), arrays_of(smooth(doodle)), strict=True):
        assert now.shape == whole.shape
        np.testing.assert_allclose(now, whole, rtol=1e-7, atol=1e-7 * np.abs(whole).max())


@pytest.mark.parametrize("every", [1, 4, 9, 1000])
def test_samples_as_they_come_are_smoothed_as_all_at_once(every):
    assert_as_offline(take(0), every)


@pytest.mark.parametrize("rate_hz", [30.0, 60.0, 90.0, 144.0])
def test_at_any_rate_of_the_sensor(rate_hz):
    assert_as_offline(take(1, rate_hz=rate_hz))


def test_uneven_times_and_a_clock_that_counts_from_1970():
    doodle = take(2)
    late = np.sort(doodle.time_s + np.random.default_rng(0).uniform(0.0, 4e-3, len(doodle)))
    assert_as_offline(Doodle(late, doodle.position_m, doodle.orientation_xyzw))
    # There, times are a quarter of a microsecond apart.
    now, whole = streamed(doodle, 7), arrays_of(smooth(doodle))
    np.testing.assert_allclose(now[1], whole[1], atol=1e-6)


@pytest.mark.parametrize("count", [1, 3, 5, 20, 40, 60])
def test_a_short_doodle_is_smoothed_whole_or_not_at_all(count):
    doodle = take(3)
    short = Doodle(
        doodle.time_s[:count], doodle.position_m[:count], doodle.orientation_xyzw[:count]
    )
    try:
        smooth(short)
    except DoodleError:
        assert streamed(short, 7) == []
    else:
        assert_as_offline(short)


def test_a_quaternion_that_flips_its_sign_changes_nothing():
    doodle = take(4)
    stream, flipping = SmoothingStream(), SmoothingStream()
    for i, (t, p, q) in enumerate(
        zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True)
    ):
        stream.push(t, p, q)
        flipping.push(t, p, -q if i % 3 == 1 else q)
    for ours, theirs in zip(stream.finish(), flipping.finish(), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_what_is_known_is_half_a_window_and_two_samples_behind():
    doodle = take(5, rate_hz=90.0)
    stream, seen_s = SmoothingStream(), -np.inf
    for t, p, q in zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True):
        stream.push(t, p, q)
        part = stream.ready()
        seen_s = part[0][-1] if part else seen_s
        if t > 1.0:
            assert t - seen_s < 0.1 + 2.0 / 90.0 + 1.0 / 60.0 + 0.02


@pytest.mark.parametrize(
    ("sample", "message"),
    [
        ((0.0, [0, 0, 0], [0, 0, 0, 1]), "later than 0"),
        ((np.nan, [0, 0, 0], [0, 0, 0, 1]), "later than 0"),
        ((1.0, [0, np.inf, 0], [0, 0, 0, 1]), "position_m: expected 3 finite"),
        ((1.0, [0, 0], [0, 0, 0, 1]), "position_m: expected 3 finite"),
        ((1.0, [0, 0, 0], [0, 0, 0, 2]), "unit length, got 2"),
    ],
)
def test_a_bad_sample_is_refused_and_not_taken(sample, message):
    stream = SmoothingStream()
    stream.push(0.0, [0, 0, 0], [0, 0, 0, 1])
    with pytest.raises(DoodleError, match=message):
        stream.push(*sample)
    stream.push(0.5, [0, 0, 0], [0, 0, 0, 1])
