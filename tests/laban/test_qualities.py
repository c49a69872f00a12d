from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from laban.body import body_extent_m
from laban.description import DESCRIPTION_NAMES, FAMILIES, MULTIPLIED, describe
from laban.qualities import QUALITIES, _percentile, movement_qualities, spectral_arc_length
from laban.stillness import without_still_ends

NAMES = [quality.name for quality in QUALITIES]


def named(motion):
    return dict(zip(NAMES, movement_qualities(motion), strict=True))


@pytest.fixture
def circle(motion_of, columns):
    def make(radius_m=0.2, rate=2.0 * np.pi, duration_s=1.0, rate_hz=400.0):
        def path(t):
            a = rate * t
            wave = [np.cos(a), -np.sin(a), -np.cos(a), np.sin(a), np.cos(a)]
            return [radius_m * rate**k * columns(wave[k], 0.0 * t, -wave[k + 1]) for k in range(4)]

        return motion_of(path, duration_s=duration_s, rate_hz=rate_hz)

    return make


@pytest.fixture
def jerk_free(motion_of, columns):
    """A minimum-jerk stroke of 0.3 m in 1 s, along X."""

    def path(t):
        u, flat = np.clip(t, 0.0, 1.0), 0.0 * t
        poly = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
        return [0.3 * columns(poly.deriv(k)(u) if k else poly(u), flat, flat) for k in range(4)]

    return motion_of(path, duration_s=1.0, rate_hz=400.0)


def test_a_circle_is_round_flat_and_turns_once(circle):
    found = named(circle())
    assert np.exp(found["log_path"]) == pytest.approx(2 * np.pi * 0.2, rel=0.01)
    assert np.exp(found["log_extent"]) == pytest.approx(0.2, rel=0.01)
    assert np.exp(found["log_turning"]) - 0.3 == pytest.approx(2 * np.pi, rel=0.01)
    assert np.exp(found["log_roundness"]) == pytest.approx(1.02, abs=0.01)
    assert np.exp(found["log_flatness"]) == pytest.approx(0.02, abs=1e-6)
    assert np.exp(found["log_path_over_reach"]) == pytest.approx(np.pi, rel=0.01)


def test_a_straight_minimum_jerk_stroke_has_its_closed_forms(jerk_free):
    found = named(jerk_free)
    assert found["log_straightness"] == pytest.approx(0.0, abs=0.01)
    assert np.exp(found["log_peak_over_mean_speed"]) == pytest.approx(1.875, rel=0.01)
    # the integral of jerk squared is 720 D^2 / T^5, and the peak speed 1.875 D / T
    assert np.exp(found["log_dimensionless_jerk"]) == pytest.approx(720 / 1.875**2, rel=0.03)
    assert found["time_to_peak"] == pytest.approx(0.5, abs=0.01)
    assert np.exp(found["log_submovements"]) == pytest.approx(2.0)
    assert np.exp(found["log_roundness"]) == pytest.approx(0.02, abs=1e-6)


def test_more_submovements_are_less_smooth():
    t = np.arange(0.0, 1.0, 0.01)
    one = t**2 * (1 - t) ** 2
    lengths = [spectral_arc_length(np.tile(one, n), 0.01 / n) for n in (1, 2, 4, 8)]
    assert (np.diff(lengths) < 0).all()
    assert lengths[0] == pytest.approx(spectral_arc_length(7.0 * one, 0.01))


@pytest.mark.parametrize("seed", range(5))
def test_turning_and_moving_the_world_changes_nothing(seed, random_motion):
    rng = np.random.default_rng(seed)
    motion = random_motion(rng)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    world = {
        name: getattr(motion, name) @ turn.T
        for name in ("position_m", "velocity_m_s", "acceleration_m_s2", "jerk_m_s3")
    }
    world["position_m"] = world["position_m"] + rng.normal(size=3)
    np.testing.assert_allclose(
        movement_qualities(replace(motion, **world)), movement_qualities(motion), atol=1e-9
    )


def test_the_sampling_rate_hardly_matters(random_motion):
    slow, fast = (
        movement_qualities(random_motion(np.random.default_rng(3), rate_hz=rate))
        for rate in (60.0, 240.0)
    )
    np.testing.assert_allclose(slow, fast, atol=0.06)  # of spectra that end a little otherwise


def test_stillness_at_the_ends_does_not_count(jerk_free):
    rest_s, step_s = 0.5, 1 / 400.0
    n = round(rest_s / step_s)
    padded = replace(
        jerk_free,
        time_s=np.arange(len(jerk_free) + 2 * n) * step_s,
        **{
            name: np.pad(getattr(jerk_free, name), ((n, n), (0, 0)), mode="edge")
            for name in ("position_m", "orientation_xyzw")
        },
        **{
            name: np.pad(getattr(jerk_free, name), ((n, n), (0, 0)))
            for name in (
                "velocity_m_s",
                "acceleration_m_s2",
                "jerk_m_s3",
                "angular_velocity_rad_s",
                "angular_acceleration_rad_s2",
                "angular_jerk_rad_s3",
            )
        },
    )
    assert len(without_still_ends(padded)) == len(without_still_ends(jerk_free))
    np.testing.assert_allclose(describe(padded), describe(jerk_free), atol=1e-9)


def test_a_body_that_never_moves_stays_whole(motion_of):
    still = motion_of(lambda t: [np.zeros((len(t), 3))] * 4)
    assert len(without_still_ends(still)) == len(still)
    assert np.isfinite(describe(still)).all()


@pytest.mark.parametrize("rate", [0.5, 2.0, 6.0])
def test_turning_on_the_spot_is_movement_of_the_whole_body(rate, motion_of, columns):
    """Parts 0.1 m from the axis go as fast as a body that is carried at a tenth of the rate."""

    def turning(t):
        flat = 0.0 * t
        q = np.stack([flat, np.sin(rate * t / 2), flat, np.cos(rate * t / 2)], axis=-1)
        return [
            q,
            columns(flat, flat + rate, flat),
            columns(flat, flat, flat),
            0 * columns(t, t, t),
        ]

    turned = named(motion_of(lambda t: [np.zeros((len(t), 3))] * 4, turning))
    assert np.exp(turned["log_rms_speed"]) == pytest.approx(0.1 * rate)
    assert np.exp(turned["log_peak_over_mean_speed"]) == pytest.approx(1.0)
    a = rate * 121 / 60.0  # about its mean direction an angle a of a circle leaves sinc(a / 2)
    spread = 0.1 * np.sqrt(1.0 - np.sinc(a / (2.0 * np.pi)) ** 2)
    assert body_extent_m(motion_of(lambda t: [np.zeros((len(t), 3))] * 4, turning)) == (
        pytest.approx(spread, rel=0.01)
    )


def test_noise_hardly_turns_a_straight_path(motion_of, columns):
    """A millimetre a sample, at 10 cm/s: the directions of samples would turn on and on."""
    rng = np.random.default_rng(0)

    def path(t):
        position = columns(0.1 * t, 0.0 * t, 0.0 * t) + rng.normal(0.0, 3e-4, (len(t), 3))
        return [position, columns(0.0 * t + 0.1, 0.0 * t, 0.0 * t), *[np.zeros((len(t), 3))] * 2]

    assert np.exp(named(motion_of(path))["log_turning"]) - 0.3 < 2.0


def test_the_10th_and_the_98th_percentile_are_numpys():
    rng = np.random.default_rng(0)
    for n in (4, 5, 61):
        signal = rng.normal(size=n)
        for share in (0.1, 0.9, 0.98):
            assert _percentile(np.sort(signal), share) == pytest.approx(
                np.percentile(signal, 100.0 * share)
            )


def test_a_stroke_that_is_stopped_dead_arrives_harder_than_a_gentle_one(motion_of, columns):
    def stroke(power):
        def path(t):
            u, flat = np.clip(t, 0.0, 1.0), 0.0 * t
            done = np.polynomial.Polynomial([0.0] * power + [1.0])
            return [columns(done.deriv(k)(u) if k else done(u), flat, flat) for k in range(4)]

        return motion_of(path, duration_s=1.0, rate_hz=100.0)

    assert named(stroke(4))["log_arrival"] > named(stroke(2))["log_arrival"] + 0.3


def test_acceleration_is_the_chords_and_not_below_what_rest_has(motion_of, columns):
    """Even acceleration is its own mean; shaking faster than a chord averages out."""

    def path(t):
        w, flat = 2.0 * np.pi * 10.0, 0.0 * t  # a chord is one whole swing
        return [
            columns(2.0 * t**2 - np.cos(w * t) / w**2, flat, flat),
            columns(4.0 * t + np.sin(w * t) / w, flat, flat),
            columns(4.0 + np.cos(w * t), flat, flat),
            columns(-w * np.sin(w * t), flat, flat),
        ]

    found = named(motion_of(path, duration_s=1.0, rate_hz=400.0))
    assert np.exp(found["log_rms_acceleration"]) == pytest.approx(np.hypot(4.0, 0.3), rel=0.01)
    still = named(motion_of(lambda t: [np.zeros((len(t), 3))] * 4))
    assert np.exp(still["log_rms_acceleration"]) == pytest.approx(0.3)
    assert still["log_arrival"] == pytest.approx(0.0, abs=1e-12)


def test_families_name_entries_and_none_twice():
    assert set(MULTIPLIED) <= set(FAMILIES["everything"])
    for names in FAMILIES.values():
        assert set(names) <= set(DESCRIPTION_NAMES)
        assert len(set(names)) == len(names)
    assert len(set(DESCRIPTION_NAMES)) == len(DESCRIPTION_NAMES) == 132
