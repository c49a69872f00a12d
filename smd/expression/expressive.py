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

import numpy as np

from laban import Effort
from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.expression.attack import with_attack
from smd.expression.body import Body
from smd.expression.operators import (
    at_frames,
    played_clip,
    rescaled,
    reshaped,
    retimed,
    stack_of,
    where_asked,
)
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


def expressive(study: Study, efforts: Sequence[Effort], *, travels: bool) -> tuple[Clip, ...]:
    """Return a clip changed to show each of some Efforts; at Effort 0, or unread, the same.

    All are made together, as one stack of poses ``(n, e, j, …)``: their arrays are short. Poses are
    changed first, in the clip's own time: Space redraws the hands' paths, Time and Weight scale
    them, and the shape of the back is added last, so that nothing scales it. Then the clip is
    retimed: by Time, then by Weight, which depends on the speeds after that, then by Flow. Flow's
    springs come after this, since they follow what is played. Hands that rest on the ground are put
    back there.

    Parameters
    ----------
    study
        `study_of` the neutral clip.
    efforts
        What to show; an axis that is None is not played.
    travels
        Whether its action does: a gait has the doodle's pace, and no timing of its own.
    """
    states = [(one.time, one.weight, one.space, one.flow) for one in efforts]
    of = np.array([[value or 0.0 for value in state] for state in states]).reshape(-1, 4)
    shows = np.asarray(of.any(axis=1))
    played = iter(_expressed(study, *of[shows].T, travels=travels) if shows.any() else ())
    return tuple(next(played) if one else study.clip for one in shows)


def _expressed(
    study: Study,
    time: FloatArray,
    weight: FloatArray,
    space: FloatArray,
    flow: FloatArray,
    *,
    travels: bool,
) -> list[Clip]:
    """Return a clip in some states of Effort, given its four axes ``(e,)``."""
    clip, body = study.clip, study.body
    poses = with_space(study, space)
    poses = with_size(poses, time, weight, study, gait=travels and clip.cyclic)
    poses = with_shape(poses, weight, study)
    frame = np.repeat(np.arange(len(clip), dtype=np.float64)[:, None], len(time), axis=1)
    if not clip.cyclic:
        fastest = fastest_paces(poses.rotation_xyzw, clip.rate_hz)
        each = zip(fastest.T, time.tolist(), weight.tolist(), flow.tolist(), strict=True)
        frame = np.stack([effort_timing(study, *state) for state in each], axis=1)
        poses = retimed(poses, frame)
    else:
        poses = where_asked(
            poses, time != 0.0, lambda p: with_attack(p, time[time != 0], clip, body)
        )

    def shown(value: FloatArray) -> FloatArray:
        """Return when each state shows a value of the neutral clip."""
        own = np.broadcast_to(value[:, None], (len(value), len(time), *value.shape[1:]))
        return at_frames(own, frame)

    poses = with_flow(poses, flow, study, shown(study.swings))
    hands = shown(study.hands_m), shown(study.bearing)
    poses = with_hands_kept(poses, clip.skeleton, body.arms, *hands)
    return [
        played_clip(clip, Poses(*(part[:, i] for part in poses)), frame[:, i])
        for i in range(len(time))
    ]


def effort_timing(
    study: Study, fastest: FloatArray, time: float, weight: float, flow: float
) -> FloatArray:
    """Return which frame of a clip to show at each of its own, ``(n,)``.

    Parameters
    ----------
    fastest
        `fastest_paces` of its poses as they are to be: the faster these change, the less it is
        hurried.
    """
    if time < 0.0:
        slowness = sustained_slowness(study.vigour, study.clip, time)
    else:
        slowness = time_slowness(study.clip, time)
    slowness *= pace_slowness(study.vigour, slowness, PACE_PER_WEIGHT * np.expm1(weight))
    if flow:
        slowness = flowing_slowness(slowness, study.clip, flow)
    return shown_frames(within_pace(slowness, fastest), study.aim.frame)


def with_size(
    poses: Poses, time: FloatArray, weight: FloatArray, study: Study, *, gait: bool
) -> Poses:
    """Return a stack made larger where strong, smaller where light, small at a sudden beginning.

    Scaled is the difference to the way from its first pose to its last, through that at its aim:
    so a character that sits down ends up sitting, and a blow strikes where it should. It is scaled
    only while the legs carry the body, so that it neither sinks through the ground nor floats
    above it. The paper shrinks the beginning of a sustained clip too (6.4.1); ours keeps its size,
    since an equal change at both poles shows nothing.

    Parameters
    ----------
    poses
        ``(n, e, j, …)`` the study's, changed or not.
    time, weight
        ``(e,)``.
    gait
        Whether it travels in cycles: then only trunk and arms are scaled.
    """
    clip, body = study.clip, study.body
    factor = np.tile((1.0 + LARGER * weight) / (1.0 + FULLER * weight), (len(clip), 1))
    if not clip.cyclic:
        factor *= beginning_scale(clip, time)
    asked = (factor != 1.0).any(axis=0)
    if not gait:
        factor = 1.0 + study.carried[:, None] * (factor - 1.0)
    if not clip.cyclic:
        factor = 1.0 + settled(len(clip), EDGE)[:, None] * (factor - 1.0)
    joints = body.upper if gait else body.every
    return where_asked(
        poses, asked, lambda p: softly_rescaled(p, joints, body, factor[:, asked], study.about)
    )


def beginning_scale(clip: Clip, time: FloatArray) -> FloatArray:
    """Return the scale ``(n, e)`` of preparation and anticipation, by 6.4.1; 1 unless sudden.

    It returns to 1 by the end of the execution, so that the pose does not jump at the end of a
    stage.
    """
    anticipated, executed = clip.stage_end_frames[1:3].tolist()
    if anticipated == 0:
        return np.ones((len(clip), len(time)))
    shrunk = 1.0 / (SMALLER_BEGINNING * np.maximum(time, 0.0) ** 2 + 1.0)
    back = smootherstep((np.arange(len(clip)) - anticipated) / max(executed - anticipated, 1))
    return 1.0 + (1.0 - back)[:, None] * (shrunk - 1.0)


def softly_rescaled(
    poses: Poses, joints: Sequence[int], body: Body, factor: FloatArray, about: Poses
) -> Poses:
    """Return a stack rescaled in full near some poses, and less the larger the angle to them.

    The share is the cosine of half the angle: 0.7 at a right angle, 0 at half a turn, where the
    shorter rotation back changes sides, and beyond which no arm is raised. Elbows and knees are
    never enlarged.

    Parameters
    ----------
    factor
        ``(n, e)``.
    about
        ``(n, j, …)``, or a single pose, the same for all states.
    """
    at = list(joints)
    about = Poses(*(part[:, None] for part in about))
    same = np.einsum("...i,...i->...", poses.rotation_xyzw[:, :, at], about.rotation_xyzw[:, :, at])
    factor = factor[..., None]
    change = np.where([j in body.hinges for j in at], np.minimum(factor, 1.0), factor)
    return rescaled(poses, at, 1.0 + (change - 1.0) * np.abs(same), about)


def with_shape(poses: Poses, weight: FloatArray, study: Study) -> Poses:
    """Return a stack whose back sinks where strong, and rises where light (6.4.2).

    Not at the aim of a hand, which would be raised and lowered with it, and little in an action
    that hardly moves: a nod is no bow.
    """
    clip, body = study.clip, study.body
    share = np.ones(len(clip)) if clip.cyclic else study.carried * settled(len(clip), BENT)
    if any(study.aim.holds(joint) for joint in body.spine):
        share = share * study.free
    bend = share[:, None] * (BEND_RAD * weight * min(study.stir / STIRRING, 1.0))
    bends = dict.fromkeys(body.spine, bend)
    if body.neck is not None:
        bends[body.neck] = -KEPT_GAZE * len(body.spine) * bend
    return reshaped(poses, bends, body.rest_xyzw)


def with_space(study: Study, space: FloatArray) -> Poses:
    """Return the study's poses as a stack whose hands move straight, or in arcs, as the eyes do.

    Each Space is made once, however many states ``(e,)`` have it.
    """
    clip, body = study.clip, study.body
    spaces, of = np.unique(space, return_inverse=True)
    share = np.ones(len(clip)) if clip.cyclic else settled(len(clip), EDGE)
    direct, indirect = spaces > 0.0, spaces < 0.0
    looking = [joint for joint in (body.neck, body.head) if joint is not None]
    steady = share[:, None] * spaces[direct]
    poses = stack_of(clip, len(spaces))
    poses = where_asked(poses, direct, lambda p: damped(p, clip, [*body.spine, *looking], steady))
    redrawn = direct | indirect
    poses = where_asked(poses, redrawn, lambda p: with_hands_redrawn(p, study, spaces[redrawn]))
    poses = where_asked(
        poses, indirect, lambda p: with_gaze_wandering(p, study, share[:, None] * -spaces[indirect])
    )
    return Poses(*(part[:, of] for part in poses))


def with_gaze_wandering(poses: Poses, study: Study, share: FloatArray) -> Poses:
    """Return a stack whose head looks around, by a share ``(n, e)`` of how far it does at most."""
    clip, head = study.clip, study.body.head
    if head is None:
        return poses
    n = len(clip)
    turns = max(round(clip.duration_s / WANDERING_S), 1)
    angle = (2.0 * np.pi * turns * np.arange(n) / (n - 1))[:, None]
    # A short cycle has no time to look around.
    reach = WANDERING_RAD * share * min(clip.duration_s / WANDERING_S, 1.0)
    side, up = (
        rotate(inverse(study.body.rest_xyzw[head]), np.array(axis))
        for axis in ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    )
    wandering = multiply(
        quaternion_about(side, reach * np.sin(angle)),
        quaternion_about(up, -0.4 * reach * np.sin(2.0 * angle)),
    )
    rotation = poses.rotation_xyzw.copy()
    rotation[:, :, head] = multiply(rotation[:, :, head], wandering)
    return Poses(rotation, poses.translation_m)


def with_flow(poses: Poses, flow: FloatArray, study: Study, swings: FloatArray) -> Poses:
    """Return a stack whose upper body is held, or swings through.

    Parameters
    ----------
    flow
        ``(e,)``.
    swings
        ``(n, e)`` how freely limbs may swing, in the time that is played.
    """
    clip, body = study.clip, study.body
    if not body.upper:
        return poses
    share = swings if clip.cyclic else swings * settled(len(clip), EDGE)[:, None]
    share = share * np.abs(flow)
    bound, free = flow > 0.0, flow < 0.0
    poses = where_asked(poses, bound, lambda p: damped(p, clip, body.upper, share[:, bound]))
    return where_asked(poses, free, lambda p: sprung(p, clip, body.upper, body, share[:, free]))
