"""A body falls freely between pushes and moves away from feet as an inverted pendulum does."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.posing import RATE_HZ
from actions_library.authoring.pushes import Push, driven

G_M_S2, HEIGHT_M, FRAMES = 9.81, 0.9, 30
DURATION_S = FRAMES / RATE_HZ


def push(first: float, last: float, before: float = 0.0, after: float = 0.0) -> Push:
    """A push from one frame to another."""
    return Push(first / RATE_HZ, last / RATE_HZ, before, after)


def accelerated(way_m: np.ndarray) -> np.ndarray:
    return (np.roll(way_m, -1) - 2.0 * way_m + np.roll(way_m, 1)) * RATE_HZ**2


def pushes_at_random(rng: np.random.Generator) -> list[Push]:
    edges = np.sort(rng.uniform(0.0, FRAMES, 4))
    ends = rng.uniform(-0.4, 0.4, (2, 2))
    return [push(*edges[:2], *ends[0]), push(*edges[2:], *ends[1])]


def test_it_falls_freely_where_nothing_pushes_and_is_borne_evenly_where_something_does():
    up, along = driven([push(0.5, 20.5, -0.2, 0.3)], DURATION_S, height_m=HEIGHT_M)
    np.testing.assert_allclose(accelerated(up)[21:], -G_M_S2, atol=1e-9)
    np.testing.assert_allclose(accelerated(along)[21:], 0.0, atol=1e-9)
    np.testing.assert_allclose(accelerated(up)[1:21], G_M_S2 * (30.0 / 20.0 - 1.0), atol=1e-9)


def test_it_moves_away_from_the_foot_as_an_inverted_pendulum_does():
    pushes = [push(0.5, 10.5, 0.1, 0.3), push(15.5, 25.5, -0.3, -0.1)]
    up, along = driven(pushes, DURATION_S, height_m=HEIGHT_M)
    load_m_s2 = accelerated(up) + G_M_S2
    past_m = np.zeros(FRAMES)
    past_m[1:11] = np.linspace(0.11, 0.29, 10)
    past_m[16:26] = np.linspace(-0.29, -0.11, 10)
    np.testing.assert_allclose(accelerated(along), load_m_s2 / HEIGHT_M * past_m, atol=1e-9)


def test_a_flight_is_a_parabola_whose_top_is_halfway():
    up, _ = driven([push(0.5, 20.5)], DURATION_S, height_m=HEIGHT_M)
    from_top_s = (np.arange(20, 32) - 25.5) / RATE_HZ
    flown = up[np.arange(20, 32) % FRAMES]
    fallen = 0.5 * G_M_S2 * (from_top_s**2 - from_top_s[0] ** 2)
    np.testing.assert_allclose(flown, flown[0] - fallen, atol=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_a_cycle_comes_back_to_where_it_was_whatever_pushes(seed):
    pushes = pushes_at_random(np.random.default_rng(seed))
    for way_m in driven(pushes, DURATION_S, height_m=HEIGHT_M):
        assert way_m.mean() == pytest.approx(0.0, abs=1e-12)
        assert accelerated(way_m).mean() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("seed", range(10))
def test_a_cycle_has_no_beginning(seed):
    rng = np.random.default_rng(seed)
    pushes, later = pushes_at_random(rng), int(rng.integers(1, FRAMES))
    moved = [
        push(RATE_HZ * one.start + later, RATE_HZ * one.end + later, one.before, one.after)
        for one in pushes
    ]
    one, other = (driven(some, DURATION_S, height_m=HEIGHT_M) for some in (pushes, moved))
    np.testing.assert_allclose(np.roll(one, later, axis=1), other, atol=1e-12)


def test_who_is_borne_all_the_time_goes_steadily():
    up, along = driven([push(0.0, 30.0, 0.2, 0.2)], DURATION_S, height_m=HEIGHT_M)
    np.testing.assert_allclose([up, along], 0.0, atol=1e-12)
