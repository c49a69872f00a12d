"""Expression: a neutral clip played with Effort (section 6.4 of the paper [1]_).

Time changes how long the stages last and how their speed goes; Weight makes speeds more or less
even, movements larger or smaller, the back sink or rise. What a clip owes to the ground it keeps:
legs are not rescaled where they carry, and what a gait takes its steps from, the doodle's path, is
not its own.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban import Effort
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.roles import BodyPlan, body_plan
from smd.geometry.arrays import FloatArray, IntArray
from smd.transfer.easing import smootherstep
from smd.transfer.operators import rescaled, reshaped, retimed, stage_timing

ALPHA = 1.5
"""The paper's, in the power of speed that Weight plays by."""

BEND_RAD = 0.1
"""The paper's, by which each bone of the spine bends forward when strong."""

KEPT_GAZE = 0.7
"""Share of the spine's bend that the neck takes back: the eyes stay on what they look at."""

STRONGEST_SCALE = 1.3
"""How much larger a strong movement is. The paper's 2 turns joints beyond what a body can."""

SLOWEST, FASTEST = 0.25, 3.0
"""Of a retimed clip beside its own pace: no moment stands still, none is skipped."""

EDGE = 0.15
"""First and last share of a clip over which its scale and shape come and go: it begins and ends in
the pose that idling has."""

SHORTEST_STAGE_S = 0.05
"""A stage shorter than this has no room for a timing of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """What of a skeleton expresses.

    Attributes
    ----------
    spine : joints that bend with Weight, without neck and head: the eyes stay on what they look at.
    neck : the joint that takes the bend back; None without a head.
    upper : joints that are rescaled in a gait: spine, arms, and what hangs from them.
    every : joints that are rescaled in anything else.
    hinges : elbows and knees, which are never enlarged.
    rest_xyzw : (j, 4) how each joint is turned in the world at rest.
    """

    spine: tuple[int, ...]
    neck: int | None
    upper: tuple[int, ...]
    every: tuple[int, ...]
    hinges: frozenset[int]
    rest_xyzw: FloatArray


def body_of(clip: Clip) -> Body:
    """Return what of a clip's skeleton expresses."""
    skeleton = clip.skeleton
    turned, place = forward_kinematics(
        skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
    )
    plan = body_plan(skeleton.joints, skeleton.parents.tolist(), place, front=(0.0, 0.0, 1.0))
    trunk = plan.spine[: plan.spine.index(plan.chest) + 1] if plan.chest in plan.spine else ()
    after = plan.spine[len(trunk) :]
    legs = {joint for limb in plan.limbs if limb.kind == "leg" for joint in limb.chain}
    lower = legs | set(plan.root)
    every = tuple(j for j in range(1, len(skeleton)) if j not in plan.root[:-1])
    return Body(
        spine=trunk,
        neck=after[0] if after else None,
        upper=tuple(j for j in every if j not in lower and not _below(plan, skeleton.parents, j)),
        every=every,
        hinges=frozenset(limb.middle for limb in plan.limbs),
        rest_xyzw=turned,
    )


def _below(plan: BodyPlan, parents: IntArray, joint: int) -> bool:
    """Return whether a joint hangs from a leg."""
    legs = {j for limb in plan.limbs if limb.kind == "leg" for j in limb.chain}
    while joint >= 0:
        if joint in legs:
            return True
        joint = int(parents[joint])
    return False


def expressive(clip: Clip, effort: Effort, body: Body, *, travels: bool) -> Clip:
    """Return a clip as it is played with Effort; at Effort 0 it is the same.

    Time comes first, then Weight: Weight's timing goes by the speeds that are to be seen, and the
    shape of the back is added last, so that nothing scales it.

    Parameters
    ----------
    clip
        Neutral.
    effort
        Only Time and Weight are expressed.
    body
        `body_of` the clip.
    travels
        Whether its action does: a gait goes by the doodle's pace, and has no timing of its own.
    """
    time, weight = effort.time or 0.0, effort.weight or 0.0
    if not clip.cyclic and (time or weight):
        source_frame = np.arange(len(clip), dtype=np.float64)
        if time:
            clip = with_small_beginning(clip, time, body)
            source_frame = time_timing(clip, time)
        if weight:
            source_frame = np.interp(
                weight_timing(retimed(clip, source_frame), weight),
                np.arange(len(clip)),
                source_frame,
            )
        clip = retimed(clip, within_pace(source_frame))
    if weight:
        clip = with_weight(clip, weight, body, gait=travels and clip.cyclic)
    return clip


def with_small_beginning(clip: Clip, time: float, body: Body) -> Clip:
    """Return a clip whose preparation and anticipation are smaller, by 6.4.1.

    It comes back to its own size by the end of the execution, so that no stage ends in a jump.
    """
    last = len(clip) - 1
    anticipated, executed = clip.stage_end_frames[1], clip.stage_end_frames[2]
    shrunk = 1.0 / (3.0 * abs(time) + 1.0)
    back = smootherstep((np.arange(last + 1) - anticipated) / max(executed - anticipated, 1))
    if anticipated == 0:
        return clip
    return rescaled(clip, body.every, shrunk + (1.0 - shrunk) * back, about=0)


def time_timing(clip: Clip, time: float) -> FloatArray:
    """Return the source frame to show at each frame, by 6.4.1.

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


def weight_timing(clip: Clip, weight: float) -> FloatArray:
    """Return the source frame to show at each frame, so that speeds differ more or less (6.4.2).

    Where the body moves fast, a strong clip is played faster still, a light one slower; the speed
    is the joints' mean, 1 where it is the clip's own mean.
    """
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    steps = np.linalg.norm(np.diff(place - place[:, :1], axis=0), axis=-1).mean(axis=-1)
    mean = float(steps.mean())
    if mean < 1e-9:
        return np.arange(len(clip), dtype=np.float64)
    pace = np.clip(steps / mean, 0.05, None) ** (ALPHA * weight / 3.0)
    pace = np.clip(pace, SLOWEST, FASTEST)
    played = np.concatenate([[0.0], np.cumsum(1.0 / pace)])
    last = len(clip) - 1
    return np.interp(np.arange(last + 1), played * (last / played[-1]), np.arange(last + 1))


def with_weight(clip: Clip, weight: float, body: Body, *, gait: bool) -> Clip:
    """Return a clip made larger and sunken where strong, smaller and risen where light (6.4.2)."""
    n = len(clip)
    share = np.ones(n)
    if not clip.cyclic:
        u = np.arange(n) / (n - 1)
        share = smootherstep(np.minimum(u, 1.0 - u) / EDGE)
    scale = 1.0 + (STRONGEST_SCALE - 1.0) * weight if weight >= 0.0 else 1.0 / (1.0 - weight)
    factor = 1.0 + share * (scale - 1.0)
    joints = body.upper if gait else body.every
    if clip.cyclic:
        clip = _scaled_about_mean(clip, joints, scale, body, enlarge=weight > 0.0)
    else:
        bending = [j for j in joints if weight < 0.0 or j not in body.hinges]
        clip = rescaled(clip, bending, factor, about=0)
    bend = share * (BEND_RAD * weight)
    bends = dict.fromkeys(body.spine, bend)
    if body.neck is not None:
        bends[body.neck] = -KEPT_GAZE * len(body.spine) * bend
    return reshaped(clip, bends, body.rest_xyzw)


def _scaled_about_mean(
    clip: Clip, joints: tuple[int, ...], scale: float, body: Body, *, enlarge: bool
) -> Clip:
    """Return a cycle scaled about the frame that is nearest to its mean pose: it has no first."""
    mean = clip.rotation_xyzw.mean(axis=0)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    near = np.abs(np.sum(clip.rotation_xyzw * mean, axis=-1)).mean(axis=-1)
    bending = [j for j in joints if not enlarge or j not in body.hinges]
    return rescaled(clip, bending, np.full(len(clip), scale), about=int(np.argmax(near)))


def within_pace(source_frame: FloatArray) -> FloatArray:
    """Return a timing whose pace is nowhere below or above what can be looked at."""
    last = len(source_frame) - 1
    pace = np.diff(source_frame)
    for _ in range(12):  # what is cut off at one moment is made up for at others
        pace = np.clip(pace * (last / pace.sum()), SLOWEST, FASTEST)
    way = np.concatenate([[0.0], np.cumsum(pace)])
    return np.clip(way * (last / way[-1]), 0.0, last)
