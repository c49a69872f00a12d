"""The token alphabet: the bins of directions, their order, names, and angles between them.

A token is two bins, one of translation and one of rotation. All code that uses bins takes them, and
their number, from here.
"""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import normalized

Direction = tuple[int, int, int]
"""Levels along +X (left), +Y (up), +Z (front): one of 27; (0, 0, 0) is no movement."""

LEVELS = (-1, 0, 1)
"""Of each component of a direction."""

DIRECTIONS: tuple[Direction, ...] = tuple(product(LEVELS, LEVELS, LEVELS))
"""The bins, in the order of their index; bin `NONE` is no movement."""

NONE = DIRECTIONS.index((0, 0, 0))
"""Index of the bin of no movement."""

BINS = len(DIRECTIONS)
"""Number of bins: 27 of translation, and as many of rotation."""

INDEX = {direction: index for index, direction in enumerate(DIRECTIONS)}
"""A direction's bin."""


def direction_name(direction: Direction) -> str:
    """Return how a direction is printed, such as ``_Y_Z`` or ``_N_X``; nothing for none."""
    named = zip(direction, "XYZ", strict=True)
    return "".join(("_N_" if level < 0 else "_") + axis for level, axis in named if level)


@cache
def unit_directions() -> FloatArray:
    """Return ``(27, 3)``, the unit vector of each bin; zero for none."""
    units = normalized(np.array(DIRECTIONS, dtype=np.float64))
    units.flags.writeable = False
    return units


@cache
def angles_rad() -> FloatArray:
    """Return ``(27, 27)``, the angles between the bins' directions.

    Those of bin `NONE`, which has no direction, are meaningless.
    """
    units = unit_directions()
    angles = np.arccos(np.clip(units @ units.T, -1.0, 1.0))
    angles.flags.writeable = False
    return angles
