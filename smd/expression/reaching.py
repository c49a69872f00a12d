"""Reaching: hands are moved, and inverse kinematics moves the arms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from smd.character.ik import Limb
from smd.character.kinematics import joints_in_world
from smd.character.poses import Poses
from smd.character.skeleton import Skeleton
from smd.expression.body import Arm
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_between,
    quaternion_from_rotvec,
    rotate,
)

SOFTNESS = 0.03
"""Last share of an arm's reach, in which it straightens more and more slowly."""

LEAST_BEND_RAD = np.radians(3.0)
"""How far an arm stays bent that reaches as far as it can, unless its own is straighter: people
seldom lock their elbows."""

STRAIGHT = 0.02
"""Sine of the bend about which an arm's hinge, and no longer the bend itself, says its axis."""

TOUCHING_M, FREE_M = 0.06, 0.22
"""Height of a wrist below which its hand rests on the ground, and above which it does not."""


class ArmPoses(NamedTuple):
    """Arms in the world, a frame each; in a stack, a frame and a state of Effort each.

    Attributes
    ----------
    above_xyzw, upper_xyzw, middle_xyzw : (n, …, a, 4) how what they hang from, shoulders and elbows
        are turned.
    shoulder_m, elbow_m, hand_m : (n, …, a, 3).
    """

    above_xyzw: FloatArray
    upper_xyzw: FloatArray
    middle_xyzw: FloatArray
    shoulder_m: FloatArray
    elbow_m: FloatArray
    hand_m: FloatArray


def arm_poses(skeleton: Skeleton, poses: Poses, arms: Sequence[Arm]) -> ArmPoses:
    """Return arms in the clip's own world."""
    above = [int(skeleton.parents[arm.upper]) for arm in arms]
    chains = [above, *zip(*((arm.upper, arm.middle, arm.hand) for arm in arms), strict=True)]
    joints = [joint for part in chains for joint in part]
    q, p = joints_in_world(skeleton, joints, poses.rotation_xyzw, poses.translation_m)
    a = len(arms)
    parts = [slice(i * a, (i + 1) * a) for i in range(4)]
    return ArmPoses(
        *(q[..., part, :] for part in parts[:3]),
        *(p[..., part, :] for part in parts[1:]),
    )


def bearing(height_m: FloatArray) -> FloatArray:
    """Return how surely hands at these heights rest on the ground, from 0 to 1."""
    return 1.0 - smootherstep((height_m - TOUCHING_M) / (FREE_M - TOUCHING_M))


def with_hands_moved(
    poses: Poses, arms: Sequence[Arm], pose: ArmPoses, offset_m: FloatArray
) -> Poses:
    """Return poses whose hands are elsewhere by ``offset_m (n, …, a, 3)`` in the world.

    An elbow bends as the new distance needs it by the law of cosines, in the plane in which it
    is bent; then the whole arm swings to where the hand should be. So nothing changes where there
    is no offset, whatever way a rig's bones are twisted. Beyond its reach an arm points at the
    place.

    Parameters
    ----------
    pose
        The arms' own.
    """
    have = pose.hand_m - pose.shoulder_m
    want = have + offset_m
    spans = np.moveaxis(np.linalg.norm([have, want], axis=-1), -1, 1)
    more = [
        arm.limb.bend_rad(_reachable_m(wanted, own, arm.limb)) - arm.limb.bend_rad(own)
        for arm, own, wanted in zip(arms, *spans, strict=True)
    ]
    upper_m, lower_m = pose.elbow_m - pose.shoulder_m, pose.hand_m - pose.elbow_m
    hinge = rotate(pose.upper_xyzw, np.stack([arm.limb.upper_hinge for arm in arms]))
    axis = _bending_axis(hinge, upper_m, lower_m)
    bend = quaternion_from_rotvec(axis * np.stack(more, axis=-1)[..., None])
    swing = quaternion_between(upper_m + rotate(bend, lower_m), want)
    upper = multiply(swing, pose.upper_xyzw)
    middle = multiply(multiply(swing, bend), pose.middle_xyzw)
    rotation = poses.rotation_xyzw.copy()
    rotation[..., [arm.upper for arm in arms], :] = multiply(inverse(pose.above_xyzw), upper)
    rotation[..., [arm.middle for arm in arms], :] = multiply(inverse(upper), middle)
    return Poses(rotation, poses.translation_m)


def _reachable_m(wanted_m: FloatArray, own_m: FloatArray, limb: Limb) -> FloatArray:
    """Return the distances ``(n, …)`` that an arm takes for wanted ones: its own for its own.

    Over the last part of its reach it straightens more and more slowly, and never all the way;
    that part begins where the arm is anyway, if it is straighter. Had also an arm's own distance
    been shortened, it would be less bent than it is taken to be, and the difference would bend it
    backwards.
    """
    nearest = abs(limb.upper_length_m - limb.lower_length_m)
    farthest = np.maximum(own_m, limb.span_m(LEAST_BEND_RAD))
    begins = np.minimum(np.maximum(own_m, (1.0 - SOFTNESS) * limb.reach_m), farthest)
    room = np.maximum(farthest - begins, 1e-9)
    beyond = np.maximum(wanted_m - begins, 0.0)
    return np.where(
        beyond > 0.0, begins - room * np.expm1(-beyond / room), np.maximum(wanted_m, nearest)
    )


def _bending_axis(hinge: FloatArray, upper_m: FloatArray, lower_m: FloatArray) -> FloatArray:
    """Return the unit axis about which an arm is bent: the hinge where it is straight."""
    across = np.cross(normalized(upper_m), normalized(lower_m))
    toward = np.sign(np.sum(across * hinge, axis=-1, keepdims=True))
    return normalized(toward * across + STRAIGHT * hinge)


def with_hands_kept(
    poses: Poses, skeleton: Skeleton, arms: Sequence[Arm], hands_m: FloatArray, bearing: FloatArray
) -> Poses:
    """Return poses whose hands rest on the ground where they should.

    Parameters
    ----------
    hands_m
        ``(n, …, a, 3)`` where each arm's hand should be while it rests.
    bearing
        ``(n, …, a)`` how surely it does.
    """
    resting = [i for i in range(len(arms)) if bearing[..., i].any()]
    if not resting:
        return poses
    arms = [arms[i] for i in resting]
    pose = arm_poses(skeleton, poses, arms)
    gap = hands_m[..., resting, :] - pose.hand_m
    return with_hands_moved(poses, arms, pose, bearing[..., resting, None] * gap)
