"""Pacing: how fast a clip that is played once goes, and when it is left.

A phrase is what the player's hand did; a clip also shows how the body comes back from it. Played
within the phrase from end to end, most clips would be twice as fast as they were made. So only
what they are about has to be done by the phrase's end; the body comes back in the pause that
follows, as far as there is one, and a transition does the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.character.clip import STAGES, Clip
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, rotate

NEAR_M = 0.2
"""Mean distance of the joints from where a clip's last pose has them, up to which a transition
does the rest: a raised arm comes down, but nobody gets up in it."""

RECOVERING = 0.6
"""Share of a pause in which a body may come back; then it is at rest."""

_FOLLOW_THROUGH = STAGES.index("follow_through")


@dataclass(frozen=True, slots=True)
class Pacing:
    """When each frame of a clip is shown.

    Attributes
    ----------
    start_s, end_s : of the move; it may end later than its phrase.
    left_frame : the frame, fractional, at which the clip is left.
    """

    start_s: float
    end_s: float
    left_frame: float

    def frame_at(self, time_s: FloatArray) -> FloatArray:
        """Return the clip's fractional frame at some times."""
        return (time_s - self.start_s) * (self.left_frame / (self.end_s - self.start_s))


def core_frame(clip: Clip) -> int:
    """Return the frame by which a clip has shown what it is about: its transition's first."""
    return int(clip.stage_end_frames[_FOLLOW_THROUGH])


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

    A clip that is shorter than its phrase is stretched. One that is longer goes at its own pace,
    if what it is about is done by the phrase's end, and its pose near to its last one by the end
    of that share of the pause in which a body may come back; else as much faster as it must. What
    is then left of it is not shown.

    Parameters
    ----------
    near
        `near_share` of the clip.
    pause_s
        How long nothing is performed after the phrase.
    """
    lasting_s, last, core = end_s - start_s, len(clip) - 1, core_frame(clip)
    if clip.duration_s <= lasting_s or core == last:
        return Pacing(start_s, end_s, last)
    whole_s = lasting_s + RECOVERING * pause_s
    needed = core + near * (last - core)
    pace_hz = max(clip.rate_hz, core / lasting_s, needed / whole_s)
    left = min(pace_hz * whole_s, float(last))
    return Pacing(start_s, start_s + left / pace_hz, left)
