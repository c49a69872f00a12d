from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.recognition.bank import compile_library
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segment, cheapest_cut
from smd.recognition.token_costs import graded_costs
from smd.recognition.tokens import Token
from tests.naive.segmentation import least_total_cost, segment_costs

ALPHABET = tuple(map(Token.parse, ("T_Z", "T_Y", "R_Y", "T_N_Z")))
BANK = compile_library(
    {
        text: Pattern.parse(text)
        for text in ("T_Z", "T_Z T_N_Z", "T_Y (T_Z T_Y)+", "R_Y+ T_Z* R_Y", "(T_Z|R_Y)+ T_N_Z*")
    }
)
GRADED = replace(BANK, token_costs=graded_costs())


def problem(rng, n, bank=BANK):
    word = tuple(ALPHABET[i] for i in rng.integers(len(ALPHABET), size=n))
    read = np.maximum(bank.reading(word), rng.uniform(0.0, 0.3, n)[:, None])
    skip = rng.uniform(0.0, 1.0, n)
    return {
        "read": read,
        "skip": skip,
        "unexplained": rng.uniform(0.2, 1.0) * skip,
        "action": float(rng.uniform(0.05, 0.5)),
    }


@pytest.mark.parametrize("bank", [BANK, GRADED], ids=["unit", "graded"])
@pytest.mark.parametrize("seed", range(100))
def test_the_total_cost_is_the_least_of_all_segmentations(seed, bank):
    rng = np.random.default_rng(seed)
    given = problem(rng, int(rng.integers(1, 12)), bank)
    costs = segment_costs(bank, given["read"], given["skip"], given["action"])
    left = given["unexplained"].copy()
    total = 0.0
    for segment in cheapest_cut(bank, **given):
        left[segment.first : segment.last] = 0.0
        total += costs[segment.first, segment.last][segment.index]
    total += float(left.sum())
    assert total == pytest.approx(least_total_cost(costs, given["unexplained"]))


@pytest.mark.parametrize("seed", range(20))
def test_segments_follow_each_other(seed):
    segments = cheapest_cut(BANK, **problem(np.random.default_rng(seed), 60))
    ends = [end for segment in segments for end in (segment.first, segment.last)]
    assert ends == sorted(ends)
    assert all(segment.first < segment.last for segment in segments)


def segments_of(text, bank=BANK, action=0.1):
    word = tuple(map(Token.parse, text.split()))
    return cheapest_cut(
        bank,
        read=bank.reading(word),
        skip=np.ones(len(word)),
        unexplained=np.full(len(word), 0.5),
        action=action,
    )


def test_a_string_without_tokens_or_actions_has_no_segments():
    assert segments_of("") == ()
    assert segments_of("T_Z T_N_Z", bank=compile_library({})) == ()


def test_what_costs_too_much_to_explain_is_left_alone():
    assert segments_of("T_Z") == (Segment(0, 0, 1),)
    assert segments_of("T_Z", action=0.6) == ()


def test_one_action_is_seen_rather_than_two():
    assert segments_of("T_Z T_N_Z") == (Segment(1, 0, 2),)


def test_the_earlier_of_two_equal_actions_is_taken():
    one, many = Pattern.parse("T_Z"), Pattern.parse("(T_Z|R_Y)+ T_N_Z*")
    for patterns in ({"a": one, "b": one}, {"a": one, "b": many}, {"a": many, "b": one}):
        assert [s.index for s in segments_of("T_Z", compile_library(patterns))] == [0]
