"""Grip: a prop held in a fist, as one holds a wand.

A hand with a thumb says which way its palm faces: its fingers point along the hand, its thumb to
the side, and the palm is square to both. The prop lies across the palm: its front comes out of the
fist at the thumb, and its top is where the knuckles are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from smd.acting.performance import Actor, HeldProp
from smd.character.kinematics import joints_in_world, rest_in_world
from smd.character.poses import Poses
from smd.character.roles import plan_of
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_matrix,
    rotate,
)

CLOSED_RAD, MOST_PER_JOINT_RAD = np.radians(245.0), np.radians(150.0)
"""How far the joints of a finger bend in a fist, all together, and each at most."""

OVER_PALM_RAD, ACROSS_RAD = np.radians(52.0), np.radians(60.0)
"""How far its thumb turns over the palm, and along the fingers."""

ALONG, BELOW = 0.65, 0.25
"""Where the middle of a fist is from the wrist: along the hand, and toward the palm, as shares of
the distance to the knuckles."""


class Grip(NamedTuple):
    """A hand that holds a prop.

    Attributes
    ----------
    hand : joint.
    closed_xyzw : local rotation of each joint that closes it.
    position_m, orientation_xyzw : the prop's pose in the hand.
    """

    hand: int
    closed_xyzw: dict[int, FloatArray]
    position_m: FloatArray
    orientation_xyzw: FloatArray


def with_props_held(actors: Sequence[Actor]) -> tuple[Actor, ...]:
    """Return actors that hold their props in a hand.

    One without doodles has no prop, one without a hand that has fingers and a thumb cannot hold
    it: these stay as they are.
    """
    return tuple(_holding(actor) for actor in actors)


def _holding(actor: Actor) -> Actor:
    """Return an actor that holds its prop, if it has one and can."""
    skeleton = actor.character.skeleton
    grip = grip_of(skeleton) if actor.doodles else None
    if grip is None:
        return actor
    rotation = actor.poses.rotation_xyzw.copy()
    for joint, closed in grip.closed_xyzw.items():
        rotation[:, joint] = closed
    world, place = joints_in_world(skeleton, [grip.hand], rotation, actor.poses.translation_m)
    held = HeldProp(
        place[:, 0] + rotate(world[:, 0], grip.position_m),
        multiply(world[:, 0], grip.orientation_xyzw),
    )
    return replace(actor, poses=Poses(rotation, actor.poses.translation_m), held=held)


def grip_of(skeleton: Skeleton) -> Grip | None:
    """Return the grip of a skeleton's right hand, else its left; None where neither can hold."""
    world, place = rest_in_world(skeleton)
    parents, plan = skeleton.parents.tolist(), plan_of(skeleton)
    for side in ("right", "left"):
        arm = plan.of("arm", side)
        if arm is None:
            continue
        fingers = [joint for joint, parent in enumerate(parents) if parent == arm.end]
        ways = normalized(place[fingers] - place[arm.end]) if len(fingers) > 1 else None
        if ways is None:
            continue
        knuckles = arm.chain[arm.chain.index(arm.end) + 1]
        along = normalized(place[knuckles] - place[arm.end])
        thumb = fingers[int(np.argmin(ways @ along))]
        toward_thumb = place[thumb] - place[arm.end]
        side_way = normalized(toward_thumb - (toward_thumb @ along) * along)
        palm = np.cross(along, side_way) * (1.0 if side == "left" else -1.0)
        closed = {
            joint: by
            for finger in fingers
            for joint, by in (
                _thumb_over(thumb, along, palm, side_way, world, parents)
                if finger == thumb
                else _bent(finger, np.cross(along, palm), world, parents)
            )
        }
        reach_m = float(np.linalg.norm(place[knuckles] - place[arm.end]))
        axes = np.stack([np.cross(along, side_way), along, side_way], axis=-1)
        back = inverse(world[arm.end])
        return Grip(
            arm.end,
            closed,
            rotate(back, reach_m * (ALONG * along + BELOW * palm)),
            multiply(back, quaternion_from_matrix(axes)),
        )
    return None


def _bent(
    finger: int, axis: FloatArray, world: FloatArray, parents: list[int]
) -> list[tuple[int, FloatArray]]:
    """Return the local rotations of a finger that is bent, given those in the world at rest."""
    chain = [finger]
    while chain[-1] in parents:
        chain.append(parents.index(chain[-1]))
    each_rad = min(CLOSED_RAD / len(chain), MOST_PER_JOINT_RAD)
    bent, above = [], world[parents[finger]]
    for i, joint in enumerate(chain, start=1):
        now = multiply(quaternion_about(axis, i * each_rad), world[joint])
        bent.append((joint, multiply(inverse(above), now)))
        above = now
    return bent


def _thumb_over(
    thumb: int,
    along: FloatArray,
    palm: FloatArray,
    side_way: FloatArray,
    world: FloatArray,
    parents: list[int],
) -> list[tuple[int, FloatArray]]:
    """Return the local rotation of a thumb that lies over the fingers."""
    over = quaternion_about(np.cross(side_way, palm), OVER_PALM_RAD)
    across = quaternion_about(np.cross(side_way, along), ACROSS_RAD)
    now = multiply(multiply(across, over), world[thumb])
    return [(thumb, multiply(inverse(world[parents[thumb]]), now))]
