"""A skeleton from a table of joints, its right side mirrored from the left by name.

Every joint's rest frame is turned as the world's: a rotation about a joint's own +X bends it
forward, about +Y turns it left, about +Z tilts it to its right.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from smd.character.skeleton import Role, Skeleton

LEFT, RIGHT = "left_", "right_"

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class JointRow:
    """A joint: its name, its parent's (empty for the root), its place in the world at rest (m)."""

    joint: str
    parent: str
    place: Point
    role: Role


def other_side(name: str) -> str:
    """Return the name on the other side: ``left_…`` and ``right_…`` exchanged, others kept."""
    if name.startswith(LEFT):
        return RIGHT + name.removeprefix(LEFT)
    if name.startswith(RIGHT):
        return LEFT + name.removeprefix(RIGHT)
    return name


def with_right_side(rows: Iterable[JointRow]) -> list[JointRow]:
    """Return the rows, and after them the mirror image of those named ``left_…``."""
    rows = list(rows)
    return rows + [
        JointRow(
            other_side(row.joint),
            other_side(row.parent),
            (-row.place[0], row.place[1], row.place[2]),
            row.role,
        )
        for row in rows
        if row.joint.startswith(LEFT)
    ]


def skeleton_of(rows: Sequence[JointRow]) -> Skeleton:
    """Return the skeleton of rows, parents before children; all rest rotations are identity."""
    joints = tuple(row.joint for row in rows)
    parents = np.array([joints.index(row.parent) if row.parent else -1 for row in rows])
    world = np.array([row.place for row in rows])
    local = world - np.where(parents[:, None] >= 0, world[parents], 0.0)
    world_from_bind = np.tile(np.eye(4), (len(joints), 1, 1))
    world_from_bind[:, :3, 3] = world
    return Skeleton(
        joints=joints,
        parents=parents,
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (len(joints), 1)),
        rest_translation_m=local,
        world_from_bind=world_from_bind,
        roles=tuple(row.role for row in rows),
    )


def place_of(skeleton: Skeleton, joint: str) -> Point:
    """Return where a joint is in the world at rest."""
    x, y, z = skeleton.world_from_bind[skeleton.index(joint), :3, 3].tolist()
    return x, y, z
