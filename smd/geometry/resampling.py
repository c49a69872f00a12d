"""Values of a sampled trajectory at other times."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import slerp


def _bracket(time_s: FloatArray, at_s: FloatArray) -> tuple[np.ndarray, FloatArray]:
    """Return the left neighbour's index and the fraction of the way to the right one."""
    left = np.clip(np.searchsorted(time_s, at_s, side="right") - 1, 0, max(len(time_s) - 2, 0))
    if len(time_s) == 1:
        return left, np.zeros_like(at_s)
    fraction = (at_s - time_s[left]) / (time_s[left + 1] - time_s[left])
    return left, np.clip(fraction, 0.0, 1.0)


def interpolate_linear(time_s: ArrayLike, value: ArrayLike, at_s: ArrayLike) -> FloatArray:
    """Interpolate ``value (n, …)`` linearly at ``at_s``; the ends are held outside."""
    value = np.asarray(value, dtype=np.float64)
    left, fraction = _bracket(np.asarray(time_s, float), np.asarray(at_s, float))
    right = np.minimum(left + 1, len(value) - 1)
    fraction = fraction.reshape(fraction.shape + (1,) * (value.ndim - 1))
    return value[left] * (1.0 - fraction) + value[right] * fraction


def interpolate_rotation(time_s: ArrayLike, q_xyzw: ArrayLike, at_s: ArrayLike) -> FloatArray:
    """Interpolate ``q_xyzw (n, …, 4)`` at constant angular speed; the ends are held outside."""
    q = np.asarray(q_xyzw, dtype=np.float64)
    left, fraction = _bracket(np.asarray(time_s, float), np.asarray(at_s, float))
    right = np.minimum(left + 1, len(q) - 1)
    return slerp(q[left], q[right], fraction.reshape(fraction.shape + (1,) * (q.ndim - 2)))
