"""The shipped humanoid's skeleton: 1.75 m tall, bound with its arms 45° down, facing +Z.

Every joint's rest frame is turned as the world's, so that a rotation about a joint's own +X
bends it forward, about +Y turns it left, about +Z tilts it to its right.
"""

from __future__ import annotations

import numpy as np

from actions_library.authoring.hand_shape import left_fingers
from smd.character.skeleton import Role, Skeleton

HEIGHT_M = 1.75

_Row = tuple[str, str, tuple[float, float, float], Role]


def _finger_rows() -> list[_Row]:
    """Return the fingers' joints, each finger's from the hand to the tip."""
    rows: list[_Row] = []
    for finger in left_fingers():
        for k, (joint, parent) in enumerate(
            zip(finger.joints, ("hand", *finger.joints), strict=False)
        ):
            x, y, z = finger.places[k].tolist()
            rows.append((joint, parent, (x, y, z), "end_effector" if k == 2 else "intermediate"))
    return rows


# (joint, parent, x, y, z in the world at rest, role); the left side, mirrored below.
_CENTRE: list[_Row] = [
    ("root", "", (0.0, 0.0, 0.0), "root"),
    ("hips", "root", (0.0, 0.955, 0.0), "root"),
    ("spine", "hips", (0.0, 1.045, -0.005), "spine"),
    ("chest", "spine", (0.0, 1.155, -0.012), "spine"),
    ("upper_chest", "chest", (0.0, 1.275, -0.012), "spine"),
    ("neck", "upper_chest", (0.0, 1.455, -0.005), "spine"),
    ("head", "neck", (0.0, 1.545, 0.015), "spine"),
]
_LEFT: list[_Row] = [
    ("eye", "head", (0.033, 1.624, 0.0715), "end_effector"),
    ("shoulder", "upper_chest", (0.030, 1.410, 0.005), "intermediate"),
    ("upper_arm", "shoulder", (0.175, 1.405, -0.010), "intermediate"),
    ("lower_arm", "upper_arm", (0.375, 1.205, -0.020), "intermediate"),
    ("hand", "lower_arm", (0.553, 1.027, 0.000), "intermediate"),
    *_finger_rows(),
    ("upper_leg", "hips", (0.092, 0.905, 0.000), "intermediate"),
    ("lower_leg", "upper_leg", (0.094, 0.492, 0.008), "intermediate"),
    ("foot", "lower_leg", (0.096, 0.085, -0.020), "intermediate"),
    ("toes", "foot", (0.100, 0.022, 0.115), "end_effector"),
]


def humanoid_skeleton() -> Skeleton:
    """Return the skeleton: 55 joints, all rest rotations identity."""
    rows = list(_CENTRE)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, parent, (x, y, z), role in _LEFT:
            central = parent in {row[0] for row in _CENTRE}
            rows.append(
                (
                    f"{side}_{name}",
                    parent if central else f"{side}_{parent}",
                    (sign * x, y, z),
                    role,
                )
            )
    joints = tuple(row[0] for row in rows)
    parents = np.array([joints.index(row[1]) if row[1] else -1 for row in rows])
    world = np.array([row[2] for row in rows])
    local = world - np.where(parents[:, None] >= 0, world[parents], 0.0)
    world_from_bind = np.tile(np.eye(4), (len(joints), 1, 1))
    world_from_bind[:, :3, 3] = world
    return Skeleton(
        joints=joints,
        parents=parents,
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (len(joints), 1)),
        rest_translation_m=local,
        world_from_bind=world_from_bind,
        roles=tuple(row[3] for row in rows),
    )
