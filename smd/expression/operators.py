"""The operators of expression: retime, rescale and reshape a clip (section 6.3 of the paper [1]_).

Each takes a clip and returns one of the same length, stages and contacts carried along; they can be
composed in any order. The root motion stays the clip's: only the pose is rescaled.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
)

SOFT = 0.1
"""Offset of a power law's time: without it, the speed at the start is zero or infinite."""


def retimed(clip: Clip, source_frame: FloatArray) -> Clip:
    """Return a clip that shows at each frame another frame of itself.

    Parameters
    ----------
    clip
        Of n frames.
    source_frame
        ``(n,)`` not decreasing, from 0 to n - 1; fractional frames lie between two.
    """
    rotation = normalized(between_frames(clip.rotation_xyzw, source_frame))
    translation = between_frames(clip.translation_m, source_frame)
    nearest = np.rint(source_frame).astype(np.int64)
    return replace(
        clip,
        rotation_xyzw=rotation,
        translation_m=translation,
        stage_end_frames=retimed_ends(clip.stage_end_frames, source_frame),
        contacts=clip.contacts[nearest],
        tracks=clip.tracks.at(source_frame),
    )


def at_frames(value: FloatArray, frame: FloatArray) -> FloatArray:
    """Return values ``(n, …)``, one a frame, at fractional frames ``(m,)`` from 0 to n - 1."""
    left = np.minimum(frame.astype(np.int64), len(value) - 2)
    share = (frame - left).reshape(-1, *(1,) * (value.ndim - 1))
    before = value[left]
    return before + share * (value[left + 1] - before)


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
    weights = 0.5 * np.stack(
        [
            u * (u * (2.0 - u) - 1.0),
            u * u * (3.0 * u - 5.0) + 2.0,
            u * (u * (4.0 - 3.0 * u) + 1.0),
            u * u * (u - 1.0),
        ]
    )
    shape = (-1, *(1,) * (value.ndim - 1))
    return np.asarray(sum(w.reshape(shape) * padded[left + k] for k, w in enumerate(weights)))


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


def rescaled(clip: Clip, joints: Sequence[int], factor: FloatArray, about: Poses) -> Clip:
    """Return a clip whose joints rotate by a factor farther from a pose, by equation (7).

    Parameters
    ----------
    joints
        Which; the ground root is none of them.
    factor
        ``(n,)``, or ``(n, k)`` of each joint, not negative; where it is 1 nothing changes. Let it
        change smoothly, or the pose jumps. Let it be 1 where a joint is half a turn away from the
        pose, since there the shorter rotation back changes sides.
    about
        The pose it is scaled about, a single one or one a frame: the first one of a stage.
    """
    at = np.asarray(joints, dtype=np.int64)
    rotation, translation = clip.rotation_xyzw.copy(), clip.translation_m.copy()
    first, place = about.rotation_xyzw[:, at], about.translation_m[:, at]
    from_first = rotvec_from_quaternion(multiply(rotation[:, at], inverse(first)))
    factor = factor.reshape(len(clip), -1, 1)
    rotation[:, at] = multiply(quaternion_from_rotvec(factor * from_first), first)
    translation[:, at] = place + factor * (translation[:, at] - place)
    return replace(clip, rotation_xyzw=rotation, translation_m=translation)


def reshaped(clip: Clip, bend_rad: Mapping[int, FloatArray], rest_xyzw: FloatArray) -> Clip:
    """Return a clip whose joints are rotated further about their left axis.

    It is the world's left axis in the rest pose, so that a positive angle bends forward for any
    rest rotations of a rig.

    Parameters
    ----------
    bend_rad
        ``(n,)`` by joint.
    rest_xyzw
        ``(j, 4)`` rotation of each joint in the world in the rest pose.
    """
    if not bend_rad:
        return clip
    joints = list(bend_rad)
    left = rotate(inverse(rest_xyzw[joints]), np.array([1.0, 0.0, 0.0]))
    angle = np.stack([bend_rad[joint] for joint in joints], axis=-1)
    bend = quaternion_from_rotvec(angle[..., None] * left)
    rotation = clip.rotation_xyzw.copy()
    rotation[:, joints] = multiply(rotation[:, joints], bend)
    return replace(clip, rotation_xyzw=rotation)
