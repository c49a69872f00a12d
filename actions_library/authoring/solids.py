"""Small solids of a few triangles, each moved by one joint: horns, claws, teeth, eyeballs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.rigging import Point, other_side
from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """Points and triangles that one joint moves."""

    joint: str
    points_m: FloatArray
    triangles: IntArray


def globe(joint: str, centre: Point, radii: Point, *, rings: int = 8, around: int = 16) -> Solid:
    """Return an ellipsoid whose poles are at its front and its back."""
    directions, triangles = cap_grid(np.pi, rings, around)
    return Solid(joint, np.array(centre) + directions * np.array(radii), triangles)


def capsule(
    joint: str,
    start: Point,
    end: Point,
    start_radius: float,
    end_radius: float,
    *,
    rings: int = 6,
    around: int = 10,
) -> Solid:
    """Return a rod with round ends; a horn or a claw where one radius is small."""
    directions, triangles = cap_grid(np.pi, rings, around)
    along = normalized(np.array(end) - np.array(start))
    side = np.array([0.0, 1.0, 0.0]) if abs(along[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    across = normalized(np.cross(side, along))
    turned = directions @ np.stack([across, np.cross(along, across), along])
    far = directions[:, 2:] > 1e-9
    base = np.where(far, np.array(end), np.array(start))
    return Solid(joint, base + turned * np.where(far, end_radius, start_radius), triangles)


def cap_grid(polar_rad: float, rings: int, around: int) -> tuple[FloatArray, IntArray]:
    """Return directions around +Z out to a polar angle, and triangles seen from outside.

    At π the ball is closed.
    """
    closed = polar_rad > np.pi - 1e-9
    polar = polar_rad * np.arange(1, rings + (0 if closed else 1)) / rings
    turn = 2.0 * np.pi * np.arange(around) / around
    ring = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.sin(polar), np.sin(turn)),
            np.outer(np.cos(polar), np.ones(around)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    points = np.concatenate([[[0.0, 0.0, 1.0]], ring])
    k = np.arange(around)
    after = (k + 1) % around
    faces = [np.column_stack([0 * k, 1 + k, 1 + after])]
    for r in range(len(polar) - 1):
        a, b = 1 + r * around + k, 1 + r * around + after
        faces += [np.column_stack([a, a + around, b]), np.column_stack([b, a + around, b + around])]
    if closed:
        last = len(points)
        points = np.concatenate([points, [[0.0, 0.0, -1.0]]])
        end = 1 + (len(polar) - 1) * around
        faces.append(np.column_stack([end + k, 0 * k + last, end + after]))
    return points, np.concatenate(faces).astype(np.int64)


def image_of_solid(solid: Solid) -> Solid:
    """Return the mirror image, moved by the joint of the other side."""
    return Solid(
        other_side(solid.joint),
        solid.points_m * np.array([-1.0, 1.0, 1.0]),
        solid.triangles[:, ::-1],
    )


def on_both_sides_of(solids: Iterable[Solid]) -> list[Solid]:
    """Return solids and their mirror images."""
    return [one for solid in solids for one in (solid, image_of_solid(solid))]


def solid_mesh(
    name: str, skeleton: Skeleton, solids: Iterable[Solid], color_rgb: tuple[float, float, float]
) -> Mesh:
    """Return one mesh of several solids."""
    points, triangles, joints, count = [], [], [], 0
    for solid in solids:
        points.append(solid.points_m)
        triangles.append(solid.triangles + count)
        joints.append(np.full(len(solid.points_m), skeleton.index(solid.joint)))
        count += len(solid.points_m)
    indices, weights = np.zeros((count, 4), dtype=np.int64), np.zeros((count, 4))
    indices[:, 0], weights[:, 0] = np.concatenate(joints), 1.0
    return Mesh(
        name, np.concatenate(points), np.concatenate(triangles), indices, weights, color_rgb
    )
