from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from smd.recognition.generalization import pattern_of
from smd.recognition.languages import extra_word
from smd.recognition.simplification import Group, simplified
from tests.naive.patterns_at_random import ABC

groups = st.builds(Group, st.sets(st.sampled_from(ABC), min_size=1).map(frozenset), st.booleans())
chains = st.lists(groups, min_size=1, max_size=5).filter(
    lambda chain: not all(group.optional for group in chain)
)


@settings(max_examples=200, deadline=None)
@given(chains)
def test_simplifying_does_not_change_the_language(chain):
    one, other = pattern_of([chain]), pattern_of([simplified(chain)])
    assert extra_word(one, other) is None
    assert extra_word(other, one) is None


@settings(max_examples=200, deadline=None)
@given(chains)
def test_no_group_that_is_left_is_needless(chain):
    kept = simplified(chain)
    for i in range(len(kept)):
        rest = kept[:i] + kept[i + 1 :]
        if any(not group.optional for group in rest):
            assert simplified(rest) == rest or len(rest) < len(kept)
            neighbours = [*kept[max(i - 1, 0) : i], *kept[i + 1 : i + 2]]
            needless = any(kept[i].tokens <= n.tokens for n in neighbours)
            assert not (needless and kept[i].optional)


def test_simplifying_twice_is_simplifying_once():
    a, b = ABC[:2]
    chain = [
        Group(frozenset({a}), True),
        Group(frozenset({a, b}), False),
        Group(frozenset({a, b}), False),
        Group(frozenset({b}), True),
        Group(frozenset({b}), False),
    ]
    once = simplified(chain)
    assert once == (Group(frozenset({a, b}), False), Group(frozenset({b}), False))
    assert simplified(once) == once
