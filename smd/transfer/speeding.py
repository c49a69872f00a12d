"""Speeding: how fast a path is gone, made possible for a body.

A hand starts, stops and turns within a tenth of a second. A body that goes the same way starts and
ends at rest, slows down before a corner, and neither its speed nor its acceleration exceeds what
its legs can do. Two things are changed, each as little as is enough: how sharp the corners of the
path are, and when each of its places is reached.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.geometry.easing import eased_clock, gaussian_smoothed
from smd.transfer.limits import Limits

EVENING = np.linspace(0.0, 1.0, 11)
"""Shares tried of the way from the drawn times to those that need the least acceleration."""

ROUNDING_M = (0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8)
"""Rounding tried of the corners: the standard deviation of a Gaussian along the way."""

STARTING_S = 0.35
"""Time in which a body speeds up, and slows down, where its hand was moving at once; no more than a
quarter of the way's time."""

JERK_S = 0.06
"""Smoothing of the times: acceleration does not set in at once."""

_STEP_M = 0.01
_MOST_STEPS = 4000
_HALVINGS = 12


@dataclass(frozen=True, eq=False)
class Way:
    """A path by its length.

    Attributes
    ----------
    gone_m : (k,) evenly spaced, from 0 to the length of the path as drawn.
    place_m : (k, 2) where it is then.
    """

    gone_m: FloatArray
    place_m: FloatArray

    @cached_property
    def length_m(self) -> float:
        """The length of the path as it is."""
        return float(way_of_places(self.place_m)[-1])

    @property
    def step_m(self) -> float:
        """How far its places are apart."""
        return max(self.length_m / (len(self.gone_m) - 1), 1e-9)

    @cached_property
    def bend_per_m(self) -> FloatArray:
        """Its curvature ``(k,)`` at each place."""
        ahead = np.gradient(self.place_m, axis=0) / self.step_m
        return np.linalg.norm(np.gradient(ahead, axis=0), axis=-1) / self.step_m

    def at(self, gone_m: FloatArray) -> FloatArray:
        """Return the places ``(n, 2)`` after some lengths."""
        axes = [np.interp(gone_m, self.gone_m, axis) for axis in self.place_m.T]
        return np.stack(axes, axis=-1)


def way_of_places(place_m: FloatArray) -> FloatArray:
    """Return the length ``(n,)`` of a path ``(n, 2)`` up to each of its places."""
    steps = np.linalg.norm(np.diff(place_m, axis=0), axis=-1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def speeding(
    time_s: FloatArray, place_m: FloatArray, fastest_m_s: FloatArray, limits: Limits
) -> tuple[FloatArray, FloatArray]:
    """Return which of its own times a path is shown at, and where it is then.

    Parameters
    ----------
    time_s
        ``(n,)`` increasing.
    place_m
        ``(n, 2)`` as drawn.
    fastest_m_s
        ``(n,)`` speed that it should not exceed there.

    Returns
    -------
    shown_s, place_m
        ``(n,)`` not decreasing, with the same ends; and ``(n, 2)``, with the same ends.
    """
    way_m = way_of_places(place_m)
    whole_m, lasting_s = float(way_m[-1]), float(time_s[-1] - time_s[0])
    if whole_m < 1e-6 or len(time_s) < 5:
        return time_s, place_m
    way, soonest = _rounded(way_m, place_m, lasting_s, fastest_m_s, limits)
    most_s = min(STARTING_S, 0.25 * lasting_s)
    drawn_m = np.interp(eased_clock(time_s, most_s, most_s), time_s, way_m)
    even_m = np.interp(time_s - time_s[0], soonest, way.gone_m)
    rate_hz = (len(time_s) - 1) / lasting_s
    even_m = gaussian_smoothed(even_m, JERK_S * rate_hz)
    place_at = np.searchsorted(way_m, way.gone_m).clip(max=len(way_m) - 1)
    most_at = fastest_m_s[place_at]
    for share in EVENING:
        gone_m = (1.0 - share) * drawn_m + share * even_m
        # A point at which a path turns back is still passed at a step's speed: not at once.
        place_m = gaussian_smoothed(way.at(gone_m), JERK_S * rate_hz)
        velocity = np.gradient(place_m, 1.0 / rate_hz, axis=0)
        push = np.linalg.norm(np.gradient(velocity, 1.0 / rate_hz, axis=0), axis=-1)
        speed = np.linalg.norm(velocity, axis=-1)
        most_m_s = np.interp(gone_m, way.gone_m, most_at)
        if np.all(speed <= most_m_s) and push.max() <= limits.acceleration_m_s2:
            break
    rising = way_m + 1e-9 * np.arange(len(way_m))
    shown_s = np.maximum.accumulate(np.interp(gone_m, rising, time_s))
    shown_s[[0, -1]] = time_s[[0, -1]]
    return shown_s, place_m


def roundest(place_m: FloatArray, limits: Limits) -> Way | None:
    """Return a path ``(n, 2)`` with its corners as round as may be; None where it leads nowhere."""
    way_m = way_of_places(place_m)
    if way_m[-1] < 1e-6:
        return None
    *_, last = _roundings(way_m, place_m, limits)
    return last


def least_s(way: Way, fastest_m_s: float, limits: Limits) -> float:
    """Return the least time for a path, from rest to rest."""
    return float(_soonest_s(way, fastest_m_s, limits.acceleration_m_s2)[-1])


def _roundings(way_m: FloatArray, place_m: FloatArray, limits: Limits) -> Iterator[Way]:
    """Yield a path, sharpest first, with its corners rounded as far as the detour allows."""
    whole_m = float(way_m[-1])
    count = int(np.clip(np.ceil(whole_m / _STEP_M), 16, _MOST_STEPS)) + 1
    gone_m = np.linspace(0.0, whole_m, count)
    once = np.concatenate([[True], np.diff(way_m) > 1e-9])
    drawn = np.stack([np.interp(gone_m, way_m[once], axis[once]) for axis in place_m.T], axis=-1)
    for sigma_m in ROUNDING_M:
        way = Way(gone_m, gaussian_smoothed(drawn, sigma_m * (count - 1) / whole_m))
        moved_m = np.sqrt(np.mean(np.sum((way.place_m - drawn) ** 2, axis=-1)))
        if sigma_m > 0.0 and (
            moved_m > limits.detour * whole_m or way.length_m < (1.0 - limits.shortening) * whole_m
        ):
            return
        yield way


def _rounded(
    way_m: FloatArray,
    place_m: FloatArray,
    lasting_s: float,
    fastest_m_s: FloatArray,
    limits: Limits,
) -> tuple[Way, FloatArray]:
    """Return a path with corners as round as its time needs, and when it is where ``(k,)``.

    The roundest is taken where none is enough.
    """
    for way in _roundings(way_m, place_m, limits):
        at = np.searchsorted(way_m, way.gone_m).clip(max=len(way_m) - 1)
        soonest_s, hurry = _times(way, lasting_s, fastest_m_s[at], limits.acceleration_m_s2)
        if hurry <= 1.0:
            break
    return way, soonest_s


def _soonest_s(way: Way, top_m_s: FloatArray | float, most_m_s2: float) -> FloatArray:
    """Return when each place of a path can be reached ``(k,)``, from rest to rest.

    Limited are the speed, and the acceleration along the path and across it [1]_: at each place the
    speed is what the corner allows, or what can be reached from the places before it and slowed
    down from before those after it.

    References
    ----------
    .. [1] J. E. Bobrow, S. Dubowsky, J. S. Gibson, "Time-optimal control of robotic manipulators
       along specified paths", International Journal of Robotics Research 4, 1985.
    """
    part, step_m = most_m_s2 * np.sqrt(0.5), way.step_m  # of the limit, along and across
    corners = part / np.maximum(way.bend_per_m, 1e-6)
    square = np.minimum(corners, np.minimum(top_m_s, 100.0) ** 2)
    square[[0, -1]] = 0.0
    rise = 2.0 * part * step_m * np.arange(len(square))
    square = np.minimum.accumulate(square - rise) + rise
    square = (np.minimum.accumulate((square + rise)[::-1]))[::-1] - rise
    speed = np.sqrt(np.maximum(square, 0.0))
    return np.concatenate([[0.0], np.cumsum(2.0 * step_m / (speed[1:] + speed[:-1]))])


def _times(
    way: Way, lasting_s: float, fastest_m_s: FloatArray, most_m_s2: float
) -> tuple[FloatArray, float]:
    """Return when each place of a path is reached ``(k,)``, at the least top speed, and the hurry.

    Where even the soonest takes longer than there is, all is faster by a factor, the hurry.
    """
    whole_s = _soonest_s(way, fastest_m_s, most_m_s2)
    hurry = float(whole_s[-1] / lasting_s)
    if hurry < 1.0:
        slow, fast = way.length_m / lasting_s, float(np.minimum(fastest_m_s, 100.0).max())
        for _ in range(_HALVINGS):
            middle = 0.5 * (slow + fast)
            if _soonest_s(way, np.minimum(middle, fastest_m_s), most_m_s2)[-1] > lasting_s:
                slow = middle
            else:
                fast = middle
        whole_s = _soonest_s(way, np.minimum(fast, fastest_m_s), most_m_s2)
    return whole_s * (lasting_s / whole_s[-1]), max(hurry, 1.0)
