"""Where a body's mass is, and where the ground must push for it to move as it does."""

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
    ("{side}_hand", "{side}_middle_proximal", 0.006, 0.506),
    ("{side}_upper_leg", "{side}_lower_leg", 0.100, 0.433),
    ("{side}_lower_leg", "{side}_foot", 0.0465, 0.433),
    ("{side}_foot", "{side}_toes", 0.0145, 0.500),
)
"""From joint, to joint, share of the body's mass, place of its centre on the way."""


GRAVITY_M_S2 = 9.81


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


def zero_moment_point(centre_m: FloatArray, acceleration_m_s2: FloatArray) -> FloatArray:
    """Return where the force of the ground on a mass passes through the ground [1]_.

    A mass does not turn, so the force points to it. In free fall there is no such place; there
    the pull is taken as 1 m/s².

    Parameters
    ----------
    centre_m, acceleration_m_s2
        Of mass, ``(n, 3)``.

    Returns
    -------
    (n, 2) float64
        Left and ahead, in metres.

    References
    ----------
    .. [1] M. Vukobratović and B. Borovac, "Zero-Moment Point: thirty-five years of its life",
       Int. J. Humanoid Robotics 1, 2004.
    """
    pull = np.maximum(acceleration_m_s2[:, 1:2] + GRAVITY_M_S2, 1.0)
    level = centre_m[:, 1:2] * acceleration_m_s2[:, [0, 2]] / pull
    return np.asarray(centre_m[:, [0, 2]] - level)
