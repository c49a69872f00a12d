"""Slope: bodies and feet are moved from the level ground onto a terrain.

Everything is animated on level ground first. Then the body follows the height of the ground below
it, smoothed, and each foot the height below its sole, exactly. What was on the ground is on it
again, and what was above it is as far above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.acting.footing import ROLLING_M, plants_of
from smd.acting.legs import Leg
from smd.acting.terrain import Terrain
from smd.errors import TransferError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import multiply, quaternion_between, rotate

RIDING_S = 0.15
"""Smoothing of the body's height over the ground: a step up is taken in a third of a second."""

MOST_TILT_RAD = np.radians(25.0)
"""Most that a sole is tilted: about what an ankle bends upward; beyond, it stands on its edge."""

CLEARING_S = 0.1
"""Time before and after an obstacle in which a swinging foot is raised over it."""

LONG_S = 1.0
"""Duration of a swing from which on a foot follows the body's height: it flies, or lies."""

EARLY_S = 0.1
"""How long before the end of a contact a foot may begin to rise for that, and after its start still
come down; never more than a third of the contact."""

_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False)
class Slope:
    """The ground along one performer's path.

    Attributes
    ----------
    terrain : the ground.
    under_m : (n,) its height below the ground root, a frame each.
    body_m : (n,) how much higher than on level ground the body is.
    """

    terrain: Terrain
    under_m: FloatArray
    body_m: FloatArray

    def laid(
        self,
        leg: Leg,
        foot_xyzw: FloatArray,
        ankle_m: FloatArray,
        stands: BoolArray,
        rate_hz: float,
    ) -> tuple[FloatArray, FloatArray]:
        """Return a foot's rotation and place on the terrain, given those on level ground.

        Parameters
        ----------
        foot_xyzw, ankle_m
            ``(n, 4)`` and ``(n, 3)``.
        stands
            ``(n,)``; there its sole is tilted like the ground; in between the tilt is interpolated.
        """
        heel, ball = rotate(foot_xyzw, leg.heel_m), rotate(foot_xyzw, leg.ball_m)
        low = ankle_m[:, 1] + np.minimum(heel[:, 1], ball[:, 1] - leg.ball_height_m)
        over = heel[:, 1] - (ball[:, 1] - leg.ball_height_m)
        on_ball = 1.0 / (1.0 + np.exp(np.clip(-over / ROLLING_M, -50.0, 50.0)))[:, None]
        pivot = on_ball * ball + (1.0 - on_ball) * heel
        plants = plants_of(stands)
        middle = (ankle_m + 0.5 * (heel + ball))[:, [0, 2]]
        normal = self._normals(middle, plants)
        tilt = quaternion_between(np.broadcast_to(_UP, normal.shape), normal)
        foot_q = multiply(tilt, foot_xyzw)
        placed_m = ankle_m + pivot + rotate(tilt, -pivot)
        wanted_m = low - self.sole_height(leg, foot_q, placed_m, normal[:, 1])
        steps_m = np.linalg.norm(np.diff(ankle_m[:, [0, 2]], axis=0), axis=-1)
        way_m = np.concatenate([[0.0], np.cumsum(steps_m)])
        placed_m[:, 1] += self._swung(wanted_m, way_m, plants, rate_hz)
        return foot_q, placed_m

    def sole_height(
        self, leg: Leg, foot_xyzw: FloatArray, ankle_m: FloatArray, level: FloatArray | float = 1.0
    ) -> FloatArray:
        """Return how high over the terrain a sole is ``(n,)``: its heel, middle or ball.

        Parameters
        ----------
        level
            Upward part of the sole's normal: the ball's thickness counts along it.
        """
        heel, ball = rotate(foot_xyzw, leg.heel_m), rotate(foot_xyzw, leg.ball_m)
        over = [
            self._over(ankle_m + (1.0 - share) * heel + share * ball)
            - share * leg.ball_height_m / level
            for share in (0.0, 0.5, 1.0)
        ]
        return np.min(over, axis=0)

    def _over(self, point_m: FloatArray) -> FloatArray:
        """Return how high points are over the terrain; beside it, over the body's ground."""
        height = self.terrain.height_at(point_m[:, [0, 2]])
        return point_m[:, 1] - np.where(np.isnan(height), self.under_m, height)

    def _normals(self, place_m: FloatArray, plants: IntArray) -> FloatArray:
        """Return a sole's normal ``(n, 3)``: the mean of the ground's in each plant."""
        found = self.terrain.normal_at(place_m)
        found = np.where(np.isnan(found), _UP, found)
        means = [_limited(found[start:end].mean(axis=0)) for start, end in plants]
        if not means:
            return np.broadcast_to(_UP, found.shape)
        along = _across(np.array(means), plants, len(found))
        return along / np.linalg.norm(along, axis=-1, keepdims=True)

    def _swung(
        self, wanted_m: FloatArray, way_m: FloatArray, plants: IntArray, rate_hz: float
    ) -> FloatArray:
        """Return how far a foot is raised: as wanted where it stands, never less in between."""
        lead = self._lead(wanted_m, way_m, plants, rate_hz)
        stands, held = np.zeros((2, len(wanted_m)), dtype=bool)
        for start, end in plants:
            early = min(round(EARLY_S * rate_hz), (end - start) // 3)
            stands[start:end] = held[start + early : end - early] = True
        lack = np.where(stands, 0.0, np.maximum(wanted_m - lead, 0.0))
        around = max(int(np.ceil(CLEARING_S * rate_hz)), 1)
        padded = np.pad(lack, around, mode="edge")
        highest = np.lib.stride_tricks.sliding_window_view(padded, 2 * around + 1).max(axis=-1)
        eased = gaussian_smoothed(highest, around / 3.0)
        swings = np.minimum(*_frames_from(held))
        more = np.maximum(eased * smootherstep(swings / around), lack)
        return np.where(stands, wanted_m, lead) + more

    def _lead(
        self, wanted_m: FloatArray, way_m: FloatArray, plants: IntArray, rate_hz: float
    ) -> FloatArray:
        """Return how far a foot is raised ``(n,)``, interpolated by distance between contacts.

        In a long swing, before the first contact and after the last, it follows the body's height.
        """
        lead = self.body_m.copy()
        if not len(plants):
            return lead
        above = wanted_m - self.body_m
        first, last = plants[0, 0], plants[-1, 1] - 1
        lead[:first] += above[first]
        lead[last:] += above[last]
        for leave, land in zip(plants[:-1, 1] - 1, plants[1:, 0], strict=True):
            swing = slice(leave, land + 1)
            gone = way_m[swing] - way_m[leave]
            share = gone / gone[-1] if gone[-1] > 0.0 else np.linspace(0.0, 1.0, len(gone))
            if land - leave > LONG_S * rate_hz:
                lead[swing] += above[leave] + share * (above[land] - above[leave])
            else:
                lead[swing] = wanted_m[leave] + share * (wanted_m[land] - wanted_m[leave])
        return lead


def slope(
    terrain: Terrain,
    root_m: FloatArray,
    flies: BoolArray,
    time_s: FloatArray,
    rate_hz: float,
    name: str,
) -> Slope:
    """Return the ground along a path.

    Parameters
    ----------
    root_m
        ``(n, 2)`` x and z of the ground root.
    flies
        ``(n,)`` when nothing touches the ground: the body's base then goes in a straight line from
        take-off to landing.
    name
        Of the performer.

    Raises
    ------
    TransferError
        If there is no ground below the path, or several surfaces one above another.
    """
    under = terrain.height_at(root_m)
    for fault, expected, found in (
        (np.isnan(under), "ground", "none"),
        (terrain.storeys_at(root_m), "one surface", "several over one another"),
    ):
        if fault.any():
            at = int(np.argmax(fault))
            raise TransferError(
                f"{terrain.name}: expected {expected} below {name!r} at {time_s[at]:.2f} s "
                f"(x {root_m[at, 0]:.2f} m, z {root_m[at, 1]:.2f} m of the stage), found {found}"
            )
    touches = np.flatnonzero(~flies)
    frames = np.arange(len(under))
    ridden = np.interp(frames, touches, under[touches]) if len(touches) else under
    return Slope(terrain, under, gaussian_smoothed(ridden, RIDING_S * rate_hz))


def _limited(normal: FloatArray) -> FloatArray:
    """Return a normal no farther from upright than `MOST_TILT_RAD`."""
    aside = np.hypot(normal[0], normal[2])
    most = np.tan(MOST_TILT_RAD) * normal[1]
    share = min(1.0, most / aside) if aside > 0.0 else 1.0
    limited = normal * [share, 1.0, share]
    return limited / np.linalg.norm(limited)


def _across(value: FloatArray, plants: IntArray, count: int) -> FloatArray:
    """Return values of plants ``(p, k)``, held in them and interpolated between them."""
    frames = np.arange(count)
    after = np.searchsorted(plants[:, 0], frames, side="right")  # plants begun by then
    left, right = np.maximum(after - 1, 0), np.minimum(after, len(plants) - 1)
    leave, land = plants[left, 1] - 1, plants[right, 0]
    share = smootherstep((frames - leave) / np.maximum(land - leave, 1))
    return value[left] + share[:, None] * (value[right] - value[left])


def _frames_from(true: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Return how many frames have passed since the last that is true, and are left to the next."""
    frames = np.arange(len(true))
    last = np.maximum.accumulate(np.where(true, frames, -len(true)))
    following = np.minimum.accumulate(np.where(true, frames, 2 * len(true))[::-1])[::-1]
    return (frames - last).astype(np.float64), (following - frames).astype(np.float64)
