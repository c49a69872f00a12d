"""TokenCosts: the costs of substituting one token for another."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from laban.frozen import Frozen
from smd.errors import PatternError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array
from smd.recognition.alphabet import BINS, NONE, angles_rad
from smd.recognition.tokens import Token, bins_of_codes, codes_of

_STEPS = 64.0
"""Costs are whole multiples of 1/64 edit, so that their sums are exact and ties are ties."""


@dataclass(frozen=True, slots=True, eq=False)
class TokenCosts(Frozen):
    """The costs of substituting one token for another, in edits.

    The costs of translation and of rotation are added, to 1 at most (the cost of an insertion or a
    deletion), and rounded up to a whole multiple of 1/64. So two small tables replace one of all
    pairs of tokens.

    Attributes
    ----------
    name : what they are called where figures are printed.
    translation, rotation : (27, 27) float64, by bins (`smd.recognition.alphabet`); symmetric, 0 on
        the diagonal and more elsewhere, at most 1.
    """

    name: str
    translation: FloatArray
    rotation: FloatArray

    def __post_init__(self) -> None:
        for part in ("translation", "rotation"):
            matrix = frozen_array(part, getattr(self, part), (BINS, BINS), PatternError)
            off_diagonal = matrix[~np.eye(BINS, dtype=bool)]
            fits = np.array_equal(matrix, matrix.T) and not matrix.diagonal().any()
            if not fits or off_diagonal.min() <= 0.0 or off_diagonal.max() > 1.0:
                raise PatternError(
                    f"token costs {self.name!r}, {part}: expected a symmetric matrix, 0 on the "
                    "diagonal, elsewhere above 0 and at most 1"
                )
            object.__setattr__(self, part, matrix)

    def between(self, tokens: Iterable[Token], others: Iterable[Token]) -> FloatArray:
        """Return ``(n, m)``, the cost of substituting each of n tokens for each of m others."""
        codes = codes_of(others)
        return self.to_nearest(codes_of(tokens), codes, np.arange(len(codes)))

    def to_nearest(self, codes: IntArray, others: IntArray, first: IntArray) -> FloatArray:
        """Return ``(n, s)``, the cost of taking each of n tokens for the nearest of each of s sets.

        Parameters
        ----------
        codes
            ``(n,)``, of the tokens.
        others
            ``(k,)``, codes of the tokens of the sets, set after set; none is empty.
        first
            ``(s,)``, where each set begins among them.
        """
        (moved, turned), (other_moved, other_turned) = map(bins_of_codes, (codes, others))
        every = np.take(self.translation[moved], other_moved, axis=1)
        every += np.take(self.rotation[turned], other_turned, axis=1)
        # What is rounded up last, of the nearest alone, comes out as if all had been.
        cost = np.minimum(np.minimum.reduceat(every, first, axis=1), 1.0)
        # - 1e-9: a sum that is a whole multiple but for rounding; + 0.0: what was 0 is not -0.
        return np.asarray(np.ceil(cost * _STEPS - 1e-9) / _STEPS + 0.0)


@cache
def unit_costs() -> TokenCosts:
    """Return the paper's costs (section 4.2): every other token is one edit away."""
    other = 1.0 - np.eye(BINS)
    return TokenCosts("unit", other, other)


@cache
def graded_costs(*, far_rad: float = np.pi, begun: float = 0.5) -> TokenCosts:
    """Return costs that grow with the angle between two tokens' directions.

    Translation and rotation each cost the angle between their directions, as a share of
    ``far_rad`` (more costs no more), or ``begun`` where only one of the two tokens moves (turns)
    at all. The two add up, to 1 at most.
    """
    part = np.minimum(angles_rad() / far_rad, 1.0)
    part[NONE, :] = part[:, NONE] = begun
    np.fill_diagonal(part, 0.0)
    return TokenCosts("graded", part, part)
