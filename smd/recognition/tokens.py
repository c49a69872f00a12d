"""Tokens: the direction in which a prop moves and turns, along its own axes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np

from smd.errors import PatternError
from smd.geometry.arrays import IntArray
from smd.recognition.alphabet import BINS, DIRECTIONS, INDEX, Direction, direction_name


@dataclass(frozen=True, slots=True, order=True)
class Token:
    """A direction of translation and a direction of rotation, each one of 27 bins.

    Printed as in the paper: ``T_Z`` forward, ``T_Y_Z`` forward and up, ``T_N_X`` to the right,
    ``R_Y`` turning left, ``T_Z/R_Y`` both, ``STILL`` neither.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 4.1.
    """

    translation: Direction = (0, 0, 0)
    rotation: Direction = (0, 0, 0)

    def __str__(self) -> str:
        named = (("T", self.translation), ("R", self.rotation))
        parts = [letter + name for letter, bin_ in named if (name := direction_name(bin_))]
        return "/".join(parts) or "STILL"

    @classmethod
    def parse(cls, name: str) -> Token:
        """Return the token that is printed as ``name``.

        Raises
        ------
        PatternError
            If no token is printed so.
        """
        token = _tokens_by_name().get(name)
        if token is None:
            raise PatternError(
                f"expected a token such as T_Z, R_N_Y, T_Y_Z/R_X or STILL, got {name[:40]!r}"
            )
        return token


def bins_of(tokens: Iterable[Token]) -> IntArray:
    """Return ``(2, n)``: the bins of the tokens' translations and of their rotations."""
    pairs = [(INDEX[token.translation], INDEX[token.rotation]) for token in tokens]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2).T


def codes_of(tokens: Iterable[Token]) -> IntArray:
    """Return the tokens' codes, one number each (`code_of_bins`)."""
    return code_of_bins(*bins_of(tokens))


def code_of_bins(translation: IntArray, rotation: IntArray) -> IntArray:
    """Return the codes of tokens: 27 times the bin of translation, plus that of rotation."""
    return BINS * translation + rotation


def bins_of_codes(codes: IntArray) -> tuple[IntArray, IntArray]:
    """Return the bins of translation and of rotation of tokens by their codes."""
    return np.divmod(codes, BINS)


@cache
def _tokens_by_name() -> dict[str, Token]:
    """Return every token by its name."""
    tokens = (Token(translation, rotation) for translation in DIRECTIONS for rotation in DIRECTIONS)
    return {str(token): token for token in tokens}


STILL = Token()
"""Neither moving nor turning."""


@dataclass(frozen=True, slots=True)
class TokenRun:
    """One token held over the samples ``first`` (included) to ``last`` (excluded).

    ``start_s`` and ``end_s`` are the times at which the run begins and the next one begins.
    ``travel_heights`` is how far the prop moved, in heights of the figurine it stands for, where
    the token moves at all (else 0); ``turn_rad`` how far it turned, where the token turns.
    """

    token: Token
    first: int
    last: int
    start_s: float
    end_s: float
    travel_heights: float = 0.0
    turn_rad: float = 0.0
