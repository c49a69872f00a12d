"""Reaching: hands moved by some way, the arms following."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from smd.character.clip import Clip
from smd.character.ik import two_bone_ik
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, multiply, rotate, sign_continuous
from smd.transfer.body import Arm, Body
from smd.transfer.easing import smootherstep
from smd.transfer.legs import world_of

SOFTNESS = 0.03
"""Last share of an arm's reach in which it straightens ever more slowly."""

TOUCHING_M, FREE_M = 0.06, 0.22
"""Height of a wrist below which its hand rests on the ground, and above which it does not."""


class World(NamedTuple):
    """A clip's poses in the world: rotations ``(n, j, 4)`` and places ``(n, j, 3)``."""

    rotation_xyzw: FloatArray
    position_m: FloatArray


def world_of_clip(clip: Clip) -> World:
    """Return a clip's poses in its own world."""
    return World(*forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m))


def bearing(height_m: FloatArray) -> FloatArray:
    """Return how surely hands at these heights rest on the ground, from 0 to 1."""
    return 1.0 - smootherstep((height_m - TOUCHING_M) / (FREE_M - TOUCHING_M))


def with_hand_moved(clip: Clip, arm: Arm, offset_m: FloatArray, world: World) -> Clip:
    """Return a clip whose hand is elsewhere by ``offset_m (n, 3)`` in the world.

    The arm is turned by what lies between the inverse kinematics of both places, so that nothing
    changes where there is no offset, whatever way a rig's bones are twisted. The elbow keeps the
    plane it bends in; beyond its reach the arm points at the place.
    """
    q, place = world
    base, end = place[:, arm.upper], place[:, arm.hand]
    hinge = rotate(q[:, arm.upper], arm.limb.upper_hinge)
    elbow = np.cross(end - base, hinge)
    before = two_bone_ik(arm.limb, base, end, elbow, softness=SOFTNESS)
    after = two_bone_ik(arm.limb, base, end + offset_m, elbow, softness=SOFTNESS)
    upper, middle = (
        multiply(multiply(b, inverse(a)), q[:, joint])
        for a, b, joint in zip(before, after, (arm.upper, arm.middle), strict=True)
    )
    rotation = clip.rotation_xyzw.copy()
    above = int(clip.skeleton.parents[arm.upper])
    rotation[:, arm.upper] = multiply(inverse(q[:, above]), upper)
    rotation[:, arm.middle] = multiply(inverse(upper), middle)
    return replace(clip, rotation_xyzw=sign_continuous(rotation))


def with_hands_kept(clip: Clip, body: Body, neutral: Clip) -> Clip:
    """Return a clip whose hands rest on the ground where those of another clip do.

    Parameters
    ----------
    neutral
        Of as many frames: at each the moment that the clip shows there, as it was authored.
    """
    world = None
    for arm in body.arms:
        _, wanted = world_of(clip.skeleton, arm.hand, neutral.rotation_xyzw, neutral.translation_m)
        rests = bearing(wanted[:, 1])
        if rests.any():
            world = world or world_of_clip(clip)
            gap = wanted - world.position_m[:, arm.hand]
            clip = with_hand_moved(clip, arm, rests[:, None] * gap, world)
    return clip
