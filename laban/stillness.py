"""Stillness: whether there is movement to read, and where it begins and ends."""

from __future__ import annotations

import math

import numpy as np

from laban.body import body_speed
from laban.features import MIN_SAMPLES, SLOW_M_S
from laban.motion import RigidMotion

STILL_SHARE = 0.05
"""Slower than this share of its quick moments (the 95th percentile), a body has not set out."""

STILL_M_S = 0.005
"""Nor at or below this speed, whatever the rest is like."""

REST_RAD_S = 0.1
"""A body that turns no faster and moves no faster than `SLOW_M_S` (RMS) is at rest."""


def is_readable(motion: RigidMotion) -> bool:
    """Return whether there is enough movement to read."""
    return len(motion) >= MIN_SAMPLES and not is_still(motion)


def is_still(motion: RigidMotion) -> bool:
    """Return whether the body is at rest: RMS speed and angular speed at most a tremor's."""
    speed = math.sqrt(float(np.sum(motion.velocity_m_s**2)) / len(motion))
    turning = math.sqrt(float(np.sum(motion.angular_velocity_rad_s**2)) / len(motion))
    return speed <= SLOW_M_S and turning <= REST_RAD_S


def without_still_ends(motion: RigidMotion) -> RigidMotion:
    """Return a movement from where it sets out to where it arrives.

    A second of stillness at either end would halve every mean of a short gesture. What is still
    in between stays: pauses are part of how somebody moves. A body that never moves is returned
    as it is.
    """
    if not len(motion):
        return motion
    speed = body_speed(motion)
    quick = float(np.sort(speed)[math.ceil(0.95 * (len(speed) - 1))])
    where = np.flatnonzero(speed > max(STILL_SHARE * quick, STILL_M_S))
    if not len(where):
        return motion
    return motion.between(float(motion.time_s[where[0]]), float(motion.time_s[where[-1]]))
