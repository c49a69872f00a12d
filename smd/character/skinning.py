"""Linear blend skinning, of shapes that are mixed in before."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import matrix_from_quaternion

_BLOCK = 1 << 16  # frames times points: what is computed of them fits the cache
_GAP = 8  # points: to add zeros to so few is quicker than to begin again


def skin_points(
    mesh: Mesh,
    skeleton: Skeleton,
    world_rotation_xyzw: ArrayLike,
    world_position_m: ArrayLike,
    shape_weights: ArrayLike | None = None,
) -> FloatArray:
    """Return a mesh's points when its skeleton stands in the given poses.

    Each point is moved by the offsets of its shapes, times their weights, and then with the
    weighted mean of its joints' transforms, each from the bind pose to the pose asked for [1]_.

    Parameters
    ----------
    mesh
        Its joint indices must be those of ``skeleton``.
    skeleton
        Gives the bind pose.
    world_rotation_xyzw, world_position_m
        Joints in the world, ``(…, j, 4)`` and ``(…, j, 3)``, as `forward_kinematics` returns
        them; any leading axes.
    shape_weights
        ``(…, s)`` of the mesh's shapes, in their order; by default all are 0.

    Returns
    -------
    FloatArray
        ``(…, p, 3)``, in metres, to single precision. It is one product of matrices: all points,
        times their weights, with all joints' transforms; and for the points that shapes move one
        more a joint.

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
    shares = _shares(mesh, used)
    moved = (rows @ _weighted_points(mesh, shares)).reshape(-1, 3, len(mesh.points_m))
    if shape_weights is not None and mesh.shapes:
        weights = np.broadcast_to(shape_weights, (*leading, len(mesh.shapes)))
        weights = weights.reshape(-1, len(mesh.shapes)).astype(np.float32)
        turns = world_from_bind[..., :3].reshape(-1, len(used), 3, 3)
        _add_shapes(moved, mesh, shares, turns, weights)
    return np.swapaxes(moved.reshape(*leading, 3, -1), -1, -2).astype(np.float64)


def _add_shapes(
    moved: NDArray[np.float32],
    mesh: Mesh,
    shares: FloatArray,
    turns: FloatArray,
    weights: NDArray[np.float32],
) -> None:
    """Add what shapes move to skinned points ``(n, 3, p)``.

    The offsets of a point, each times its weight, are summed in one product of matrices. Each of
    its joints turns the sum, times its share: the points of a face follow few joints.

    Parameters
    ----------
    shares
        ``(k, p)`` of each joint used in each point.
    turns
        ``(n, k, 3, 3)`` of the same joints, from the bind pose.
    weights
        ``(n, s)`` of the shapes.
    """
    touched = np.unique(np.concatenate([shape.indices for shape in mesh.shapes]))
    if len(touched) == 0:
        return
    runs = _runs(touched)
    points = np.concatenate([np.arange(first, end) for first, end in runs])
    offsets = np.zeros((len(mesh.shapes), 3, len(points)), np.float32)
    for row, shape in zip(offsets, mesh.shapes, strict=True):
        row[:, np.searchsorted(points, shape.indices)] = shape.offsets_m.T
    flat = offsets.reshape(len(offsets), -1)
    joints = np.flatnonzero(shares[:, touched].any(axis=1))
    share_of = shares[np.ix_(joints, points)].astype(np.float32)
    turn_of = np.ascontiguousarray(np.moveaxis(turns[:, joints], 1, 0), dtype=np.float32)
    step = max(_BLOCK // len(points), 1)
    for start in range(0, len(moved), step):
        rows = slice(start, start + step)
        summed = (weights[rows] @ flat).reshape(-1, 3, len(points))
        added = np.zeros_like(summed)
        for turn, share in zip(turn_of[:, rows], share_of, strict=True):
            added += turn @ (summed * share)
        at = 0
        for first, end in runs:
            moved[rows, :, first:end] += added[..., at : at + end - first]
            at += end - first


def _runs(indices: IntArray) -> list[tuple[int, int]]:
    """Return the runs of increasing indices, first and end; across small gaps they go on."""
    cuts = np.flatnonzero(np.diff(indices) > _GAP) + 1
    return [(int(run[0]), int(run[-1]) + 1) for run in np.split(indices, cuts)]


def _weighted_points(mesh: Mesh, shares: FloatArray) -> NDArray[np.float32]:
    """Return each point ``(x, y, z, 1)`` times its weight for each joint used, ``(4 k, p)``."""
    p = len(mesh.points_m)
    points = np.concatenate([mesh.points_m, np.ones((p, 1))], axis=-1)
    weighted = shares[:, None, :] * points.T[None]
    return weighted.reshape(-1, p).astype(np.float32)


def _shares(mesh: Mesh, used: IntArray) -> FloatArray:
    """Return the weight of each joint used for each point, ``(k, p)``."""
    p = len(mesh.points_m)
    dense = np.zeros((len(used), p))
    place = np.searchsorted(used, mesh.joint_indices)
    place = np.minimum(place, len(used) - 1)  # what has no weight may be no joint of these
    np.add.at(dense, (place, np.arange(p)[:, None]), mesh.joint_weights)
    return dense
