"""Limits: what a body can do over the ground."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from smd.errors import TransferError


@dataclass(frozen=True, slots=True)
class Limits:
    """What a plan keeps to.

    How many steps a minute a gait takes, and how long they are, its own `Gait` says.

    Attributes
    ----------
    acceleration_m_s2 : of a body over the ground. Real walks and jumps reach 1.7 to 5.3 m/s² in
        one frame of a hundred, measured on recordings.
    push_m_s2 : of its mass over the ground, in an action that is done on the spot.
    speed_m_s : over the ground of what neither runs nor flies.
    turning_rad_s, turning_rad_s2 : about the upright axis, and how fast that changes.
    detour, shortening : how far the path of a phrase may be moved (RMS), and how much of it may be
        cut off at its corners, as shares of its length.
    """

    acceleration_m_s2: float = 4.0
    push_m_s2: float = 6.0
    speed_m_s: float = 4.0
    turning_rad_s: float = 3.5
    turning_rad_s2: float = 12.0
    detour: float = 0.1
    shortening: float = 0.2

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if not (np.isfinite(value) and value > 0.0):
                raise TransferError(f"{one.name}: expected a positive number, got {value!r}")
        for name in ("detour", "shortening"):
            if getattr(self, name) >= 1.0:
                raise TransferError(
                    f"{name}: expected a share below 1, got {getattr(self, name)!r}"
                )
