"""Linear blend skinning."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import matrix_from_quaternion


def skin_points(
    mesh: Mesh, skeleton: Skeleton, world_rotation_xyzw: ArrayLike, world_position_m: ArrayLike
) -> FloatArray:
    """Return a mesh's points when its skeleton stands in the given poses.

    Each point moves with the weighted mean of its joints' transforms, each from the bind pose to
    the pose asked for [1]_.

    Parameters
    ----------
    mesh
        Its joint indices must be those of ``skeleton``.
    skeleton
        Gives the bind pose.
    world_rotation_xyzw, world_position_m
        Joints in the world, ``(…, j, 4)`` and ``(…, j, 3)``, as `forward_kinematics` returns
        them; any leading axes.

    Returns
    -------
    FloatArray
        ``(…, p, 3)``, in metres, to single precision. It is one product of matrices: all points,
        times their weights, with all joints' transforms.

    References
    ----------
    .. [1] N. Magnenat-Thalmann, R. Laperrière, D. Thalmann, "Joint-Dependent Local Deformations
       for Hand Animation and Object Grasping", Graphics Interface 1988.
    """
    used = np.unique(mesh.joint_indices[mesh.joint_weights > 0.0])
    rotation = matrix_from_quaternion(np.asarray(world_rotation_xyzw)[..., used, :])
    position = np.asarray(world_position_m, dtype=np.float64)[..., used, :]
    world_from_joint = np.concatenate([rotation, position[..., None]], axis=-1)
    joint_from_bind = np.linalg.inv(skeleton.world_from_bind[used])
    world_from_bind = world_from_joint @ joint_from_bind
    leading = world_from_bind.shape[:-3]
    # (…, 3, 4 k) with (4 k, p): the points come out with their coordinates first.
    rows = np.moveaxis(world_from_bind, -3, -2).reshape(-1, 4 * len(used)).astype(np.float32)
    moved = rows @ _weighted_points(mesh, used)
    return np.swapaxes(moved.reshape(*leading, 3, -1), -1, -2).astype(np.float64)


def _weighted_points(mesh: Mesh, used: IntArray) -> NDArray[np.float32]:
    """Return each point ``(x, y, z, 1)`` times its weight for each joint used, ``(4 k, p)``."""
    p = len(mesh.points_m)
    dense = np.zeros((len(used), p))
    place = np.searchsorted(used, mesh.joint_indices)
    place = np.minimum(place, len(used) - 1)  # what has no weight may be no joint of these
    np.add.at(dense, (place, np.arange(p)[:, None]), mesh.joint_weights)
    points = np.concatenate([mesh.points_m, np.ones((p, 1))], axis=-1)
    weighted = dense[:, None, :] * points.T[None]
    return weighted.reshape(-1, p).astype(np.float32)
