"""Balance: a body's weight is brought over the feet that carry it.

Where a body accelerates, what it pushes against is not below its centre of mass but at the zero
moment point [1]_, and a body can push against the ground only where its feet are. Poses that are
played faster than they were made, blended, or moved along a path break this. So the zero moment
point of the poses is brought to the feet, as far as it is off them, and the movement of the centre
of mass that has this zero moment point is found: the idea of [2]_, in closed form. The body then
leans into what it does, and does not start or stop more abruptly than it can push.

References
----------
.. [1] M. Vukobratović, B. Borovac, "Zero-moment point: thirty five years of its life",
   International Journal of Humanoid Robotics 1, 2004.
.. [2] H. J. Shin, L. Kovar, M. Gleicher, "Physical Touch-Up of Human Motions", Pacific Graphics
   2003.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from smd.acting.flight import GRAVITY_M_S2
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep

BESIDE_M = 0.08
"""How far off its feet a zero moment point may be: half a foot's width, and what real ones are."""

MOST_SHIFT_M = 0.3
"""Most that a body is moved aside: its legs still reach the ground."""

STEADIED_S = 0.04
"""Smoothing of the centre of mass before its acceleration is taken."""

UPRIGHT = (0.55, 0.75)
"""Height of the centre of mass, as a share of the resting one, below which a body sits, lies or
crawls, and rests on more than its feet; and above which feet alone carry it."""


def balance_shift(
    centre_m: FloatArray,
    soles_m: FloatArray,
    stands: BoolArray,
    flies: BoolArray,
    height_m: float,
    rate_hz: float,
) -> FloatArray:
    """Return how far over the ground a body's centre of mass must be moved ``(n, 2)``.

    Parameters
    ----------
    centre_m
        ``(n, 3)`` the centre of mass in the poses.
    soles_m
        ``(n, legs, 2, 2)`` x and z of heel and ball of each foot.
    stands
        ``(n, legs)`` which carry the body.
    flies
        ``(n,)`` when nothing does, and it falls.
    height_m
        Of the centre of mass at rest.
    """
    if len(centre_m) < 5 or not stands.any():
        return np.zeros((len(centre_m), 2))
    steady_m = gaussian_smoothed(centre_m, STEADIED_S * rate_hz)
    pushed = np.gradient(np.gradient(steady_m, axis=0), axis=0) * rate_hz**2
    lasting2 = np.clip(steady_m[:, 1] / np.maximum(GRAVITY_M_S2 + pushed[:, 1], 3.0), 0.02, 0.2)
    over_m = steady_m[:, [0, 2]]
    point_m = over_m - lasting2[:, None] * pushed[:, [0, 2]]
    carried = stands.any(axis=1) & ~flies
    off_m = _off(point_m, soles_m, stands)
    far_m = np.linalg.norm(off_m, axis=-1, keepdims=True)
    back_m = off_m * np.maximum(1.0 - BESIDE_M / np.maximum(far_m, 1e-9), 0.0)
    upright = smootherstep((steady_m[:, 1] / height_m - UPRIGHT[0]) / (UPRIGHT[1] - UPRIGHT[0]))
    wanted_m = np.where(carried[:, None], -upright[:, None] * back_m, 0.0)
    # In the air a body pushes against nothing: there its acceleration is to be taken out.
    wanted_push = np.where(flies[:, None], -pushed[:, [0, 2]], 0.0)
    shift_m = _solved(wanted_m, wanted_push, lasting2, carried | ~flies, rate_hz)
    length = np.linalg.norm(shift_m, axis=-1, keepdims=True)
    return shift_m / (1.0 + (length / MOST_SHIFT_M) ** 4) ** 0.25


def _solved(
    wanted_m: FloatArray,
    wanted_push: FloatArray,
    lasting2: FloatArray,
    carried: BoolArray,
    rate_hz: float,
) -> FloatArray:
    """Return the shift whose zero moment point moves as wanted: s - k s'' = wanted, 0 at the ends.

    Where nothing carries the body, its acceleration is as wanted instead.
    """
    from scipy.linalg import solve_banded

    n = len(wanted_m)
    stiff = lasting2 * rate_hz**2
    banded = np.zeros((3, n))
    banded[1] = 2.0 * stiff + carried
    banded[0, 1:], banded[2, :-1] = -stiff[:-1], -stiff[1:]
    right = np.where(carried[:, None], wanted_m, -lasting2[:, None] * wanted_push)
    banded[1, [0, -1]], banded[0, 1], banded[2, -2] = 1.0, 0.0, 0.0
    right[[0, -1]] = 0.0
    return np.asarray(solve_banded((1, 1), banded, right))


def _off(point_m: FloatArray, soles_m: FloatArray, stands: BoolArray) -> FloatArray:
    """Return the way ``(n, 2)`` from the nearest place on the standing feet to a point.

    Zero where it is between them.
    """
    n, legs = stands.shape
    first = np.argmax(stands, axis=1)
    held = np.where(stands, np.arange(legs), first[:, None])  # others stand in for one that swings
    corners = soles_m[np.arange(n)[:, None], held].reshape(n, -1, 2)
    best = point_m - corners[:, 0]
    for i, j in combinations(range(corners.shape[1]), 2):
        edge = corners[:, j] - corners[:, i]
        square = np.sum(edge * edge, axis=-1)
        along = np.sum((point_m - corners[:, i]) * edge, axis=-1) / np.maximum(square, 1e-12)
        off = point_m - corners[:, i] - np.clip(along, 0.0, 1.0)[:, None] * edge
        nearer = np.sum(off * off, axis=-1) < np.sum(best * best, axis=-1)
        best = np.where(nearer[:, None], off, best)
    return np.where(_inside(point_m, corners)[:, None], 0.0, best)


def _inside(point_m: FloatArray, corners: FloatArray) -> BoolArray:
    """Return whether a point is within any triangle of some corners ``(n, k, 2)``: their hull."""
    inside = np.zeros(len(point_m), dtype=bool)
    to = corners - point_m[:, None]
    for a, b, c in combinations(range(corners.shape[1]), 3):
        turns = [_cross(to[:, i], to[:, j]) for i, j in ((a, b), (b, c), (c, a))]
        same = np.stack([turn > 1e-12 for turn in turns]).all(axis=0)
        other = np.stack([turn < -1e-12 for turn in turns]).all(axis=0)
        inside |= same | other
    return inside


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
