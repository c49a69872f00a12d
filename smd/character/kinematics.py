"""Forward kinematics."""

from __future__ import annotations

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
    for joint, parent in enumerate(skeleton.parents):
        q, t = local_q[..., joint, :], local_t[..., joint, :]
        if parent < 0:
            world_q[..., joint, :], world_p[..., joint, :] = q, t
            continue
        parent_q = world_q[..., parent, :]
        world_q[..., joint, :] = multiply(parent_q, q)
        world_p[..., joint, :] = world_p[..., parent, :] + rotate(parent_q, t)
    return world_q, world_p
