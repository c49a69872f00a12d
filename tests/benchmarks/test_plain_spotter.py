"""The plain spotter finds what it was shown."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.composed import RATE_HZ, compose, resampled
from benchmarks.plain_spotter import PlainSpotter, best_apart, parting_threshold
from benchmarks.tally import Named
from tests.benchmarks.conftest import stroke

LABELS = (1, 3, 5, 7)


@pytest.fixture(scope="module")
def spotter():
    examples = {
        str(label): [resampled(stroke(label, i), RATE_HZ) for i in range(50, 55)]
        for label in LABELS
    }
    return PlainSpotter(examples)


@pytest.fixture(scope="module")
def played(idle):
    takes = [(str(label), stroke(label, 60)) for label in LABELS]
    free, held, gestures = compose(takes, idle, np.random.default_rng(2))
    return replace(free, drawing=held), gestures


def test_it_finds_what_it_was_shown(spotter, played):
    doodle, gestures = played
    found = spotter.spot(doodle)
    assert [one.action for one in found] == [one.action for one in gestures]
    for one, meant in zip(found, gestures, strict=True):
        assert abs(one.start_s - meant.start_s) < 0.4
        assert abs(one.end_s - meant.end_s) < 0.4


def test_where_the_trigger_is_not_held_it_finds_nothing(spotter, played):
    doodle, _ = played
    assert spotter.spot(replace(doodle, drawing=np.zeros(len(doodle), bool))) == []


def test_it_finds_the_same_wherever_the_hand_is(spotter, played):
    doodle, _ = played
    moved = replace(doodle, position_m=doodle.position_m + np.array([3.0, -1.0, 2.0]))
    told = [(one.action, round(one.start_s, 6)) for one in spotter.spot(doodle)]
    assert [(one.action, round(one.start_s, 6)) for one in spotter.spot(moved)] == told


@pytest.mark.parametrize("seed", range(10))
def test_the_threshold_parts_best(seed):
    rng = np.random.default_rng(seed)
    alike, unlike = rng.normal(1.0, 0.5, 30), rng.normal(2.0, 0.5, 40)

    def f1(threshold: float) -> float:
        right, wrong = np.mean(alike <= threshold), np.mean(unlike <= threshold)
        return 2.0 * right / (right + 1.0 + wrong)

    best = parting_threshold(alike, unlike)
    every = np.sort(np.concatenate([alike, unlike]))
    assert f1(best) == pytest.approx(max(map(f1, every)))
    assert all(f1(each) < f1(best) - 1e-12 for each in every[every < best])


def test_of_windows_that_overlap_the_nearest_stays():
    found = [
        (0.5, Named("a", 1.0, 2.0)),
        (0.4, Named("b", 1.9, 3.0)),
        (0.9, Named("c", 2.9, 4.0)),
        (0.3, Named("d", 3.0, 3.5)),
        (1.0, Named("e", 0.0, 1.9)),
    ]
    assert [one.action for one in best_apart(found)] == ["e", "b", "d"]
