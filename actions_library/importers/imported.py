"""Imported: what a file holds, before it becomes a part of a library."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from actions_library.naming import numbered
from laban.faults import Fault, printable
from smd.character.blend_shape import BlendShape
from smd.character.character import MAX_INFLUENCES, Mesh, shape_names
from smd.character.roles import body_plan
from smd.character.skeleton import Skeleton
from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import ImportedFileError
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_matrix,
    rotate,
    sign_continuous,
)

MOST_BYTES = 192 << 20
"""Largest file, or content of an archive, that is read: a few copies of it fit in 1 GiB."""

MOST_JOINTS, DEEPEST, MOST_FRAMES = 1024, 192, 200_000
"""Of a file that is read: joints, joints one below another, and frames of one animation."""

MOST_POSES = 3_000_000
"""Frames times joints, of all of a file's animations: ten minutes of 41 joints at 120 Hz."""

MOST_ANIMATIONS = 2000
"""Of a file: each costs a millisecond, however short it is."""

MOST_POINTS, MOST_TRIANGLES = 1_000_000, 2_000_000
"""Of all of a file's meshes."""

MOST_SHAPES, MOST_OFFSETS = 4096, 10_000_000
"""Of all of a file's meshes: shapes, and points that they move."""


@dataclass(frozen=True, slots=True, eq=False)
class Animation:
    """A named movement of the imported skeleton.

    Attributes
    ----------
    name : in the file.
    rate_hz : frames per second.
    rotation_xyzw : (n, j, 4) of each joint in its parent's frame, or the world's for a root.
    translation_m : (n, j, 3).
    tracks : (n, …) weights of shapes.
    """

    name: str
    rate_hz: float
    rotation_xyzw: FloatArray
    translation_m: FloatArray
    tracks: Tracks = NO_TRACKS

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame."""
        return (len(self.rotation_xyzw) - 1) / self.rate_hz


@dataclass(frozen=True, slots=True, eq=False)
class Imported:
    """What a file holds, in metres, +Y up; its position and front are still the file's.

    Attributes
    ----------
    path : of the file.
    skeleton : its rest pose is the file's. Joints have the file's names, made unique.
    meshes : bound to it; none in files of movement alone.
    animations : by the file's order.
    notes : what the file holds and was left out, one line each.
    rest_tracks : (1, …) weights of shapes where nothing animates them.
    """

    path: Path
    skeleton: Skeleton
    meshes: tuple[Mesh, ...]
    animations: tuple[Animation, ...]
    notes: tuple[str, ...] = ()
    rest_tracks: Tracks = NO_TRACKS

    @property
    def shapes(self) -> tuple[str, ...]:
        """Names of its meshes' shapes, each once."""
        return shape_names(self.meshes)

    def animation(self, name: str | None) -> Animation:
        """Return the animation of a name, or the only one.

        Blender writes an action ``Walk`` of a rig as ``Rig|Walk``; either name will do, where only
        one rig has it.

        Raises
        ------
        ImportedFileError
            If there is none of that name, or the name is None and there are several.
        """
        named = [a for a in self.animations if name in (None, a.name)]
        if len(named) == 1 or (named and name is not None):
            return named[0]
        named = [a for a in self.animations if name == a.name.rpartition("|")[2]]
        if len(named) == 1:
            return named[0]
        known = ", ".join(a.name for a in self.animations) or "no animation"
        found = "none given" if name is None else name
        raise Fault("clip", f"one of {known}", found).of(self.path, ImportedFileError)

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
            bad = Fault(f"clip {animation.name!r}", within, span)
            raise bad.of(self.path, ImportedFileError)
        rows = slice(first, final + 1)
        frames = np.arange(first, final + 1, dtype=np.float64)
        return replace(
            animation,
            rotation_xyzw=animation.rotation_xyzw[rows],
            translation_m=animation.translation_m[rows],
            tracks=animation.tracks.at(frames),
        )


def unique_names(names: Sequence[str], without: str = "joint") -> tuple[str, ...]:
    """Return the names, numbered from the second of a kind on; ``joint_3`` where there is none."""
    return tuple(numbered(printable(n) or f"{without}_{i}" for i, n in enumerate(names)))


def depth_of(parents: Sequence[int]) -> int:
    """Return the depth of the tree of joints; parents come before children."""
    depths: list[int] = []
    for parent in parents:
        depths.append(1 if parent < 0 else depths[parent] + 1)
    return max(depths, default=0)


def check_poses(place: str, frames: float, joints: int, before: int = 0) -> None:
    """Refuse an animation of so many frames, where so many poses of joints came before it.

    Raises
    ------
    Fault
        If there are too many frames, or too many poses in all.
    """
    if not frames <= MOST_FRAMES:
        raise Fault(place, f"at most {MOST_FRAMES} frames", f"{frames:.6g}")
    poses = before + int(frames) * joints
    if poses > MOST_POSES:
        raise Fault(place, f"at most {MOST_POSES} frames times joints", poses)


def rigid(place: str, world: FloatArray, parents: Sequence[int]) -> tuple[FloatArray, FloatArray]:
    """Return local rotations ``(…, j, 4)`` and translations ``(…, j, 3)`` of joints in the world.

    A joint's scale is left out, but not its effect on the positions of its descendants.

    Parameters
    ----------
    world
        ``(…, j, 4, 4)`` matrices that act on columns.

    Raises
    ------
    Fault
        If a matrix is not finite, or scales an axis to nothing.
    """
    if not np.isfinite(world).all():
        raise Fault(place, "finite transforms", "one that is not")
    axes = world[..., :3, :3]
    length = np.linalg.norm(axes, axis=-2, keepdims=True)
    if length.size and length.min() < 1e-9:
        joint = int(np.argwhere(length[..., 0, :].min(axis=-1) < 1e-9)[0][-1])
        raise Fault(place, "scales above zero", f"zero at joint {joint}")
    axes = axes / length
    volume = np.linalg.det(axes)
    if volume.size and np.abs(volume).min() < 1e-6:
        joint = int(np.argwhere(np.abs(volume) < 1e-6)[0][-1])
        raise Fault(place, "axes that span space", f"flat ones at joint {joint}")
    mirrored = volume < 0.0  # a negative scale: of the file, not of the pose
    axes = np.where(mirrored[..., None, None], -axes, axes)
    rotation = quaternion_from_matrix(axes)
    position = world[..., :3, 3]
    local_q, local_t = rotation.copy(), position.copy()
    below = np.flatnonzero(np.asarray(parents) >= 0)
    above = np.asarray(parents, dtype=np.int64)[below]
    back = inverse(rotation[..., above, :])
    local_t[..., below, :] = rotate(back, position[..., below, :] - position[..., above, :])
    local_q[..., below, :] = multiply(back, rotation[..., below, :])
    if local_q.ndim == 3:
        local_q = sign_continuous(local_q)
    return local_q, local_t


def skeleton_of(
    names: Sequence[str],
    parents: Sequence[int],
    rest_world: FloatArray,
    bind_world: FloatArray,
) -> Skeleton:
    """Return the skeleton of joints in the world, ``(j, 4, 4)`` at rest and when bound."""
    if not names:
        raise Fault("", "a skeleton", "no joint")
    if len(names) > MOST_JOINTS:
        raise Fault("", f"at most {MOST_JOINTS} joints", len(names))
    if depth_of(parents) > DEEPEST:
        raise Fault("", f"at most {DEEPEST} joints one below another", depth_of(parents))
    rotation, translation = rigid("rest pose", rest_world, parents)
    # Bind poses keep no scale either: points are stored in the size they have at rest.
    bind_q, bind_t = rigid("bind pose", bind_world, [-1] * len(names))
    bind = np.tile(np.eye(4), (len(names), 1, 1))
    bind[:, :3, :3], bind[:, :3, 3] = matrix_from_quaternion(bind_q), bind_t
    return Skeleton(
        joints=unique_names(names),
        parents=np.asarray(parents),
        rest_rotation_xyzw=rotation,
        rest_translation_m=translation,
        world_from_bind=bind,
        roles=body_plan(unique_names(names), parents, rest_world[:, :3, 3]).roles,
    )


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


def bound_shape(
    shape: BlendShape, weights: FloatArray, indices: IntArray, m: FloatArray
) -> BlendShape:
    """Return a shape whose offsets go with their points, as `bound` moves these."""
    turns = m.copy()
    turns[:, :3, 3] = 0.0
    own = shape.indices
    return replace(shape, offsets_m=bound(shape.offsets_m, weights[own], indices[own], turns))


def bound(points: FloatArray, weights: FloatArray, indices: IntArray, m: FloatArray) -> FloatArray:
    """Return points moved by the weighted mean of their joints' matrices ``(j, 4, 4)``."""
    moved = np.zeros_like(points)
    for k in range(weights.shape[1]):  # one influence at a time: a matrix a point is much to hold
        own = m[indices[:, k]]
        place = np.einsum("pab,pb->pa", own[:, :3, :3], points) + own[:, :3, 3]
        moved += weights[:, k, None] * place
    return moved


AXIS = {
    sign + axis: (-1.0 if sign else 1.0) * np.eye(3)[i]
    for sign in ("", "-")
    for i, axis in enumerate("xyz")
}


def to_y_up(up: str) -> FloatArray:
    """Return the rotation ``(3, 3)`` that takes a file's up axis to +Y, the shortest way."""
    if up not in AXIS:
        raise Fault("up", f"one of {', '.join(AXIS)}", repr(up))
    axis = AXIS[up]
    if axis[1] < 0.0:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.cross(axis, [0.0, 1.0, 0.0])
    turned = np.array(
        [[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]]
    )
    return np.eye(3) + turned + turned @ turned / (1.0 + axis[1])


def checked_unit(unit_m: float) -> float:
    """Return a unit, if it is one."""
    if not (np.isfinite(unit_m) and unit_m > 0.0):
        raise Fault("unit", "a positive number of metres", unit_m)
    return unit_m
