"""Legs: the joints that hold a foot, and the points of its sole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from smd.character.clip import Clip
from smd.character.ik import Limb, limb_of
from smd.character.kinematics import joints_in_world, rest_in_world
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, normalized, rotate

HEEL_BEHIND_ANKLE = 0.37
"""How far the heel is behind the ankle, as a share of the ball's distance ahead of it."""


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """A foot and the two joints above it.

    Attributes
    ----------
    upper, lower, foot : indices of the joints: thigh, shin, foot.
    limb : thigh and shin.
    heel_m, ball_m : (3,) points of the sole, in the foot's frame.
    up : (3,) unit, where the world's up is in the foot's frame when it stands flat.
    ball_height_m : height over the ground of ``ball_m`` when the foot stands flat.
    left_m : how far to the left the foot is at rest.
    """

    upper: int
    lower: int
    foot: int
    limb: Limb
    heel_m: FloatArray
    ball_m: FloatArray
    up: FloatArray
    ball_height_m: float
    left_m: float


BENT = 0.03
"""How far off the line from hip to foot a resting knee is, as a share of its length, where its leg
counts as bent; people's are at 0.02 and point ahead."""

LOW_AT_REST = 0.3
"""Height at rest, as a share of the body's, below which a joint that touches is a foot: hands that
crawl touch the ground too."""

STEEP = 1.0
"""Tangent of a foot's slope at rest above which the animal stands on its toes, as dogs do."""


def feet_of(clip: Clip) -> tuple[int, ...]:
    """Return the joints of a clip's feet: low contact joints below no other one, as toes are.

    Where toes alone touch the ground, since the animal stands on them, it is the joint above them.
    """
    skeleton = clip.skeleton
    if not clip.contact_joints:
        return ()
    _, place = rest_in_world(skeleton)
    up = place[:, 1] - place[:, 1].min()
    contact = {skeleton.index(name) for name in clip.contact_joints}
    contact = {joint for joint in contact if up[joint] < LOW_AT_REST * up.max()}
    feet = []
    for joint in sorted(contact):
        above = int(clip.skeleton.parents[joint])
        while above >= 0 and above not in contact:
            above = int(clip.skeleton.parents[above])
        if above < 0:
            parent = int(clip.skeleton.parents[joint])
            on_toes = _joints_above(skeleton, joint) > 2 and _steep(place[joint] - place[parent])
            feet.append(parent if on_toes else joint)
    return tuple(sorted(feet))


def _steep(ahead_m: FloatArray) -> bool:
    """Return whether a foot that goes so far from ankle to ball stands on its toes."""
    return bool(-ahead_m[1] > STEEP * np.hypot(ahead_m[0], ahead_m[2]))


def _joints_above(skeleton: Skeleton, tip: int) -> int:
    """Return how many joints of a limb are above its tip; 0 where it is no tip."""
    children = np.bincount(skeleton.parents[1:], minlength=len(skeleton))
    above, joint = 0, int(skeleton.parents[tip])
    while children[tip] == 0 and joint > 0 and children[joint] == 1:
        above, joint = above + 1, int(skeleton.parents[joint])
    return above


def legs_of(skeleton: Skeleton, feet: Sequence[int]) -> tuple[Leg, ...]:
    """Return the legs of the feet that have one: two joints above them, apart from the root.

    The knee points where it does at rest, and ahead where the resting leg is straight. The ball is
    at the foot's first child, the heel on the ground behind the ankle; a foot without a child
    touches the ground below its joint alone, and a steep one with its toes.
    """
    world_q, world_p = rest_in_world(skeleton)
    legs = []
    for foot in feet:
        lower = int(skeleton.parents[foot])
        upper = int(skeleton.parents[lower]) if lower > 0 else -1
        if upper <= 0:
            continue
        below = np.flatnonzero(skeleton.parents == foot)
        ahead = world_p[below[0]] - world_p[foot] if len(below) else np.zeros(3)
        under = np.array([0.0, -world_p[foot, 1], 0.0])
        heel = under - HEEL_BEHIND_ANKLE * np.array([ahead[0], 0.0, ahead[2]])
        ball = ahead if len(below) else under
        if len(below) and _steep(ahead):
            # As high as the ball's joint, so that it never bears: toes are rolled over either way.
            heel = ahead * [0.9, 1.0, 0.9]
        back = inverse(world_q[foot])
        thigh, shin, end = (skeleton.joints[joint] for joint in (upper, lower, foot))
        legs.append(
            Leg(
                upper=upper,
                lower=lower,
                foot=foot,
                limb=limb_of(
                    skeleton, thigh, shin, end, _knee_points(*world_p[[upper, lower, foot]])
                ),
                heel_m=rotate(back, heel),
                ball_m=rotate(back, ball),
                up=rotate(back, np.array([0.0, 1.0, 0.0])),
                ball_height_m=float(world_p[foot, 1] + ball[1]),
                left_m=float(world_p[foot, 0]),
            )
        )
    return tuple(legs)


def _knee_points(hip_m: FloatArray, knee_m: FloatArray, foot_m: FloatArray) -> FloatArray:
    """Return where a knee points at rest, across its leg: behind in a dog, outward in an insect."""
    along = normalized(foot_m - hip_m)
    out_m = knee_m - hip_m
    out_m = out_m - (out_m @ along) * along
    if np.linalg.norm(out_m) > BENT * np.linalg.norm(foot_m - hip_m):
        return np.asarray(normalized(out_m))
    return np.array([0.0, 0.0, 1.0])


def world_of(
    skeleton: Skeleton, joint: int, rotation_xyzw: FloatArray, translation_m: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return one joint's rotation ``(n, 4)`` and position ``(n, 3)`` in the world."""
    q, p = joints_in_world(skeleton, [joint], rotation_xyzw, translation_m)
    return q[:, 0], p[:, 0]


def yaw_of(leg: Leg, foot_xyzw: FloatArray) -> FloatArray:
    """Return which way a foot points over the ground ``(n, …)``, about +Y from +Z, without jumps.

    The steeper it is, the more its instep decides: on tiptoe, and beyond, a foot points where the
    shin's front does.
    """
    ahead = leg.ball_m - leg.heel_m
    ahead = normalized(ahead - (ahead @ leg.up) * leg.up)
    along, up = rotate(foot_xyzw, ahead), rotate(foot_xyzw, leg.up)
    along = along - along[..., 1:2] ** 3 * up
    return np.unwrap(np.arctan2(along[..., 0], along[..., 2]), axis=0)


def pelvis_of(skeleton: Skeleton, legs: Sequence[Leg]) -> int | None:
    """Return the joint below the root that holds all legs, if there is one."""
    holders = set()
    for leg in legs:
        joint = leg.upper
        while skeleton.parents[joint] > 0:
            joint = int(skeleton.parents[joint])
        holders.add(joint)
    holders -= {leg.upper for leg in legs}
    return holders.pop() if len(holders) == 1 else None


def sole_height(leg: Leg, foot_xyzw: FloatArray, ankle_m: FloatArray) -> FloatArray:
    """Return how high over the level ground a sole is ``(n,)``: its heel or its ball."""
    heel_m = ankle_m[:, 1] + rotate(foot_xyzw, leg.heel_m)[:, 1]
    ball_m = ankle_m[:, 1] + rotate(foot_xyzw, leg.ball_m)[:, 1] - leg.ball_height_m
    return np.minimum(heel_m, ball_m)
