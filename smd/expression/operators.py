"""The operators of expression: retime, rescale and reshape a clip (section 6.3 of the paper [1]_).

Each takes the poses of a clip and returns as many; they can be composed in any order. The root
motion stays the clip's: only the pose is rescaled.

Poses are ``(n, …, j, 4)`` and ``(n, …, j, 3)``: a frame each, or a stack, a frame and a state of
Effort each. What an operator is told is ``(n, …)`` then, of every frame and state.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
    sign_continuous,
)

SOFT = 0.1
"""Offset of a power law's time: without it, the speed at the start is zero or infinite."""


def retimed(poses: Poses, source_frame: FloatArray) -> Poses:
    """Return poses that show at each frame another frame of themselves.

    Parameters
    ----------
    poses
        Of n frames.
    source_frame
        ``(n, …)`` not decreasing, from 0 to n - 1; fractional frames lie between two.
    """
    rotation = sign_continuous(poses.rotation_xyzw)
    return Poses(
        normalized(between_frames(rotation, source_frame)),
        between_frames(poses.translation_m, source_frame),
    )


def played_clip(clip: Clip, poses: Poses, source_frame: FloatArray) -> Clip:
    """Return a clip with other poses, its stages, contacts and tracks when they are shown.

    Parameters
    ----------
    clip
        Of n frames.
    poses
        ``(n, j, …)``.
    source_frame
        ``(n,)`` which frame of the clip each shows, as in `retimed`.
    """
    return replace(
        clip,
        rotation_xyzw=poses.rotation_xyzw,
        translation_m=poses.translation_m,
        stage_end_frames=retimed_ends(clip.stage_end_frames, source_frame),
        contacts=clip.contacts[np.rint(source_frame).astype(np.int64)],
        tracks=clip.tracks.at(source_frame),
    )


def at_frames(value: FloatArray, frame: FloatArray) -> FloatArray:
    """Return values ``(n, …)``, one a frame, at fractional frames from 0 to n - 1.

    Parameters
    ----------
    value
        ``(n, …)``; in a stack ``(n, e, …)``.
    frame
        ``(m,)``; in a stack ``(m, e)``, of each state its own.
    """
    left = np.minimum(frame.astype(np.int64), len(value) - 2)
    share = _over(frame - left, value)
    before = _rows(value, left)
    return before + share * (_rows(value, left + 1) - before)


def between_frames(value: FloatArray, frame: FloatArray) -> FloatArray:
    """Return values as `at_frames` does, on a curve through the frames that keeps its direction.

    On straight lines, a movement that is retimed would jerk from frame to frame. The cubics are
    those of Catmull and Rom [1]_; beyond its ends a clip goes straight on.

    References
    ----------
    .. [1] E. Catmull, R. Rom, "A class of local interpolating splines", Computer Aided Geometric
       Design, 1974.
    """
    before = 2.0 * value[:1] - value[1:2]
    after = 2.0 * value[-1:] - value[-2:-1]
    padded = np.concatenate([before, value, after])
    left = np.minimum(frame.astype(np.int64), len(value) - 2)
    u = frame - left
    weights = (
        0.5 * (u * (u * (2.0 - u) - 1.0)),
        0.5 * (u * u * (3.0 * u - 5.0) + 2.0),
        0.5 * (u * (u * (4.0 - 3.0 * u) + 1.0)),
        0.5 * (u * u * (u - 1.0)),
    )
    parts = (_over(w, value) * _rows(padded, left + k) for k, w in enumerate(weights))
    return np.asarray(sum(parts))


def _rows(value: FloatArray, at: IntArray) -> FloatArray:
    """Return the rows of values ``(n, …)`` at ``(m,)``, or those of each state at ``(m, e)``."""
    return value[(at, *np.indices(at.shape, sparse=True)[1:])]


def _over(share: FloatArray, value: FloatArray) -> FloatArray:
    """Return a share of each frame and state, for all that values have of them."""
    return share.reshape(*share.shape, *(1,) * (value.ndim - share.ndim))


def retimed_ends(stage_end_frames: IntArray, source_frame: FloatArray) -> IntArray:
    """Return the frames ``(5,)`` that are nearest to the ends of stages once a clip is retimed."""
    last = len(source_frame) - 1
    after = np.clip(np.searchsorted(source_frame, stage_end_frames), 1, last)
    early = stage_end_frames - source_frame[after - 1] < source_frame[after] - stage_end_frames
    ends = after - early
    ends[-1] = last  # a clip that has ended stands on
    return np.asarray(ends)


def powered_pace(u: FloatArray, exponent: float) -> FloatArray:
    """Return the pace of a stage whose time ``v`` is raised to a power, where it has got to ``u``.

    Time within a stage is normalised to 0 … 1, so that every power is continuous and increasing:
    ``u = ((v + SOFT)**exponent - low) / (high - low)``, of which this is du/dv.
    """
    low, high = SOFT**exponent, (1.0 + SOFT) ** exponent
    inner = u * (high - low) + low
    return exponent / (high - low) * inner ** (1.0 - 1.0 / exponent)


def rescaled(poses: Poses, joints: Sequence[int], factor: FloatArray, about: Poses) -> Poses:
    """Return poses whose joints rotate by a factor farther from a pose, by equation (7).

    Parameters
    ----------
    joints
        Which; the ground root is none of them.
    factor
        ``(n, …, k)`` of each joint, or ``(n, …, 1)``, not negative; where it is 1 nothing changes.
        Let it change smoothly, or the pose jumps. Let it be 1 where a joint is half a turn away
        from the pose, since there the shorter rotation back changes sides.
    about
        The pose it is scaled about, a single one or one a frame: the first one of a stage.
    """
    at = np.asarray(joints, dtype=np.int64)
    rotation, translation = poses.rotation_xyzw.copy(), poses.translation_m.copy()
    first, place = about.rotation_xyzw[..., at, :], about.translation_m[..., at, :]
    from_first = rotvec_from_quaternion(multiply(rotation[..., at, :], inverse(first)))
    factor = factor[..., None]
    rotation[..., at, :] = multiply(quaternion_from_rotvec(factor * from_first), first)
    translation[..., at, :] = place + factor * (translation[..., at, :] - place)
    return Poses(rotation, translation)


def reshaped(poses: Poses, bend_rad: Mapping[int, FloatArray], rest_xyzw: FloatArray) -> Poses:
    """Return poses whose joints are rotated further about their left axis.

    It is the world's left axis in the rest pose, so that a positive angle bends forward for any
    rest rotations of a rig.

    Parameters
    ----------
    bend_rad
        ``(n, …)`` by joint.
    rest_xyzw
        ``(j, 4)`` rotation of each joint in the world in the rest pose.
    """
    if not bend_rad:
        return poses
    joints = list(bend_rad)
    left = rotate(inverse(rest_xyzw[joints]), np.array([1.0, 0.0, 0.0]))
    angle = np.stack([bend_rad[joint] for joint in joints], axis=-1)
    bend = quaternion_from_rotvec(angle[..., None] * left)
    rotation = poses.rotation_xyzw.copy()
    rotation[..., joints, :] = multiply(rotation[..., joints, :], bend)
    return Poses(rotation, poses.translation_m)


def stack_of(poses: Poses | Clip, states: int) -> Poses:
    """Return poses ``(n, j, …)`` as a stack ``(n, e, j, …)`` in which all states are alike."""
    parts = poses.rotation_xyzw, poses.translation_m
    return Poses(*(np.repeat(part[:, None], states, axis=1) for part in parts))


def where_asked(poses: Poses, asked: BoolArray, change: Callable[[Poses], Poses]) -> Poses:
    """Return a stack in which the states ``(e,)`` that ask for it are changed."""
    if not asked.any():
        return poses
    if asked.all():
        return change(poses)
    rotation, translation = (part.copy() for part in poses)
    part = Poses(rotation[:, asked], translation[:, asked])
    rotation[:, asked], translation[:, asked] = change(part)
    return Poses(rotation, translation)
