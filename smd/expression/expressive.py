"""Expression: a neutral clip played with Effort (section 6.4 of the paper [1]_).

Time changes the durations of the stages and their speed curves. Weight makes speeds more or less
even, movements larger or smaller, and lowers or raises the back. Space makes the hands' paths
straighter or more curved, and lets the gaze rest or wander. Flow holds each pose, or lets the limbs
swing through. Ground contacts are kept: legs are not rescaled while they carry the body, and a gait
takes its pace from the doodle's path. Space and Flow are ours: the paper has Time and Weight.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from laban import Effort
from smd.character.clip import Clip
from smd.character.poses import Poses, mixed
from smd.expression.body import Body
from smd.expression.operators import rescaled, reshaped, retimed, retimed_ends
from smd.expression.reaching import with_hands_kept
from smd.expression.springs import damped, settled, sprung
from smd.expression.study import Study, retimed_study
from smd.expression.timing import (
    ALPHA,
    EVENED,
    SOFTENED,
    after_waiting,
    busy_share,
    fastest_paces,
    held_timing,
    pace_timing,
    time_timing,
    within_pace,
)
from smd.expression.tracing import with_hands_redrawn
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep
from smd.geometry.rotations import inverse, multiply, quaternion_about, rotate

BEND_RAD = 0.1
"""Forward bend of each bone of the spine when strong, as in the paper."""

KEPT_GAZE = 0.7
"""Share of the spine's bend that the neck compensates, so that the gaze stays."""

STRONGEST_SCALE = 1.3
"""Scale of a strong movement. The paper's 2 rotates joints beyond a body's limits."""

WANDERING_RAD, WANDERING_S = np.radians(16.0), 2.2
"""Amplitude of an indirect gaze to either side, and its period."""

EDGE = 0.15
"""First and last share of a clip over which its scale and shape are blended in and out: it begins
and ends in the pose of the idle clip."""


def expressive(study: Study, effort: Effort, *, travels: bool) -> Clip:
    """Return a clip changed to show an Effort; at Effort 0, or where none was read, the same.

    Timing comes first: Time, then Weight, which depends on the speeds after that, then Flow. Of
    the poses, Space changes the hands' paths, Weight scales them, Flow's springs follow their
    parent joints, and the shape of the back is added last, so that nothing scales it. Hands that
    rest on the ground are put back there.

    Parameters
    ----------
    study
        `study_of` the neutral clip.
    effort
        What to show; an axis that is None is not played.
    travels
        Whether its action does: a gait has the doodle's pace, and no timing of its own.
    """
    time, weight = effort.time or 0.0, effort.weight or 0.0
    space, flow = effort.space or 0.0, effort.flow or 0.0
    clip, body = study.clip, study.body
    if not (time or weight or space or flow):
        return clip
    if not clip.cyclic:
        source_frame = effort_timing(study, time, weight, flow)
        if time > 0.0:
            clip = with_small_beginning(study, time)
        clip, study = retimed(clip, source_frame), retimed_study(study, source_frame)
    if space:
        clip = with_space(clip, space, body, study.bearing)
    if weight:
        clip = with_weight(clip, weight, study, gait=travels and clip.cyclic)
    if flow:
        clip = with_flow(clip, flow, body)
    if weight:
        clip = with_shape(clip, weight, body)
    return with_hands_kept(clip, body.arms, study.hands_m, study.bearing)


def effort_timing(study: Study, time: float, weight: float, flow: float) -> FloatArray:
    """Return which frame of a clip to show at each of its own, ``(n,)``."""
    clip = study.clip
    frame = np.arange(len(clip), dtype=np.float64)
    source_frame = time_timing(clip, time) if time else frame
    for power in (EVENED * min(time, 0.0), ALPHA * SOFTENED * weight):
        if power:
            way_m = np.interp(source_frame, frame, study.way_m)
            source_frame = np.interp(pace_timing(way_m, power), frame, source_frame)
    if flow > 0.0:
        ends = retimed_ends(clip.stage_end_frames, source_frame)
        held = held_timing(ends, clip.rate_hz, flow)
        source_frame = np.interp(held, frame, source_frame)
    busy = busy_share(time)
    fastest = fastest_paces(study.turning_rad_s, busy)
    return after_waiting(within_pace(source_frame, fastest), busy)


def with_small_beginning(study: Study, time: float) -> Clip:
    """Return a sudden clip whose preparation and anticipation are smaller, by 6.4.1.

    The paper shrinks those of a sustained clip too; ours keep their size, since an equal change at
    both poles shows nothing. The clip returns to its own size by the end of the execution, so that
    the pose does not jump at the end of a stage.
    """
    clip = study.clip
    last = len(clip) - 1
    anticipated, executed = clip.stage_end_frames[1], clip.stage_end_frames[2]
    if anticipated == 0:
        return clip
    shrunk = 1.0 / (3.0 * time + 1.0)
    back = smootherstep((np.arange(last + 1) - anticipated) / max(executed - anticipated, 1))
    factor = 1.0 + study.carried * (1.0 - back) * (shrunk - 1.0)
    return softly_rescaled(clip, study.body.every, factor, poses_at(clip, [0]))


def with_weight(clip: Clip, weight: float, study: Study, *, gait: bool) -> Clip:
    """Return a clip made larger where strong, smaller where light (6.4.2).

    Scaled is the difference to the interpolation from its first pose to its last, so that a
    character that sits down ends up sitting, strong or light. It is scaled only while the legs
    carry the body, so that it neither sinks through the ground nor floats above it.

    Parameters
    ----------
    study
        Of the neutral clip, retimed as this one is.
    """
    body = study.body
    scale = 1.0 + (STRONGEST_SCALE - 1.0) * weight if weight >= 0.0 else 1.0 / (1.0 - weight)
    joints = body.upper if gait else body.every
    bending = [j for j in joints if weight < 0.0 or j not in body.hinges]
    factor = np.full(len(clip), scale) if gait else 1.0 + study.carried * (scale - 1.0)
    if clip.cyclic:
        return softly_rescaled(clip, bending, factor, poses_at(clip, [middle_frame(clip)]))
    factor = 1.0 + settled(len(clip), EDGE) * (factor - 1.0)
    return softly_rescaled(clip, bending, factor, way_across(clip, study.way_m))


def poses_at(clip: Clip, frames: Sequence[int]) -> Poses:
    """Return a clip's poses at some frames, with its root motion."""
    return Poses(clip.rotation_xyzw[list(frames)], clip.translation_m[list(frames)])


def way_across(clip: Clip, way_m: FloatArray) -> Poses:
    """Return the interpolation from a clip's first pose to its last, by the way of its joints.

    Where both are equal this is that pose.
    """
    share = way_m / way_m[-1] if way_m[-1] > 0.0 else np.zeros(len(way_m))
    ends = poses_at(clip, [0]), poses_at(clip, [len(clip) - 1])
    first, last = (Poses(*(np.repeat(part, len(clip), axis=0) for part in end)) for end in ends)
    return mixed(first, last, share)


def softly_rescaled(clip: Clip, joints: Sequence[int], factor: FloatArray, about: Poses) -> Clip:
    """Return a clip rescaled in full near a pose, and less the larger the angle to it.

    The share is the cosine of half the angle: 0.7 at a right angle, 0 at half a turn, where the
    shorter rotation back changes sides, and beyond which no arm is raised.
    """
    at = list(joints)
    same = np.sum(clip.rotation_xyzw[:, at] * about.rotation_xyzw[:, at], axis=-1)
    return rescaled(clip, at, 1.0 + (factor - 1.0)[:, None] * np.abs(same), about)


def with_shape(clip: Clip, weight: float, body: Body) -> Clip:
    """Return a clip whose back sinks where strong, and rises where light (6.4.2)."""
    share = np.ones(len(clip)) if clip.cyclic else settled(len(clip), EDGE)
    bend = share * (BEND_RAD * weight)
    bends = dict.fromkeys(body.spine, bend)
    if body.neck is not None:
        bends[body.neck] = -KEPT_GAZE * len(body.spine) * bend
    return reshaped(clip, bends, body.rest_xyzw)


def middle_frame(clip: Clip) -> int:
    """Return the frame of a cycle that is nearest to its mean pose: a cycle has no first one."""
    mean = clip.rotation_xyzw.mean(axis=0)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    near = np.abs(np.sum(clip.rotation_xyzw * mean, axis=-1)).mean(axis=-1)
    return int(np.argmax(near))


def with_space(clip: Clip, space: float, body: Body, bearing: FloatArray) -> Clip:
    """Return a clip whose hands move straight, or in arcs with a wandering gaze."""
    clip = with_hands_redrawn(clip, body, space, bearing)
    n = len(clip)
    share = np.ones(n) if clip.cyclic else settled(n, EDGE)
    looking = [joint for joint in (body.neck, body.head) if joint is not None]
    if space > 0.0:
        return damped(clip, [*body.spine, *looking], space * share)
    if body.head is None:
        return clip
    turns = max(round(clip.duration_s / WANDERING_S), 1)
    angle = 2.0 * np.pi * turns * np.arange(n) / (n - 1)
    # A short cycle has no time to look around.
    reach = WANDERING_RAD * -space * share * min(clip.duration_s / WANDERING_S, 1.0)
    side, up = (
        rotate(inverse(body.rest_xyzw[body.head]), np.array(axis))
        for axis in ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    )
    wandering = multiply(
        quaternion_about(side, reach * np.sin(angle)),
        quaternion_about(up, -0.4 * reach * np.sin(2.0 * angle)),
    )
    rotation = clip.rotation_xyzw.copy()
    rotation[:, body.head] = multiply(rotation[:, body.head], wandering)
    return replace(clip, rotation_xyzw=rotation)


def with_flow(clip: Clip, flow: float, body: Body) -> Clip:
    """Return a clip whose upper body is held, or swings through."""
    share = np.ones(len(clip)) if clip.cyclic else settled(len(clip), EDGE)
    if flow > 0.0:
        return damped(clip, body.upper, flow * share)
    return sprung(clip, body.upper, body, -flow * share)
