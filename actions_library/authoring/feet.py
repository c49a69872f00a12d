"""Feet: where and when they stand, and how they swing from one stand to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from actions_library.authoring.curves import eased
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import quaternion_from_euler, rotate

_STEP_S = 1e-4
"""Step of the one-sided differences that give a swing its first and last velocity."""

ALWAYS_S = 1e3
"""Before and after any clip."""

FREEING_S = 0.12
"""Time in which a foot that has left the ground comes under its leg's own keys, and back."""


@dataclass(frozen=True, slots=True)
class Via:
    """A place on a foot's way through the air.

    Attributes
    ----------
    at : fraction of the swing's time.
    up : height of the ankle above where it is when standing (m).
    along : fraction of the way over the ground; the time's by default.
    out : distance from the straight way, away from the body's middle (m).
    pitch : toes down (°).
    toes : bends the toes up (°).
    """

    at: float
    up: float
    along: float | None = None
    out: float = 0.0
    pitch: float = 0.0
    toes: float = 0.0


_FREE_SWING = (Via(0.25, 0.30, pitch=30.0), Via(0.75, 0.30, pitch=10.0))
"""Between its plants, where a foot's way is not seen: high, so that it comes from above."""


@dataclass(frozen=True, slots=True)
class OnBall:
    """A standing foot on its ball at a time (s): toes down (°), and turned left on the spot (°)."""

    at: float
    pitch: float
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class Plant:
    """A foot's stand on the ground.

    Attributes
    ----------
    land, leave : when it touches the ground first and last (s).
    left, ahead, yaw : where the ankle stands (m) and where the toes point (°, to the left).
    land_pitch : of the foot when it lands: below 0 on the heel, above 0 on the ball (°).
    flat : how long after landing the whole sole is down (s).
    leave_pitch : of the foot when it leaves, rolling over the ball (°).
    roll : how long before leaving the heel begins to rise (s).
    on_ball : keys of rising onto the ball and turning on it while it stands; the first at pitch 0.
    swing : the way through the air that led here; None where the leg's own keys say it.
    """

    land: float
    leave: float
    left: float
    ahead: float
    yaw: float = 0.0
    land_pitch: float = 0.0
    flat: float = 0.10
    leave_pitch: float = 0.0
    roll: float = 0.20
    on_ball: tuple[OnBall, ...] = ()
    swing: tuple[Via, ...] | None = (Via(0.5, 0.06),)


@dataclass(frozen=True, slots=True)
class FootShape:
    """Points of a foot from its ankle, at rest: where it rolls (m).

    One that stands ``on_toes`` (a paw, a hoof) rolls over its ball either way, the toes flat.
    """

    ball: FloatArray
    heel: FloatArray
    ankle_height: float
    on_toes: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class FootPath:
    """A foot over time, in the clip's world: ``(n, …)`` each.

    Where ``free`` is above 0, the leg's own keys have the foot to that share.
    """

    ankle_m: FloatArray
    rotation_xyzw: FloatArray
    toes_up_rad: FloatArray
    sole_down: BoolArray
    toes_down: BoolArray
    free: FloatArray


def other_foot(plant: Plant) -> Plant:
    """Return the plant's mirror image, for the other foot."""
    turned = tuple(replace(key, turn=-key.turn) for key in plant.on_ball)
    return replace(plant, left=-plant.left, yaw=-plant.yaw, on_ball=turned)


def repeated(plants: Sequence[Plant], period_s: float, *, left: float, ahead: float) -> list[Plant]:
    """Return a cycle's plants with those of the cycles around it; each cycle travels so far."""
    return [
        replace(
            plant,
            land=plant.land + k * period_s,
            leave=plant.leave + k * period_s,
            left=plant.left + k * left,
            ahead=plant.ahead + k * ahead,
            on_ball=tuple(replace(key, at=key.at + k * period_s) for key in plant.on_ball),
        )
        for k in range(-2, 3)
        for plant in plants
    ]


def foot_path(
    plants: Sequence[Plant], shape: FootShape, out: float, time_s: FloatArray
) -> FootPath:
    """Return a foot's path: still and rolling while it stands, a spline while it swings.

    Parameters
    ----------
    plants
        In the order of time, apart from each other; they cover the first and last time or lie
        beyond them.
    out
        +1 for a left foot, -1 for a right one.
    """
    from scipy.interpolate import make_interp_spline

    row = np.empty((len(time_s), 6))
    sole, toes = np.zeros(len(time_s), bool), np.zeros(len(time_s), bool)
    free = np.zeros(len(time_s))
    for plant in plants:
        on = (time_s >= plant.land - 1e-9) & (time_s <= plant.leave + 1e-9)
        row[on] = _standing(plant, shape, time_s[on])
        sole[on] = row[on, 4] == 0.0
        toes[on] = shape.on_toes | (row[on, 4] >= 0.0)
    for before, after in pairwise(plants):
        on = (time_s > before.leave + 1e-9) & (time_s < after.land - 1e-9)
        if not on.any():
            continue
        ends = np.array([before.leave, after.land])
        leave = _standing(before, shape, ends[0] - np.array([_STEP_S, 0.0]))
        land = _standing(after, shape, ends[1] + np.array([0.0, _STEP_S]))
        swing = _FREE_SWING if after.swing is None else after.swing
        if after.swing is None:
            edge_s = np.minimum(time_s[on] - ends[0], ends[1] - time_s[on])
            free[on] = eased(edge_s / min(FREEING_S, 0.5 * (ends[1] - ends[0])))
        vias = [_via_row(via, before, after, shape, out) for via in swing]
        spline = make_interp_spline(
            [ends[0], *(ends[0] + via.at * (ends[1] - ends[0]) for via in swing), ends[1]],
            [leave[1], *vias, land[0]],
            k=3,
            bc_type=(
                [(1, np.diff(leave, axis=0)[0] / _STEP_S)],
                [(1, np.diff(land, axis=0)[0] / _STEP_S)],
            ),
        )
        row[on] = spline(time_s[on])
    return FootPath(
        ankle_m=row[:, :3],
        rotation_xyzw=_foot_rotation(row[:, 3], row[:, 4]),
        toes_up_rad=row[:, 5],
        sole_down=sole,
        toes_down=toes,
        free=free,
    )


def _foot_rotation(yaw_rad: FloatArray, pitch_rad: FloatArray) -> FloatArray:
    angles = np.stack([yaw_rad, pitch_rad, np.zeros_like(yaw_rad)], axis=-1)
    return quaternion_from_euler("YXZ", angles)


def _standing(plant: Plant, shape: FootShape, time_s: FloatArray) -> FloatArray:
    """Return (x, y, z, yaw, pitch, toes up) of a standing foot that rolls over heel and ball."""
    since = np.clip((time_s - plant.land) / plant.flat, 0.0, 1.0)
    until = np.clip((time_s - plant.leave + plant.roll) / plant.roll, 0.0, 1.0)
    pitch = np.radians(plant.land_pitch * (1.0 - since) ** 2 + plant.leave_pitch * until**2)
    turn = np.zeros_like(pitch)
    if plant.on_ball:
        pitch = pitch + _between_keys(plant.on_ball, "pitch", time_s)
        turn = _between_keys(plant.on_ball, "turn", time_s)
    yaw = np.full_like(pitch, np.radians(plant.yaw))
    flat = _foot_rotation(yaw, np.zeros_like(yaw))
    yaw = yaw + turn
    rolled = _foot_rotation(yaw, pitch)
    over_ball = shape.on_toes | (pitch[:, None] > 0.0) | (turn[:, None] != 0.0)
    pivot = np.where(over_ball, shape.ball, shape.heel)
    stand = np.array([plant.left, shape.ankle_height, plant.ahead])
    ankle = stand + rotate(flat, pivot) - rotate(rolled, pivot)
    toes = pitch if shape.on_toes else np.maximum(pitch, 0.0)
    return np.column_stack([ankle, yaw, pitch, toes])


def _between_keys(keys: Sequence[OnBall], value: str, time_s: FloatArray) -> FloatArray:
    """Return a value (radians) that rests at its keys' extremes and is held outside them."""
    from scipy.interpolate import PchipInterpolator

    at = np.array([key.at for key in keys])
    curve = PchipInterpolator(at, np.radians([getattr(key, value) for key in keys]))
    return np.asarray(curve(np.clip(time_s, at[0], at[-1])), dtype=np.float64)


def _via_row(via: Via, before: Plant, after: Plant, shape: FootShape, out: float) -> FloatArray:
    """Return (x, y, z, yaw, pitch, toes up) of a place on the way between two plants."""
    along = via.at if via.along is None else via.along
    yaw = np.radians(before.yaw + along * (after.yaw - before.yaw))
    aside = out * via.out
    return np.array(
        [
            before.left + along * (after.left - before.left) + aside * np.cos(yaw),
            shape.ankle_height + via.up,
            before.ahead + along * (after.ahead - before.ahead) - aside * np.sin(yaw),
            yaw,
            np.radians(via.pitch),
            np.radians(via.toes),
        ]
    )
