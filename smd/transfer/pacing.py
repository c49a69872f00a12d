"""Pacing: the retiming of a clip that is played once, and when it is left.

The strike has to come when the hand's did. So until its execution ends, a clip advances evenly
through the phrase, as in the paper. But a clip also shows how the body returns to rest, and within
the phrase most clips would play that twice as fast as they were made. So what follows the execution
has its own pace: the body returns in the pause after the phrase, as far as there is one, and
blending does the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.character.clip import STAGES, Clip
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed
from smd.geometry.rotations import inverse, rotate

NEAR_M = 0.2
"""Mean distance of the joints from a clip's last pose up to which blending does the rest: it can
lower an arm, but not get a body up from the floor."""

RECOVERING = 0.6
"""Share of a pause in which a body may return to rest; then it is at rest."""

EASED_S = 0.04
"""Time over which the pace changes."""

_EXECUTION, _FOLLOW_THROUGH = (STAGES.index(name) for name in ("execution", "follow_through"))


@dataclass(frozen=True, slots=True, eq=False)
class Pacing:
    """When each frame of a clip is shown.

    Attributes
    ----------
    time_s : (k,) increasing, from the move's start to its end, which may be after its phrase's.
    frame : (k,) of the clip, fractional; the last is the one at which it is left.
    """

    time_s: FloatArray
    frame: FloatArray

    @property
    def start_s(self) -> float:
        """When its first frame is shown."""
        return float(self.time_s[0])

    @property
    def end_s(self) -> float:
        """When the clip is left."""
        return float(self.time_s[-1])

    def frame_at(self, time_s: FloatArray) -> FloatArray:
        """Return the clip's fractional frame ``(n,)`` at even times from the start to the end."""
        frame = np.interp(time_s, self.time_s, self.frame)
        if len(self.time_s) == 2:
            return frame
        return gaussian_smoothed(frame, EASED_S * (len(time_s) - 1) / (time_s[-1] - time_s[0]))


def core_frame(clip: Clip) -> int:
    """Return the last frame of a clip's follow-through: there its transition begins."""
    return int(clip.stage_end_frames[_FOLLOW_THROUGH])


def struck_frame(clip: Clip) -> int:
    """Return the last frame of a clip's execution."""
    return int(clip.stage_end_frames[_EXECUTION])


def near_share(clip: Clip, position_m: FloatArray) -> float:
    """Return the share of a clip's transition after which its pose is near to its last one.

    Parameters
    ----------
    position_m
        ``(n, j, 3)`` where the joints are, in the clip's own world.
    """
    core, last = core_frame(clip), len(clip) - 1
    if core == last:
        return 0.0
    place = position_m[core:] * [1.0, 0.0, 1.0] - clip.translation_m[core:, :1] * [1.0, 0.0, 1.0]
    place = rotate(inverse(clip.rotation_xyzw[core:, :1]), place)
    place[..., 1] = position_m[core:, :, 1]
    apart = np.linalg.norm(place - place[-1], axis=-1).mean(axis=-1)
    far = np.flatnonzero(apart > NEAR_M)
    return float((far[-1] + 1) / (last - core)) if len(far) else 0.0


def paced(clip: Clip, near: float, start_s: float, end_s: float, pause_s: float) -> Pacing:
    """Return when each frame of a clip is shown in a phrase.

    A clip that is shorter than its phrase is stretched evenly. One that is longer goes evenly too,
    until its execution ends; from there it takes its own time, if its follow-through is done by
    the phrase's end, and its pose near to its last one by the end of that share of the pause in
    which a body may come back; else it is as much faster as it must. What is then left of it is
    not shown.

    Parameters
    ----------
    near
        `near_share` of the clip.
    pause_s
        How long nothing is performed after the phrase.
    """
    lasting_s, last = end_s - start_s, len(clip) - 1
    struck, core = struck_frame(clip), core_frame(clip)
    if clip.duration_s <= lasting_s or struck == last:
        return Pacing(np.array([start_s, end_s]), np.array([0.0, last]))
    struck_s = lasting_s * struck / last
    rest_s = lasting_s - struck_s
    whole_s = rest_s + RECOVERING * pause_s
    needed = core + near * (last - core)
    pace_hz = max(clip.rate_hz, (core - struck) / rest_s, (needed - struck) / whole_s)
    left = min(struck + pace_hz * whole_s, float(last))
    left_s = struck_s + (left - struck) / pace_hz
    return Pacing(start_s + np.array([0.0, struck_s, left_s]), np.array([0.0, struck, left]))
