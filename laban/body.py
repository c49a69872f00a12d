"""Body: the speed of a whole body, including its rotation.

The origin of a prop that turns on the spot does not move, yet the movement may be sudden or strong.
So speed and acceleration are those of the body and not of its origin: the root mean square over its
parts, which lie about a radius of gyration away.
"""

from __future__ import annotations

import numpy as np

from laban.motion import FloatArray, RigidMotion

BODY_RADIUS_M = 0.1
"""Radius of gyration of a hand-held prop, roughly: one radian then counts as 0.1 m."""


def body_rate(linear: FloatArray, angular: FloatArray) -> FloatArray:
    """Return the RMS over a body's parts of a rate of its pose, ``(n,)``.

    Parameters
    ----------
    linear, angular
        ``(n, 3)``: velocity and angular velocity, or the first or second derivative of both.
        (The centripetal acceleration of parts of a turning body is left out.)
    """
    return np.sqrt(_square(linear) + BODY_RADIUS_M**2 * _square(angular))


def body_speed(motion: RigidMotion) -> FloatArray:
    """Return the RMS speed of a body's parts, ``(n,)`` in m/s."""
    return body_rate(motion.velocity_m_s, motion.angular_velocity_rad_s)


def body_extent_m(motion: RigidMotion) -> float:
    """Return the RMS distance of a body's parts from their mean places, in m."""
    from_mean = motion.position_m - motion.position_m.mean(axis=0)
    place = float(np.einsum("ni,ni", from_mean, from_mean)) / len(motion)
    x, y, z, w = motion.orientation_xyzw.T
    n = len(motion)
    mean_axes = np.array(
        [
            [n - 2 * (y @ y + z @ z), 2 * (x @ y - w @ z), 2 * (x @ z + w @ y)],
            [2 * (x @ y + w @ z), n - 2 * (x @ x + z @ z), 2 * (y @ z - w @ x)],
            [2 * (x @ z - w @ y), 2 * (y @ z + w @ x), n - 2 * (x @ x + y @ y)],
        ]
    )
    turned = 0.5 * (3.0 - float(np.sum((mean_axes / n) ** 2)))
    return float(np.sqrt(place + BODY_RADIUS_M**2 * max(turned, 0.0)))


def _square(vector: FloatArray) -> FloatArray:
    return np.einsum("ni,ni->n", vector, vector)
