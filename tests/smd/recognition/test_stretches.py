"""Dense stretches: those of a plain loop over every length and end, whatever is still."""

import numpy as np
import pytest

from smd.recognition.stretches import (
    LONGEST,
    RATIO,
    SHORTEST,
    STEP,
    are_alike_long,
    dense_stretches,
)
from smd.recognition.tokens import STILL, Token, TokenRun

AHEAD = Token((0, 0, 1), (0, 0, 0))


def runs_at_random(rng, count, start_s=0.0):
    ends_s = start_s + np.cumsum(rng.uniform(0.02, 0.6, count))
    starts_s = np.concatenate([[start_s], ends_s[:-1]])
    tokens = [STILL if rng.random() < 0.3 else AHEAD for _ in range(count)]
    return [
        TokenRun(token, i, i + 1, float(a), float(b), 1.0, 0.0)
        for i, (token, a, b) in enumerate(zip(tokens, starts_s, ends_s, strict=True))
    ]


def plain(runs, durations_s):
    low, high = SHORTEST * min(durations_s), LONGEST * max(durations_s)
    count = int(np.ceil(np.log(high / low) / np.log(RATIO))) + 1
    found = set()
    for length_s in np.exp(np.linspace(np.log(low), np.log(high), count)):
        step_s = STEP * length_s
        k = int(np.ceil(runs[0].start_s / step_s))
        while k * step_s <= runs[-1].end_s + step_s:
            inside = [
                i
                for i, run in enumerate(runs)
                if k * step_s - length_s <= 0.5 * (run.start_s + run.end_s) < k * step_s
            ]
            moving = [i for i in inside if runs[i].token != STILL]
            if moving:
                found.add((moving[0], moving[-1] + 1))
            k += 1
    return sorted(found)


@pytest.mark.parametrize("seed", range(20))
def test_they_are_those_of_the_plain_loop(seed):
    rng = np.random.default_rng(seed)
    runs = runs_at_random(rng, int(rng.integers(1, 40)), float(rng.uniform(0.0, 3.0)))
    durations_s = rng.uniform(0.3, 2.0, int(rng.integers(1, 4)))
    is_still = np.array([run.token == STILL for run in runs])
    found = dense_stretches(runs, is_still, durations_s)
    assert sorted(found) == plain(runs, durations_s)
    assert len(set(found)) == len(found)


def test_a_gesture_among_many_short_runs_is_among_them_to_a_tenth():
    runs = [TokenRun(AHEAD, i, i + 1, 0.03 * i, 0.03 * (i + 1), 1.0, 0.0) for i in range(300)]
    still = np.zeros(300, bool)
    found = dense_stretches(runs, still, np.array([1.0]))
    for start_s, end_s in ((2.0, 3.0), (4.31, 5.13), (6.5, 7.8)):
        off = min(
            max(abs(runs[i].start_s - start_s), abs(runs[j - 1].end_s - end_s)) for i, j in found
        )
        assert off < 0.13 * (end_s - start_s)


def test_what_only_stands_still_has_none():
    runs = [TokenRun(STILL, 0, 1, 0.0, 5.0, 0.0, 0.0)]
    assert dense_stretches(runs, np.array([True]), np.array([1.0])) == []
    assert dense_stretches([], np.zeros(0, bool), np.array([1.0])) == []


def test_lengths_of_other_actions_are_told_apart():
    alike = are_alike_long(np.array([0.3, 1.0, 3.0]), np.array([1.0, np.nan]))
    assert alike.tolist() == [[False, False], [True, False], [False, False]]
