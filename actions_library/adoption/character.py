"""An imported figure as a character of ours: on the ground, facing +Z, below a ground root."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from actions_library.importers.imported import Imported, unique_names
from laban.faults import Fault
from smd.character.character import Character, Mesh
from smd.character.kinematics import forward_kinematics
from smd.character.roles import BodyPlan, body_plan
from smd.character.skeleton import Skeleton
from smd.errors import ImportedFileError
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    matrix_from_quaternion,
    multiply,
    quaternion_about,
    rotate,
)

GROUND_ROOT = "ground_root"
"""Name of the joint that carries the root motion; numbered where a file has that name."""


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """Rotation and shift that make an imported figure stand at the origin, facing +Z.

    Attributes
    ----------
    turn_xyzw : (4,) about +Y, first.
    shift_m : (3,) then.
    height_m : of the figure.
    """

    turn_xyzw: FloatArray
    shift_m: FloatArray
    height_m: float


def plan_of(imported: Imported, *, front: Sequence[float] | None = None) -> BodyPlan:
    """Return the body plan of an imported skeleton; ``front`` overrides the guess of its front."""
    skeleton = imported.skeleton
    _, place = rest_pose(skeleton)
    return body_plan(skeleton.joints, skeleton.parents.tolist(), place, front=front)


def rest_pose(skeleton: Skeleton) -> tuple[FloatArray, FloatArray]:
    """Return rotations ``(j, 4)`` and positions ``(j, 3)`` of the joints in the world at rest."""
    return forward_kinematics(skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)


def standing_of(imported: Imported, plan: BodyPlan) -> Standing:
    """Return the rotation and shift that make a figure stand.

    The ground is below its lowest point; the origin between its feet, or below its pelvis.
    """
    _, place = rest_pose(imported.skeleton)
    turn = quaternion_about([0.0, 1.0, 0.0], -np.arctan2(plan.front[0], plan.front[2]))
    place = rotate(turn, place)
    points = [rotate(turn, mesh.points_m) for mesh in imported.meshes]
    everything = np.concatenate([place, *points])
    feet = [limb.end for limb in plan.limbs if limb.kind == "leg"]
    middle = place[feet].mean(axis=0) if feet else place[plan.pelvis]
    lowest, highest = everything[:, 1].min(), everything[:, 1].max()
    shift = np.array([-middle[0], -lowest, -middle[2]])
    return Standing(turn, shift, float(highest - lowest))


def adopted_character(
    imported: Imported, name: str, *, front: Sequence[float] | None = None
) -> Character:
    """Return an imported figure as a character.

    Raises
    ------
    ImportedFileError
        If the file holds no mesh that its joints move.
    """
    if not imported.meshes:
        fault = Fault("", "a character with a mesh", "a skeleton alone")
        raise fault.of(imported.path, ImportedFileError)
    standing = standing_of(imported, plan_of(imported, front=front))
    if _has_ground_root(imported.skeleton, standing):
        return Character(name, imported.skeleton, _with_unique_names(imported.meshes))
    skeleton = grounded_skeleton(imported.skeleton, standing)
    meshes = tuple(
        replace(
            mesh,
            points_m=rotate(standing.turn_xyzw, mesh.points_m) + standing.shift_m,
            joint_indices=np.where(mesh.joint_weights > 0.0, mesh.joint_indices + 1, 0),
            shapes=tuple(
                replace(shape, offsets_m=rotate(standing.turn_xyzw, shape.offsets_m))
                for shape in mesh.shapes
            ),
        )
        for mesh in imported.meshes
    )
    return Character(name, skeleton, _with_unique_names(meshes))


def _has_ground_root(skeleton: Skeleton, standing: Standing) -> bool:
    """Return whether a figure stands already, and its first joint on the ground between its feet.

    Then that joint is the ground root; all others must be its descendants.
    """
    there = np.linalg.norm(skeleton.rest_translation_m[0]) < 1e-3 * standing.height_m
    level = abs(float(skeleton.rest_rotation_xyzw[0] @ IDENTITY_XYZW)) > 1.0 - 1e-9
    turned = abs(float(standing.turn_xyzw @ IDENTITY_XYZW)) < 1.0 - 1e-6
    near = np.linalg.norm(standing.shift_m) < 0.05 * standing.height_m
    alone = bool((skeleton.parents[1:] >= 0).all()) and len(skeleton) > 1
    return bool(there and level and near and alone and not turned)


def grounded_skeleton(skeleton: Skeleton, standing: Standing) -> Skeleton:
    """Return a skeleton that stands at the origin, below a new first joint on the ground."""
    roots = skeleton.parents < 0
    rotation = skeleton.rest_rotation_xyzw.copy()
    translation = skeleton.rest_translation_m.copy()
    rotation[roots] = multiply(standing.turn_xyzw, rotation[roots])
    translation[roots] = rotate(standing.turn_xyzw, translation[roots]) + standing.shift_m
    change = np.eye(4)
    change[:3, :3] = matrix_from_quaternion(standing.turn_xyzw)
    change[:3, 3] = standing.shift_m
    return Skeleton(
        joints=unique_names([*skeleton.joints, GROUND_ROOT])[-1:] + skeleton.joints,
        parents=np.concatenate([[-1], skeleton.parents + 1]),
        rest_rotation_xyzw=np.concatenate([[IDENTITY_XYZW], rotation]),
        rest_translation_m=np.concatenate([np.zeros((1, 3)), translation]),
        world_from_bind=np.concatenate([np.eye(4)[None], change @ skeleton.world_from_bind]),
        roles=("root", *skeleton.roles),
    )


def _with_unique_names(meshes: Sequence[Mesh]) -> tuple[Mesh, ...]:
    names = unique_names([mesh.name for mesh in meshes])
    return tuple(replace(mesh, name=name) for mesh, name in zip(meshes, names, strict=True))
