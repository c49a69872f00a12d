from __future__ import annotations

import time

import pytest
from hypothesis import HealthCheck, given, settings

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.recognition.automaton import compile_automaton, edit_distance
from smd.recognition.collisions import collisions, collisions_of
from smd.recognition.pattern import Pattern
from tests.naive.pattern_language import language
from tests.naive.patterns_at_random import patterns

SHIPPED = {action.name: action.pattern for action in HUMANOID_ACTIONS if action.pattern}
LONGEST = 7


def library(**texts):
    return {name: Pattern.parse(text) for name, text in texts.items()}


def only(found):
    assert len(found) == 1
    return found[0]


def accepts(pattern, word):
    return edit_distance(compile_automaton(pattern), word) == 0


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(patterns(), patterns())
def test_the_kind_is_what_enumeration_says(a, b):
    of_a, of_b = language(a, LONGEST), language(b, LONGEST)
    found = collisions({"a": a, "b": b}, within=0)
    kind = found[0].kind if found else None
    if kind in ("equal", "contained", "shared"):
        assert accepts(a, found[0].witness)
        assert accepts(b, found[0].witness)
        assert found[0].distance == 0
    if of_a == of_b:
        assert kind == "equal" or len(found[0].suggestion) > 0
    elif not of_a & of_b:
        assert kind in (None, "part") or len(found[0].witness) > LONGEST
    elif of_a < of_b:
        assert kind == "shared" or (kind, found[0].first) == ("contained", "a")
    elif of_b < of_a:
        assert kind == "shared" or (kind, found[0].first) == ("contained", "b")
    else:
        assert kind == "shared"


@pytest.mark.parametrize(
    ("a", "b", "kind", "line"),
    [
        (
            "T_Z+ T_Z*",
            "T_Z",
            "equal",
            "a and b are drawn alike: both accept T_Z; draw one of them with another movement",
        ),
        (
            "T_Z+ T_Y*",
            "T_Z+",
            "contained",
            "b is contained in a: both accept T_Z; add to b a movement that a never has, "
            "or draw a as T_Z T_Y, where b never has T_Y",
        ),
        (
            "T_Z T_Y*",
            "T_Z T_X*",
            "shared",
            "a and b overlap: both accept T_Z; only a is drawn as T_Z T_Y, only b as T_Z T_X",
        ),
        (
            "T_Z T_N_Z",
            "T_X T_Z (T_N_Z T_Z)+ T_X",
            "part",
            "a lies inside b: T_Z T_N_Z inside T_X T_Z T_N_Z T_Z T_X; "
            "pause before and after a, or add to it a movement that b never has",
        ),
        (
            "T_Z T_N_Y",
            "T_Y_Z T_N_Y",
            "near",
            "a and b are 1 edit apart: T_Z T_N_Y against T_Y_Z T_N_Y; "
            "draw T_Y_Z or T_Z large and clear",
        ),
    ],
)
def test_each_kind_is_said_in_one_line(a, b, kind, line):
    found = only(collisions(library(a=a, b=b)))
    assert found.kind == kind
    assert str(found) == line


def test_what_is_opposite_or_far_is_no_collision():
    assert collisions(library(left="T_X", right="T_N_X", up="T_Y", turn="R_Y")) == ()
    near = library(a="T_Z T_N_Y", b="T_Y_Z T_N_Y")
    assert collisions(near, within=0) == ()


def test_what_lies_inside_some_strings_only_is_not_told():
    assert collisions(library(a="T_Z T_X T_Z", b="R_Y (T_Z T_X T_Z)* R_Z"), within=0) == ()


def test_the_worst_come_first():
    found = collisions(library(a="T_Z", b="T_Y_Z", c="T_Z", d="T_Z T_X*", e="T_X T_Z T_X"))
    kinds = [one.kind for one in found]
    assert kinds == sorted(kinds, key=("equal", "contained", "shared", "part", "near").index)
    assert (found[0].first, found[0].second) == ("a", "c")


def test_the_collisions_of_one_action_are_those_that_name_it():
    all_pairs = {
        frozenset((one.first, one.second)): one.kind
        for one in collisions(SHIPPED)
        if "run" in (one.first, one.second)
    }
    ours = {frozenset((one.first, one.second)): one.kind for one in collisions_of("run", SHIPPED)}
    assert ours == all_pairs
    assert len(ours) > 2


def test_nothing_collides_in_a_library_of_none_or_one():
    assert collisions({}) == ()
    assert collisions(library(a="T_Z")) == ()


def test_what_the_shipped_patterns_share_both_accept():
    for one in collisions(SHIPPED):
        if one.kind == "shared":
            assert accepts(SHIPPED[one.first], one.witness)
            assert accepts(SHIPPED[one.second], one.witness)
        if one.kind == "part":
            assert accepts(SHIPPED[one.first], one.witness)
            assert accepts(SHIPPED[one.second], one.counterpart)


def test_forty_actions_are_compared_within_seconds():
    some = list(SHIPPED.items())[:11]
    many = {f"{name}_{i}": pattern for i in range(4) for name, pattern in some}
    many = dict(list(many.items())[:40])
    started = time.process_time()
    found = collisions(many)
    # Two seconds on a quiet machine; the bound leaves room for a busy one.
    assert time.process_time() - started < 6.0
    # Seven actions are there four times, with six pairs each, and four three times, with three.
    assert sum(one.kind == "equal" for one in found) == 7 * 6 + 4 * 3
