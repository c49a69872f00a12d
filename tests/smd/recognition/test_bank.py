from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.recognition.automaton import compile_automaton, edit_distance, least_cost, reading
from smd.recognition.bank import (
    compile_library,
    distances,
    least_costs,
    least_costs_of_parts,
    occurrences,
)
from smd.recognition.pattern import Pattern
from smd.recognition.token_costs import graded_costs, unit_costs
from smd.recognition.tokens import Token
from tests.naive.pattern_language import distance
from tests.naive.patterns_at_random import ABC, patterns

COSTS = [unit_costs(), graded_costs()]
ALPHABET = (*ABC, Token.parse("T_N_X"))
PATTERNS = {
    text: Pattern.parse(text)
    for text in (
        "T_Z",
        "T_Z R_Y* T_Z",
        "(T_Z|T_Y_Z)+ R_Y",
        "(T_Z R_Y)+ T_Z",
        "T_Z (T_Y_Z|R_Y)* T_Z",
        "T_Z R_Y|T_Y_Z (R_Y T_Z)*",
        "(T_Z T_Y_Z T_Z)+ R_Y*",
    )
}
SHIPPED = {action.name: action.pattern for action in HUMANOID_ACTIONS if action.pattern}
words = st.lists(st.sampled_from(ALPHABET), max_size=7).map(tuple)
libraries = st.lists(patterns(most=5), min_size=1, max_size=3).map(
    lambda several: {str(i): pattern for i, pattern in enumerate(several)}
)


def by_name(costs):
    return costs.name


def price_in(token_costs):
    return lambda a, b: float(token_costs.between([a], [b])[0, 0])


def assert_nearest_and_shortest(bank, library, word):
    found = occurrences(bank, word)
    for i, pattern in enumerate(library.values()):
        automaton = compile_automaton(pattern)
        read = reading(automaton, word, bank.token_costs)  # of each token, whatever part it is of
        for end in range(len(word) + 1):
            ways = [
                least_cost(automaton, read=read[start:end], skip=np.ones(end - start))
                for start in range(end + 1)
            ]
            assert found.distance[end, i] == min(ways)
            assert found.start[end, i] == max(k for k, d in enumerate(ways) if d == min(ways))


@pytest.mark.parametrize("costs", COSTS, ids=by_name)
def test_distances_are_the_naive_ones_for_all_short_words(costs):
    bank = compile_library(PATTERNS, costs)
    for n in range(4):
        for word in product(ALPHABET, repeat=n):
            naive = [distance(word, pattern, price_in(costs)) for pattern in PATTERNS.values()]
            assert distances(bank, word).tolist() == naive, word


@pytest.mark.parametrize("costs", COSTS, ids=by_name)
@settings(deadline=None, max_examples=40)
@given(libraries, words)
def test_occurrences_are_the_nearest_and_shortest_parts(costs, library, word):
    assert_nearest_and_shortest(compile_library(library, costs), library, word)


@pytest.mark.parametrize("costs", COSTS, ids=by_name)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.long
def test_occurrences_are_the_nearest_and_shortest_parts_of_long_strings(costs, seed):
    rng = np.random.default_rng(seed)
    tokens = sorted({token for pattern in SHIPPED.values() for token in pattern.tokens()})
    word = tuple(tokens[i] for i in rng.integers(len(tokens), size=30))
    assert_nearest_and_shortest(compile_library(SHIPPED, costs), SHIPPED, word)


@pytest.mark.parametrize("costs", COSTS, ids=by_name)
@pytest.mark.parametrize("seed", range(3))
def test_the_shipped_actions_are_measured_as_one_by_one(costs, seed):
    rng = np.random.default_rng(seed)
    bank = compile_library(SHIPPED, costs)
    tokens = sorted({token for pattern in SHIPPED.values() for token in pattern.tokens()})
    word = tuple(tokens[i] for i in rng.integers(len(tokens), size=200))
    automata = [compile_automaton(pattern) for pattern in SHIPPED.values()]
    one_by_one = [edit_distance(automaton, word, costs) for automaton in automata]
    assert distances(bank, word).tolist() == one_by_one
    faint, skip = rng.uniform(0.0, 0.5, 200), rng.uniform(0.0, 1.0, 200)
    priced = least_costs(bank, read=np.maximum(bank.reading(word), faint[:, None]), skip=skip)
    for automaton, cost in zip(automata, priced, strict=True):
        read = np.maximum(reading(automaton, word, costs), faint[:, None])
        assert cost == pytest.approx(least_cost(automaton, read=read, skip=skip), rel=1e-12)


@pytest.mark.parametrize("costs", COSTS, ids=by_name)
def test_the_costs_of_many_parts_are_those_of_each_alone(costs):
    rng = np.random.default_rng(3)
    bank = compile_library(PATTERNS, costs)
    automata = [compile_automaton(pattern) for pattern in PATTERNS.values()]
    word = [ALPHABET[i] for i in rng.integers(len(ALPHABET), size=12)]
    skip = rng.uniform(0.1, 1.0, len(word))
    parts = [(i, j) for i in range(len(word) + 1) for j in range(i, len(word) + 1)]
    parts = [parts[i] for i in rng.permutation(len(parts))] + parts[:3]
    found = least_costs_of_parts(bank, parts, read=bank.reading(word), skip=skip)
    for (first, last), each in zip(parts, found, strict=True):
        for automaton, cost in zip(automata, each, strict=True):
            read = reading(automaton, word[first:last], costs)
            expected = least_cost(automaton, read=read, skip=skip[first:last])
            assert cost == pytest.approx(expected, rel=1e-12)
    assert least_costs_of_parts(bank, [], read=bank.reading(word), skip=skip).shape == (0, 7)


def test_graded_distances_are_never_larger():
    rng = np.random.default_rng(0)
    tokens = sorted({token for pattern in SHIPPED.values() for token in pattern.tokens()})
    word = tuple(tokens[i] for i in rng.integers(len(tokens), size=40))
    unit, graded = (distances(compile_library(SHIPPED, costs), word) for costs in COSTS)
    assert (graded <= unit).all()
    assert (graded < unit).all()


def test_the_order_of_the_library_does_not_matter():
    word = tuple(map(Token.parse, ["T_Z", "R_Y", "T_Z", "T_Y_Z", "R_Y"]))
    turned = dict(reversed(PATTERNS.items()))
    forwards, backwards = (distances(compile_library(p), word) for p in (PATTERNS, turned))
    assert forwards.tolist() == backwards[::-1].tolist()


def test_an_empty_library_or_string_is_measured():
    word = (Token.parse("T_Z"),)
    assert distances(compile_library({}), word).shape == (0,)
    assert occurrences(compile_library({}), word).distance.shape == (2, 0)
    bank = compile_library(PATTERNS)
    assert distances(bank, ()).tolist() == bank.shortest.tolist()
    assert occurrences(bank, ()).distance.tolist() == [bank.shortest.tolist()]


def test_a_bank_is_small_and_cannot_be_changed():
    bank = compile_library(SHIPPED)
    arrays = (bank.tokens, bank.first, bank.state, bank.enter, bank.leave)
    arrays += (bank.source, bank.missing, bank.way, bank.shortest)
    assert sum(array.nbytes for array in arrays) < 60_000
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
