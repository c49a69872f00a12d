"""Gaze: heads turn to where their bodies go, and to a partner.

A clip's head looks wherever its action has it, the same in every scene. People look along their
way, and turn the head into a curve before the body follows [1]_; and whoever stands, or acts in
place, looks at the one beside. The eyes would do the last part of it; here the head does it all.
What a clip's head does quickly, as in nodding, is kept: only the mean direction is brought to what
is looked at. A trunk that lies, rolls or somersaults takes its head along, as the clip has it.

References
----------
.. [1] R. Grasso et al., "Eye-head coordination for the steering of locomotion in humans: an
   anticipatory synergy", Neuroscience Letters 253, 1998.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from smd.acting.performance import Actor
from smd.character.kinematics import joints_in_world, rest_in_world
from smd.character.poses import Poses
from smd.character.roles import plan_of, reaches_ground
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import (
    heading_rad,
    inverse,
    multiply,
    normalized,
    quaternion_about,
    rotate,
)

AHEAD_S = 0.6
"""How far ahead on its way a body looks."""

WALKING = 0.35
"""Speed, in body heights a second, from which a body looks along its way alone."""

TURNING_RAD = np.radians(20.0)
"""Turn of the body within that time from which it looks where it will face."""

NEAR, FAR = 4.0, 7.0
"""Distances of a partner, in body heights, up to which it is looked at, and from which not."""

SIDEWAYS_RAD, BEHIND_RAD = np.radians(80.0), np.radians(130.0)
"""Bearings up to which something is looked at, and from which nobody turns round for it."""

MOST_YAW_RAD = np.radians(60.0)
"""Most that a head is turned from the way the chest faces; necks allow 80 degrees [1]_.

References
----------
.. [1] American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and Recording",
   1965.
"""

MOST_PITCH_RAD = np.radians(30.0)
"""Most that it looks up or down at a partner."""

UPRIGHT, LYING = np.cos(np.radians(40.0)), np.cos(np.radians(70.0))
"""Cosines of a trunk's lean up to which its head is turned, and from which it is not."""

SMOOTHED_S = 0.14
"""Smoothing of the turn: a head that turns by 60 degrees does so at 170 degrees a second."""

MEAN_S = 0.4
"""Smoothing that gives the mean direction of a clip's own head."""

_UP = np.array([0.0, 1.0, 0.0])
_FRONT = np.array([0.0, 0.0, 1.0])


class Neck(NamedTuple):
    """The joints that turn a head.

    Attributes
    ----------
    chest : joint that carries them.
    joints : from the first above the chest to the head.
    """

    chest: int
    joints: tuple[int, ...]


def neck_of(skeleton: Skeleton) -> Neck | None:
    """Return the neck of a skeleton; None where it has no head apart from its trunk."""
    plan = plan_of(skeleton)
    if plan.head is None or plan.chest not in plan.spine or plan.head not in plan.spine:
        return None
    first = plan.spine.index(plan.chest)
    last = plan.spine.index(plan.head)
    # The segments of a caterpillar are its spine up to the head: feet hang from most of them.
    held = reaches_ground(skeleton.parents.tolist(), rest_in_world(skeleton)[1])
    first += sum(bool(held[joint]) for joint in plan.spine[first + 1 : last])
    joints = plan.spine[first + 1 : last + 1]
    return Neck(plan.spine[first], joints) if joints else None


def with_gaze(actors: Sequence[Actor], rate_hz: float) -> tuple[Actor, ...]:
    """Return actors whose heads turn to their way, and to each other.

    Parameters
    ----------
    actors
        Of one scene, all with the same number of frames.
    rate_hz
        Frames per second.
    """
    necks = [neck_of(actor.character.skeleton) for actor in actors]
    heads = [_head_m(actor, neck) for actor, neck in zip(actors, necks, strict=True)]
    done = []
    for i, (actor, neck) in enumerate(zip(actors, necks, strict=True)):
        if neck is not None:
            others = [head for j, head in enumerate(heads) if j != i]
            actor = replace(actor, poses=_gazing(actor, neck, others, rate_hz))
        done.append(actor)
    return tuple(done)


def _head_m(actor: Actor, neck: Neck | None) -> FloatArray:
    """Return where the head of an actor is ``(n, 3)``; without one, its topmost joint at rest."""
    skeleton = actor.character.skeleton
    joint = neck.joints[-1] if neck else int(np.argmax(rest_in_world(skeleton)[1][:, 1]))
    return joints_in_world(skeleton, [joint], *actor.poses)[1][:, 0]


@dataclass(frozen=True, slots=True, eq=False)
class _Look:
    """Where a head should look, each ``(n,)``: angles from the body's heading, and how much."""

    yaw_rad: FloatArray
    pitch_rad: FloatArray
    share: FloatArray


def _gazing(actor: Actor, neck: Neck, others: Sequence[FloatArray], rate_hz: float) -> Poses:
    """Return an actor's poses with its head turned."""
    skeleton = actor.character.skeleton
    rotation, translation = actor.poses
    rest = rest_in_world(skeleton)[0]
    joints = [neck.chest, *neck.joints]
    world, place = joints_in_world(skeleton, joints, rotation, translation)
    from_rest = multiply(world, inverse(rest[joints]))
    heading = np.unwrap(heading_rad(rotation[:, 0]))
    height_m = actor.character.height_m
    face, chest = rotate(from_rest[:, -1], _FRONT), rotate(from_rest[:, 0], _FRONT)
    yaw, pitch = (_mean(angle, rate_hz) for angle in _angles(face, heading))
    facing, _ = _angles(chest, heading)
    way = _way(translation[:, 0], heading, height_m, rate_hz)
    partner = _partner(others, place[:, -1], heading, height_m)
    to_partner = partner.share * (1.0 - way.share * np.maximum(np.cos(way.yaw_rad), 0.0))
    to_way = (1.0 - to_partner) * way.share * _in_view(way.yaw_rad)
    upright = rotate(from_rest[:, 0], _UP)[:, 1]
    allowed = smootherstep((upright - LYING) / (UPRIGHT - LYING))
    most = facing - MOST_YAW_RAD, facing + MOST_YAW_RAD
    more_yaw = sum(
        share * (np.clip(look.yaw_rad, *most) - yaw)
        for share, look in ((to_partner, partner), (to_way, way))
    )
    more_pitch = to_partner * (np.clip(partner.pitch_rad, -MOST_PITCH_RAD, MOST_PITCH_RAD) - pitch)
    turn = allowed[:, None] * np.stack([more_yaw, more_pitch], axis=1)
    turn = gaussian_smoothed(turn, SMOOTHED_S * rate_hz)
    across = normalized(np.cross(_UP, rotate(rotation[:, 0], _FRONT)))
    return Poses(_turned(rotation, world, neck, turn, across), translation)


def _mean(angle_rad: FloatArray, rate_hz: float) -> FloatArray:
    """Return an angle without its quick changes."""
    return gaussian_smoothed(angle_rad, MEAN_S * rate_hz)


def _angles(way: FloatArray, heading: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the angles of directions ``(n, 3)``: left of the heading, in ±pi, and upward."""
    level = np.hypot(way[:, 0], way[:, 2])
    yaw = np.arctan2(way[:, 0], way[:, 2]) - heading
    return np.arctan2(np.sin(yaw), np.cos(yaw)), np.arctan2(way[:, 1], level)


def _in_view(yaw_rad: FloatArray) -> FloatArray:
    """Return how much a head turns to what is in a direction: not at all to what is behind."""
    return 1.0 - smootherstep((np.abs(yaw_rad) - SIDEWAYS_RAD) / (BEHIND_RAD - SIDEWAYS_RAD))


def _way(root_m: FloatArray, heading: FloatArray, height_m: float, rate_hz: float) -> _Look:
    """Return the look at where a body will be, or will face, in a short while."""
    frame = np.arange(len(root_m), dtype=np.float64)
    later = frame + AHEAD_S * rate_hz
    step = np.stack([np.interp(later, frame, axis) for axis in root_m.T], axis=1) - root_m
    step[:, 1] = 0.0
    turn = np.interp(later, frame, heading) - heading
    travels = smootherstep(np.linalg.norm(step, axis=1) / (AHEAD_S * WALKING * height_m))
    turns = smootherstep(np.abs(turn) / TURNING_RAD)
    ahead, _ = _angles(step, heading)
    # Mixed as directions: as angles, the ways to the left and to the right of the back are far
    # apart.
    x = travels * np.cos(ahead) + (1.0 - travels) * np.cos(turn)
    y = travels * np.sin(ahead) + (1.0 - travels) * np.sin(turn)
    share = 1.0 - (1.0 - travels) * (1.0 - turns)
    return _Look(np.arctan2(y, x), np.zeros_like(turn), share)


def _partner(
    others: Sequence[FloatArray], head_m: FloatArray, heading: FloatArray, height_m: float
) -> _Look:
    """Return the look at the others; the nearer one is, the more."""
    toward, weight = np.zeros_like(head_m), np.zeros(len(head_m))
    near = np.zeros(len(head_m))
    for other_m in others:
        apart = other_m - head_m
        distance = np.maximum(np.linalg.norm(apart, axis=1), 1e-6)
        seen = 1.0 - smootherstep((distance / height_m - NEAR) / (FAR - NEAR))
        share = seen / distance**4
        toward += share[:, None] * apart / distance[:, None]
        weight += share
        near = np.maximum(near, seen)
    yaw, pitch = _angles(toward / np.maximum(weight, 1e-12)[:, None], heading)
    return _Look(yaw, pitch, near * _in_view(yaw))


def _turned(
    rotation: FloatArray, world: FloatArray, neck: Neck, turn: FloatArray, across: FloatArray
) -> FloatArray:
    """Return local rotations whose neck and head are turned, each joint by an even part.

    Parameters
    ----------
    rotation, world
        ``(n, j, 4)`` local ones; of the chest and the neck's joints in the world.
    turn
        ``(n, 2)`` to the left and upward.
    across
        ``(n, 3)`` axis from right to left.
    """
    rotation = rotation.copy()
    above = world[:, 0]
    for k, joint in enumerate(neck.joints, start=1):
        part = k / len(neck.joints)
        by = multiply(
            quaternion_about(_UP, part * turn[:, 0]), quaternion_about(across, -part * turn[:, 1])
        )
        now = multiply(by, world[:, k])
        rotation[:, joint] = multiply(inverse(above), now)
        above = now
    return rotation
