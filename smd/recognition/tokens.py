"""Tokens: the direction in which a prop moves and turns, along its own axes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import product

from smd.errors import PatternError

Direction = tuple[int, int, int]
"""Signs along +X (left), +Y (up), +Z (front): one of 27; (0, 0, 0) is no movement."""


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
        parts = []
        for letter, direction in (("T", self.translation), ("R", self.rotation)):
            axes = [
                ("_N_" if sign < 0 else "_") + axis
                for sign, axis in zip(direction, "XYZ", strict=True)
                if sign
            ]
            if axes:
                parts.append(letter + "".join(axes))
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


@cache
def _tokens_by_name() -> dict[str, Token]:
    """Return all 27 x 27 tokens by their names."""
    signs = (-1, 0, 1)
    directions = [(x, y, z) for x in signs for y in signs for z in signs]
    tokens = [Token(t, r) for t, r in product(directions, directions)]
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
