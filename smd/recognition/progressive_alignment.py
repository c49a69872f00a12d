"""Progressive alignment: several token sequences side by side, like tokens in one column."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.alphabet import NONE, angles_rad
from smd.recognition.tokens import Token, bins_of

UNLIKE = 1.0 - 1e-9
"""Tokens at this distance or more have nothing in common; the sums of shares round."""


@dataclass(frozen=True, slots=True)
class WeightedToken:
    """A token of a sequence, and how much of the sequence's movement it is.

    Attributes
    ----------
    token : which one.
    weight : in [0, 1]; 1 for the largest of its sequence.
    """

    token: Token
    weight: float


@dataclass(frozen=True, slots=True)
class Column:
    """The tokens of several aligned sequences in one column.

    Attributes
    ----------
    entries : one per sequence, None where a sequence has a gap; not all None.
    """

    entries: tuple[WeightedToken | None, ...]

    @property
    def tokens(self) -> frozenset[Token]:
        """What stands here in any sequence."""
        return frozenset(entry.token for entry in self.entries if entry)

    @property
    def weight(self) -> float:
        """Mean weight over all sequences, a gap counting as 0."""
        return sum(entry.weight for entry in self.entries if entry) / len(self.entries)

    @property
    def is_full(self) -> bool:
        """Whether no sequence has a gap here."""
        return None not in self.entries


def token_distances(tokens: Sequence[Token], others: Sequence[Token]) -> FloatArray:
    """Return ``(n, m)``: the distances of n tokens from m others, in [0, 1].

    It is the mean over translation and rotation, where either token has them, of the angle between
    the directions: 1 from a right angle on, and where one token has no direction. Stillness is at
    distance 1 from all else.
    """
    total, parts = np.zeros((2, len(tokens), len(others)))
    for ours, theirs in zip(bins_of(tokens), bins_of(others), strict=True):
        total += _apart()[np.ix_(ours, theirs)]
        parts += (ours[:, None] != NONE) | (theirs != NONE)
    return total / np.maximum(parts, 1.0)


def token_distance(a: Token, b: Token) -> float:
    """Return how unlike two tokens are, in [0, 1], as `token_distances` does."""
    return float(token_distances((a,), (b,))[0, 0])


def progressively_aligned(sequences: Sequence[Sequence[WeightedToken]]) -> tuple[Column, ...]:
    """Align sequences at the least cost found by adding one after another.

    Progressive alignment [1]_: the first sequence makes the columns; each next one, the most like
    it first, is aligned to the columns so far. A token without a partner costs its weight, a gap in
    a column the mean weight of what stands there, and a token in a column their mean distance
    times both. Tokens that are unlike (`token_distance` of 1) never share a column.

    Parameters
    ----------
    sequences
        At least one.

    Returns
    -------
    tuple of Column
        Every sequence reads through them from left to right.

    References
    ----------
    .. [1] D.-F. Feng, R. F. Doolittle, "Progressive sequence alignment as a prerequisite to
       correct phylogenetic trees", Journal of Molecular Evolution 25(4), 1987.
    """
    first = [[entry] for entry in sequences[0]]
    to_first = [_aligned(first, sequence)[0] for sequence in sequences]
    order = [0, *sorted(range(1, len(sequences)), key=to_first.__getitem__)]
    columns: list[list[WeightedToken | None]] = [[entry] for entry in sequences[0]]
    for added, index in enumerate(order[1:], start=1):
        _, pairs = _aligned(columns, sequences[index])
        columns = [
            [
                *(columns[column] if column is not None else [None] * added),
                sequences[index][item] if item is not None else None,
            ]
            for column, item in pairs
        ]
    back = np.argsort(order)
    return tuple(Column(tuple(column[i] for i in back)) for column in columns)


@cache
def _apart() -> FloatArray:
    """Return ``(27, 27)``: the angle between directions over a right one, at most 1.

    It is 1 where only one of them is none, 0 where both are.
    """
    apart = np.minimum(angles_rad() / (0.5 * np.pi), 1.0)
    np.fill_diagonal(apart, 0.0)
    return apart


def _aligned(
    columns: Sequence[Sequence[WeightedToken | None]], sequence: Sequence[WeightedToken]
) -> tuple[float, list[tuple[int | None, int | None]]]:
    """Return the least cost of aligning a sequence to columns, and the pairs, in order."""
    m, n = len(columns), len(sequence)
    passed = [sum(s.weight for s in column if s) / len(column) for column in columns]
    alone = [entry.weight for entry in sequence]
    unlike = _mean_distances(columns, sequence)
    cost = np.zeros((m + 1, n + 1)).tolist()
    for i in range(m + 1):
        for j in range(n + 1):
            if i or j:
                cost[i][j] = min(way[0] for way in _ways(cost, i, j, passed, alone, unlike))
    pairs: list[tuple[int | None, int | None]] = []
    i, j = m, n
    while i or j:
        _, column, item = min(_ways(cost, i, j, passed, alone, unlike), key=lambda way: way[0])
        pairs.append((column, item))
        i, j = i - (column is not None), j - (item is not None)
    return float(cost[m][n]), pairs[::-1]


def _ways(
    cost: list[list[float]],
    i: int,
    j: int,
    passed: list[float],
    alone: list[float],
    unlike: FloatArray,
) -> list[tuple[float, int | None, int | None]]:
    """Return the ways to have used i columns and j items: cost, column used, item used."""
    ways: list[tuple[float, int | None, int | None]] = []
    if i:
        ways.append((cost[i - 1][j] + passed[i - 1], i - 1, None))
    if j:
        ways.append((cost[i][j - 1] + alone[j - 1], None, j - 1))
    if i and j and unlike[i - 1, j - 1] < UNLIKE:
        both = float(unlike[i - 1, j - 1]) * (passed[i - 1] + alone[j - 1])
        ways.append((cost[i - 1][j - 1] + both, i - 1, j - 1))
    return ways


def _mean_distances(
    columns: Sequence[Sequence[WeightedToken | None]], sequence: Sequence[WeightedToken]
) -> FloatArray:
    """Return ``(columns, items)``: the mean distance of a column's tokens to each item's."""
    held = [[entry.token for entry in column if entry] for column in columns]
    tokens = tuple(dict.fromkeys(token for column in held for token in column))
    place = {token: i for i, token in enumerate(tokens)}
    share = np.zeros((len(columns), len(tokens)))
    for i, column in enumerate(held):
        for token in column:
            share[i, place[token]] += 1.0 / len(column)
    return share @ token_distances(tokens, [entry.token for entry in sequence])
