"""Linear blend skinning."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
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
        ``(…, p, 3)``, in metres. Twelve numbers a point and pose are held for a moment, which is
        about 1 MB a pose for ten thousand points: long clips are best skinned in parts.

    References
    ----------
    .. [1] N. Magnenat-Thalmann, R. Laperrière, D. Thalmann, "Joint-Dependent Local Deformations
       for Hand Animation and Object Grasping", Graphics Interface 1988.
    """
    rotation = matrix_from_quaternion(world_rotation_xyzw)
    position = np.asarray(world_position_m, dtype=np.float64)
    world_from_joint = np.concatenate([rotation, position[..., None]], axis=-1)
    joint_from_bind = np.linalg.inv(skeleton.world_from_bind)
    world_from_bind = world_from_joint @ joint_from_bind
    blended = np.tensordot(_dense_weights(mesh, len(skeleton)), world_from_bind, ([1], [-3]))
    blended = np.moveaxis(blended, 0, -3)
    turned = np.einsum("...pab,pb->...pa", blended[..., :3], mesh.points_m)
    return np.asarray(turned + blended[..., 3])


def _dense_weights(mesh: Mesh, joint_count: int) -> FloatArray:
    """Return the weight of every joint on every point, ``(p, j)``."""
    dense = np.zeros((len(mesh.points_m), joint_count))
    rows = np.arange(len(dense))[:, None]
    np.add.at(dense, (rows, mesh.joint_indices), mesh.joint_weights)
    return dense
