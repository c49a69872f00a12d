from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from smd.recognition.automaton import compile_automaton, edit_distance
from smd.recognition.languages import (
    extra_word,
    holding_word,
    inner_word,
    nearest_words,
    word_without,
)
from smd.recognition.pattern import Pattern, merged
from tests.naive.pattern_language import language
from tests.naive.patterns_at_random import ABC, patterns

LONGEST = 7
some = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def parse(text):
    """``a`` is T_Z, ``b`` T_Y_Z, ``c`` R_Y."""
    for letter, token in zip("abc", ABC, strict=True):
        text = text.replace(letter, f" {token} ")
    return Pattern.parse(text)


def word(text):
    return tuple(ABC["abc".index(letter)] for letter in text)


def accepts(pattern, string):
    return edit_distance(compile_automaton(pattern), string) == 0


def inside(part, whole):
    return any(whole[i : i + len(part)] == part for i in range(len(whole) - len(part) + 1))


def shared_word(a, b):
    found = nearest_words(a, b, most=0)
    return found.first if found else None


def same_language(a, b):
    return extra_word(a, b) is None and extra_word(b, a) is None


def shortest(strings):
    return min(map(len, strings), default=None)


@some
@given(patterns(), patterns())
def test_the_shared_word_is_a_shortest_of_both(a, b):
    both = language(a, LONGEST) & language(b, LONGEST)
    found = shared_word(a, b)
    if found is None:
        assert not both
    else:
        assert accepts(a, found)
        assert accepts(b, found)
        assert len(found) == (shortest(both) or len(found))


@some
@given(patterns(), patterns())
def test_the_extra_word_is_a_shortest_of_one_alone(a, b):
    alone = language(a, LONGEST) - language(b, LONGEST)
    found = extra_word(a, b)
    if found is None:
        assert not alone
    else:
        assert accepts(a, found)
        assert not accepts(b, found)
        assert len(found) == (shortest(alone) or len(found))


@some
@given(patterns(), patterns())
def test_the_inner_word_is_a_shortest_that_lies_in_a_string_of_the_other(a, b):
    wholes = language(a, LONGEST)
    parts = {w for w in language(b, LONGEST) if any(inside(w, whole) for whole in wholes)}
    found = inner_word(a, b)
    if found is None:
        assert not parts
    else:
        assert accepts(b, found)
        assert len(found) <= (shortest(parts) or len(found))
        if parts:
            assert len(found) == shortest(parts)


@some
@given(patterns(), patterns())
def test_the_holding_word_is_a_shortest_with_a_string_of_the_other_inside(a, b):
    parts = language(b, LONGEST)
    wholes = {w for w in language(a, LONGEST) if any(inside(part, w) for part in parts)}
    found = holding_word(a, b)
    if found is None:
        assert not wholes
    else:
        assert accepts(a, found)
        assert len(found) == (shortest(wholes) or len(found))
        assert found in wholes or len(found) > LONGEST


@some
@given(patterns(), patterns())
def test_the_word_without_is_a_shortest_with_no_string_of_the_other_inside(a, b):
    parts = language(b, LONGEST)
    free = {w for w in language(a, LONGEST) if not any(inside(part, w) for part in parts)}
    found = word_without(a, b)
    if found is None:
        assert not free
    else:
        assert accepts(a, found)
        assert len(found) == (shortest(free) or len(found))
        assert found in free or len(found) > LONGEST


@settings(some, max_examples=60)
@given(patterns(most=3), patterns(most=3))
def test_the_nearest_words_are_as_near_as_any(a, b):
    automaton = compile_automaton(b)
    strings = (w for n in range(1, 6) for w in product(ABC, repeat=n))
    tried = min(edit_distance(automaton, w) for w in strings if accepts(a, merged(w)))
    found = nearest_words(a, b, most=3)
    assert found.distance == tried
    assert accepts(a, found.first)
    assert accepts(b, found.second)


@settings(some, max_examples=40)
@given(patterns(most=3), patterns(most=3))
def test_replacing_what_may_not_be_replaced_takes_two_edits(a, b):
    """Then only what is left out and put in counts: the longest common string of unmerged ones."""
    found = nearest_words(a, b, most=3, replaceable=nothing)
    left = [w for n in range(1, 5) for w in product(ABC, repeat=n) if accepts(a, merged(w))]
    right = [w for n in range(1, 5) for w in product(ABC, repeat=n) if accepts(b, merged(w))]
    tried = min((len(v) + len(w) - 2 * common(v, w) for v, w in product(left, right)), default=9)
    if found is None:
        assert tried > 3
    else:
        assert found.distance == tried


def nothing(tokens, others):
    return np.zeros((len(tokens), len(others)), bool)


def common(v, w):
    """Length of the longest common subsequence."""
    above = [0] * (len(w) + 1)
    for a in v:
        row = [0]
        for j, b in enumerate(w):
            row.append(above[j] + 1 if a == b else max(row[j], above[j + 1]))
        above = row
    return above[-1]


@some
@given(patterns(), st.integers(0, 3))
def test_no_further_than_asked(a, most):
    far = Pattern.parse("R_X R_Z R_X R_Z R_X R_Z R_X R_Z")
    found = nearest_words(a, far, most=most)
    assert found is None


@some
@given(patterns())
def test_a_pattern_has_its_own_language_and_not_that_of_more(a):
    assert same_language(a, a)
    assert not same_language(a, Pattern.parse(f"({a})|R_X"))


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        ("a+", "a", True),
        ("a a a", "a", True),
        ("(a|b)+ a*", "(a|b)+", True),
        ("(a|b)+ a", "(a|b)+", False),
        ("(a|b)+ (a|b)+", "(a|b)+", True),
        ("(a b)+", "a (b a)* b", True),
        ("(a b)+", "a (b a)* b*", False),
    ],
)
def test_known_languages(a, b, same):
    assert same_language(parse(a), parse(b)) == same


def test_known_words():
    assert shared_word(parse("a+ b*"), parse("b* a+ b c*")) == word("ab")
    assert shared_word(parse("a"), parse("b")) is None
    assert extra_word(parse("a b* c*"), parse("a b*")) == word("ac")
    assert inner_word(parse("a b c"), parse("b (a|c)")) == word("bc")
    assert inner_word(parse("a b c"), parse("c b")) is None
    assert word_without(parse("a b* c"), parse("b")) == word("ac")
    assert word_without(parse("a b+ c"), parse("b")) is None
    assert nearest_words(parse("a b a"), parse("a c a"), most=1).distance == 1
    assert nearest_words(parse("a b a"), parse("c a c"), most=2) is None
    near = nearest_words(parse("a b a c"), parse("a c"), most=2)
    assert (near.distance, near.first, near.second) == (1, word("abac"), word("ac"))


def test_sets_of_states_that_would_double_with_every_token_stay_few():
    """Twelve tokens after the last ``a``: a deterministic automaton has 4096 states."""
    either = "(a|b) c "
    late = parse("((a|b) c)* a c " + 12 * either)
    assert extra_word(late, late) is None
