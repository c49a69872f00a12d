from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.recognition.automaton import (
    compile_automaton,
    edit_distance,
    least_cost,
    reading,
)
from smd.recognition.pattern import Pattern
from smd.recognition.token_costs import graded_costs, unit_costs
from smd.recognition.tokens import Token
from tests.naive.pattern_language import distance, distance_to_word
from tests.naive.patterns_at_random import ABC, patterns

OTHER = Token.parse("T_N_X")
PATTERNS = [
    "T_Z",
    "T_Z R_Y",
    "T_Z R_Y* T_Z",
    "T_Z+ T_Z+ R_Y",
    "(T_Z|T_Y_Z)+ R_Y",
    "(T_Z R_Y)+",
    "(T_Z R_Y)+ T_Z",
    "T_Z (T_Y_Z|R_Y)* T_Z",
    "(T_Z T_Y_Z T_Z)+ R_Y*",
    "T_Z R_Y|T_Y_Z (R_Y T_Z)*",
    "((T_Z|T_Y_Z) R_Y)+",
]
words = st.lists(st.sampled_from((*ABC, OTHER)), max_size=4).map(tuple)


def price_in(token_costs):
    return lambda a, b: float(token_costs.between([a], [b])[0, 0])


@pytest.mark.parametrize("text", PATTERNS)
def test_distance_is_the_naive_one_for_all_short_words(text):
    pattern = Pattern.parse(text)
    automaton = compile_automaton(pattern)
    for n in range(4):
        for word in product((*ABC, OTHER), repeat=n):
            assert edit_distance(automaton, word) == distance(word, pattern), word


@settings(deadline=None, max_examples=150)
@given(patterns(most=5), words)
def test_distance_is_the_naive_one_for_random_patterns(pattern, word):
    automaton = compile_automaton(pattern)
    assert edit_distance(automaton, word) == distance(word, pattern)
    graded = graded_costs()
    assert edit_distance(automaton, word, graded) == distance(word, pattern, price_in(graded))


@pytest.mark.parametrize("seed", range(3))
def test_distance_is_the_naive_one_for_long_words(seed):
    rng = np.random.default_rng(seed)
    pattern = Pattern.parse("T_Z (T_Y T_X)* (R_Y|R_X T_Y) T_Z* (R_N_Y|R_N_X) T_Z (T_Y|T_X R_X)")
    finite = Pattern.parse("T_Z (R_Y|R_X T_Y) T_Z* (R_N_Y|R_N_X T_Z) T_Z (T_Y|T_X R_X)")
    tokens = pattern.tokens()
    for _ in range(5):
        word = tuple(tokens[i] for i in rng.integers(len(tokens), size=rng.integers(8, 24)))
        naive = min(distance_to_word(word, one) for one in finite.words())
        assert edit_distance(compile_automaton(finite), word) == naive
        rounds = (distance_to_word(word, one) for one in pattern.words(repeats=12))
        assert edit_distance(compile_automaton(pattern), word) == min(rounds)


@settings(deadline=None)
@given(patterns())
def test_every_word_of_a_pattern_is_at_distance_zero(pattern):
    automaton = compile_automaton(pattern)
    for word in pattern.words(2)[:20]:
        assert edit_distance(automaton, word) == 0
        held = tuple(token for token in word for _ in range(2))
        assert edit_distance(automaton, held) == 0


@settings(deadline=None)
@given(patterns())
def test_nothing_is_as_far_as_the_shortest_word_is_long(pattern):
    automaton = compile_automaton(pattern)
    assert edit_distance(automaton, ()) == automaton.shortest == len(pattern.words()[0])


@settings(deadline=None)
@given(patterns(), words, st.integers(0, 4), st.sampled_from(ABC))
def test_one_more_token_is_at_most_one_more_edit(pattern, word, at, token):
    automaton = compile_automaton(pattern)
    longer = (*word[:at], token, *word[at:])
    assert abs(edit_distance(automaton, longer) - edit_distance(automaton, word)) <= 1


@settings(deadline=None)
@given(patterns(most=5), words.filter(len), st.integers(0, 2**32 - 1))
def test_dearer_edits_never_make_a_string_nearer(pattern, word, seed):
    automaton = compile_automaton(pattern)
    rng = np.random.default_rng(seed)
    read = reading(automaton, word, unit_costs())
    skip = rng.uniform(0.0, 1.0, len(word))
    cost = least_cost(automaton, read=read, skip=skip)
    assert cost <= edit_distance(automaton, word)
    assert cost <= least_cost(automaton, read=read + 0.1, skip=skip + 0.1)


def test_states_that_read_alike_are_one():
    assert len(compile_automaton(Pattern.parse("(T_Z|T_X_Z|T_N_X_Z)+"))) == 1
    assert len(compile_automaton(Pattern.parse("(T_Z|T_X_Z) R_Y"))) == 3  # Z and then XZ is wrong


def test_the_humanoid_s_automata_are_small():
    for action in HUMANOID_ACTIONS:
        if action.pattern:
            assert len(compile_automaton(action.pattern)) <= 24


def test_an_automaton_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        compile_automaton(Pattern.parse("T_Z")).step[0, 0] = 1
