"""Study: what every Effort needs of a neutral clip, computed once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.expression.body import Body
from smd.expression.operators import at_frames
from smd.expression.reaching import bearing
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep

GROUNDED, CARRIED = 0.3, 0.6
"""Height of the pelvis, as a share of its own at rest, below which a body sits or lies on the
ground, and above which its legs carry it."""


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """A neutral clip, and what every Effort needs of it.

    Attributes
    ----------
    clip : neutral.
    body : the joints of its skeleton that express Effort.
    way_m : (n,) how far the joints have gone by each frame, on average, as seen from the ground
        root.
    turning_rad_s : (n - 1,) how fast the joint turns that turns fastest.
    carried : (n,) how surely legs carry the body, from 0, on the ground, to 1.
    hands_m : (n, a, 3) where the hands of the body's arms are.
    bearing : (n, a) how surely each of them rests on the ground, from 0 to 1.
    """

    clip: Clip
    body: Body
    way_m: FloatArray
    turning_rad_s: FloatArray
    carried: FloatArray
    hands_m: FloatArray
    bearing: FloatArray


def study_of(clip: Clip, body: Body) -> Study:
    """Return the study of a neutral clip."""
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    steps = np.linalg.norm(np.diff(place - place[:, :1], axis=0), axis=-1).mean(axis=-1)
    hands = place[:, [arm.hand for arm in body.arms]]
    way = np.concatenate([[0.0], np.cumsum(steps)])
    q = clip.rotation_xyzw[:, 1:]
    cosine = np.abs(np.einsum("nji,nji->nj", q[1:], q[:-1])).min(axis=1)
    turning = 2.0 * np.arccos(np.minimum(cosine, 1.0)) * clip.rate_hz
    # A body without legs may have its pelvis for its lowest joint: it never lies down.
    height = np.ones(len(clip))
    if body.pelvis_height_m > 0.0:
        height = place[:, body.pelvis, 1] / body.pelvis_height_m
    carried = smootherstep((height - GROUNDED) / (CARRIED - GROUNDED))
    return Study(clip, body, way, turning, carried, hands, bearing(hands[..., 1]))


def retimed_study(study: Study, source_frame: FloatArray) -> Study:
    """Return the study of the retimed clip; its ``clip`` and pace stay those of the neutral one."""
    frame = np.arange(len(study.clip), dtype=np.float64)
    return replace(
        study,
        way_m=np.interp(source_frame, frame, study.way_m),
        carried=np.interp(source_frame, frame, study.carried),
        hands_m=at_frames(study.hands_m, source_frame),
        bearing=at_frames(study.bearing, source_frame),
    )
