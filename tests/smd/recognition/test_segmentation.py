from __future__ import annotations

import numpy as np
import pytest

from smd.recognition.automaton import compile_automaton, wrong_tokens
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segment, least_cost_segments
from smd.recognition.tokens import Token
from tests.naive.segmentation import cost_of_segment, least_total_cost

ALPHABET = tuple(map(Token.parse, ("T_Z", "T_Y", "R_Y", "T_N_Z")))
AUTOMATA = [
    compile_automaton(Pattern.parse(text))
    for text in ("T_Z", "T_Z T_N_Z", "T_Y (T_Z T_Y)+", "R_Y+ T_Z* R_Y", "(T_Z|R_Y)+ T_N_Z*")
]


def problem(rng, n):
    word = tuple(ALPHABET[i] for i in rng.integers(len(ALPHABET), size=n))
    read = [np.maximum(wrong_tokens(a, word), rng.uniform(0.0, 0.3, n)[:, None]) for a in AUTOMATA]
    skip = rng.uniform(0.0, 1.0, n)
    return word, read, skip, rng.uniform(0.2, 1.0) * skip, float(rng.uniform(0.05, 0.5))


@pytest.mark.parametrize("seed", range(150))
def test_the_total_cost_is_the_least_of_all_segmentations(seed):
    rng = np.random.default_rng(seed)
    _, read, skip, unexplained, action = problem(rng, int(rng.integers(1, 12)))
    segments = least_cost_segments(
        AUTOMATA, read=read, skip=skip, unexplained=unexplained, action=action
    )
    left = unexplained.copy()
    total = 0.0
    for segment in segments:
        left[segment.first : segment.last] = 0.0
        total += cost_of_segment(
            AUTOMATA[segment.index], read[segment.index], skip, segment.first, segment.last, action
        )
    total += float(left.sum())
    assert total == pytest.approx(least_total_cost(AUTOMATA, read, skip, unexplained, action))


@pytest.mark.parametrize("seed", range(20))
def test_segments_follow_each_other(seed):
    _, read, skip, unexplained, action = problem(np.random.default_rng(seed), 60)
    segments = least_cost_segments(
        AUTOMATA, read=read, skip=skip, unexplained=unexplained, action=action
    )
    ends = [end for segment in segments for end in (segment.first, segment.last)]
    assert ends == sorted(ends)
    assert all(segment.first < segment.last for segment in segments)


def segments_of(text, automata=AUTOMATA, action=0.1):
    word = tuple(map(Token.parse, text.split()))
    return least_cost_segments(
        automata,
        read=[wrong_tokens(a, word).astype(float) for a in automata],
        skip=np.ones(len(word)),
        unexplained=np.full(len(word), 0.5),
        action=action,
    )


def test_a_string_without_tokens_or_actions_has_no_segments():
    assert segments_of("") == ()
    assert segments_of("T_Z T_N_Z", automata=[]) == ()


def test_what_costs_too_much_to_explain_is_left_alone():
    assert segments_of("T_Z") == (Segment(0, 0, 1),)
    assert segments_of("T_Z", action=0.6) == ()


def test_one_action_is_seen_rather_than_two():
    assert segments_of("T_Z T_N_Z") == (Segment(1, 0, 2),)


def test_the_earlier_of_two_equal_actions_is_taken():
    assert [s.index for s in segments_of("T_Z", automata=[AUTOMATA[0], AUTOMATA[0]])] == [0]
    assert [s.index for s in segments_of("T_Z", automata=[AUTOMATA[4], AUTOMATA[0]])] == [0]
