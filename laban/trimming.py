"""Trimming: a movement without the stillness before and after it."""

from __future__ import annotations

import numpy as np

from laban.motion import RigidMotion

STILL_SHARE = 0.05
"""Slower than this share of its quick moments (the 95th percentile), a body has not set out."""

STILL_M_S, STILL_RAD_S = 0.005, 0.05
"""Nor at or below these speeds, whatever the rest is like."""


def without_still_ends(motion: RigidMotion) -> RigidMotion:
    """Return a movement from where it sets out to where it arrives.

    A second of stillness at either end would halve every mean of a short gesture. What is still
    in between stays: pauses are part of how somebody moves. A body that never moves is returned
    as it is.
    """
    speed = np.linalg.norm(motion.velocity_m_s, axis=-1)
    rate = np.linalg.norm(motion.angular_velocity_rad_s, axis=-1)
    moves = np.zeros(len(motion), dtype=bool)
    for signal, least in ((speed, STILL_M_S), (rate, STILL_RAD_S)):
        if len(signal):
            moves |= signal > max(STILL_SHARE * float(np.percentile(signal, 95.0)), least)
    where = np.flatnonzero(moves)
    if not len(where):
        return motion
    return motion.between(float(motion.time_s[where[0]]), float(motion.time_s[where[-1]]))
