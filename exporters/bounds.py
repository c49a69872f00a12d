"""The bounding box of a moving character, without skinning any point."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.character.character import Character
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import FloatArray


def joint_reach_m(character: Character) -> FloatArray:
    """Return the greatest distance of each joint's points from it, ``(j,)``; -inf without any."""
    reach = np.full(len(character.skeleton), -np.inf)
    joints = character.skeleton.world_from_bind[:, :3, 3]
    for mesh in character.meshes:
        away = np.linalg.norm(mesh.points_m[:, None] - joints[mesh.joint_indices], axis=-1)
        moved = mesh.joint_weights > 0
        np.maximum.at(reach, mesh.joint_indices[moved], away[moved])
    return reach


def body_boxes(
    character: Character, rotation_xyzw: ArrayLike, translation_m: ArrayLike
) -> FloatArray:
    """Return a box ``(n, 2, 3)``, its least and greatest corner, that holds the skin each frame.

    A skinned point is a weighted mean of where each of its joints alone would carry it, and
    joints do not stretch: it lies in the hull of balls around its joints, whose radius is
    `joint_reach_m`. The box holds those balls; it is about a hand's breadth larger than the
    body, and costs forward kinematics alone.
    """
    reach = joint_reach_m(character)
    moving = np.isfinite(reach)
    _, position = forward_kinematics(character.skeleton, rotation_xyzw, translation_m)
    centre, radius = position[:, moving], reach[moving, None]
    return np.stack([(centre - radius).min(axis=1), (centre + radius).max(axis=1)], axis=1)
