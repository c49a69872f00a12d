from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smd.acting.company import AHEAD_S, SOFT, kept_apart, least_distance_m, parted
from smd.doodle import Doodle, Recording
from smd.geometry.arrays import FloatArray
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

TIME_S = np.linspace(0.0, 10.0, 601)
HEIGHT_M = np.array([1.8, 1.8])
LEAST_M = least_distance_m(1.8, 1.8)


def crossing(miss_m: float = 0.0, speed_m_s: float = 1.0) -> FloatArray:
    """One goes ahead, the other to the left; they cross at 5 s, one of them late by a way."""
    way = speed_m_s * (TIME_S - 5.0)
    ahead = np.stack([0.0 * way, way], axis=-1)
    aside = np.stack([way - miss_m, 0.0 * way], axis=-1)
    return np.stack([ahead, aside])


def between(position_m: FloatArray) -> FloatArray:
    return np.linalg.norm(position_m[1] - position_m[0], axis=-1)


def test_the_least_distance_is_a_bodys_width():
    assert least_distance_m(1.75, 1.75) == pytest.approx(0.525)
    assert least_distance_m(2.0, 1.0) == pytest.approx(0.45)


def test_two_that_cross_pass_at_their_least_distance_and_where_they_would_be_nearest():
    places = crossing()
    now = places + kept_apart(places, HEIGHT_M, TIME_S)
    assert between(now).min() == pytest.approx(LEAST_M, rel=0.07)
    assert between(now).min() >= LEAST_M - 1e-9
    # Both are as fast, so each goes aside by half of it, across the way between them: (1, 1).
    aside = (now - places)[:, 300]
    assert np.linalg.norm(aside, axis=-1) == pytest.approx(0.5 * LEAST_M, rel=0.07)
    assert aside[0] == pytest.approx(-aside[1])
    assert abs(aside[0] @ (places[1, 301] - places[0, 301])) < 1e-9


def test_they_are_where_they_were_before_and_after():
    places = crossing(0.1)
    moved = np.linalg.norm(kept_apart(places, HEIGHT_M, TIME_S), axis=-1)
    far_s = (1.0 + SOFT) * LEAST_M / np.sqrt(2.0) + AHEAD_S + 0.1
    assert (moved[:, np.abs(TIME_S - 5.05) > far_s] == 0.0).all()
    assert moved.max() < LEAST_M


def test_ways_bend_without_a_jump():
    places = crossing(0.05)
    velocity = np.diff(places + kept_apart(places, HEIGHT_M, TIME_S), axis=1) * 60.0
    assert np.linalg.norm(velocity, axis=-1).max() < 1.4
    assert np.linalg.norm(np.diff(velocity, axis=1), axis=-1).max() < 0.05


def test_who_stands_hardly_gives_way_to_who_goes_by():
    places = crossing()
    places[1] = [0.05, 0.0]
    offset = kept_apart(places, HEIGHT_M, TIME_S)
    assert between(places + offset).min() >= LEAST_M - 1e-9
    moved = np.linalg.norm(offset, axis=-1).max(axis=-1)
    assert moved[1] < 0.07 * moved[0]


def test_who_goes_round_another_at_arms_length_still_does():
    turned = 2.0 * np.pi * TIME_S / 10.0
    around = 0.8 * LEAST_M * np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    done = parted(around, LEAST_M, TIME_S)
    across = around[:, 0] * done[:, 1] - around[:, 1] * done[:, 0]
    assert across == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(done, axis=-1).min() >= LEAST_M - 1e-12


def walks(seed: int, count: int, apart_m: float) -> FloatArray:
    """Smooth ways at random around places in a row."""
    rng = np.random.default_rng(seed)
    wave = np.sin(
        rng.uniform(0.2, 1.5, (count, 3, 1, 2)) * TIME_S[:, None]
        + rng.uniform(0.0, 6.3, (count, 3, 1, 2))
    )
    row = np.arange(count)[:, None, None] * np.array([apart_m, 0.0])
    return wave.sum(axis=1) + row


@given(st.integers(0, 10_000), st.floats(0.0, 3.0), st.floats(0.5, 2.5))
@settings(max_examples=15, deadline=None, derandomize=True)
def test_two_never_come_nearer_and_whoever_is_named_first(seed, apart_m, height_m):
    places = walks(seed, 2, apart_m)
    heights = np.array([1.8, height_m])
    now = places + kept_apart(places, heights, TIME_S)
    assert between(now).min() >= least_distance_m(*heights) - 1e-9
    other = places[::-1] + kept_apart(places[::-1], heights[::-1], TIME_S)
    assert other[::-1] == pytest.approx(now, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_who_is_far_apart_is_not_touched(seed):
    assert not kept_apart(walks(seed, 3, 20.0), np.full(3, 1.8), TIME_S).any()


@pytest.mark.parametrize("seed", range(4))
def test_in_a_crowd_of_four_nobody_is_walked_through(seed):
    places = walks(seed, 4, 1.0)
    now = places + kept_apart(places, np.full(4, 1.8), TIME_S)
    near = min(np.linalg.norm(now[b] - now[a], axis=-1).min() for a in range(4) for b in range(a))
    assert near > 0.8 * LEAST_M


def test_animate_bends_the_ways_and_says_so(library):
    scale = library.character.height_m / 0.175
    time_s = np.arange(8 * 90 + 1) / 90.0
    way = np.clip(time_s - 1.0, 0.0, 6.0) / scale
    still, up = 0.0 * way, 0.8 + 0.0 * way
    level = np.tile([0.0, 0.0, 0.0, 1.0], (len(way), 1))
    fox = Doodle(time_s, np.stack([still, up, way], axis=-1), level, "fox")
    wolf = Doodle(time_s, np.stack([still + 0.01, up, 6.0 / scale - way], axis=-1), level, "wolf")
    spoken = (Phrase("walk", 1.0, 7.0),)
    score = Score((Part("fox", spoken), Part("wolf", spoken)))
    performance = animate(score, Recording((fox, wolf)), library)
    first, second = (actor.poses.translation_m[:, 0] for actor in performance.actors)
    assert np.linalg.norm(first - second, axis=-1).min() > 0.999 * least_distance_m(1.758, 1.758)
    (line,) = [line for line in performance.warnings if line.startswith("devices")]
    assert line.startswith("devices 'fox' and 'wolf': at 4.0")
    assert "expected 0.53 m between them, found 0.10 m; they give way by up to 0." in line
    alone = animate(Score((Part("fox", spoken),)), Recording((fox, wolf)), library).actors[0]
    assert first[:40] == pytest.approx(alone.poses.translation_m[:40, 0], abs=1e-9)
    assert first[-24:] == pytest.approx(alone.poses.translation_m[-24:, 0], abs=1e-9)
