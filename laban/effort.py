"""Effort: the quality of a movement on Laban's axes, and the one table of these."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any


class LabanError(ValueError):
    """Input that cannot be read for Effort; the message is one line for the user."""


def _axis(low: str, high: str, *, steps: int) -> Mapping[str, Any]:
    """Return an axis's metadata besides its name: words of its poles, steps to a pole."""
    return {"poles": (low, high), "steps": steps}


@dataclass(frozen=True, slots=True)
class Effort:
    """Laban Effort, each axis in [-1, 1], or None where it was not read.

    An axis leads from its indulging pole (-1) to its fighting one (+1); the fields are the table
    that `AXES`, `POLES` and `EFFORT_STEPS` are read from.

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

    time: float | None = field(default=None, metadata=_axis("sustained", "sudden", steps=5))
    weight: float | None = field(default=None, metadata=_axis("light", "strong", steps=5))
    space: float | None = field(default=None, metadata=_axis("indirect", "direct", steps=2))
    flow: float | None = field(default=None, metadata=_axis("free", "bound", steps=2))

    def __post_init__(self) -> None:
        for axis in AXES:
            value = getattr(self, axis)
            if value is not None and not (math.isfinite(value) and -1.0 <= value <= 1.0):
                raise LabanError(f"effort {axis}: expected a number in [-1, 1], got {value!r}")


AXES: tuple[str, ...] = tuple(axis.name for axis in fields(Effort))
"""The axes in the order in which they are listed everywhere."""

POLES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {axis.name: axis.metadata["poles"] for axis in fields(Effort)}
)
"""The words for -1 and 1 on each axis."""

NEUTRAL = "neutral"
"""The word for neither pole."""

EFFORT_STEPS: Mapping[str, int] = MappingProxyType(
    {axis.name: axis.metadata["steps"] for axis in fields(Effort)}
)
"""Steps from neutral to a pole in which an axis is played: smaller differences are not visible."""
