"""Doodles with closed-form answers: straight lines, circles, helices, spins."""

from __future__ import annotations

import numpy as np

from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import normalized, quaternion_about

RATE_HZ = 90.0
"""Rate of the simulated tracker."""

Vector = tuple[float, float, float]


def straight_line(
    *,
    length_m: float,
    duration_s: float,
    direction: Vector = (0.0, 0.0, 1.0),
    rate_hz: float = RATE_HZ,
) -> Doodle:
    """Return a prop that moves straight at constant speed, facing +Z all the while."""
    time_s = even_times(duration_s, rate_hz)
    way = normalized(direction) * length_m
    return Doodle(time_s, time_s[:, None] / duration_s * way, _facing(np.zeros_like(time_s)))


def circle(
    *, radius_m: float, duration_s: float, turns: float = 1.0, rate_hz: float = RATE_HZ
) -> Doodle:
    """Return a prop that walks to its left around a level circle, its front along the way.

    Its angular velocity is ``2 pi turns / duration_s`` about +Y, its speed that times the radius.
    """
    return helix(radius_m=radius_m, rise_m=0.0, duration_s=duration_s, turns=turns, rate_hz=rate_hz)


def helix(
    *,
    radius_m: float,
    rise_m: float,
    duration_s: float,
    turns: float = 1.0,
    rate_hz: float = RATE_HZ,
) -> Doodle:
    """Return a `circle` that rises by ``rise_m`` in all: curvature and torsion are constant.

    With r the radius and h the rise a radian, they are ``r / (r^2 + h^2)`` and
    ``h / (r^2 + h^2)``.
    """
    time_s = even_times(duration_s, rate_hz)
    angle = 2.0 * np.pi * turns * time_s / duration_s
    ways = [-radius_m * np.cos(angle), rise_m * time_s / duration_s, radius_m * np.sin(angle)]
    return Doodle(time_s, np.stack(ways, axis=-1), _facing(angle))


def spin(
    *,
    angle_rad: float,
    duration_s: float,
    axis: Vector = (0.0, 1.0, 0.0),
    rate_hz: float = RATE_HZ,
) -> Doodle:
    """Return a prop that turns on the spot at a constant rate."""
    time_s = even_times(duration_s, rate_hz)
    turned = quaternion_about(axis, angle_rad * time_s / duration_s)
    return Doodle(time_s, np.zeros((len(time_s), 3)), turned)


def even_times(duration_s: float, rate_hz: float) -> FloatArray:
    """Return even times from 0; a last partial period is dropped."""
    # + 1e-9: 0.29 s at 100 Hz is 28.999…96 periods, and must count as 29.
    return np.arange(int(duration_s * rate_hz + 1e-9) + 1) / rate_hz


def _facing(heading_rad: FloatArray) -> FloatArray:
    """Return upright orientations that face the given headings."""
    return quaternion_about([0.0, 1.0, 0.0], heading_rad)
