"""Expression: a neutral clip played with Effort (section 6.4 of the paper [1]_).

Time changes the durations of the stages and their speed curves, and the attack of a gait's steps.
Weight makes speeds more or less even, movements larger or smaller, and lowers or raises the back.
Space makes the hands' paths straighter or more curved, and lets the gaze rest or wander. Flow holds
each pose, or lets the limbs swing through. What the action is for is kept: where a hand strikes or
reaches, it does so with every Effort. Ground contacts are kept too: legs are not rescaled while
they carry the body, and a gait takes its pace from the doodle's path. Space and Flow are ours: the
paper has Time and Weight.

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
from smd.character.poses import Poses
from smd.expression.attack import with_attack
from smd.expression.body import Body
from smd.expression.operators import at_frames, rescaled, reshaped, retimed
from smd.expression.reaching import with_hands_kept
from smd.expression.springs import damped, settled, sprung
from smd.expression.study import Study
from smd.expression.timing import (
    PACE_PER_WEIGHT,
    fastest_paces,
    flowing_slowness,
    pace_slowness,
    shown_frames,
    sustained_slowness,
    time_slowness,
    within_pace,
)
from smd.expression.tracing import with_hands_redrawn
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep
from smd.geometry.rotations import inverse, multiply, quaternion_about, rotate

BEND_RAD = 0.1
"""Forward bend of each bone of the spine when strong, as in the paper."""

STIRRING = 0.6
"""How far joints go on average, in heights of the pelvis, where an action bends the back fully."""

KEPT_GAZE = 0.7
"""Share of the spine's bend that the neck compensates, so that the gaze stays."""

LARGER, FULLER = 0.625, 0.25
"""Scale of a movement: ``(1 + LARGER weight) / (1 + FULLER weight)``, smooth at 0; 0.5 when light,
as in the paper, and 1.3 when strong: the paper's 2 rotates joints beyond a body's limits."""

SMALLER_BEGINNING = 3.0
"""A sudden beginning is ``1 / (SMALLER_BEGINNING time² + 1)`` as large: at the pole the paper's
quarter, and without its kink at 0."""

WANDERING_RAD, WANDERING_S = np.radians(16.0), 2.2
"""Amplitude of an indirect gaze to either side, and its period."""

EDGE, BENT = 0.15, 0.35
"""First and last share of a clip over which its scale, and the shape of its back, are blended in
and out: it begins and ends in the pose of the idle clip. A back that bent as soon as the clip is
scaled would be the quickest movement in a quiet one."""


def expressive(study: Study, effort: Effort, *, travels: bool) -> Clip:
    """Return a clip changed to show an Effort; at Effort 0, or where none was read, the same.

    Poses are changed first, in the clip's own time: Space redraws the hands' paths, Time and
    Weight scale them, and the shape of the back is added last, so that nothing scales it. Then the
    clip is retimed: by Time, then by Weight, which depends on the speeds after that, then by Flow.
    Flow's springs come after this, since they follow what is played. Hands that rest on the
    ground are put back there.

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
    clip = study.clip
    if not (time or weight or space or flow):
        return clip
    if space:
        if space not in study.spaced:
            study.spaced[space] = with_space(study, space)
        clip = study.spaced[space]
    clip = with_size(clip, time, weight, study, gait=travels and clip.cyclic)
    if weight:
        clip = with_shape(clip, weight, study)
    frame = np.arange(len(clip), dtype=np.float64)
    if not clip.cyclic:
        frame = effort_timing(study, clip, time, weight, flow)
        clip = retimed(clip, frame)
    elif time:
        clip = with_attack(clip, time, study.body)
    if flow:
        clip = with_flow(clip, flow, study.body, at_frames(study.swings, frame))
    bearing = at_frames(study.bearing, frame)
    return with_hands_kept(clip, study.body.arms, at_frames(study.hands_m, frame), bearing)


def effort_timing(study: Study, clip: Clip, time: float, weight: float, flow: float) -> FloatArray:
    """Return which frame of a clip to show at each of its own, ``(n,)``.

    Parameters
    ----------
    clip
        The study's, its poses as they are to be: the faster these change, the less it is hurried.
    """
    if time < 0.0:
        slowness = sustained_slowness(study.vigour, study.clip, time)
    else:
        slowness = time_slowness(study.clip, time)
    slowness *= pace_slowness(study.vigour, slowness, PACE_PER_WEIGHT * np.expm1(weight))
    if flow:
        slowness = flowing_slowness(slowness, study.clip, flow)
    return shown_frames(within_pace(slowness, fastest_paces(clip)), study.aim.frame)


def with_size(clip: Clip, time: float, weight: float, study: Study, *, gait: bool) -> Clip:
    """Return a clip made larger where strong, smaller where light, and small at a sudden beginning.

    Scaled is the difference to the way from its first pose to its last, through that at its aim:
    so a character that sits down ends up sitting, and a blow strikes where it should. It is scaled
    only while the legs carry the body, so that it neither sinks through the ground nor floats
    above it. The paper shrinks the beginning of a sustained clip too (6.4.1); ours keeps its size,
    since an equal change at both poles shows nothing.

    Parameters
    ----------
    clip
        The study's, its poses changed or not.
    gait
        Whether it travels in cycles: then only trunk and arms are scaled.
    """
    factor = np.full(len(clip), (1.0 + LARGER * weight) / (1.0 + FULLER * weight))
    if not clip.cyclic:
        factor *= beginning_scale(clip, time)
    if (factor == 1.0).all():
        return clip
    body = study.body
    if not gait:
        factor = 1.0 + study.carried * (factor - 1.0)
    if not clip.cyclic:
        factor = 1.0 + settled(len(clip), EDGE) * (factor - 1.0)
    return softly_rescaled(clip, body.upper if gait else body.every, body, factor, study.about)


def beginning_scale(clip: Clip, time: float) -> FloatArray:
    """Return the scale ``(n,)`` of preparation and anticipation, by 6.4.1; 1 unless sudden.

    It returns to 1 by the end of the execution, so that the pose does not jump at the end of a
    stage.
    """
    anticipated, executed = clip.stage_end_frames[1:3].tolist()
    if anticipated == 0 or time <= 0.0:
        return np.ones(len(clip))
    shrunk = 1.0 / (SMALLER_BEGINNING * time**2 + 1.0)
    back = smootherstep((np.arange(len(clip)) - anticipated) / max(executed - anticipated, 1))
    return 1.0 + (1.0 - back) * (shrunk - 1.0)


def softly_rescaled(
    clip: Clip, joints: Sequence[int], body: Body, factor: FloatArray, about: Poses
) -> Clip:
    """Return a clip rescaled in full near some poses, and less the larger the angle to them.

    The share is the cosine of half the angle: 0.7 at a right angle, 0 at half a turn, where the
    shorter rotation back changes sides, and beyond which no arm is raised. Elbows and knees are
    never enlarged.
    """
    at = list(joints)
    same = np.sum(clip.rotation_xyzw[:, at] * about.rotation_xyzw[:, at], axis=-1)
    change = np.where(
        [j in body.hinges for j in at], np.minimum(factor, 1.0)[:, None], factor[:, None]
    )
    return rescaled(clip, at, 1.0 + (change - 1.0) * np.abs(same), about)


def with_shape(clip: Clip, weight: float, study: Study) -> Clip:
    """Return a clip whose back sinks where strong, and rises where light (6.4.2).

    Not at the aim of a hand, which would be raised and lowered with it, and little in an action
    that hardly moves: a nod is no bow.
    """
    body = study.body
    share = np.ones(len(clip)) if clip.cyclic else study.carried * settled(len(clip), BENT)
    if any(study.aim.holds(joint) for joint in body.spine):
        share = share * study.free
    bend = share * (BEND_RAD * weight * min(study.stir / STIRRING, 1.0))
    bends = dict.fromkeys(body.spine, bend)
    if body.neck is not None:
        bends[body.neck] = -KEPT_GAZE * len(body.spine) * bend
    return reshaped(clip, bends, body.rest_xyzw)


def with_space(study: Study, space: float) -> Clip:
    """Return a clip whose hands move straight, or in arcs with a wandering gaze."""
    clip, body = study.clip, study.body
    n = len(clip)
    share = np.ones(n) if clip.cyclic else settled(n, EDGE)
    looking = [joint for joint in (body.neck, body.head) if joint is not None]
    if space > 0.0:
        steady = damped(clip, [*body.spine, *looking], space * share)
        return with_hands_redrawn(steady, study, space)
    clip = with_hands_redrawn(clip, study, space)
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


def with_flow(clip: Clip, flow: float, body: Body, swings: FloatArray) -> Clip:
    """Return a clip whose upper body is held, or swings through.

    Parameters
    ----------
    swings
        ``(n,)`` how freely limbs may swing, in the time that is played.
    """
    if not body.upper:
        return clip
    share = swings if clip.cyclic else swings * settled(len(clip), EDGE)
    if flow > 0.0:
        return damped(clip, body.upper, flow * share)
    return sprung(clip, body.upper, body, -flow * share)
