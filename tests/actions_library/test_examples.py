"""The few performances that become examples stand for all of them."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from actions_library.authoring.examples import medoids


def apart_of(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, None] - points[None], axis=-1)


def spread(apart: np.ndarray, chosen) -> float:
    return float(apart[:, list(chosen)].min(axis=1).sum())


@pytest.mark.parametrize("seed", range(20))
def test_what_lies_in_heaps_is_stood_for_by_one_of_each(seed):
    rng = np.random.default_rng(seed)
    heaps = np.repeat(np.arange(5), rng.integers(2, 9, 5))
    points = 100.0 * np.stack([heaps, heaps % 2], axis=1) + rng.normal(size=(len(heaps), 2))
    order = rng.permutation(len(points))
    chosen = medoids(apart_of(points[order]), 5)
    assert sorted(heaps[order][chosen]) == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("seed", range(20))
def test_it_is_within_a_tenth_of_the_best_choice_of_all(seed):
    apart = apart_of(np.random.default_rng(seed).normal(size=(12, 3)))
    best = min(spread(apart, some) for some in combinations(range(12), 3))
    assert spread(apart, medoids(apart, 3)) <= 1.1 * best


@pytest.mark.parametrize("seed", range(5))
def test_it_leaves_smaller_gaps_than_as_many_drawn_at_random(seed):
    rng = np.random.default_rng(seed)
    apart = apart_of(rng.normal(size=(72, 6)))
    drawn = [spread(apart, rng.permutation(72)[:18]) for _ in range(200)]
    assert spread(apart, medoids(apart, 18)) < min(drawn)


def test_the_order_of_things_does_not_matter_to_what_is_chosen():
    rng = np.random.default_rng(1)
    points = rng.normal(size=(40, 4))
    order = rng.permutation(40)
    again = order[medoids(apart_of(points[order]), 7)]
    assert sorted(again) == medoids(apart_of(points), 7).tolist()


def test_things_that_are_all_the_same_are_chosen_once_each():
    assert len(set(medoids(np.zeros((9, 9)), 4).tolist())) == 4


@pytest.mark.parametrize("count", [1, 3, 5])
def test_no_more_are_chosen_than_there_are(count):
    apart = apart_of(np.arange(3.0)[:, None])
    assert medoids(apart, count).tolist() == ([1] if count == 1 else [0, 1, 2])
