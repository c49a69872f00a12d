"""The root motion of a movement without a ground root: the body's path and heading.

A file moves the pelvis, or keeps it in place while the feet slide backward as on a treadmill. From
either we make the path of a joint on the ground, the parent of the rest of the body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import heading_rad, inverse, multiply, quaternion_about, rotate

FAR = 0.5
"""Distance over the ground, in leg lengths, from which a movement is taken to travel."""

CLOSED_STEPS = 1.6
"""Greatest difference of the last pose of a cycle to its first, in multiples of the largest change
between frames."""

UNDER_WAY = 0.3
"""Least speed of a cycle at its ends, as a share of its usual speed: a movement that begins and
ends at rest is played once."""

TURNED_RAD = 0.5
"""A change of heading that is more than swaying."""

LOW = 0.06
"""Height, in leg lengths, up to which a foot may bear weight."""

SOFTENING_S = 0.12
"""Standard deviation of the smoothing of a path that is not even."""


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """The path of the ground root, and the kind of movement.

    Attributes
    ----------
    position_m : (n, 3) on the ground, from the origin.
    rotation_xyzw : (n, 4) about +Y, the first one identity.
    pelvis_m : (n, 3) and
    pelvis_turn_xyzw : (4,) where the pelvis is then, and by what all joints are turned.
    travels, cyclic : given or guessed.
    treadmill : whether the way comes from feet that slid backward, not from the pelvis.
    """

    position_m: FloatArray
    rotation_xyzw: FloatArray
    pelvis_m: FloatArray
    pelvis_turn_xyzw: FloatArray
    travels: bool
    cyclic: bool
    treadmill: bool


def found_ground(
    world_xyzw: FloatArray,
    pelvis_m: FloatArray,
    pelvis: int,
    pelvis_rest_xyzw: FloatArray,
    feet_m: FloatArray,
    rate_hz: float,
    leg_m: float,
    *,
    travels: bool | None,
    cyclic: bool,
) -> Ground:
    """Return the ground root of a movement.

    Parameters
    ----------
    world_xyzw
        ``(n, j, 4)`` of the joints in the world.
    pelvis_m, pelvis, pelvis_rest_xyzw
        ``(n, 3)`` where the pelvis goes, which joint it is, and how it is turned at rest.
    feet_m
        ``(n, f, 3)`` tips of the legs.
    leg_m
        Height of the pelvis above the feet: what lengths are measured by.
    travels, cyclic
        What the movement is; ``travels`` may be None for a guess.
    """
    slid = _slid_m(feet_m, rate_hz, leg_m)
    went, would_go = (float(np.linalg.norm(way[-1] - way[0])) for way in (pelvis_m[:, ::2], slid))
    if travels is None:
        travels = went > FAR * leg_m or (cyclic and would_go > FAR * leg_m)
    treadmill = cyclic and travels and went < 0.25 * would_go
    pelvis_m = pelvis_m.copy()
    if treadmill:
        pelvis_m[:, ::2] += slid
    turned = multiply(world_xyzw[:, pelvis], inverse(pelvis_rest_xyzw))
    facing = np.unwrap(heading_rad(turned))
    path, heading = _path(pelvis_m[:, ::2], facing, rate_hz, travels=travels, cyclic=cyclic)
    first = quaternion_about([0.0, 1.0, 0.0], -heading[0])
    level = np.column_stack([path[:, 0], np.zeros(len(path)), path[:, 1]])
    return Ground(
        position_m=rotate(first, level - level[0]),
        rotation_xyzw=quaternion_about([0.0, 1.0, 0.0], heading - heading[0]),
        pelvis_m=rotate(first, pelvis_m - level[0]),
        pelvis_turn_xyzw=first,
        travels=travels,
        cyclic=cyclic,
        treadmill=treadmill,
    )


def repeats(world_xyzw: FloatArray) -> bool:
    """Return whether a movement looks like a cycle: its last pose leads on to its first."""
    if len(world_xyzw) < 4:
        return False
    steps = _turn_rad(world_xyzw[:-1], world_xyzw[1:])
    largest, usual = steps.max(axis=-1), steps.mean(axis=-1)
    closed = float(_turn_rad(world_xyzw[-1], world_xyzw[0]).max()) < CLOSED_STEPS * largest.max()
    ends = min(usual[:2].mean(), usual[-2:].mean())
    return bool(closed and ends > UNDER_WAY * np.median(usual))


def wants_first_frame(world_xyzw: FloatArray) -> bool:
    """Return whether a cycle's last frame is the one before its first, and not equal to it."""
    steps = _turn_rad(world_xyzw[:-1], world_xyzw[1:]).mean(axis=-1)
    return bool(_turn_rad(world_xyzw[-1], world_xyzw[0]).mean() > 0.5 * np.median(steps))


def _turn_rad(one_xyzw: FloatArray, other_xyzw: FloatArray) -> FloatArray:
    """Return the angle between rotations."""
    dots = np.abs(np.sum(one_xyzw * other_xyzw, axis=-1))
    return np.asarray(2.0 * np.arccos(np.clip(dots, 0.0, 1.0)))


def _slid_m(feet_m: FloatArray, rate_hz: float, leg_m: float) -> FloatArray:
    """Return how far the ground under the lowest foot slid backward since the start, ``(n, 2)``."""
    rows = np.arange(len(feet_m))
    if feet_m.shape[1] == 0 or len(rows) < 3:
        return np.zeros((len(rows), 2))
    velocity = np.gradient(feet_m[..., ::2], 1.0 / rate_hz, axis=0)
    above = feet_m[..., 1] - feet_m[..., 1].min(axis=0)
    lowest = np.argmin(above, axis=1)
    bears = above[rows, lowest] < LOW * leg_m
    speed = -np.median(velocity[rows, lowest][bears], axis=0)
    return np.asarray(speed * (rows / rate_hz)[:, None])


def _path(
    way: FloatArray, facing: FloatArray, rate_hz: float, *, travels: bool, cyclic: bool
) -> tuple[FloatArray, FloatArray]:
    """Return the ground root's path ``(n, 2)`` and heading ``(n,)``.

    A cycle moves evenly and straight; a movement that turns in place turns its root.
    """
    from scipy.ndimage import gaussian_filter1d

    n = len(way)
    even = np.linspace(0.0, 1.0, n)[:, None]
    if not travels:
        path = np.broadcast_to(way[0], way.shape)
    elif cyclic:
        path = way[0] + even * (way[-1] - way[0])
    else:
        path = np.asarray(gaussian_filter1d(way, SOFTENING_S * rate_hz, axis=0, mode="nearest"))
        path = path + (1.0 - even) * (way[0] - path[0]) + even * (way[-1] - path[-1])
    if cyclic:
        return path, np.full(n, float(facing.mean()))
    if abs(facing[-1] - facing[0]) < TURNED_RAD:
        return path, np.full(n, float(facing[0]))
    return path, np.asarray(gaussian_filter1d(facing, SOFTENING_S * rate_hz, mode="nearest"))
