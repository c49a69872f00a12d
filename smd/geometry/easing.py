"""Smooth ways from 0 to 1, and smoothing of curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray


def smootherstep(x: ArrayLike) -> FloatArray:
    """Return 0 below 0, 1 above 1, and between them a rise whose ends are at rest.

    Speed and acceleration vanish at both ends [1]_.

    References
    ----------
    .. [1] K. Perlin, "Improving Noise", SIGGRAPH 2002.
    """
    x = np.clip(np.asarray(x, dtype=np.float64), 0.0, 1.0)
    return x * x * x * (x * (6.0 * x - 15.0) + 10.0)


def fading(x: ArrayLike) -> FloatArray:
    """Return what a speed of 1 at 0 adds up to while it dies away; 0 again from 1 on.

    The quintic whose value and curvature vanish at 0, and whose value, slope and curvature vanish
    at 1.
    """
    x = np.clip(np.asarray(x, dtype=np.float64), 0.0, 1.0)
    return x + x**3 * (-6.0 + x * (8.0 - 3.0 * x))


def gaussian_smoothed(value: FloatArray, sigma: float) -> FloatArray:
    """Return ``value (n, …)`` smoothed along time by a Gaussian of ``sigma`` samples.

    Beyond its ends the curve goes on as its own point reflection, so that the ends keep their
    values and a straight line stays one.
    """
    n = len(value)
    reach = min(int(np.ceil(3.0 * sigma)), n - 1)
    if reach < 1 or sigma <= 0.0 or value.size == 0:
        return value
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    columns = value.reshape(n, -1).T
    before = 2.0 * columns[:, :1] - columns[:, reach:0:-1]
    after = 2.0 * columns[:, -1:] - columns[:, -2 : -2 - reach : -1]
    padded = np.concatenate([before, columns, after], axis=1)
    # All columns in one call, end to end; what overlaps two of them is left out.
    smoothed = np.convolve(padded.ravel(), kernel)[2 * reach :].reshape(padded.shape)
    return np.ascontiguousarray(smoothed[:, :n].T).reshape(value.shape)


def eased_clock(time_s: FloatArray, rise_s: float, fall_s: float) -> FloatArray:
    """Return times from the first to the last of ``time_s`` whose pace rises and falls smoothly.

    Over the first ``rise_s`` the pace grows from nothing, over the last ``fall_s`` it dies away;
    in between it is a little above 1 to make up for both.

    Parameters
    ----------
    time_s
        ``(n,)``, increasing.
    rise_s, fall_s
        Zero or more; their sum is less than the whole time. At zero, that end keeps its pace.
    """
    start_s, end_s = time_s[0], time_s[-1]
    pace = np.ones_like(time_s)
    if rise_s > 0.0:
        pace *= smootherstep((time_s - start_s) / rise_s)
    if fall_s > 0.0:
        pace *= smootherstep((end_s - time_s) / fall_s)
    steps = 0.5 * (pace[1:] + pace[:-1]) * np.diff(time_s)
    passed = np.concatenate([[0.0], np.cumsum(steps)])
    return start_s + passed * ((end_s - start_s) / passed[-1])
