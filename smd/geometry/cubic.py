"""Values of a sampled trajectory at other times, through four neighbours instead of two.

A straight line between samples that come at uneven times bends a curve by up to
``acceleration * step**2 / 8``; differentiated three times, that error is what remains. The cubic
through the four nearest samples is exact on cubics, which is what Savitzky-Golay fits next.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
)

MOST_NOISE_GAIN = 3.0
"""Largest sum of absolute weights of a cubic; even samples reach 1.25 inside, 1.63 at the ends.

Where samples nearly coincide, or beside a gap, a cubic through them swings far from all four (and
multiplies their noise by this sum); the straight line, whose sum is 1, takes its place there.
"""


def _lagrange_weights(nodes_s: FloatArray, at_s: FloatArray) -> FloatArray:
    """Return the weights ``(m, 4)`` of the cubic through ``nodes_s (m, 4)`` at ``at_s (m,)``."""
    weights = np.ones_like(nodes_s)
    for i in range(4):
        for j in range(4):
            if i != j:
                weights[:, i] *= (at_s - nodes_s[:, j]) / (nodes_s[:, i] - nodes_s[:, j])
    return weights


def _neighbours(time_s: FloatArray, at_s: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Return each time's left neighbour (m,), four neighbours (m, 4) and their weights (m, 4)."""
    at_s = np.clip(at_s, time_s[0], time_s[-1])
    left = np.clip(np.searchsorted(time_s, at_s, side="right") - 1, 0, len(time_s) - 2)
    first = np.clip(left - 1, 0, len(time_s) - 4)
    index = first[:, None] + np.arange(4)
    nodes = time_s[index]
    weights = _lagrange_weights(nodes, at_s)
    middle_s = 0.5 * (time_s[left] + time_s[left + 1])  # one verdict per interval: no jump inside
    gain = np.abs(_lagrange_weights(nodes, middle_s)).sum(axis=1)
    wild = ~(gain <= MOST_NOISE_GAIN)  # so that NaN, of steps too small to divide by, is wild too
    fraction = (at_s - time_s[left]) / (time_s[left + 1] - time_s[left])
    straight = np.where(index == left[:, None], 1.0 - fraction[:, None], 0.0)
    straight += np.where(index == left[:, None] + 1, fraction[:, None], 0.0)
    return left, index, np.where(wild[:, None], straight, weights)


def interpolate_cubic(time_s: ArrayLike, value: ArrayLike, at_s: ArrayLike) -> FloatArray:
    """Interpolate ``value (n, d)``, n at least 4, at ``at_s (m,)``; the ends are held outside."""
    value = np.asarray(value, dtype=np.float64)
    _, index, weights = _neighbours(np.asarray(time_s, float), np.asarray(at_s, float))
    return np.einsum("mk,mkd->md", weights, value[index])


def interpolate_rotation_cubic(time_s: ArrayLike, q_xyzw: ArrayLike, at_s: ArrayLike) -> FloatArray:
    """Interpolate ``q_xyzw (n, 4)``, n at least 4, at ``at_s (m,)``; the ends are held outside.

    The four neighbours become rotation vectors seen from the left one of the two in between;
    their cubic is exact where the rotation turns about one axis by a cubic angle.
    """
    q = np.asarray(q_xyzw, dtype=np.float64)
    left, index, weights = _neighbours(np.asarray(time_s, float), np.asarray(at_s, float))
    seen_from_left = rotvec_from_quaternion(multiply(inverse(q[left])[:, None], q[index]))
    return multiply(
        q[left], quaternion_from_rotvec(np.einsum("mk,mkd->md", weights, seen_from_left))
    )
