"""Reaching: hands are moved, and inverse kinematics moves the arms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from smd.character.clip import Clip
from smd.character.ik import Limb
from smd.character.kinematics import joints_in_world
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


class ArmPose(NamedTuple):
    """An arm in the world, a frame each.

    Attributes
    ----------
    above_xyzw, upper_xyzw, middle_xyzw : (n, 4) how what it hangs from, shoulder and elbow are
        turned.
    shoulder_m, elbow_m, hand_m : (n, 3).
    """

    above_xyzw: FloatArray
    upper_xyzw: FloatArray
    middle_xyzw: FloatArray
    shoulder_m: FloatArray
    elbow_m: FloatArray
    hand_m: FloatArray


def arm_poses(clip: Clip, arms: Sequence[Arm]) -> list[ArmPose]:
    """Return arms in the clip's own world."""
    joints = [
        joint
        for arm in arms
        for joint in (int(clip.skeleton.parents[arm.upper]), arm.upper, arm.middle, arm.hand)
    ]
    q, p = joints_in_world(clip.skeleton, joints, clip.rotation_xyzw, clip.translation_m)
    return [
        ArmPose(q[:, i], q[:, i + 1], q[:, i + 2], p[:, i + 1], p[:, i + 2], p[:, i + 3])
        for i in range(0, len(joints), 4)
    ]


def bearing(height_m: FloatArray) -> FloatArray:
    """Return how surely hands at these heights rest on the ground, from 0 to 1."""
    return 1.0 - smootherstep((height_m - TOUCHING_M) / (FREE_M - TOUCHING_M))


def with_hand_moved(clip: Clip, arm: Arm, pose: ArmPose, offset_m: FloatArray) -> Clip:
    """Return a clip whose hand is elsewhere by ``offset_m (n, 3)`` in the world.

    The elbow bends as the new distance needs it by the law of cosines, in the plane in which it
    is bent; then the whole arm swings to where the hand should be. So nothing changes where there
    is no offset, whatever way a rig's bones are twisted. Beyond its reach the arm points at the
    place.

    Parameters
    ----------
    pose
        The arm's own in this clip.
    """
    have = pose.hand_m - pose.shoulder_m
    want = have + offset_m
    span = np.linalg.norm([have, want], axis=-1)
    bent, bends = arm.limb.bend_rad([span[0], _reachable_m(span[1], span[0], arm.limb)])
    upper_m, lower_m = pose.elbow_m - pose.shoulder_m, pose.hand_m - pose.elbow_m
    axis = _bending_axis(rotate(pose.upper_xyzw, arm.limb.upper_hinge), upper_m, lower_m)
    bend = quaternion_from_rotvec(axis * (bends - bent)[:, None])
    swing = quaternion_between(upper_m + rotate(bend, lower_m), want)
    upper = multiply(swing, pose.upper_xyzw)
    middle = multiply(multiply(swing, bend), pose.middle_xyzw)
    rotation = clip.rotation_xyzw.copy()
    rotation[:, arm.upper] = multiply(inverse(pose.above_xyzw), upper)
    rotation[:, arm.middle] = multiply(inverse(upper), middle)
    return replace(clip, rotation_xyzw=rotation)


def _reachable_m(wanted_m: FloatArray, own_m: FloatArray, limb: Limb) -> FloatArray:
    """Return the distances ``(n,)`` that an arm takes for wanted ones: its own for its own.

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
    clip: Clip, arms: Sequence[Arm], hands_m: FloatArray, bearing: FloatArray
) -> Clip:
    """Return a clip whose hands rest on the ground where they should.

    Parameters
    ----------
    hands_m
        ``(n, a, 3)`` where each arm's hand should be while it rests.
    bearing
        ``(n, a)`` how surely it does.
    """
    if not bearing.any():
        return clip
    for i, (arm, pose) in enumerate(zip(arms, arm_poses(clip, arms), strict=True)):
        if bearing[:, i].any():
            gap = hands_m[:, i] - pose.hand_m
            clip = with_hand_moved(clip, arm, pose, bearing[:, i, None] * gap)
    return clip
