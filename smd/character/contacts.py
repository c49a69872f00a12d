"""Contacts: when the feet of any clip touch the ground, by height and speed (section 6.1).

A foot touches while it is low and slow. Low is measured from where its joint is at rest, and both
in leg lengths, so that the rule holds for a doll as for a giant.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.runs import runs_of_true

LOW, SLOW_PER_S = 0.044, 0.35
"""Height above rest and speed, in leg lengths, up to which a joint touches."""

LEAVING = 2.0
"""How many times higher or faster it may be before it has left: no flicker at the limit."""

SHORTEST_S = 0.05
"""A touch or a gap shorter than this is none."""


def contacts(
    position_m: FloatArray,
    rest_height_m: Sequence[float],
    rate_hz: float,
    leg_m: float,
    *,
    tolerance: float = 1.0,
) -> BoolArray:
    """Return when joints touch the ground, ``(n, c)``.

    Parameters
    ----------
    position_m
        ``(n, c, 3)`` of the joints in the world, +Y up, at even times.
    rest_height_m
        Of each joint above the ground when it stands.
    rate_hz
        Frames per second.
    leg_m
        Length of the character's legs: height of its pelvis above its feet at rest.
    tolerance
        How many times higher and faster than usual a foot still touches.
    """
    above = position_m[..., 1] - np.asarray(rest_height_m, dtype=np.float64)
    # Over the ground: a runner's foot comes down and goes up again within two frames.
    level = np.gradient(position_m[..., ::2], 1.0 / rate_hz, axis=0)
    speed = np.linalg.norm(level, axis=-1)
    how = np.maximum(above / (LOW * leg_m), speed / (SLOW_PER_S * leg_m)) / tolerance
    touching = np.empty(how.shape, dtype=bool)
    shortest = max(round(SHORTEST_S * rate_hz), 1)
    for column, own in zip(touching.T, how.T, strict=True):
        column[:] = _with_hysteresis(own)
        _without_shorter(column, shortest, value=False)
        _without_shorter(column, shortest, value=True)
    return touching


def _with_hysteresis(how: FloatArray) -> BoolArray:
    """Return where a signal is within 1, and went beyond `LEAVING` not since."""
    touching = how <= 1.0
    runs = runs_of_true(how <= LEAVING)
    for start, end in runs:
        inside = np.flatnonzero(touching[start:end])
        if len(inside):
            touching[start + inside[0] : start + inside[-1] + 1] = True
    return touching


def _without_shorter(on: BoolArray, shortest: int, *, value: bool) -> None:
    """Flip stretches of a value that are shorter than some frames and lie inside."""
    for start, end in runs_of_true(on == value):
        if end - start < shortest and start > 0 and end < len(on):
            on[start:end] = not value
