"""Effort: the quality of a movement on Laban's four axes."""

from __future__ import annotations

import math
from dataclasses import dataclass

AXES = ("time", "weight", "space", "flow")
"""The axes in the order in which they are listed everywhere."""


class LabanError(ValueError):
    """Input that cannot be read for Effort; the message is one line for the user."""


@dataclass(frozen=True, slots=True)
class Effort:
    """Laban Effort, each axis in [-1, 1], or None where it was not read.

    Attributes
    ----------
    time : sustained -1 … +1 sudden.
    weight : light -1 … +1 strong.
    space : indirect -1 … +1 direct.
    flow : free -1 … +1 bound.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 5.1.
    """

    time: float | None = None
    weight: float | None = None
    space: float | None = None
    flow: float | None = None

    def __post_init__(self) -> None:
        for axis in AXES:
            value = getattr(self, axis)
            if value is not None and not (math.isfinite(value) and -1.0 <= value <= 1.0):
                raise LabanError(f"effort {axis}: expected a number in [-1, 1], got {value!r}")
