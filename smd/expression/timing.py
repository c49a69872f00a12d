"""Timing: which frame of a clip is shown when, by Effort (sections 6.3 and 6.4 of the paper [1]_).

Every change is one of *slowness*: how long each step of a clip, from a frame to the next, lasts in
its own time, ``(n - 1,)``. Slownesses multiply. At the end they are brought to the clip's duration,
so that every phrase keeps its own, and are kept within what a body can do; added up, they say when
each frame is shown.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
.. [2] G. Fleisig et al., "Kinematic and kinetic comparison of baseball pitching among various
   levels of development", Journal of Biomechanics 32, 1999.
.. [3] A. Lees, L. Nolan, "The biomechanics of soccer: a review", Journal of Sports Sciences 16,
   1998.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from smd.character.clip import Clip
from smd.expression.operators import powered_pace
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep

PACE_PER_WEIGHT = 0.4
"""Power of a body's vigour that Weight multiplies its pace by is this times ``e^weight - 1``: from
-0.25 to 0.7. The paper's 1.5 either way leaves a single frame of a strong blow, and makes the pace
of a light one so even that it comes off its rest with a jerk."""

EVENED = 1.0
"""Power of its vigour that the pace of a sustained clip is divided by, within each part of it."""

QUICK_PER_SUDDEN = 0.6
"""A sudden body is ready, and back, in ``exp(-0.6 time)`` of the time."""

WAITING, WAITS = 0.1, 5.0
"""Last share of a clip in which a sudden body waits: it is back by then, but for its last few
centimetres; and how many times longer than its own that takes, at least."""

HELD, RUNNING_ON = 0.7, 0.2
"""How far a bound clip comes to rest between stages, and a free one is the quicker there."""

SLOWEST, FASTEST = 0.125, 4.0
"""Limits of a retimed clip's pace over its own: no moment stands still, none is skipped."""

UNHURRIED = 1.75
"""The faster limit of a sustained clip, besides its anticipation, which is twice as fast: what its
execution takes longer, the rest must make up for, but not in a hurry."""

FASTEST_TURN_RAD_S = np.radians(1200.0)
"""Limit of a joint's speed in a retimed clip, unless its own is faster; in a phrase shorter than
its clip, all is faster again. People's elbows reach 2400 degrees a second in a pitch [2]_,
their knees 1700 in a kick [3]_."""

SHORTEST_STAGE_S = 0.05
"""A stage shorter than this has no room for a timing of its own."""

BLENDED_S = 0.03
"""Smoothing of the change from one stage's slowness to the next one's, and of speeds: a pace that
jumps is a blow."""


class Vigour(NamedTuple):
    """How a body moves in each step of a clip, as seen from its ground root.

    Attributes
    ----------
    speed : (n - 1,) in metres a step, on average over the joints.
    force : (n - 1,) change of it, of the joint that changes most, in metres a step a step.
    """

    speed: FloatArray
    force: FloatArray


def vigour_of(seen_m: FloatArray, rate_hz: float) -> Vigour:
    """Return how a body moves whose joints are at ``seen_m (n, j, 3)``."""
    step = np.diff(seen_m, axis=0)
    change = np.linalg.norm(np.diff(step, axis=0), axis=-1).max(axis=-1, initial=0.0)
    change = np.concatenate([change[:1], change, change[-1:]]) if len(change) else np.zeros(2)
    speed, force = np.linalg.norm(step, axis=-1).mean(axis=-1), 0.5 * (change[1:] + change[:-1])
    smooth = [gaussian_smoothed(part, BLENDED_S * rate_hz) for part in (speed, force)]
    return Vigour(*(np.maximum(part, 0.0) for part in smooth))


def time_slowness(clip: Clip, time: float) -> FloatArray:
    """Return the slowness of Time's stages, by 6.4.1.

    Sudden: a longer anticipation, then a short execution that speeds up from its start; sustained:
    a short anticipation, then a long execution that slows down.
    """
    anticipation = 1.0 / (1.0 - 0.5 * time) if time >= 0.0 else 1.0 + 0.5 * time
    execution = 1.0 / (1.0 + 2.0 * time) if time >= 0.0 else 1.0 - 2.0 * time
    lasting = [1.0, anticipation, execution, 1.0, 1.0]
    slowness = np.ones(len(clip) - 1)
    start = 0
    for stage, end in enumerate(clip.stage_end_frames.tolist()):
        if (end - start) / clip.rate_hz >= SHORTEST_STAGE_S:
            slowness[start:end] = lasting[stage]
            if stage == 2:
                u = (np.arange(end - start) + 0.5) / (end - start)
                slowness[start:end] /= powered_pace(u, 1.0 - 0.4 * time)
        start = end
    if time > 0.0:
        slowness = waiting_slowness(slowness, clip, time)
    return np.exp(gaussian_smoothed(np.log(slowness), BLENDED_S * clip.rate_hz))


def waiting_slowness(slowness: FloatArray, clip: Clip, sudden: float) -> FloatArray:
    """Return the slowness of a sudden clip that is soon ready and soon back, and then waits.

    So do simulated people, who act for a share of the time (`smd.synthetic.efforts`). What has been
    gained is waited at the end, where a clip hardly moves: neither frozen, nor before anything has
    happened, nor at the cost of the anticipation.
    """
    n, (prepared, _, _, followed, _) = len(slowness), clip.stage_end_frames.tolist()
    slowness[:prepared] *= np.exp(-QUICK_PER_SUDDEN * sudden)
    slowness[followed:] *= np.exp(-QUICK_PER_SUDDEN * sudden)
    waits = max(followed, round((1.0 - WAITING) * n))
    if waits < n:
        gained = (n - slowness[:waits].sum()) / (n - waits)
        slowness[waits:] = np.clip(gained, 1.0 + WAITS * sudden, 1.0 / SLOWEST)
    return slowness


def pace_slowness(vigour: Vigour, slowness: FloatArray, power: float) -> FloatArray:
    """Return the slowness with which the body's pace is multiplied by a power of its vigour.

    Above 0, vigorous moments become faster and others slower (the paper's strong Weight, 6.4.2);
    below 0 the pace becomes more even. The paper takes the speed alone. But a movement that comes
    off its rest is slow; an even pace would make it come with a jerk, so accelerations count
    alike. Both are relative to their means, and added to 1 at right angles: what hardly moves is
    neither hurried nor held.

    Parameters
    ----------
    slowness
        ``(n - 1,)`` of what is played already: it has its part in how fast they go.
    """
    speed, force = vigour.speed / slowness, vigour.force / slowness**2
    means = [float((part * slowness).sum() / slowness.sum()) for part in (speed, force)]
    if min(means) < 1e-9:
        return np.ones(len(slowness))
    squared = 1.0 + (speed / means[0]) ** 2 + (force / means[1]) ** 2
    return np.asarray(squared ** (-0.5 * power))


def sustained_slowness(vigour: Vigour, clip: Clip, time: float) -> FloatArray:
    """Return the slowness of a sustained clip's stages, even and in no hurry.

    The pace is evened before the execution, in it and after it, each by itself. Evenness grows
    with the square of ``time``, so that nothing changes its direction at 0.

    Parameters
    ----------
    time
        Below 0.
    """
    slowness = time_slowness(clip, time)
    begins, ends = clip.stage_end_frames[1:3].tolist()
    for at in (slice(0, begins), slice(begins, ends), slice(ends, len(slowness))):
        if len(own := slowness[at]) / clip.rate_hz >= SHORTEST_STAGE_S:
            part = Vigour(vigour.speed[at], vigour.force[at])
            even = own * pace_slowness(part, own, -EVENED * time**2)
            slowness[at] = even * (own.sum() / even.sum())
    fastest = np.full(len(slowness), UNHURRIED)
    fastest[clip.stage_end_frames[0] : begins] *= 2.0
    return within_pace(slowness, fastest)


def flowing_slowness(slowness: FloatArray, clip: Clip, flow: float) -> FloatArray:
    """Return a slowness in which bound stages ease in and out, and free ones run on into the next.

    Each lasts as long as without.
    """
    played = np.concatenate([[0.0], np.cumsum(slowness)])
    even = np.linspace(0.0, 1.0, 201)
    share = HELD * flow if flow >= 0.0 else RUNNING_ON * flow
    eased = even + share * (smootherstep(even) - even)
    held, start = played.copy(), 0
    for end in clip.stage_end_frames.tolist():
        lasts = played[end] - played[start]
        if lasts / clip.rate_hz >= SHORTEST_STAGE_S:
            u = (played[start : end + 1] - played[start]) / lasts
            held[start : end + 1] = played[start] + lasts * np.interp(u, eased, even)
        start = end
    return np.diff(held)


def fastest_paces(rotation_xyzw: FloatArray, rate_hz: float) -> FloatArray:
    """Return how many frames one step of poses may pass ``(n - 1, …)``, by their fastest joint.

    Parameters
    ----------
    rotation_xyzw
        ``(n, …, j, 4)`` of the poses.
    """
    q = rotation_xyzw[..., 1:, :]
    cosine = np.abs(np.einsum("...ji,...ji->...j", q[1:], q[:-1])).min(axis=-1, initial=1.0)
    turning_rad_s = 2.0 * np.arccos(np.minimum(cosine, 1.0)) * rate_hz
    return np.clip(FASTEST_TURN_RAD_S / np.maximum(turning_rad_s, 1e-9), 1.0, FASTEST)


def within_pace(slowness: FloatArray, fastest: FloatArray) -> FloatArray:
    """Return a slowness as long as the clip, whose pace stays within its limits.

    A pace above 1 nears its limit as an exponential does, so that a little more of an Effort is
    always a little more; a pace that were cut off would say the same of much and of little. What
    it lacks is made up for by all steps alike, where these have room.

    Parameters
    ----------
    fastest
        ``(n - 1,)`` the most source frames that one step may pass, at each of them; at least 1.
    """
    pace = slowness.sum() / (len(slowness) * slowness)
    room = np.maximum(fastest - 1.0, 1e-9)
    over = np.maximum(pace - 1.0, 0.0)
    pace = np.minimum(pace, 1.0) + room * -np.expm1(-over / room)
    return _filled(1.0 / pace, 1.0 / fastest, 1.0 / SLOWEST)


def _filled(slowness: FloatArray, least: FloatArray, most: float) -> FloatArray:
    """Return a slowness times that number with which it adds up to one a step, within limits.

    The sum grows with the number, and linearly between the numbers at which a step reaches a
    limit.
    """
    reached = np.concatenate([least / slowness, most / slowness])
    order = np.argsort(reached, kind="stable")
    times = np.concatenate([[0.0], reached[order]])
    slope = np.cumsum(np.concatenate([slowness, -slowness])[order])
    total = float(least.sum()) + np.concatenate(
        [[0.0, 0.0], np.cumsum(slope[:-1] * np.diff(times[1:]))]
    )
    return np.clip(slowness * np.interp(len(slowness), total, times), least, most)


def shown_frames(slowness: FloatArray, aim_frame: int) -> FloatArray:
    """Return the source frame ``(n,)`` to show at each of a clip's n frames.

    Not decreasing, from the first to the last. The aim is one of them: between two frames, the
    place where a blow strikes would not be shown.

    Parameters
    ----------
    slowness
        ``(n - 1,)`` that adds up to n - 1, as `within_pace` returns it.
    """
    frame = np.arange(len(slowness) + 1, dtype=np.float64)
    played = np.concatenate([[0.0], np.cumsum(slowness)])
    played *= frame[-1] / played[-1]
    aim = played[aim_frame]
    played = np.interp(played, [0.0, aim, frame[-1]], [0.0, np.rint(aim), frame[-1]])
    return np.interp(frame, played, frame)
