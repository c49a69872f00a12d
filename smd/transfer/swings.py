"""Swings: a clip that waves or claps does it at its own tempo, oftener where there is more time.

Slower or faster as a whole, it would wave in slow motion, or buzz. So the part of a clip that
repeats itself is found, and as many of its periods are played as have the time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from smd.character.clip import Clip
from smd.character.poses import Poses, mixed
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.easing import smootherstep
from smd.transfer.ground_root import EXECUTION
from smd.transfer.pacing import Pacing

ALIKE = 0.2
"""Greatest distance of a joint from where it was a period before, over how far joints move. Clips
that wave or clap stay below 0.11, all others above 0.5."""

LEAST_PERIOD_S = 0.2
"""Of a swing: hands wave two to four times a second."""


class Swing(NamedTuple):
    """The part of a clip that repeats itself.

    Attributes
    ----------
    first : its first frame.
    period : frames after which a pose comes again.
    periods : how many whole ones, at least 2.
    own_s : how long a period lasts at the tempo of the neutral clip.
    """

    first: int
    period: int
    periods: int
    own_s: float

    @property
    def end(self) -> int:
        """The frame at which it ends."""
        return self.first + self.periods * self.period


def swing_of(clip: Clip, position_m: FloatArray) -> Swing | None:
    """Return the part of a clip's execution that repeats itself; None where none does.

    Parameters
    ----------
    position_m
        ``(n, j, 3)`` where the joints are, in the clip's own world.
    """
    begin, end = clip.stage_end_frames[EXECUTION - 1 : EXECUTION + 1].tolist()
    best: tuple[float, Swing] | None = None
    for period in range(round(LEAST_PERIOD_S * clip.rate_hz), (end - begin) // 2 + 1):
        unlike = _unlike(position_m[begin : end + 1], period)
        alike = np.flatnonzero(unlike < ALIKE)
        if len(alike) == 0:
            if best is not None:
                break  # longer ones are several of its periods
            continue
        first = int(alike[0])
        count = 2
        while first + (count - 1) * period < len(unlike) and (
            unlike[first + (count - 1) * period] < ALIKE
        ):
            count += 1
        found = float(unlike.min()), Swing(begin + first, period, count, period / clip.rate_hz)
        best = found if best is None else min(best, found)
    return None if best is None else best[1]


def expressed(swing: Swing, neutral: Clip, clip: Clip) -> Swing:
    """Return where the swing of a neutral clip is in its expression by Effort.

    Effort makes the periods unequal in size and pace; they come one after the other all the same,
    between the ends of the same stages.
    """
    ends = neutral.stage_end_frames, clip.stage_end_frames
    first, end = np.interp([swing.first, swing.end], *ends).tolist()
    period = max(int((end - first) / swing.periods), 1)
    return swing._replace(first=round(first), period=period)


def _unlike(position_m: FloatArray, period: int) -> FloatArray:
    """Return how much a period differs from the next one, for each of its first frames.

    The greatest distance of a joint between both, over the greatest extent of a joint's way.
    """
    apart = np.linalg.norm(position_m[period:] - position_m[:-period], axis=-1).max(axis=-1)
    windows = np.lib.stride_tricks.sliding_window_view(apart, period)
    both = np.lib.stride_tricks.sliding_window_view(position_m, 2 * period, axis=0)
    extent = np.linalg.norm(np.ptp(both, axis=-1), axis=-1).max(axis=-1)
    return np.asarray(windows.max(axis=-1)[: len(extent)] / np.maximum(extent, 1e-9))


def with_periods(clip: Clip, swing: Swing, count: int) -> Clip:
    """Return a clip that swings ``count`` times, at least once.

    Where two periods meet that did not, the first goes over into the one that led to the second.
    """
    plays = [min(i, swing.periods - 1) for i in range(count)]
    leads = [after - 1 for after in plays[1:]] + [swing.periods - 1]
    once = np.arange(swing.period)
    before, after = np.arange(swing.first), np.arange(swing.end, len(clip))
    own, toward = (
        np.concatenate([before, *(swing.first + i * swing.period + once for i in which), after])
        for which in (plays, leads)
    )
    share = np.zeros(len(own))
    share[swing.first : len(own) - len(after)] = np.tile(smootherstep(once / swing.period), count)
    played = Poses(clip.rotation_xyzw, clip.translation_m)
    poses = mixed(_at(played, own), _at(played, toward), share)
    value = clip.tracks.value[own]
    value = value + share[:, None] * (clip.tracks.value[toward] - value)
    ends = clip.stage_end_frames.copy()
    ends[ends >= swing.end] += (count - swing.periods) * swing.period
    return replace(
        clip,
        rotation_xyzw=poses.rotation_xyzw,
        translation_m=poses.translation_m,
        contacts=clip.contacts[own],
        stage_end_frames=ends,
        tracks=Tracks(clip.tracks.names, value),
    )


def _at(poses: Poses, frames: IntArray) -> Poses:
    return Poses(poses.rotation_xyzw[frames], poses.translation_m[frames])


def at_own_tempo(pacing: Pacing, swing: Swing) -> tuple[int, Pacing]:
    """Return how often a clip swings in the time that it has for it, and when its frames are then.

    Parameters
    ----------
    pacing
        Of the clip as it is.
    """
    begin_s, end_s = np.interp([swing.first, swing.end], pacing.frame, pacing.time_s).tolist()
    count = max(round((end_s - begin_s) / swing.own_s), 1)
    before, after = pacing.frame < swing.first, pacing.frame > swing.end
    more = (count - swing.periods) * swing.period
    ends_s, ends = np.array([begin_s, end_s]), np.array([swing.first, swing.end + more])
    return count, Pacing(
        np.concatenate([pacing.time_s[before], ends_s, pacing.time_s[after]]),
        np.concatenate([pacing.frame[before], ends, pacing.frame[after] + more]),
    )
