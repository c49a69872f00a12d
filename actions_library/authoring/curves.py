"""Smooth curves through key values."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import FloatArray

EASE_S = 0.028
"""Standard deviation of the softening: a corner takes about four of these, two to each side."""

_REST = 2.5
"""Standard deviations that a curve rests at its ends, so that softening does not move them."""


def smooth_curve(
    key_s: ArrayLike,
    value: ArrayLike,
    frames: int,
    rate_hz: float,
    *,
    lag_s: float = 0.0,
    cyclic: bool = False,
    ease_s: float = EASE_S,
) -> FloatArray:
    """Sample a curve through keys ``(k, c)`` at ``frames`` even times from 0.

    Monotone cubics [1]_ join the keys, so that a key that is an extreme is one in the curve too
    and nothing overshoots; a Gaussian then softens the corners that they leave in the
    acceleration. A curve rests at its first and last frame, and is held outside its keys; or it
    repeats with the period of the sampled time, whose last frame is then its first.

    Parameters
    ----------
    lag_s
        How far the curve comes after its keys: parts that are carried arrive late.

    References
    ----------
    .. [1] F. N. Fritsch and J. Butland, "A method for constructing local monotone piecewise
       cubic interpolants", SIAM J. Sci. Stat. Comput. 5, 1984.
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.ndimage import gaussian_filter1d

    key = np.asarray(key_s, dtype=np.float64) + lag_s
    value = np.asarray(value, dtype=np.float64)
    last_s = (frames - 1) / rate_hz
    if cyclic:
        key = (key[:, None] + last_s * np.arange(-2, 3)).T.ravel()
        value = np.tile(value, (5, 1))
    elif len(key) == 1:
        return np.tile(value, (frames, 1))
    else:
        rest_s = _REST * ease_s
        key = np.clip(key, rest_s, last_s - rest_s)
    sigma = ease_s * rate_hz
    margin = int(np.ceil(4.0 * sigma)) + 1
    at = np.arange(-margin, frames + margin) / rate_hz
    curve = PchipInterpolator(key, value, axis=0)(np.clip(at, key[0], key[-1]))
    return np.asarray(gaussian_filter1d(curve, sigma, axis=0))[margin:-margin]


def eased(fraction: ArrayLike) -> FloatArray:
    """Return the minimum-jerk way from 0 to 1 [1]_, held outside.

    References
    ----------
    .. [1] T. Flash and N. Hogan, "The coordination of arm movements", J. Neurosci. 5, 1985.
    """
    u = np.clip(np.asarray(fraction, dtype=np.float64), 0.0, 1.0)
    return u**3 * (10.0 + u * (6.0 * u - 15.0))
