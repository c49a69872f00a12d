"""Embedding: poses and velocities as points whose Euclidean distance means something."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import (
    heading_rad,
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_about,
    rotate,
)

SAMPLES = 64
"""Poses that represent a gesture: one every 30 ms of a gesture of 2 s."""

METRES_PER_RADIAN = DEFAULT_FIGURE_HEIGHT_M
"""Translation that counts as much as rotation by a radian: a figurine that moves by its own height
moves as visibly as one that turns by a radian (the tokenizer weighs them alike)."""


class PoseSequence(NamedTuple):
    """Positions and orientations of a prop over time.

    ``position_m (…, n, 3)`` and ``orientation_xyzw (…, n, 4)``; leading axes: several gestures.
    """

    position_m: FloatArray
    orientation_xyzw: FloatArray


def sample_poses(source: Doodle | RigidMotion, samples: int = SAMPLES) -> PoseSequence:
    """Return poses at even times from the first sample to the last: a gesture at any speed.

    Parameters
    ----------
    source
        At least one sample.
    samples
        How many poses, at least one.
    """
    at_s = np.linspace(source.time_s[0], source.time_s[-1], samples)
    return PoseSequence(
        interpolate_linear(source.time_s, source.position_m, at_s),
        interpolate_rotation(source.time_s, source.orientation_xyzw, at_s),
    )


def heading_frame(poses: PoseSequence) -> FloatArray:
    """Return the frame whose up is the world's and whose front is the prop's, ``(…, 4)``.

    The front is the mean of the poses' fronts, projected to the ground plane and not normalised, so
    poses that look up or down have little weight. If they cancel, it is that of the first pose.
    """
    q = poses.orientation_xyzw
    mean = rotate(q, np.broadcast_to([0.0, 0.0, 1.0], (*q.shape[:-1], 3))).mean(axis=-2)
    # 0.1: a full turn leaves next to nothing, and its direction is noise.
    level = np.hypot(mean[..., 0], mean[..., 2]) > 0.1
    mean_heading = np.arctan2(mean[..., 0], mean[..., 2])
    heading = np.where(level, mean_heading, heading_rad(q[..., 0, :]))
    return quaternion_about([0.0, 1.0, 0.0], heading)


def seen_from(poses: PoseSequence, frame_xyzw: FloatArray) -> PoseSequence:
    """Return poses in a turned frame, ``(…, 4)``, the mean of the positions at its origin."""
    frame_from_world = inverse(frame_xyzw)[..., None, :]
    position = rotate(frame_from_world, poses.position_m)
    return PoseSequence(
        position - position.mean(axis=-2, keepdims=True),
        multiply(frame_from_world, poses.orientation_xyzw),
    )


def extent_m(poses: PoseSequence) -> FloatArray:
    """Return the root mean square distance of the positions from their mean, ``(…)``."""
    spread = poses.position_m - poses.position_m.mean(axis=-2, keepdims=True)
    return np.sqrt(np.mean(np.sum(spread * spread, axis=-1), axis=-1))


def scaled(poses: PoseSequence, factor: ArrayLike) -> PoseSequence:
    """Return poses with the positions larger by a factor, ``(…)``."""
    by = np.asarray(factor, dtype=np.float64)[..., None, None]
    return PoseSequence(poses.position_m * by, poses.orientation_xyzw)


def embed_poses(poses: PoseSequence, *, metres_per_radian: float = METRES_PER_RADIAN) -> FloatArray:
    """Return points ``(…, n, 12)`` whose squared distance adds that of positions and of rotations.

    The last nine numbers are the rotation matrix times ``metres_per_radian / sqrt(2)``, since the
    Frobenius distance of the matrices of two rotations that differ by an angle ``a`` is
    ``2 sqrt(2) |sin(a / 2)|`` [1]_: two orientations are ``2 |sin(a / 2)| metres_per_radian``
    apart, which is ``a`` for small angles and 2 for half a turn. It depends on the angle alone,
    not on the frame, and the sign of a quaternion does not matter.

    References
    ----------
    .. [1] D. Q. Huynh, "Metrics for 3D Rotations: Comparison and Analysis", Journal of
       Mathematical Imaging and Vision 35(2), 2009.
    """
    matrices = matrix_from_quaternion(poses.orientation_xyzw)
    matrices = matrices.reshape(*matrices.shape[:-2], 9)
    return np.concatenate(
        [poses.position_m, matrices * (metres_per_radian / np.sqrt(2.0))], axis=-1
    )
