"""Places: several token sequences laid side by side, so that like tokens stand at one place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized
from smd.recognition.tokenizer import DIRECTIONS, NONE
from smd.recognition.tokens import Token

UNLIKE = 1.0 - 1e-9
"""Tokens at this distance or more have nothing in common; the sums of shares round."""


@dataclass(frozen=True, slots=True)
class Stroke:
    """A token of a sequence, and how much of the sequence's movement it is.

    Attributes
    ----------
    token : which one.
    weight : in [0, 1]; 1 for the largest of its sequence.
    """

    token: Token
    weight: float


@dataclass(frozen=True, slots=True)
class Place:
    """What sequences have at one place.

    Attributes
    ----------
    strokes : one per sequence, None where a sequence has nothing there; not all None.
    """

    strokes: tuple[Stroke | None, ...]

    @property
    def tokens(self) -> frozenset[Token]:
        """What stands here in any sequence."""
        return frozenset(stroke.token for stroke in self.strokes if stroke)

    @property
    def weight(self) -> float:
        """Mean weight over all sequences, nothing counting as 0."""
        return sum(stroke.weight for stroke in self.strokes if stroke) / len(self.strokes)

    @property
    def is_full(self) -> bool:
        """Whether no sequence is without a token here."""
        return None not in self.strokes


def token_distances(tokens: Sequence[Token], others: Sequence[Token]) -> FloatArray:
    """Return ``(n, m)``: how unlike n tokens are to m others, in [0, 1].

    The mean over translation and rotation, where either token has them, of the angle between the
    directions, 1 from a right angle on and where one of them has none. Stillness is like nothing
    else.
    """
    total, parts = np.zeros((2, len(tokens), len(others)))
    for ours, theirs in zip(_bins(tokens), _bins(others), strict=True):
        total += _apart()[np.ix_(ours, theirs)]
        parts += (ours[:, None] != NONE) | (theirs != NONE)
    return total / np.maximum(parts, 1.0)


def token_distance(a: Token, b: Token) -> float:
    """Return how unlike two tokens are, in [0, 1], as `token_distances` does."""
    return float(token_distances((a,), (b,))[0, 0])


def laid_side_by_side(sequences: Sequence[Sequence[Stroke]]) -> tuple[Place, ...]:
    """Lay sequences side by side at the least cost found by adding one after another.

    Progressive alignment [1]_: the first sequence makes the places; each next one, the most like
    it first, is aligned to the places so far. A token without a partner costs its weight, a place
    passed over the mean weight of what stands there, and a token at a place their mean distance
    times both. Tokens that are unlike (`token_distance` of 1) never share a place.

    Parameters
    ----------
    sequences
        At least one.

    Returns
    -------
    tuple of Place
        Every sequence reads through them from left to right.

    References
    ----------
    .. [1] D.-F. Feng, R. F. Doolittle, "Progressive sequence alignment as a prerequisite to
       correct phylogenetic trees", Journal of Molecular Evolution 25(4), 1987.
    """
    first = [[stroke] for stroke in sequences[0]]
    to_first = [_aligned(first, sequence)[0] for sequence in sequences]
    order = [0, *sorted(range(1, len(sequences)), key=to_first.__getitem__)]
    columns: list[list[Stroke | None]] = [[stroke] for stroke in sequences[0]]
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
    return tuple(Place(tuple(column[i] for i in back)) for column in columns)


def _bins(tokens: Sequence[Token]) -> IntArray:
    """Return ``(2, n)``: the bins of the tokens' translations and of their rotations."""
    pairs = [(_INDEX[token.translation], _INDEX[token.rotation]) for token in tokens]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2).T


_INDEX = {direction: index for index, direction in enumerate(DIRECTIONS)}


@cache
def _apart() -> FloatArray:
    """Return ``(27, 27)``: the angle between directions over a right one, at most 1.

    It is 1 where only one of them is none, 0 where both are.
    """
    units = normalized(np.array(DIRECTIONS, dtype=np.float64))
    angle = np.arccos(np.clip(units @ units.T, -1.0, 1.0)) / (0.5 * np.pi)
    apart = np.minimum(angle, 1.0)
    np.fill_diagonal(apart, 0.0)
    return apart


def _aligned(
    columns: Sequence[Sequence[Stroke | None]], sequence: Sequence[Stroke]
) -> tuple[float, list[tuple[int | None, int | None]]]:
    """Return the least cost of aligning a sequence to columns, and the pairs, in order."""
    m, n = len(columns), len(sequence)
    passed = [sum(s.weight for s in column if s) / len(column) for column in columns]
    alone = [stroke.weight for stroke in sequence]
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
    columns: Sequence[Sequence[Stroke | None]], sequence: Sequence[Stroke]
) -> FloatArray:
    """Return ``(columns, items)``: the mean distance of a column's tokens to each item's."""
    held = [[stroke.token for stroke in column if stroke] for column in columns]
    tokens = tuple(dict.fromkeys(token for column in held for token in column))
    place = {token: i for i, token in enumerate(tokens)}
    share = np.zeros((len(columns), len(tokens)))
    for i, column in enumerate(held):
        for token in column:
            share[i, place[token]] += 1.0 / len(column)
    return share @ token_distances(tokens, [stroke.token for stroke in sequence])
