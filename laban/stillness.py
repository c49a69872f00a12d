"""Stillness: whether there is movement to read, where it begins and ends, and where it rests."""

from __future__ import annotations

import math

import numpy as np

from laban.body import BODY_RADIUS_M, body_speed
from laban.features import MIN_SAMPLES, SLOW_M_S
from laban.motion import RigidMotion

STILL_SHARE = 0.05
"""Below this share of its quick moments' speed (the 95th percentile) a body is still."""

STILL_M_S = 0.005
"""At or below this speed a body is still in any case."""

REST_RAD_S = 0.1
"""A body that turns no faster and moves no faster than `SLOW_M_S` (RMS) is at rest."""

REST_S = 0.4
"""Length of a rest that separates two movements; stops within a movement are shorter."""


def is_readable(motion: RigidMotion) -> bool:
    """Return whether there is enough movement to read."""
    return len(motion) >= MIN_SAMPLES and not is_still(motion)


def is_still(motion: RigidMotion) -> bool:
    """Return whether the body is at rest: RMS speed and angular speed at most a tremor's."""
    speed = math.sqrt(float(np.sum(motion.velocity_m_s**2)) / len(motion))
    turning = math.sqrt(float(np.sum(motion.angular_velocity_rad_s**2)) / len(motion))
    return speed <= SLOW_M_S and turning <= REST_RAD_S


def without_still_ends(motion: RigidMotion) -> RigidMotion:
    """Return a movement without the stillness before and after it.

    A second of stillness at either end would halve every mean of a short gesture. Stillness in
    between stays: pauses are part of how somebody moves. A body that never moves is returned
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


def movements(motion: RigidMotion) -> list[RigidMotion]:
    """Return the movements between rests: where a body is at rest for `REST_S` or longer.

    None is empty; a body that never moves has none.
    """
    if len(motion) < MIN_SAMPLES:
        return []
    speed = body_speed(motion)
    quick = float(np.quantile(speed, 0.95))
    at_rest = math.hypot(SLOW_M_S, BODY_RADIUS_M * REST_RAD_S)
    moving = np.flatnonzero(speed > max(STILL_SHARE * quick, at_rest))
    if not len(moving):
        return []
    parted = np.flatnonzero(np.diff(moving) * motion.step_s >= REST_S)
    first = moving[np.concatenate([[0], parted + 1])]
    last = moving[np.concatenate([parted, [len(moving) - 1]])]
    time_s = motion.time_s
    return [
        motion.between(float(time_s[i]), float(time_s[j])) for i, j in zip(first, last, strict=True)
    ]
