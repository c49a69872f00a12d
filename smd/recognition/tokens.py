"""Tokens: the direction in which a prop moves and turns, in its own frame."""

from __future__ import annotations

from dataclasses import dataclass

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


STILL = Token()
"""Neither moving nor turning."""


@dataclass(frozen=True, slots=True)
class TokenRun:
    """One token held over the samples ``first`` (included) to ``last`` (excluded).

    ``start_s`` and ``end_s`` are the times at which the run begins and the next one begins.
    """

    token: Token
    first: int
    last: int
    start_s: float
    end_s: float
