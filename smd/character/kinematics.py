"""Forward kinematics."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
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
    joints = range(len(skeleton))
    rotation = np.asarray(rotation_xyzw, dtype=np.float64)
    return joints_in_world(skeleton, joints, rotation, np.asarray(translation_m, dtype=np.float64))


@lru_cache(maxsize=16)
def rest_in_world(skeleton: Skeleton) -> tuple[FloatArray, FloatArray]:
    """Return each joint's rotation ``(j, 4)`` and position ``(j, 3)`` in the world at rest.

    They are read-only: computed once for a skeleton.
    """
    local = skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
    rotation, place = forward_kinematics(skeleton, *local)
    rotation.flags.writeable = place.flags.writeable = False
    return rotation, place


def joints_in_world(
    skeleton: Skeleton, joints: Sequence[int], rotation_xyzw: FloatArray, translation_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return some joints' rotations ``(…, k, 4)`` and positions ``(…, k, 3)`` in the world.

    As `forward_kinematics`, but for these joints and what they hang from alone.
    """
    lineage = _lineage(tuple(joints), tuple(skeleton.parents.tolist()))
    # Joints first: a generation is one block of memory.
    local_q = np.moveaxis(rotation_xyzw, -2, 0).take(lineage.order, axis=0)
    local_t = np.moveaxis(translation_m, -2, 0).take(lineage.order, axis=0)
    world_q, world_p = np.empty_like(local_q), np.empty_like(local_t)
    for at, above in lineage.generations:
        if len(above) == 0:
            world_q[at], world_p[at] = local_q[at], local_t[at]
            continue
        parent_q = world_q.take(above, axis=0)
        world_q[at] = multiply(parent_q, local_q[at])
        world_p[at] = world_p.take(above, axis=0) + rotate(parent_q, local_t[at])
    rotation, place = world_q.take(lineage.rows, axis=0), world_p.take(lineage.rows, axis=0)
    return np.moveaxis(rotation, 0, -2), np.moveaxis(place, 0, -2)


class _Lineage(NamedTuple):
    """Joints and what they hang from, roots first.

    ``order`` are their indices in the skeleton. ``generations`` are slices of them, each with where
    its parents are among them, none for the roots. ``rows`` is where the joints are that were asked
    for.
    """

    order: IntArray
    generations: list[tuple[slice, IntArray]]
    rows: IntArray


@lru_cache(maxsize=256)
def _lineage(joints: tuple[int, ...], parents: tuple[int, ...]) -> _Lineage:
    """Return some joints and what they hang from."""
    depth: dict[int, int] = {}
    for joint in joints:
        way = []
        while joint >= 0 and joint not in depth:
            way.append(joint)
            joint = parents[joint]
        for below in reversed(way):
            depth[below] = depth.get(parents[below], -1) + 1
    order = sorted(depth, key=lambda joint: (depth[joint], joint))
    of = {joint: row for row, joint in enumerate(order)}
    generations = []
    for _, members in groupby(order, key=depth.__getitem__):
        own = list(members)
        above = [of[parents[joint]] for joint in own if parents[joint] >= 0]
        at = slice(of[own[0]], of[own[-1]] + 1)
        generations.append((at, np.array(above, dtype=np.int64)))
    rows = [of[joint] for joint in joints]
    return _Lineage(np.array(order, np.int64), generations, np.array(rows, np.int64))
