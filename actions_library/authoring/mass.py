"""Where a body's mass is."""

from __future__ import annotations

import numpy as np

from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

SIDES = ("left", "right")

SEGMENTS = (
    ("hips", "upper_chest", 0.497, 0.60),
    ("neck", "head", 0.081, 1.60),
    ("{side}_upper_arm", "{side}_lower_arm", 0.028, 0.436),
    ("{side}_lower_arm", "{side}_hand", 0.016, 0.430),
    ("{side}_hand", "{side}_fingers", 0.006, 0.506),
    ("{side}_upper_leg", "{side}_lower_leg", 0.100, 0.433),
    ("{side}_lower_leg", "{side}_foot", 0.0465, 0.433),
    ("{side}_foot", "{side}_toes", 0.0145, 0.500),
)
"""From joint, to joint, share of the body's mass, place of its centre on the way."""


def centre_of_mass(skeleton: Skeleton, position: FloatArray) -> FloatArray:
    """Return the body's centre of mass, ``(n, 3)``, from the shares of its segments [1]_.

    Parameters
    ----------
    position
        Joints in the world, ``(n, j, 3)``.

    References
    ----------
    .. [1] D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed., table 4.1.
    """
    total, mass = np.zeros((len(position), 3)), 0.0
    for start, end, share, along in SEGMENTS:
        for side in SIDES if "{side}" in start + end else SIDES[:1]:
            a, b = (position[:, skeleton.index(j.format(side=side))] for j in (start, end))
            total += share * (a + along * (b - a))
            mass += share
    return total / mass
