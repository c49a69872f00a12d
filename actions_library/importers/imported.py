"""Imported: what a file holds, before it becomes a part of a library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from actions_library.naming import numbered
from smd.character.character import MAX_INFLUENCES, Mesh
from smd.character.roles import body_plan
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError, ImportedFileError
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_matrix,
    rotate,
    sign_continuous,
)

MOST_BYTES = 1 << 30
"""Largest file, or content of an archive, that is read."""

MOST_JOINTS, MOST_FRAMES = 4096, 200_000
"""Of a file that is read: far beyond any character, and little enough to hold."""


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """A named movement of the imported skeleton.

    Attributes
    ----------
    name : in the file.
    rate_hz : frames per second.
    rotation_xyzw : (n, j, 4) of each joint in its parent's frame, or the world's for a root.
    translation_m : (n, j, 3).
    """

    name: str
    rate_hz: float
    rotation_xyzw: FloatArray
    translation_m: FloatArray

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame."""
        return (len(self.rotation_xyzw) - 1) / self.rate_hz


@dataclass(frozen=True, slots=True, eq=False)
class Imported:
    """What a file holds, in metres, +Y up; where it stands and faces is still the file's.

    Attributes
    ----------
    path : of the file.
    skeleton : its rest pose is the file's. Joints have the file's names, made unique.
    meshes : bound to it; none in files of movement alone.
    animations : by the file's order.
    notes : what the file holds and was left out, one line each.
    """

    path: Path
    skeleton: Skeleton
    meshes: tuple[Mesh, ...]
    animations: tuple[Animation, ...]
    notes: tuple[str, ...] = ()

    def animation(self, name: str | None) -> Animation:
        """Return the animation of a name, or the only one.

        Raises
        ------
        ImportedFileError
            If there is none of that name, or the name is None and there are several.
        """
        named = [a for a in self.animations if name in (None, a.name)]
        if len(named) == 1 or (named and name is not None):
            return named[0]
        known = ", ".join(a.name for a in self.animations) or "no animation"
        raise fault(self.path, "clip", f"one of {known}", "none given" if name is None else name)

    def part(self, animation: Animation, start_s: float | None, end_s: float | None) -> Animation:
        """Return the part of an animation between two times, at least two frames.

        Raises
        ------
        ImportedFileError
            If less than that lies between them.
        """
        rate_hz, last = animation.rate_hz, len(animation.rotation_xyzw) - 1
        first = 0 if start_s is None else round(start_s * rate_hz)
        final = last if end_s is None else min(round(end_s * rate_hz), last)
        if final - first < 1:
            span = f"{first / rate_hz:.2f} to {final / rate_hz:.2f} s"
            within = f"a start before an end within {animation.duration_s:.2f} s"
            raise fault(self.path, f"clip {animation.name!r}", within, span)
        rows = slice(first, final + 1)
        return replace(
            animation,
            rotation_xyzw=animation.rotation_xyzw[rows],
            translation_m=animation.translation_m[rows],
        )


def fault(path: Path, place: str, expected: str, found: object) -> ImportedFileError:
    """Return the error for a file: where in it, what was expected, what was found."""
    where = f"{path}: {place}: " if place else f"{path}: "
    return ImportedFileError(f"{where}expected {expected}, found {found}")


def unique_names(names: Sequence[str]) -> tuple[str, ...]:
    """Return the names, numbered from the second of a kind on; who has none is a joint."""
    return tuple(numbered(name or f"joint_{i}" for i, name in enumerate(names)))


def rigid(
    path: Path, place: str, world: FloatArray, parents: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    """Return local rotations ``(…, j, 4)`` and translations ``(…, j, 3)`` of joints in the world.

    A joint's scale is left out, but not what it does to the places of those below it.

    Parameters
    ----------
    world
        ``(…, j, 4, 4)`` matrices that act on columns.

    Raises
    ------
    ImportedFileError
        If a matrix is not finite, or scales an axis to nothing.
    """
    if not np.isfinite(world).all():
        raise fault(path, place, "finite transforms", "one that is not")
    axes = world[..., :3, :3]
    length = np.linalg.norm(axes, axis=-2, keepdims=True)
    if length.size and length.min() < 1e-9:
        joint = int(np.argwhere(length[..., 0, :].min(axis=-1) < 1e-9)[0][-1])
        raise fault(path, place, "scales above zero", f"zero at joint {joint}")
    axes = axes / length
    mirrored = np.linalg.det(axes) < 0.0  # a negative scale: of the file, not of the pose
    axes = np.where(mirrored[..., None, None], -axes, axes)
    rotation = quaternion_from_matrix(axes)
    position = world[..., :3, 3]
    local_q, local_t = rotation.copy(), position.copy()
    for j, parent in enumerate(parents):
        if parent >= 0:
            back = inverse(rotation[..., parent, :])
            local_t[..., j, :] = rotate(back, position[..., j, :] - position[..., parent, :])
            local_q[..., j, :] = multiply(back, rotation[..., j, :])
    if local_q.ndim == 3:
        local_q = sign_continuous(local_q)
    return local_q, local_t


def skeleton_of(
    path: Path,
    names: Sequence[str],
    parents: Sequence[int],
    rest_world: FloatArray,
    bind_world: FloatArray,
) -> Skeleton:
    """Return the skeleton of joints in the world, ``(j, 4, 4)`` at rest and when bound."""
    if not names:
        raise fault(path, "", "a skeleton", "no joint")
    if len(names) > MOST_JOINTS:
        raise fault(path, "", f"at most {MOST_JOINTS} joints", len(names))
    rotation, translation = rigid(path, "rest pose", rest_world, parents)
    # Bind poses keep no scale either: points are stored in the size they have at rest.
    bind_q, bind_t = rigid(path, "bind pose", bind_world, [-1] * len(names))
    bind = np.tile(np.eye(4), (len(names), 1, 1))
    bind[:, :3, :3], bind[:, :3, 3] = matrix_from_quaternion(bind_q), bind_t
    try:
        return Skeleton(
            joints=unique_names(names),
            parents=np.asarray(parents),
            rest_rotation_xyzw=rotation,
            rest_translation_m=translation,
            world_from_bind=bind,
            roles=body_plan(unique_names(names), parents, rest_world[:, :3, 3]).roles,
        )
    except CharacterError as error:
        raise ImportedFileError(f"{path}: {error}") from error


def strongest(indices: IntArray, weights: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the four strongest influences of each point, weights summing to 1.

    Parameters
    ----------
    indices, weights
        ``(p, k)``, any k. A point that nothing moves goes with its first joint.
    """
    p, k = weights.shape
    if k < MAX_INFLUENCES:
        pad = ((0, 0), (0, MAX_INFLUENCES - k))
        indices, weights = np.pad(indices, pad), np.pad(weights, pad)
    order = np.argsort(-weights, axis=1, kind="stable")[:, :MAX_INFLUENCES]
    rows = np.arange(p)[:, None]
    indices, weights = indices[rows, order], np.maximum(weights[rows, order], 0.0)
    total = weights.sum(axis=1, keepdims=True)
    weights = np.where(total > 1e-9, weights / np.maximum(total, 1e-9), [1.0, 0.0, 0.0, 0.0])
    return np.where(weights > 0.0, indices, 0).astype(np.int64), weights


def bound(points: FloatArray, weights: FloatArray, indices: IntArray, m: FloatArray) -> FloatArray:
    """Return points moved by the weighted mean of their joints' matrices ``(j, 4, 4)``."""
    mean = np.einsum("pk,pkab->pab", weights, m[indices])
    return np.asarray(np.einsum("pab,pb->pa", mean[:, :3, :3], points) + mean[:, :3, 3])


AXIS = {
    sign + axis: (-1.0 if sign else 1.0) * np.eye(3)[i]
    for sign in ("", "-")
    for i, axis in enumerate("xyz")
}


def to_y_up(path: Path, up: str) -> FloatArray:
    """Return the rotation ``(3, 3)`` that takes a file's up axis to +Y, the shortest way."""
    if up not in AXIS:
        raise fault(path, "up", f"one of {', '.join(AXIS)}", repr(up))
    axis = AXIS[up]
    if axis[1] < 0.0:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.cross(axis, [0.0, 1.0, 0.0])
    turned = np.array(
        [[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]]
    )
    return np.eye(3) + turned + turned @ turned / (1.0 + axis[1])


def checked_unit(path: Path, unit_m: float) -> float:
    """Return a unit, if it is one."""
    if not (np.isfinite(unit_m) and unit_m > 0.0):
        raise fault(path, "unit", "a positive number of metres", unit_m)
    return unit_m
