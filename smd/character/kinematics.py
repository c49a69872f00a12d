"""Forward kinematics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

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
    return _down_the_tree(
        skeleton.parents.tolist(),
        np.asarray(rotation_xyzw, dtype=np.float64),
        np.asarray(translation_m, dtype=np.float64),
    )


def joints_in_world(
    skeleton: Skeleton, joints: Sequence[int], rotation_xyzw: FloatArray, translation_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return some joints' rotations ``(…, k, 4)`` and positions ``(…, k, 3)`` in the world.

    As `forward_kinematics`, but for these joints and what they hang from alone.
    """
    parents = skeleton.parents.tolist()
    above: set[int] = set()
    for joint in joints:
        while joint >= 0 and joint not in above:
            above.add(joint)
            joint = parents[joint]
    order = sorted(above)
    of = {joint: row for row, joint in enumerate(order)}
    q, p = _down_the_tree(
        [of.get(parents[joint], -1) for joint in order],
        rotation_xyzw[..., order, :],
        translation_m[..., order, :],
    )
    rows = [of[joint] for joint in joints]
    return q[..., rows, :], p[..., rows, :]


def _down_the_tree(
    parents: list[int], local_q: FloatArray, local_t: FloatArray
) -> tuple[FloatArray, FloatArray]:
    world_q, world_p = np.empty_like(local_q), np.empty_like(local_t)
    for joints, above in _generations(parents):
        q, t = local_q[..., joints, :], local_t[..., joints, :]
        if above[0] < 0:
            world_q[..., joints, :], world_p[..., joints, :] = q, t
            continue
        parent_q = world_q[..., above, :]
        world_q[..., joints, :] = multiply(parent_q, q)
        world_p[..., joints, :] = world_p[..., above, :] + rotate(parent_q, t)
    return world_q, world_p


def _generations(parents: list[int]) -> Iterator[tuple[list[int], list[int]]]:
    """Yield the roots, their children, and so on; of each joints and their parents."""
    depth: list[int] = []
    for parent in parents:
        depth.append(0 if parent < 0 else depth[parent] + 1)
    for generation in range(max(depth, default=-1) + 1):
        joints = [joint for joint, at in enumerate(depth) if at == generation]
        yield joints, [parents[joint] for joint in joints]
