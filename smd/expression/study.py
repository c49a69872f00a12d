"""Study: what every Effort needs of a neutral clip, computed once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses, mixed
from smd.character.roles import to_knuckles
from smd.expression.aim import Aim, aim_of, freedom, progress, seen_from_root, swing
from smd.expression.body import Body
from smd.expression.reaching import bearing
from smd.expression.timing import Vigour, vigour_of
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.easing import gaussian_smoothed, smootherstep

GROUNDED, CARRIED = 0.3, 0.6
"""Height of the pelvis, as a share of its own at rest, below which a body sits or lies on the
ground, and above which its legs carry it."""

SETTLING_S = 0.15
"""Time before and after a body is on the ground in which it moves as it does there: what is larger
or smaller until then would have to come back in a jerk."""


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """A neutral clip, and what every Effort needs of it.

    Attributes
    ----------
    clip : neutral.
    body : the joints of its skeleton that express Effort.
    aim : what its action is for.
    free : (n,) how freely its poses may be changed: not at all at the aim.
    swings : (n,) how freely its limbs may swing: not at all as the execution ends.
    about : the poses that its movement is scaled about.
    vigour : how it moves.
    stir : how far its joints go on average, in heights of the pelvis at rest.
    carried : (n,) how surely legs alone carry the body, from 0, on the ground or on its hands and
        near that moment, to 1.
    hands_m : (n, a, 3) where the hands of the body's arms are.
    bearing : (n, a) how surely each of them rests on the ground, from 0 to 1.
    """

    clip: Clip
    body: Body
    aim: Aim
    free: FloatArray
    swings: FloatArray
    about: Poses
    vigour: Vigour
    stir: float
    carried: FloatArray
    hands_m: FloatArray
    bearing: FloatArray


def study_of(clip: Clip, body: Body) -> Study:
    """Return the study of a neutral clip."""
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    seen = seen_from_root(clip, place)
    moving = seen[:, to_knuckles(clip.skeleton)]
    hands = place[:, [arm.hand for arm in body.arms]]
    # A body without legs may have its pelvis for its lowest joint: it never lies down.
    height, stir = np.ones(len(clip)), 1.0
    if body.pelvis_height_m > 0.0:
        height = place[:, body.pelvis, 1] / body.pelvis_height_m
        steps = np.linalg.norm(np.diff(moving, axis=0), axis=-1)
        stir = float(steps.mean(axis=-1).sum()) / body.pelvis_height_m
    resting = bearing(hands[..., 1])
    legs = smootherstep((height - GROUNDED) / (CARRIED - GROUNDED))
    carried = _until(np.minimum(legs, 1.0 - resting.max(axis=-1, initial=0.0)), clip.rate_hz)
    aim = aim_of(clip, body, seen)
    return Study(
        clip=clip,
        body=body,
        aim=aim,
        free=freedom(clip, aim),
        swings=np.ones(len(clip)) if clip.cyclic else swing(clip),
        about=_middle(clip) if clip.cyclic else _way(clip, aim, seen),
        vigour=vigour_of(moving, clip.rate_hz),
        stir=stir,
        carried=carried,
        hands_m=hands,
        bearing=resting,
    )


def _until(share: FloatArray, rate_hz: float) -> FloatArray:
    """Return a share ``(n,)`` that is as low some time before and after, and smooth."""
    near = round(SETTLING_S * rate_hz)
    around = sliding_window_view(np.pad(share, near, mode="edge"), 2 * near + 1)
    return gaussian_smoothed(around.min(axis=-1), 0.5 * near)


def _middle(clip: Clip) -> Poses:
    """Return the pose of a cycle that is nearest to its mean: a cycle has no first one."""
    mean = clip.rotation_xyzw.mean(axis=0)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    near = np.abs(np.sum(clip.rotation_xyzw * mean, axis=-1)).mean(axis=-1)
    return poses_at(clip, np.array([np.argmax(near)]))


def _way(clip: Clip, aim: Aim, seen_m: FloatArray) -> Poses:
    """Return the poses that lead from a clip's first one to its last one, straight.

    They lead through that at its aim. They go as far at each frame as the body has got on its
    way: what is left is how the body draws back, goes round and beyond.
    """
    last = len(clip) - 1
    through = sorted({0, last, *([aim.frame] if aim.effectors else [])})
    got = progress(seen_m, through, clip.rate_hz)
    leg = np.minimum(got.astype(np.int64), len(through) - 2)
    ends = np.array(through)
    return mixed(poses_at(clip, ends[leg]), poses_at(clip, ends[leg + 1]), got - leg)


def poses_at(clip: Clip, frames: IntArray) -> Poses:
    """Return a clip's poses at some frames, with its root motion."""
    return Poses(clip.rotation_xyzw[frames], clip.translation_m[frames])
