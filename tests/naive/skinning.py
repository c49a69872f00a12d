"""Linear blend skinning as its formula says it: the oracle of `smd.character.skinning`."""

from __future__ import annotations

import numpy as np

from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import matrix_from_quaternion


def skinned(
    mesh: Mesh,
    skeleton: Skeleton,
    rotation: FloatArray,
    position: FloatArray,
    shape_weights: FloatArray | None = None,
) -> FloatArray:
    """Return one pose's points: the sum over influences of w · W · B⁻¹ · (p + offsets)."""
    world_from_joint = np.tile(np.eye(4), (len(skeleton), 1, 1))
    world_from_joint[:, :3, :3] = matrix_from_quaternion(rotation)
    world_from_joint[:, :3, 3] = position
    moved = world_from_joint @ np.linalg.inv(skeleton.world_from_bind)
    formed = mesh.points_m.copy()
    weights = np.zeros(len(mesh.shapes)) if shape_weights is None else shape_weights
    for shape, weight in zip(mesh.shapes, weights, strict=True):
        formed[shape.indices] += weight * shape.offsets_m
    points = np.concatenate([formed, np.ones((len(formed), 1))], axis=1)
    total = np.zeros_like(points)
    for joints, weights in zip(mesh.joint_indices.T, mesh.joint_weights.T, strict=True):
        total += weights[:, None] * np.einsum("pab,pb->pa", moved[joints], points)
    return total[:, :3]
