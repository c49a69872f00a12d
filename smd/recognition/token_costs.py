"""TokenCosts: what it costs to take one token for another."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from smd.errors import PatternError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array
from smd.geometry.rotations import normalized
from smd.recognition.tokenizer import DIRECTIONS, NONE
from smd.recognition.tokens import Token

_STEPS = 64.0
"""Costs are whole multiples of 1/64 edit, so that their sums are exact and ties are ties."""


@dataclass(frozen=True, slots=True, eq=False)
class TokenCosts:
    """What it costs to take one token for another, in edits.

    Attributes
    ----------
    name : what they are called where figures are printed.
    matrix : (729, 729) float64, by the tokens' codes (`codes_of`); symmetric, 0 on the diagonal
        and more elsewhere, at most 1 (a token too many, or one missing, costs 1).
    """

    name: str
    matrix: FloatArray

    def __post_init__(self) -> None:
        n = len(DIRECTIONS) ** 2
        matrix = frozen_array("matrix", self.matrix, (n, n), PatternError)
        off_diagonal = matrix[~np.eye(n, dtype=bool)]
        fits = np.array_equal(matrix, matrix.T) and not matrix.diagonal().any()
        if not fits or off_diagonal.min() <= 0.0 or off_diagonal.max() > 1.0:
            raise PatternError(
                f"token costs {self.name!r}: expected a symmetric matrix, 0 on the diagonal, "
                "elsewhere above 0 and at most 1"
            )
        object.__setattr__(self, "matrix", matrix)

    def between(self, tokens: Iterable[Token], others: Iterable[Token]) -> FloatArray:
        """Return ``(n, m)``, the cost of taking each of n tokens for each of m others."""
        return np.asarray(self.matrix[np.ix_(codes_of(tokens), codes_of(others))])


@cache
def _codes() -> dict[Token, int]:
    """Return the code of every token."""
    pairs = ((translation, rotation) for translation in DIRECTIONS for rotation in DIRECTIONS)
    return {Token(*pair): code for code, pair in enumerate(pairs)}


def codes_of(tokens: Iterable[Token]) -> IntArray:
    """Return the tokens' codes: 27 times the bin of translation, plus that of rotation."""
    codes = _codes()
    return np.array([codes[token] for token in tokens], dtype=np.int64)


@cache
def unit_costs() -> TokenCosts:
    """Return the paper's costs (section 4.2): every other token is one edit away."""
    return TokenCosts("unit", 1.0 - np.eye(len(DIRECTIONS) ** 2))


@cache
def graded_costs(*, far_rad: float = np.pi, begun: float = 0.5) -> TokenCosts:
    """Return costs by how far apart two tokens' directions are.

    Translation and rotation each cost the angle between their directions, as a share of
    ``far_rad`` (more costs no more), or ``begun`` where only one of the two tokens moves (turns)
    at all. The two add up, to 1 at most.
    """
    units = normalized(np.array(DIRECTIONS, dtype=np.float64))
    angle = np.arccos(np.clip(units @ units.T, -1.0, 1.0))
    part = np.minimum(angle / far_rad, 1.0)
    part[NONE, :] = part[:, NONE] = begun
    np.fill_diagonal(part, 0.0)
    both = part[:, None, :, None] + part[None, :, None, :]
    n = len(DIRECTIONS) ** 2
    matrix = np.minimum(both.reshape(n, n), 1.0)
    return TokenCosts("graded", np.ceil(matrix * _STEPS - 1e-9) / _STEPS)
