"""Forward kinematics."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import multiply, rotate


def forward_kinematics(
    skeleton: Skeleton, rotation_xyzw: ArrayLike, translation_m: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return each joint's rotation ``(…, j, 4)`` and position ``(…, j, 3)`` in the world.

    Parameters
    ----------
    skeleton
        Gives the tree.
    rotation_xyzw, translation_m
        Local poses ``(…, j, 4)`` and ``(…, j, 3)``; any leading axes.
    """
    local_q = np.asarray(rotation_xyzw, dtype=np.float64)
    local_t = np.asarray(translation_m, dtype=np.float64)
    world_q, world_p = np.empty_like(local_q), np.empty_like(local_t)
    for joints, parents in _generations(skeleton.parents.tolist()):
        q, t = local_q[..., joints, :], local_t[..., joints, :]
        if parents[0] < 0:
            world_q[..., joints, :], world_p[..., joints, :] = q, t
            continue
        parent_q = world_q[..., parents, :]
        world_q[..., joints, :] = multiply(parent_q, q)
        world_p[..., joints, :] = world_p[..., parents, :] + rotate(parent_q, t)
    return world_q, world_p


def _generations(parents: list[int]) -> Iterator[tuple[list[int], list[int]]]:
    """Yield the roots, their children, and so on; of each joints and their parents."""
    depth: list[int] = []
    for parent in parents:
        depth.append(0 if parent < 0 else depth[parent] + 1)
    for generation in range(max(depth) + 1):
        joints = [joint for joint, at in enumerate(depth) if at == generation]
        yield joints, [parents[joint] for joint in joints]
