"""Savitzky-Golay smoothing of positions and rotations: a cubic fitted around every sample.

Around each sample, the cubic that is nearest in least squares to the samples of a window gives
the smoothed value and three derivatives [1]_. Rotations are fitted in the tangent space at the
window's centre [2]_: with ``R_c`` the rotation measured there, the window becomes the rotation
vectors ``log(R_c^T R_k)``, the cubic through them is ``phi(t)``, and the smoothed rotation is
``R_c exp(phi(t))``. Nearer to an end than half a window, the window stays inside the data and its
cubic is evaluated off its centre.

References
----------
.. [1] A. Savitzky, M. J. E. Golay, "Smoothing and Differentiation of Data by Simplified Least
   Squares Procedures", Analytical Chemistry 36(8), 1964.
.. [2] M. J. Jongeneel, A. Saccon, "Geometric Savitzky-Golay Filtering of Noisy Rotations on SO(3)
   with Simultaneous Angular Velocity and Acceleration Estimation", IROS 2022.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import multiply, quaternion_from_rotvec, sign_continuous

ORDER = 3
"""Degree of the polynomials, the paper's."""

SMALLEST_HALF_WINDOW = 2
"""Samples on either side of the centre: five determine a cubic with one to spare."""

_CHUNK = 2048  # windows at a time: keeps the working set in cache and memory flat on long takes


class SmoothRotations(NamedTuple):
    """Smoothed rotations and the body-frame derivatives of their angular motion."""

    orientation_xyzw: FloatArray
    velocity_rad_s: FloatArray
    acceleration_rad_s2: FloatArray
    jerk_rad_s3: FloatArray


def _centres(n: int, half: int, stride: int) -> tuple[IntArray, IntArray]:
    """Return the samples to smooth and the centre of each one's window."""
    if n < 2 * half + 1 or half < SMALLEST_HALF_WINDOW:
        raise ValueError(f"window of {2 * half + 1} samples on {n}: expected 5 or more, at most n")
    at = np.arange(0, n, stride)
    return at, np.clip(at, half, n - 1 - half)


@cache
def fit_weights(half: int) -> FloatArray:
    """Return the ``(4, 2 half + 1)`` weights that give a window's cubic coefficients.

    Time runs from -1 to 1 over the window; coefficients are lowest power first.
    """
    time = np.linspace(-1.0, 1.0, 2 * half + 1)
    weights = np.asarray(np.linalg.pinv(np.vander(time, ORDER + 1, True)), dtype=np.float64)
    weights.flags.writeable = False
    return weights


def _derivatives(coefficients: FloatArray, at: FloatArray, half_s: float) -> FloatArray:
    """Return value and three derivatives ``(4, m, 3)`` of cubics ``(m, 4, 3)`` at ``at (m,)``."""
    moved = np.zeros((ORDER + 1, ORDER + 1, len(at)))
    for derivative in range(ORDER + 1):
        for power in range(derivative, ORDER + 1):
            factor = factorial(power) / factorial(power - derivative) / half_s**derivative
            moved[derivative, power] = factor * at ** (power - derivative)
    return np.einsum("rpm,mpd->rmd", moved, coefficients)


def smooth_values(value: ArrayLike, step_s: float, half: int, stride: int = 1) -> FloatArray:
    """Smooth ``value (n, d)``, sampled every ``step_s``, and differentiate it.

    Parameters
    ----------
    value
        At least ``2 half + 1`` samples.
    step_s
        Time between samples.
    half
        Samples on either side of a window's centre, at least 2.
    stride
        Smooth every ``stride``-th sample only; all of them take part.

    Returns
    -------
    (4, ceil(n / stride), d)
        The value and its first, second and third derivative.
    """
    value = np.asarray(value, dtype=np.float64)
    at, centre = _centres(len(value), half, stride)
    windows = np.lib.stride_tricks.sliding_window_view(value, 2 * half + 1, axis=0)
    fit = fit_weights(half).T
    coefficients = np.concatenate(
        [
            np.swapaxes(windows[centre[i : i + _CHUNK] - half] @ fit, 1, 2)
            for i in range(0, len(at), _CHUNK)
        ]
    )
    return _derivatives(coefficients, (at - centre) / half, half * step_s)


def smooth_rotations(
    q_xyzw: ArrayLike, step_s: float, half: int, stride: int = 1
) -> SmoothRotations:
    """Smooth unit quaternions ``(n, 4)``, sampled every ``step_s``, and differentiate them.

    Neighbouring samples must differ by less than half a turn, and the samples of a window from
    its centre by less than a whole turn. The parameters are those of `smooth_values`.
    """
    q = sign_continuous(q_xyzw)
    at, centre = _centres(len(q), half, stride)
    fit = fit_weights(half).T
    coefficients = np.concatenate(
        [
            _window_rotvecs(q, centre[i : i + _CHUNK], half).transpose(1, 0, 2) @ fit
            for i in range(0, len(at), _CHUNK)
        ]
    )
    phi = _derivatives(np.swapaxes(coefficients, 1, 2), (at - centre) / half, half * step_s)
    smoothed = multiply(q[centre], quaternion_from_rotvec(phi[0]))
    return SmoothRotations(sign_continuous(smoothed), *body_rates(*phi))


def _window_rotvecs(q: FloatArray, centre: IntArray, half: int) -> FloatArray:
    """Return ``log(R_c^T R_k)`` of the windows around ``centre``, shape (3, m, 2 half + 1).

    The quaternions are sign-continuous, so the angle is followed past half a turn. Components
    come first and the product is written out: this is where smoothing spends its time.
    """
    x, y, z, w = np.moveaxis(q[centre[:, None] + np.arange(-half, half + 1)], -1, 0)
    cx, cy, cz, cw = (q[centre, i, None] for i in range(4))
    vector = np.stack(
        [
            cw * x - cx * w - (cy * z - cz * y),
            cw * y - cy * w - (cz * x - cx * z),
            cw * z - cz * w - (cx * y - cy * x),
        ]
    )
    cosine = cw * w + cx * x + cy * y + cz * z
    sine = np.sqrt(np.einsum("dmk,dmk->mk", vector, vector))
    factor = np.full_like(sine, 2.0)  # the limit of angle / sin(angle / 2) at no turn
    np.divide(2.0 * np.arctan2(sine, cosine), sine, out=factor, where=sine > 1e-12)
    vector *= factor
    return vector


# 1 - cos(x) over x^2, and x - sin(x) over x^3, as power series in x^2; they alternate and 20 terms
# are exact in double precision up to a whole turn.
def _series() -> FloatArray:
    """Return the coefficients of both, each with its first two derivatives ``(20, 6)``."""
    columns = np.zeros((6, 20))
    for column, (first, order) in zip(columns, product((2, 3), range(3)), strict=True):
        terms = [(-1.0) ** k / factorial(2 * k + first) for k in range(20)]
        column[: 20 - order] = polyder(terms, order)
    return columns.T


_SERIES = _series()


def body_rates(
    phi: FloatArray, d1: FloatArray, d2: FloatArray, d3: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return body angular velocity, acceleration and jerk of ``R_c exp(phi(t))``, each (n, 3).

    ``omega = phi' - a phi x phi' + b phi x (phi x phi')`` with ``a = (1 - cos|phi|)/|phi|^2`` and
    ``b = (|phi| - sin|phi|)/|phi|^3``, the right Jacobian of the rotation group [1]_,
    differentiated twice by the product rule; ``s = |phi|^2`` carries a and b.

    References
    ----------
    .. [1] J. Sola, J. Deray, D. Atchuthan, "A micro Lie theory for state estimation in robotics",
       arXiv:1812.01537, appendix B.
    """
    s = np.sum(phi * phi, axis=-1, keepdims=True)
    s1 = 2.0 * np.sum(phi * d1, axis=-1, keepdims=True)
    s2 = 2.0 * np.sum(d1 * d1 + phi * d2, axis=-1, keepdims=True)
    series = np.zeros((len(s), _SERIES.shape[1]))
    for terms in _SERIES[::-1]:  # Horner's scheme, all six at once
        series = series * s + terms
    a, a1, a2 = _composed(series[:, :3], s1, s2)
    b, b1, b2 = _composed(series[:, 3:], s1, s2)
    u = _cross(phi, d1)
    u1 = _cross(phi, d2)
    u2 = _cross(d1, d2) + _cross(phi, d3)
    v = _cross(phi, u)
    v1 = _cross(d1, u) + _cross(phi, u1)
    v2 = _cross(d2, u) + 2.0 * _cross(d1, u1) + _cross(phi, u2)
    velocity = d1 - a * u + b * v
    acceleration = d2 - a1 * u - a * u1 + b1 * v + b * v1
    jerk = d3 - a2 * u - 2.0 * a1 * u1 - a * u2 + b2 * v + 2.0 * b1 * v1 + b * v2
    return velocity, acceleration, jerk


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the cross product of vectors (n, 3); ``np.cross`` takes five times as long on few."""
    ax, ay, az = a.T
    bx, by, bz = b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def _composed(
    series: FloatArray, s1: FloatArray, s2: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return f(s(t)) and its time derivatives from f, f' and f'' at s ``(n, 3)``."""
    f, f1, f2 = (series[:, i, None] for i in range(3))
    return f, f1 * s1, f2 * s1**2 + f1 * s2
