"""Patterns at random, for Hypothesis."""

from __future__ import annotations

from hypothesis import strategies as st

from smd.recognition import pattern as ast
from smd.recognition.pattern import Pattern, accepts_empty
from smd.recognition.tokens import Token

ABC = tuple(map(Token.parse, ("T_Z", "T_Y_Z", "R_Y")))


def nodes(tokens=ABC, most=6):
    """Expressions over a few tokens, nested at will."""

    def deeper(inner):
        some = st.lists(inner, min_size=1, max_size=3).map(tuple)
        return st.one_of(
            some.map(ast.Sequence),
            some.map(ast.Choice),
            st.builds(ast.Repeat, inner, st.booleans()),
        )

    return st.recursive(st.sampled_from(tokens), deeper, max_leaves=most)


def patterns(tokens=ABC, most=6):
    return nodes(tokens, most).filter(lambda node: not accepts_empty(node)).map(Pattern)
