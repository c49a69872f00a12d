"""What holds the skin of a character, moving or not, without skinning any point.

Where shapes move a point before its joints do, it is within a ball around where it was bound: of
the sum of their offsets' lengths, each times the largest weight that it ever has.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from smd.character.character import Character, Mesh
from smd.character.kinematics import forward_kinematics
from smd.character.tracks import NO_TRACKS, Tracks
from smd.geometry.arrays import FloatArray


def formed_by_m(mesh: Mesh, tracks: Tracks) -> FloatArray:
    """Return how far shapes move each point at most, ``(p,)``, while they have these weights."""
    found = np.zeros(len(mesh.points_m))
    most = np.abs(tracks.of(shape.name for shape in mesh.shapes)).max(axis=0, initial=0.0)
    for shape, weight in zip(mesh.shapes, most, strict=True):
        found[shape.indices] += weight * np.linalg.norm(shape.offsets_m, axis=-1)
    return found


def joint_reach_m(character: Character, tracks: Tracks = NO_TRACKS) -> FloatArray:
    """Return the greatest distance of each joint's points from it, ``(j,)``; -inf without any."""
    reach = np.full(len(character.skeleton), -np.inf)
    joints = character.skeleton.world_from_bind[:, :3, 3]
    for mesh in character.meshes:
        away = np.linalg.norm(mesh.points_m[:, None] - joints[mesh.joint_indices], axis=-1)
        away += formed_by_m(mesh, tracks)[:, None]
        moved = mesh.joint_weights > 0
        np.maximum.at(reach, mesh.joint_indices[moved], away[moved])
    return reach


def joint_boxes(character: Character, tracks: Tracks = NO_TRACKS) -> FloatArray:
    """Return the corners of a box ``(j, 8, 3)`` in each joint's frame that holds what it moves.

    That is the joint itself and the skin. A joint without skin that no other hangs from is given a
    tip, as far away as the joint is from its parent: where it turns is seen all the same.
    """
    skeleton = character.skeleton
    low, high = np.zeros((len(skeleton), 3)), np.zeros((len(skeleton), 3))
    bind = skeleton.world_from_bind
    bare = np.ones(len(skeleton), dtype=bool)
    bare[skeleton.parents[skeleton.parents >= 0]] = False
    for mesh in character.meshes:
        point, place = np.nonzero(mesh.joint_weights > 0)
        joint = mesh.joint_indices[point, place]
        away = mesh.points_m[point] - bind[joint, :3, 3]
        local = np.einsum("kij,ki->kj", bind[joint, :3, :3], away)
        around = formed_by_m(mesh, tracks)[point, None]
        np.minimum.at(low, joint, local - around)
        np.maximum.at(high, joint, local + around)
        bare[joint] = False
    tip = np.where(bare, np.linalg.norm(skeleton.rest_translation_m, axis=-1), 0.0)[:, None]
    low, high = np.minimum(low, -tip), np.maximum(high, tip)
    upper = np.array(list(np.ndindex(2, 2, 2)), dtype=bool)
    return np.where(upper, high[:, None], low[:, None])


def body_boxes(
    character: Character,
    rotation_xyzw: ArrayLike,
    translation_m: ArrayLike,
    tracks: Tracks = NO_TRACKS,
) -> FloatArray:
    """Return a box ``(n, 2, 3)``, its least and greatest corner, that holds the skin each frame.

    A skinned point is a weighted mean of where each of its joints alone would carry it, and
    joints do not stretch: it lies in the hull of balls around its joints, whose radius is
    `joint_reach_m`. The box holds those balls; it is about a hand's breadth larger than the
    body, and costs forward kinematics alone.
    """
    reach = joint_reach_m(character, tracks)
    moving = np.isfinite(reach)
    _, position = forward_kinematics(character.skeleton, rotation_xyzw, translation_m)
    centre, radius = position[:, moving], reach[moving, None]
    return np.stack([(centre - radius).min(axis=1), (centre + radius).max(axis=1)], axis=1)
