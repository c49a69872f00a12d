"""Smoothing: from what a tracker reported to an even, smooth motion with derivatives."""

from __future__ import annotations

import math

import numpy as np

from laban import RigidMotion
from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray
from smd.geometry.cubic import interpolate_cubic, interpolate_rotation_cubic
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.savgol import SMALLEST_HALF_WINDOW, smooth_rotations, smooth_values

RATE_HZ = 60.0
"""Rate of smoothed motion: the paper's."""

WINDOW_S = 0.2
"""Time that one cubic spans.

A stroke of the hand of 0.2 s keeps 94 % of its peak speed; of a tremor's speed 37 % is left at
8 Hz, 4 % at 10 Hz, 12 % at 12 Hz (``docs/smoothing.md`` prints the table for other windows).
"""

MOST_SAMPLES = 10_000_000
"""46 hours at 60 Hz: beyond it the times are in another unit, and memory would run out."""


def smooth(doodle: Doodle, *, rate_hz: float = RATE_HZ, window_s: float = WINDOW_S) -> RigidMotion:
    """Resample a doodle evenly, smooth it, and differentiate it three times.

    Uneven samples are brought to an even grid by local cubics; the grid is a multiple of
    ``rate_hz`` as fine as the doodle's own samples, so that all of them take part.
    Third-order Savitzky-Golay over ``window_s`` follows, for positions and, in the tangent space,
    for rotations; the motion then keeps every sample that falls on ``rate_hz``. A doodle shorter
    than the window is fitted with the widest window that it holds.

    Parameters
    ----------
    doodle
        Long enough for five samples at ``rate_hz``.
    rate_hz
        Rate of the result, positive. A last partial period is dropped.
    window_s
        Time that a fit spans, rounded to an even number of periods, at least four.

    Returns
    -------
    RigidMotion
        ``floor(duration_s * rate_hz) + 1`` samples, the first at the doodle's first time.

    Raises
    ------
    DoodleError
        If the doodle is too short (or absurdly long), or an option is not positive and finite.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 4.1.
    """
    for name, value in (("rate_hz", rate_hz), ("window_s", window_s)):
        if not (np.isfinite(value) and value > 0):
            raise DoodleError(f"{name}: expected a positive number, got {value!r}")
    # + 1e-9: 0.29 s at 100 Hz is 28.999…96 periods, and must count as 29.
    periods = int(np.floor(min(doodle.duration_s * rate_hz, 2.0 * MOST_SAMPLES) + 1e-9))
    if periods < 2 * SMALLEST_HALF_WINDOW:
        raise DoodleError(
            f"device {doodle.device!r} at {doodle.time_s[0]:.3f} s: expected a doodle of at least "
            f"{2 * SMALLEST_HALF_WINDOW / rate_hz:.3f} s, got {doodle.duration_s:.3f} s"
        )
    if periods >= MOST_SAMPLES:
        raise DoodleError(
            f"device {doodle.device!r}: expected a doodle of at most "
            f"{MOST_SAMPLES / rate_hz:.0f} s, got {doodle.duration_s:.0f} s"
        )
    stride = min(stride_of((len(doodle) - 1) / doodle.duration_s, rate_hz), MOST_SAMPLES // periods)
    half = min(half_window(rate_hz, window_s), periods // 2) * stride
    step_s = 1.0 / (rate_hz * stride)
    from_start_s = np.arange(periods * stride + 1, dtype=np.float64) * step_s
    measured = resampled(doodle, from_start_s)
    return fitted(doodle.time_s[0] + from_start_s, *measured, step_s, half, stride)


def stride_of(own_rate_hz: float, rate_hz: float) -> int:
    """Return how many times finer than ``rate_hz`` a grid must be to use a doodle's own samples."""
    # - 0.3: the steps between whole multiples of 60 Hz fall at 78 and 138 Hz, where no sensor is.
    return max(1, math.ceil(own_rate_hz / rate_hz - 0.3))


def half_window(rate_hz: float, window_s: float) -> int:
    """Return half the periods of ``rate_hz`` that a fit spans."""
    return max(round(0.5 * window_s * rate_hz), SMALLEST_HALF_WINDOW)


def fitted(
    time_s: FloatArray,
    measured_m: FloatArray,
    measured_xyzw: FloatArray,
    step_s: float,
    half: int,
    stride: int,
) -> RigidMotion:
    """Return the motion fitted to samples every ``step_s``, at every ``stride``-th of them."""
    position, velocity, acceleration, jerk = smooth_values(measured_m, step_s, half, stride)
    turning = smooth_rotations(measured_xyzw, step_s, half, stride)
    return RigidMotion(
        time_s=time_s[::stride],
        position_m=position,
        orientation_xyzw=turning.orientation_xyzw,
        velocity_m_s=velocity,
        acceleration_m_s2=acceleration,
        jerk_m_s3=jerk,
        angular_velocity_rad_s=turning.velocity_rad_s,
        angular_acceleration_rad_s2=turning.acceleration_rad_s2,
        angular_jerk_rad_s3=turning.jerk_rad_s3,
    )


def resampled(doodle: Doodle, from_start_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return position and orientation at times counted from the doodle's first sample."""
    own_s = doodle.time_s - doodle.time_s[0]  # small numbers: clocks may count from 1970
    if len(doodle) < 4:
        return (
            interpolate_linear(own_s, doodle.position_m, from_start_s),
            interpolate_rotation(own_s, doodle.orientation_xyzw, from_start_s),
        )
    return (
        interpolate_cubic(own_s, doodle.position_m, from_start_s),
        interpolate_rotation_cubic(own_s, doodle.orientation_xyzw, from_start_s),
    )
