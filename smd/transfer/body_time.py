"""Body time: the time that a body needs for each frame of a clip that is played once.

At its own pace a clip may push the mass of a body about more than its legs can, all the more where
Effort has changed its timing: then these frames need longer. Where a clip is calm, it may be played
faster. So a phrase has a time in which it is comfortable, and a least time; and whatever time it is
given is shared out among its frames accordingly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.acting.flight import GRAVITY_M_S2, YIELDING_S
from smd.geometry.arrays import BoolArray, FloatArray
from smd.transfer.ground_root import EXECUTION
from smd.transfer.limits import Limits
from smd.transfer.pacing import RECOVERING, Pacing, core_frame, struck_frame
from smd.transfer.repertoire import Piece
from smd.transfer.speeding import Way, least_s

CALMLY = 0.5
"""Least time of a calm frame, as a share of its own."""

UPWARDS_M_S2 = 1.5 * GRAVITY_M_S2
"""Acceleration upwards that legs still give to a body: people jump with two and a half times their
weight on the ground."""

DOWNWARDS_M_S2 = 0.8 * GRAVITY_M_S2
"""Acceleration downwards of a body whose feet stay on the ground: it cannot fall faster."""

MOST_FLOWN = 0.6
"""Most of the time up to the strike that a flight may take."""

MOST_WAITED = 0.5
"""Most of the time up to the strike in which a body may get into the first pose."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyTime:
    """The time between the frames of a clip, in seconds.

    Attributes
    ----------
    comfortable_s, least_s : (n - 1,).
    flies : (n - 1,) when it is in free fall, whose time is given.
    pushes : (n - 1,) when it flies, gathers speed for that or absorbs it: never slower than that.
    entry_s : time to get into its first pose.
    struck, core : frames at which execution and follow-through end.
    needed : frame from which its pose is near to its last one.
    """

    comfortable_s: FloatArray
    least_s: FloatArray
    flies: BoolArray
    pushes: BoolArray
    entry_s: float
    struck: int
    core: int
    needed: float

    @property
    def before_s(self) -> float:
        """Time up to the strike."""
        return self.entry_s + float(self.comfortable_s[: self.struck].sum())

    @property
    def after_s(self) -> float:
        """Time of the follow-through."""
        return float(self.comfortable_s[self.struck : self.core].sum())

    @property
    def return_s(self) -> float:
        """Time of the pause behind it in which the body comes to rest."""
        gone = np.concatenate([[0.0], np.cumsum(self.comfortable_s)])
        near_s = float(np.interp(self.needed, np.arange(len(gone)), gone))
        return max(near_s - float(gone[self.core]), 0.0) / RECOVERING


def body_time(
    piece: Piece, way: Way | None, flight_s: float | None, entry_s: float, limits: Limits
) -> BodyTime:
    """Return the time that a body needs for a clip that is played once.

    Parameters
    ----------
    way
        The path that it takes in its execution, if it does.
    flight_s
        How long it flies, if it does.
    entry_s
        Time to get into its first pose.
    """
    clip, last = piece.clip, len(piece.clip) - 1
    slower = np.ones(last + 1)
    if piece.body is not None:
        aside = piece.body.aside_m_s2 / limits.push_m_s2
        up = np.maximum(piece.body.up_m_s2, 0.0) / UPWARDS_M_S2
        down = np.maximum(piece.body.down_m_s2, 0.0) / DOWNWARDS_M_S2
        slower = np.sqrt(np.max([aside, up, down], axis=0))
    slower = np.maximum(slower[1:], slower[:-1])
    comfortable = np.maximum(slower, 1.0) / clip.rate_hz
    least = np.maximum(slower, CALMLY) / clip.rate_hz
    flies, pushes = np.zeros(last, dtype=bool), np.zeros(last, dtype=bool)
    if piece.airborne is not None and flight_s is not None:
        first, end = piece.airborne.first, piece.airborne.last
        around = round(YIELDING_S * clip.rate_hz)
        flies[first:end] = pushes[max(first - around, 0) : end + around] = True
        comfortable[flies] = least[flies] = flight_s / np.count_nonzero(flies)
    elif way is not None:
        executes = slice(*clip.stage_end_frames[EXECUTION - 1 : EXECUTION + 1].tolist())
        for step in (comfortable, least):
            if step[executes].sum() > 0.0:
                wanted_s = least_s(way, limits.speed_m_s, limits)
                step[executes] *= max(wanted_s / step[executes].sum(), 1.0)
    core = core_frame(clip)
    needed = core + piece.near * (last - core)
    return BodyTime(comfortable, least, flies, pushes, entry_s, struck_frame(clip), core, needed)


def body_pacing(
    time: BodyTime, start_s: float, strike_s: float, end_s: float, pause_s: float
) -> Pacing:
    """Return when each frame of a clip is shown in a phrase.

    Parameters
    ----------
    start_s, strike_s, end_s
        Of the phrase.
    pause_s
        How long nothing is performed after it.
    """
    wait_s = min(time.entry_s, MOST_WAITED * (strike_s - start_s))
    if time.struck == 0:  # nothing leads up to its strike
        wait_s = strike_s - start_s
    before_s = _shared(time, 0, time.struck, strike_s - start_s - wait_s)
    rest_s, whole_s = end_s - strike_s, end_s - strike_s + RECOVERING * pause_s
    after_s = time.comfortable_s[time.struck :]
    gone = np.concatenate([[0.0], np.cumsum(after_s)])
    if len(after_s) and gone[-1] <= rest_s:
        after_s = _stretched(after_s, time.pushes[time.struck :], rest_s)
    elif len(after_s):
        near = np.interp(time.needed - time.struck, np.arange(len(gone)), gone)
        after_s = after_s / max(gone[time.core - time.struck] / rest_s, near / whole_s, 1.0)
    steps = np.concatenate([[start_s, wait_s], before_s, after_s])
    time_s, frame = np.cumsum(steps), np.arange(-1.0, len(steps) - 1.0)
    frame[0] = 0.0
    left_s = max(end_s if gone[-1] <= rest_s else strike_s + whole_s, strike_s)
    kept = time_s < left_s - 1e-9
    left = float(np.interp(left_s, time_s, frame))
    time_s, frame = np.append(time_s[kept], left_s), np.append(frame[kept], left)
    once = np.concatenate([[True], np.diff(time_s) > 1e-9])
    return Pacing(time_s[once], frame[once])


def _stretched(step_s: FloatArray, pushes: BoolArray, lasting_s: float) -> FloatArray:
    """Return steps that last longer altogether, but for those that push, if there are others."""
    calm = ~pushes if (~pushes).any() else np.ones(len(step_s), dtype=bool)
    more_s = lasting_s - float(step_s.sum())
    return step_s * np.where(calm, 1.0 + more_s / max(float(step_s[calm].sum()), 1e-9), 1.0)


def _shared(time: BodyTime, first: int, end: int, lasting_s: float) -> FloatArray:
    """Return the time of each step of a clip, all together as long as there is."""
    part = slice(first, end)
    flies = time.flies[part]
    easy, least = time.comfortable_s[part].copy(), time.least_s[part].copy()
    flown_s = float(easy[flies].sum())
    if flown_s > MOST_FLOWN * lasting_s:
        for step in (easy, least):
            step[flies] *= MOST_FLOWN * lasting_s / flown_s
        flown_s = MOST_FLOWN * lasting_s
    if lasting_s >= float(easy.sum()):
        return _stretched(easy, time.pushes[part], lasting_s)
    grounded_s, easy_s, least_s_ = (
        lasting_s - flown_s,
        float(easy[~flies].sum()),
        float(least[~flies].sum()),
    )
    if easy_s - least_s_ < 1e-9:  # of rounding alone: one that comes to the same is no quicker
        share, most = 0.0, grounded_s / max(easy_s, 1e-9)
    else:
        share = min((easy_s - grounded_s) / (easy_s - least_s_), 1.0)
        most = grounded_s / ((1.0 - share) * easy_s + share * least_s_)
    step = (1.0 - share) * easy + share * least
    step[~flies] *= most
    return np.asarray(step)
