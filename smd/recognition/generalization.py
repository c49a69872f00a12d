"""Generalization: from the token sequences of examples to the pattern they have in common."""

from __future__ import annotations

from collections.abc import Sequence

from smd.recognition import pattern as ast
from smd.recognition.pattern import Pattern
from smd.recognition.progressive_alignment import (
    UNLIKE,
    Column,
    WeightedToken,
    progressively_aligned,
    token_distances,
)
from smd.recognition.simplification import Group, simplified
from smd.recognition.tokens import STILL, Token

MANDATORY_SHARE = 0.2
"""A token is mandatory if its movement is at least this share of the largest in its example, on
average over the examples; smaller ones may be a start, a stop, or a rounded corner."""

ENOUGH_EXAMPLES = 3
"""From so many examples on, a token that all of them have is mandatory, however small."""

MOST_OPTIONAL = 3
"""Optional columns between two mandatory ones; more become one group that has all their tokens."""


def generalized(examples: Sequence[Sequence[WeightedToken]]) -> tuple[Group, ...]:
    """Return groups of tokens that all of several sequences match, from left to right.

    Section 4.3 of the paper [1]_, with one change: it pairs the mandatory tokens of the examples
    by their index, so that one extra token in one example shifts all that follow. Here sequences
    are aligned so that similar tokens stand in one column. A column where every example has a
    token, and whose movement is not negligible, becomes a mandatory group of its tokens; the
    columns between become optional groups, in their order.

    Parameters
    ----------
    examples
        At least one, none empty. The first one is where the alignment begins.

    Returns
    -------
    tuple of Group
        Accepts every example; empty if they share no column that must occur.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    """
    groups: list[Group] = []
    between: list[Group] = []
    for column in progressively_aligned(examples):
        if _is_mandatory(column):
            groups += [*_few(between), Group(column.tokens, optional=False)]
            between = []
        else:
            between.append(Group(column.tokens, optional=True))
    return simplified([*groups, *_few(between)]) if groups else ()


def ways_of(examples: Sequence[Sequence[WeightedToken]]) -> list[tuple[Group, ...]]:
    """Return the ways in which a gesture is drawn: as few as have a mandatory column each.

    If all examples share a column there is one way, that of `generalized`. If not, those that
    share the fullest column (the larger movement, if several are as full) are separated from the
    others, and so on: each example is accepted by one of the ways.
    """
    groups = generalized(examples)
    if groups:
        return [groups]
    columns = progressively_aligned(examples)
    fullest = max(columns, key=lambda column: (_count(column) * _moves(column), column.weight))
    parts: tuple[list[Sequence[WeightedToken]], list[Sequence[WeightedToken]]] = ([], [])
    for example, stroke in zip(examples, fullest.entries, strict=True):
        parts[stroke is None].append(example)
    if not all(parts):  # a column all have, but a trifle: the first example goes alone
        parts = ([examples[0]], list(examples[1:]))
    return [way for part in parts for way in ways_of(part)]


def pattern_of(ways: Sequence[Sequence[Group]]) -> Pattern:
    """Return ways, each of groups of which one is mandatory at least, as a pattern."""
    return Pattern(ast.Choice(tuple(_sequence(groups) for groups in ways)))


def _sequence(groups: Sequence[Group]) -> ast.Node:
    """Return groups as an expression."""
    parts = []
    for group in groups:
        tokens = sorted(group.tokens, key=_plain_first)
        parts.append(ast.Repeat(ast.Choice(tuple(tokens)), optional=group.optional))
    return ast.Sequence(tuple(parts))


def odd_one_out(examples: Sequence[Sequence[WeightedToken]]) -> int:
    """Return the example whose largest movement is least like those of the others."""
    main = [main_token(strokes) for strokes in examples]
    return int(token_distances(main, main).sum(axis=1).argmax())


def stranger(examples: Sequence[Sequence[WeightedToken]]) -> int | None:
    """Return an example none of whose movements resembles one of any other example, or None.

    If there are several, it is the one whose largest movement is least similar to the others'.
    """
    large = [{s.token for s in one if s.weight >= MANDATORY_SHARE} for one in examples]
    odd = odd_one_out(examples)
    for index in (odd, *(i for i in range(len(examples)) if i != odd)):
        others = set().union(*(large[i] for i in range(len(examples)) if i != index))
        if (token_distances(tuple(large[index]), tuple(others)) >= UNLIKE).all():
            return index
    return None


def main_token(strokes: Sequence[WeightedToken]) -> Token:
    """Return the token of a sequence's largest movement."""
    return max(strokes, key=lambda stroke: stroke.weight).token


def _count(column: Column) -> int:
    """Return how many sequences have something at a column."""
    return sum(entry is not None for entry in column.entries)


def _moves(column: Column) -> bool:
    """Tell whether what stands at a column moves."""
    return STILL not in column.tokens


def _is_mandatory(column: Column) -> bool:
    """Tell whether what stands at a column must occur."""
    if not column.is_full or STILL in column.tokens:
        return False
    agreed = len(column.tokens) == 1 and len(column.entries) >= ENOUGH_EXAMPLES
    return agreed or column.weight >= MANDATORY_SHARE


def _few(optional: list[Group]) -> list[Group]:
    """Return optional groups, all in one if they are many."""
    optional = list(simplified(optional))
    if len(optional) <= MOST_OPTIONAL:
        return optional
    return [Group(frozenset().union(*(group.tokens for group in optional)), optional=True)]


def _plain_first(token: Token) -> tuple[int, Token]:
    """Sort tokens along few axes first, for reading."""
    return sum(map(abs, (*token.translation, *token.rotation))), token
