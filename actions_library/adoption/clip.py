"""An imported animation as a clip of a character: retargeted, with ground root and labels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from actions_library.adoption.carrying import (
    bones,
    carried_over,
    leg_length_m,
    partners,
    stature_m,
)
from actions_library.adoption.character import plan_of, rest_pose, standing_of
from actions_library.adoption.rooting import Ground, found_ground, repeats, wants_first_frame
from actions_library.importers.imported import Animation, Imported
from smd.character.character import Character
from smd.character.clip import Clip
from smd.character.contacts import contacts
from smd.character.kinematics import forward_kinematics
from smd.character.roles import BodyPlan, body_plan
from smd.character.skeleton import Skeleton
from smd.character.stages import stage_end_frames
from smd.character.tracks import Tracks
from smd.errors import CharacterError, ImportedFileError
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    inverse,
    multiply,
    rotate,
    sign_continuous,
    slerp,
)

SAME_BONE = 0.02
"""Greatest difference in length of equal bones, as a share of the character's height."""

SAME_REST_COSINE = 0.996
"""Cosine of half the angle by which equal joints may differ at rest: 10 degrees."""


MOST_HOVERING = 0.2
"""Height of the feet at their lowest, in leg lengths, that is taken for a mistake."""

TREADMILL_TOLERANCE = 2.5
"""Factor on the thresholds of a contact on a treadmill: the speed of the belt is constant in a
cycle, that of the feet is not."""

CLOSING = 0.25
"""Last share of a cycle, over which the gap to its beginning is closed."""


@dataclass(frozen=True, slots=True, eq=False)
class Adopted:
    """A clip, and what was estimated about it.

    Attributes
    ----------
    clip : of the character.
    ground : how its ground root was found.
    same_skeleton : whether it was of this skeleton; else it was carried over by roles.
    left_out : names of its tracks that the character has no shape for.
    """

    clip: Clip
    ground: Ground
    same_skeleton: bool
    left_out: tuple[str, ...] = ()


def adopted_clip(
    imported: Imported,
    animation: Animation,
    character: Character,
    name: str,
    *,
    travels: bool | None = None,
    cyclic: bool | None = None,
    front: Sequence[float] | None = None,
) -> Adopted:
    """Return an imported animation as a clip of a character.

    Parameters
    ----------
    imported, animation
        Of which file, and which of its animations.
    character
        Of which the clip will be; its first joint is the ground root.
    name
        Of the action.
    travels, cyclic
        What it is; by default guessed: it travels if it gets far, and repeats if it ends as it
        began.
    front
        Level direction in which the imported figure faces, where the guess is wrong.

    Raises
    ------
    ImportedFileError
        If the skeletons are not of the same kind.
    """
    source = plan_of(imported, front=front)
    world_q, world_p = _world(imported, animation, source)
    skeleton = character.skeleton
    same = _same_joints(imported.skeleton, skeleton, character.height_m)
    rest = rest_pose(skeleton)
    target = body_plan(skeleton.joints, skeleton.parents.tolist(), rest[1], front=(0.0, 0.0, 1.0))
    if same is not None:
        world_q, pelvis = _of_same(world_q, world_p, skeleton, same, imported, target)
    else:
        try:
            world_q, pelvis = _of_other(world_q, world_p, imported, source, skeleton, target)
        except CharacterError as error:
            raise ImportedFileError(f"{imported.path}: {error}") from error
    cyclic = repeats(world_q) if cyclic is None else cyclic
    tracks = animation.tracks.among(character.shapes)
    if cyclic and wants_first_frame(world_q):
        tracks = tracks.at(np.append(np.arange(len(world_q)), 0.0))
        step = (pelvis[-1] - pelvis[0]) / (len(pelvis) - 1) * [1.0, 0.0, 1.0]
        world_q = np.concatenate([world_q, world_q[:1]])
        pelvis = np.concatenate([pelvis, pelvis[:1] + step * len(pelvis)])
    leg_m = stature_m(target, rest[1])
    feet = [limb.chain[-1] for limb in target.limbs if limb.kind == "leg"]
    still = _Root(np.zeros((len(pelvis), 3)), np.tile(IDENTITY_XYZW, (len(pelvis), 1)))
    _, place = forward_kinematics(skeleton, *_local(skeleton, rest, target, world_q, pelvis, still))
    pelvis = pelvis - [0.0, _hovering_m(place[:, feet], rest[1][feet], leg_m), 0.0]
    ground = found_ground(
        world_q,
        pelvis,
        target.pelvis,
        rest[0][target.pelvis],
        place[:, feet],
        animation.rate_hz,
        leg_m,
        travels=travels,
        cyclic=cyclic,
    )
    rotation, translation = _local(
        skeleton,
        rest,
        target,
        multiply(ground.pelvis_turn_xyzw, world_q),
        ground.pelvis_m,
        _Root(ground.position_m, ground.rotation_xyzw),
    )
    if ground.cyclic:
        rotation, translation = _closed(rotation, translation)
        tracks = _closed_tracks(tracks)
    clip = _labelled(
        rotation,
        translation,
        tracks,
        ground,
        skeleton,
        target,
        rest[1],
        name,
        animation.rate_hz,
        leg_m,
    )
    return Adopted(clip, ground, same is not None, animation.tracks.without(character.shapes).names)


class _Root(NamedTuple):
    """Position ``(n, 3)`` and rotation ``(n, 4)`` of the ground root."""

    position_m: FloatArray
    rotation_xyzw: FloatArray


def _hovering_m(feet_m: FloatArray, rest_m: FloatArray, leg_m: float) -> float:
    """Return how far above the ground the feet stay at their lowest; 0 if that is no mistake."""
    if feet_m.shape[1] == 0:
        return 0.0
    lowest = float((feet_m[..., 1] - rest_m[:, 1]).min())
    return lowest if abs(lowest) < MOST_HOVERING * leg_m else 0.0


def _closing(count: int) -> FloatArray:
    """Return the share of the gap that is closed in each of a cycle's frames, ``(n, 1)``."""
    u = np.clip((np.arange(count) / (count - 1) - (1.0 - CLOSING)) / CLOSING, 0.0, 1.0)
    return (u * u * (3.0 - 2.0 * u))[:, None]


def _closed_tracks(tracks: Tracks) -> Tracks:
    """Return tracks of a cycle, their last values equal to the first, as `_closed` does it."""
    if not tracks.names:
        return tracks
    gap = tracks.value[0] - tracks.value[-1]
    return Tracks(tracks.names, tracks.value + _closing(len(tracks)) * gap)


def _closed(rotation: FloatArray, translation: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a cycle whose last frame equals its first, except for the ground root.

    The gap is distributed over its last part.
    """
    n = len(rotation)
    share = _closing(n)
    gap = multiply(inverse(rotation[-1]), rotation[0])
    none = np.broadcast_to(IDENTITY_XYZW, gap.shape)
    closed = multiply(rotation, slerp(none, gap, np.broadcast_to(share, (n, rotation.shape[1]))))
    placed = translation + share[..., None] * (translation[0] - translation[-1])
    closed[:, 0], placed[:, 0] = rotation[:, 0], translation[:, 0]
    return sign_continuous(closed), placed


def _world(
    imported: Imported, animation: Animation, plan: BodyPlan
) -> tuple[FloatArray, FloatArray]:
    """Return joints over time in the world, the figure turned to face +Z and on the ground.

    The height of the ground follows from the rest pose or from the movement itself, whichever has
    the feet nearer to it: in motion capture, the rest pose often hangs below the origin.
    """
    standing = standing_of(imported, plan)
    q, p = forward_kinematics(imported.skeleton, animation.rotation_xyzw, animation.translation_m)
    p = rotate(standing.turn_xyzw, p) + standing.shift_m * [1.0, 0.0, 1.0]
    feet = [limb.chain[-1] for limb in plan.limbs if limb.kind == "leg"] or [plan.pelvis]
    lowest = float(p[:, feet, 1].min())
    shift = min((0.0, float(standing.shift_m[1])), key=lambda shift: abs(lowest + shift))
    return multiply(standing.turn_xyzw, q), p + np.array([0.0, shift, 0.0])


def _same_joints(own: Skeleton, other: Skeleton, height_m: float) -> dict[int, int] | None:
    """Return the joint of ``own`` for those of ``other`` if both are one skeleton, else None.

    Every joint of the movement that has a name in the character must hang there from the same
    parent, by a bone of the same length, turned alike at rest; half of them at least must be there.
    """
    by_name = {name: j for j, name in enumerate(own.joints)}
    found = {j: by_name[name] for j, name in enumerate(other.joints) if name in by_name}
    if 2 * len(found) < len(own):
        return None
    for j, k in found.items():
        if own.parents[k] < 0 or int(other.parents[j]) not in found:
            continue
        if found[int(other.parents[j])] != int(own.parents[k]):
            return None
        apart = np.linalg.norm(other.rest_translation_m[j] - own.rest_translation_m[k])
        cosine = abs(float(other.rest_rotation_xyzw[j] @ own.rest_rotation_xyzw[k]))
        if apart > SAME_BONE * height_m or cosine < SAME_REST_COSINE:
            return None
    return found


def _of_same(
    world_q: FloatArray,
    world_p: FloatArray,
    skeleton: Skeleton,
    same: dict[int, int],
    imported: Imported,
    target: BodyPlan,
) -> tuple[FloatArray, FloatArray]:
    """Return the character's joints in the world, and the pelvis's path, for one skeleton."""
    rest_q, rest_p = rest_pose(skeleton)
    moved = np.empty((len(world_q), len(skeleton), 4))
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if joint in same:
            moved[:, joint] = world_q[:, same[joint]]
        elif parent >= 0:
            local = multiply(inverse(rest_q[parent]), rest_q[joint])
            moved[:, joint] = multiply(moved[:, parent], local)
        else:
            moved[:, joint] = rest_q[joint]
    if target.pelvis in same:
        return moved, world_p[:, same[target.pelvis]]
    return moved, world_p[:, 0] - world_p[0, 0] + rest_p[target.pelvis]


def _of_other(
    world_q: FloatArray,
    world_p: FloatArray,
    imported: Imported,
    source: BodyPlan,
    skeleton: Skeleton,
    target: BodyPlan,
) -> tuple[FloatArray, FloatArray]:
    """Return the character's joints in the world, and the pelvis's path, for another skeleton."""
    standing = standing_of(imported, source)
    q, p = rest_pose(imported.skeleton)
    source_rest = multiply(standing.turn_xyzw, q), rotate(standing.turn_xyzw, p) + standing.shift_m
    target_rest = rest_pose(skeleton)
    moved = carried_over(
        world_q,
        source_rest,
        target_rest,
        skeleton.parents.tolist(),
        partners(source, target),
        bones(source),
        bones(target),
    )
    scale = leg_length_m(target, target_rest[1]) / leg_length_m(source, source_rest[1])
    way = (world_p[:, source.pelvis] - source_rest[1][source.pelvis]) * scale
    return moved, way + target_rest[1][target.pelvis]


def _local(
    skeleton: Skeleton,
    rest: tuple[FloatArray, FloatArray],
    plan: BodyPlan,
    world_q: FloatArray,
    pelvis_m: FloatArray,
    root: _Root,
) -> tuple[FloatArray, FloatArray]:
    """Return local poses whose bones keep their length, except for the pelvis, which is placed.

    Joints between the ground root and the pelvis stay at rest: the pelvis has their movement.
    """
    n = len(world_q)
    rotation = np.tile(skeleton.rest_rotation_xyzw, (n, 1, 1))
    translation = np.tile(skeleton.rest_translation_m, (n, 1, 1))
    rotation[:, 0], translation[:, 0] = root.rotation_xyzw, root.position_m
    world = world_q.copy()
    for joint in plan.root[:-1]:
        world[:, joint] = multiply(root.rotation_xyzw, rest[0][joint])
    for joint, parent in enumerate(skeleton.parents.tolist()):
        if joint in plan.root[:-1]:
            continue
        back = inverse(world[:, parent])
        rotation[:, joint] = multiply(back, world[:, joint])
        if joint == plan.pelvis:
            holder = root.position_m + rotate(root.rotation_xyzw, rest[1][parent])
            translation[:, joint] = rotate(back, pelvis_m - holder)
    return sign_continuous(rotation), translation


def _labelled(
    rotation: FloatArray,
    translation: FloatArray,
    tracks: Tracks,
    ground: Ground,
    skeleton: Skeleton,
    plan: BodyPlan,
    rest_place: FloatArray,
    name: str,
    rate_hz: float,
    leg_m: float,
) -> Clip:
    """Return the clip with its contacts and stages."""
    _, place = forward_kinematics(skeleton, rotation, translation)
    feet = sorted(
        {joint for limb in plan.limbs if limb.kind == "leg" for joint in (limb.end, limb.chain[-1])}
    )
    touching = contacts(
        place[:, feet],
        rest_place[feet, 1].tolist(),
        rate_hz,
        leg_m,
        tolerance=TREADMILL_TOLERANCE if ground.treadmill else 1.0,
    )
    kept = [i for i in range(len(feet)) if touching[:, i].any()]
    return Clip(
        name=name,
        skeleton=skeleton,
        rate_hz=rate_hz,
        rotation_xyzw=rotation,
        translation_m=translation,
        stage_end_frames=stage_end_frames(
            place - place[:, :1], rate_hz, cyclic=ground.cyclic, touches=touching
        ),
        contact_joints=tuple(skeleton.joints[feet[i]] for i in kept),
        contacts=touching[:, kept],
        cyclic=ground.cyclic,
        tracks=tracks,
    )
