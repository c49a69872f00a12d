"""Timing: which frame of a clip is shown when, by Effort (sections 6.3 and 6.4 of the paper [1]_).

Each function returns the source frame ``(n,)`` to show at each of a clip's n frames: not
decreasing, from the first to the last, so that every phrase keeps its duration.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
.. [2] G. Fleisig et al., "Kinematic and kinetic comparison of baseball pitching among various
   levels of development", Journal of Biomechanics 32, 1999.
.. [3] A. Lees, L. Nolan, "The biomechanics of soccer: a review", Journal of Sports Sciences 16,
   1998.
"""

from __future__ import annotations

import numpy as np

from smd.character.clip import Clip
from smd.expression.operators import stage_timing
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.easing import smootherstep

ALPHA = 1.5
"""The paper's factor in the power of speed for Weight."""

SOFTENED = 1.0 / 3.0
"""Share of that power that is used: all of it leaves a single frame of a blow."""

EVENED = 0.5
"""Power of the speed that a sustained clip's pace is divided by."""

BUSY_PER_SUDDEN = 0.6
"""A sudden clip acts for ``exp(-0.6 time)`` of its phrase, as simulated people do (see
`smd.synthetic.efforts`), and is still before and after."""

WAITING = 0.5
"""Share of this waiting that comes before."""

HELD = 0.7
"""How far a bound clip comes to rest between stages."""

SLOWEST, FASTEST = 0.25, 4.0
"""Limits of a retimed clip's pace over its own: no moment stands still, none is skipped."""

FASTEST_TURN_RAD_S = np.radians(1200.0)
"""Limit of a joint's speed in a retimed clip, unless its own is faster; in a phrase shorter than
its clip, all is faster again. People's elbows reach 2400 degrees a second in a pitch [2]_,
their knees 1700 in a kick [3]_."""

SHORTEST_STAGE_S = 0.05
"""A stage shorter than this has no room for a timing of its own."""


def time_timing(clip: Clip, time: float) -> FloatArray:
    """Return the timing of Time's stages, by 6.4.1.

    Sudden: a longer anticipation, then a short execution that speeds up from its start; sustained:
    a short anticipation, then a long execution that slows down.
    """
    anticipation = 1.0 / (1.0 - 0.5 * time) if time >= 0.0 else 1.0 + 0.5 * time
    execution = 1.0 / (1.0 + 2.0 * time) if time >= 0.0 else 1.0 - 2.0 * time
    lasting = [1.0, anticipation, execution, 1.0, 1.0]
    power = [1.0, 1.0, 1.0 - 0.4 * time, 1.0, 1.0]
    starts = np.concatenate([[0], clip.stage_end_frames[:-1]])
    short = (clip.stage_end_frames - starts) / clip.rate_hz < SHORTEST_STAGE_S
    lasting = [1.0 if s else x for s, x in zip(short, lasting, strict=True)]
    power = [1.0 if s else x for s, x in zip(short, power, strict=True)]
    return stage_timing(clip, lasting, power)


def pace_timing(way_m: FloatArray, power: float) -> FloatArray:
    """Return the timing in which the body's speed is its own to the power of 1 plus ``power``.

    Above 0, fast moments become faster and slow ones slower (the paper's strong Weight, 6.4.2);
    below 0 the pace becomes more even.

    Parameters
    ----------
    way_m
        ``(n,)`` how far the joints have gone by each frame, on average; a speed is 1 where it is
        the mean one.
    """
    frame = np.arange(len(way_m), dtype=np.float64)
    steps = np.diff(way_m)
    mean = float(steps.mean())
    if mean < 1e-9:
        return frame
    pace = np.clip(steps / mean, 0.05, None) ** power
    pace = np.clip(pace, SLOWEST, FASTEST)
    played = np.concatenate([[0.0], np.cumsum(1.0 / pace)])
    return np.interp(frame, played * (frame[-1] / played[-1]), frame)


def held_timing(stage_end_frames: IntArray, rate_hz: float, bound: float) -> FloatArray:
    """Return the timing in which each stage eases in and out, by a share."""
    share = HELD * bound
    source = np.arange(stage_end_frames[-1] + 1, dtype=np.float64)
    start = 0
    for end in stage_end_frames.tolist():
        if end > start:
            u = np.linspace(0.0, 1.0, end - start + 1)
            if (end - start) / rate_hz >= SHORTEST_STAGE_S:
                u += share * (smootherstep(u) - u)
            source[start : end + 1] = start + u * (end - start)
            start = end
    return source


def within_pace(source_frame: FloatArray, fastest: FloatArray) -> FloatArray:
    """Return a timing whose pace stays within its limits.

    Parameters
    ----------
    fastest
        ``(n - 1,)`` the most source frames that one step may pass, at each of them.
    """
    last = len(source_frame) - 1
    pace, way, steps = np.diff(source_frame), source_frame, np.arange(last) + 0.5
    for _ in range(12):  # what is cut off at one moment is made up for at others
        most = np.interp(0.5 * (way[1:] + way[:-1]), steps, fastest)
        pace = np.minimum(np.maximum(pace * (last / pace.sum()), SLOWEST), most)
        way = np.concatenate([[0.0], np.cumsum(pace)])
        way *= last / way[-1]
    return np.clip(way, 0.0, last)


def fastest_paces(turning_rad_s: FloatArray, busy: float) -> FloatArray:
    """Return how many frames of a clip one step may pass ``(n - 1,)``, before waiting is added.

    Parameters
    ----------
    turning_rad_s
        ``(n - 1,)`` how fast the fastest joint turns in the clip's own time.
    busy
        `busy_share` of the clip: by it the timing is shortened later.
    """
    able = FASTEST_TURN_RAD_S / np.maximum(turning_rad_s, 1e-9)
    return np.asarray(busy * np.clip(able, 1.0 / busy, FASTEST))


def busy_share(time: float) -> float:
    """Return the share of its phrase in which a clip moves."""
    return float(np.exp(-BUSY_PER_SUDDEN * max(time, 0.0)))


def after_waiting(source_frame: FloatArray, busy: float) -> FloatArray:
    """Return a timing that waits, plays everything in a share of the time, and waits again."""
    last = len(source_frame) - 1
    waited = WAITING * (1.0 - busy) * last
    frame = np.arange(last + 1, dtype=np.float64)
    return np.interp((frame - waited) / busy, frame, source_frame)
