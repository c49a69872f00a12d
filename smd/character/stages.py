"""Stages: where the five stages of any clip end (section 6.1 of the paper [1]_).

Each stage ends in an extreme pose. The paper looks for frames in which speed and acceleration
vanish; bodies that arrive part by part have none. We look along the direction in which the body
moves most: its turning points are the extreme poses, and there the speed vanishes by definition.
The first lively sweep between two of them is the execution; a sweep before it goes the other way
and is the anticipation, as in the paper's rule for two extreme poses. The execution ends where
most of its speed is gone, the follow-through where the sweep turns. What flies has not been
executed until it has landed.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from smd.geometry.arrays import BoolArray, FloatArray, IntArray

SMOOTHING_S = 0.02
"""Standard deviation of the softening of the way along the main direction."""

LEAST_SWEEP = 0.03
"""Shortest sweep, as a share of the whole range along the main direction."""

LIVELY = 0.7
"""An execution is the first sweep with so much of the liveliest one's length times speed."""

ARRIVED, DEPARTED = 0.3, 0.1
"""Shares of the execution's top speed: it has ended below the first, and begins above the other
where nothing went before it."""


def stage_end_frames(
    position_m: ArrayLike, rate_hz: float, *, cyclic: bool, touches: BoolArray
) -> IntArray:
    """Return the last frame of each of the five stages, ``(5,)``.

    Parameters
    ----------
    position_m
        ``(n, j, 3)`` of the joints, from the ground root: without travel.
    rate_hz
        Frames per second.
    cyclic
        A cycle is all execution.
    touches
        ``(n, c)`` when each of the joints that touch the ground does; none is no flight.
    """
    position = np.asarray(position_m, dtype=np.float64)
    last = len(position) - 1
    if cyclic or last < 3 or np.ptp(position, axis=0).max() < 1e-6:
        return np.array([0, 0, last, last, last])
    way = way_along_main_direction(position, rate_hz)
    speed = np.abs(np.gradient(way)) * rate_hz
    turns = turning_frames(way, LEAST_SWEEP * np.ptp(way))
    sweeps = list(pairwise(turns))
    lively = [abs(way[b] - way[a]) * speed[a : b + 1].max() for a, b in sweeps]
    main = next(i for i, value in enumerate(lively) if value >= LIVELY * max(lively))
    begins, turned = sweeps[main]
    top = begins + int(np.argmax(speed[begins : turned + 1]))
    slow = np.flatnonzero(speed[top : turned + 1] < ARRIVED * speed[top])
    ends = top + int(slow[0]) if len(slow) else turned
    if main == 0:
        moving = np.flatnonzero(speed[: top + 1] > DEPARTED * speed[top])
        begins = int(moving[0])
    prepared = sweeps[main - 1][0] if main > 0 else 0
    landed = landing_frame(touches, ends)
    if ends < landed:
        ends = landed
        turned = next((turn for turn in turns if turn >= ends), last)
    return np.array([prepared, begins, ends, turned, last])


def landing_frame(touches: BoolArray, frame: int) -> int:
    """Return where the last flight that begins before a frame ends; 0 if none does.

    Who begins or ends in the air has not jumped.
    """
    grounded = np.flatnonzero(touches.any(axis=1))
    flies = np.flatnonzero((np.diff(grounded) > 1) & (grounded[:-1] < frame))
    return int(grounded[flies[-1] + 1]) if len(flies) else 0


def way_along_main_direction(position_m: FloatArray, rate_hz: float) -> FloatArray:
    """Return how far the body is along the direction in which it moves most, ``(n,)``.

    The direction is one of all joints at once: the first singular vector of their velocities.
    """
    from scipy.ndimage import gaussian_filter1d

    flat = position_m.reshape(len(position_m), -1)
    velocity = np.gradient(flat, axis=0)
    direction = np.linalg.svd(velocity, full_matrices=False)[2][0]
    return np.asarray(gaussian_filter1d((flat - flat[0]) @ direction, SMOOTHING_S * rate_hz))


def turning_frames(way: FloatArray, least: float) -> list[int]:
    """Return the first frame and those at which a way turns back, by at least so much."""
    turns, farthest, sign = [0], 0, 0.0
    for i in range(len(way)):
        if sign == 0.0:
            if abs(way[i] - way[0]) > least:
                sign, farthest = float(np.sign(way[i] - way[0])), i
        elif (way[i] - way[farthest]) * sign > 0.0:
            farthest = i
        elif abs(way[i] - way[farthest]) > least:
            turns.append(farthest)
            farthest, sign = i, -sign
    return [*turns, farthest] if farthest > turns[-1] else [*turns, len(way) - 1]
