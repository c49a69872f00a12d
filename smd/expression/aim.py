"""Aim: what an action is for, and the body's way there.

A blow is for the place where it strikes, a pick-up for the ground that the hand reaches. So the
place of a hand or foot at the end of the execution is its action's *aim*, and Effort changes the
way there, not the place. Whether an action has an aim is read from its clip: a hand or foot that
carries nothing has then gone far from where it began, as seen from the ground root and from its own
shoulder or hip, and not by a long way round. Who bows, turns or crouches takes the hands along, and
who rolls or spins has them anywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from smd.character.clip import STAGES, Clip
from smd.expression.body import Body, Effector
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import inverse, rotate

GONE, STRETCHED = 0.5, 0.25
"""How far an effector with an aim has gone, in reaches of its limb: as seen from the ground root,
and from the joint that its limb hangs from."""

DIRECT = 1.0 / 3.0
"""And which share of its way during the execution that is, at least."""

LEAST_S = 0.3
"""Least time over which a change of pose dies away before the aim, and over which it comes back."""

SWUNG_S = 0.15
"""Time over which a limb that lags behind whips to where it is due, and is let go again."""

SMOOTHED_S = 0.04
"""Smoothing of the progress to the aim, which is at rest while the body draws back."""

_EXECUTION = STAGES.index("execution")


@dataclass(frozen=True, slots=True, eq=False)
class Aim:
    """What an action is for.

    Attributes
    ----------
    frame : of the neutral clip, the last one of its execution.
    effectors : whose places there are to be kept; none where the action has no aim.
    """

    frame: int
    effectors: tuple[Effector, ...]

    def holds(self, joint: int) -> bool:
        """Return whether a joint moves an effector that has an aim."""
        return any(joint in effector.chain for effector in self.effectors)


def aim_of(clip: Clip, body: Body, seen_m: FloatArray) -> Aim:
    """Return what an action is for.

    Parameters
    ----------
    seen_m
        ``(n, j, 3)`` of the clip's joints, as seen from the ground root.
    """
    begins, frame = clip.stage_end_frames[_EXECUTION - 1 : _EXECUTION + 1].tolist()
    if clip.cyclic:
        return Aim(frame, ())
    found = []
    for effector in body.effectors:
        if effector.is_leg and _touches(clip, effector.beyond)[frame]:
            continue
        own, base = seen_m[:, effector.end], seen_m[:, effector.base]
        gone = np.linalg.norm(own[frame] - own[0])
        stretched = np.linalg.norm((own - base)[frame] - (own - base)[0])
        way = np.linalg.norm(np.diff(own[begins : frame + 1], axis=0), axis=-1).sum()
        least = max(GONE * effector.reach_m, DIRECT * way)
        if gone >= least and stretched >= STRETCHED * effector.reach_m:
            found.append(effector)
    return Aim(frame, tuple(found))


def seen_from_root(clip: Clip, place_m: FloatArray) -> FloatArray:
    """Return places ``(n, k, 3)`` in the character's own frame, that of the ground root."""
    return rotate(inverse(clip.rotation_xyzw[:, :1]), place_m - clip.translation_m[:, :1])


def _touches(clip: Clip, joints: frozenset[int]) -> BoolArray:
    """Return when any of some joints touches the ground, ``(n,)``."""
    columns = [
        i for i, name in enumerate(clip.contact_joints) if clip.skeleton.index(name) in joints
    ]
    return np.asarray(clip.contacts[:, columns].any(axis=1))


def freedom(clip: Clip, aim: Aim) -> FloatArray:
    """Return how freely poses may be changed on the way to the aim, ``(n,)``: not at all there.

    1 where an action has no aim, and far from it. What is changed dies away during the execution,
    and comes back during half of what follows: in less time it would be a movement of its own.
    """
    if not aim.effectors:
        return np.ones(len(clip))
    begins, last = int(clip.stage_end_frames[_EXECUTION - 1]), len(clip) - 1
    least = LEAST_S * clip.rate_hz
    return _around(clip, max(aim.frame - begins, least), max(0.5 * (last - aim.frame), least))


def swing(clip: Clip) -> FloatArray:
    """Return how freely limbs may swing, ``(n,)``: not at all as the execution ends.

    Until shortly before, and soon after: what swings through has somewhere to swing through.
    """
    return _around(clip, SWUNG_S * clip.rate_hz, SWUNG_S * clip.rate_hz)


def _around(clip: Clip, before: float, after: float) -> FloatArray:
    away = np.arange(len(clip)) - clip.stage_end_frames[_EXECUTION]
    return smootherstep(np.where(away < 0, -away / before, away / after))


def progress(seen_m: FloatArray, through: Sequence[int], rate_hz: float) -> FloatArray:
    """Return how far a clip has got ``(n,)``: 0 at the first of some poses, 1 at the and so on.

    Between two of them it is the farthest that the joints have got along the line that leads from
    one to the other: it stands while the body draws back, and does not return.

    Parameters
    ----------
    seen_m
        ``(n, j, 3)`` of the joints, as seen from the ground root.
    through
        Frames, increasing, from the first to the last one.
    """
    flat = seen_m.reshape(len(seen_m), -1)
    value = np.zeros(len(flat))
    for i, (start, end) in enumerate(pairwise(through)):
        line = flat[end] - flat[start]
        length = float(line @ line)
        if length > 1e-6:
            along = (flat[start : end + 1] - flat[start]) @ line / length
            value[start : end + 1] = i + np.maximum.accumulate(np.clip(along, 0.0, 1.0))
        else:
            value[start : end + 1] = i + np.linspace(0.0, 1.0, end - start + 1)
    smooth = gaussian_smoothed(value, SMOOTHED_S * rate_hz)
    for i, frame in enumerate(through):
        near = np.exp(-0.5 * ((np.arange(len(value)) - frame) / (2.0 * SMOOTHED_S * rate_hz)) ** 2)
        smooth = smooth + (i - smooth[frame]) * near
    return np.clip(smooth, 0.0, len(through) - 1.0)
