"""Body: the joints of a skeleton that express Effort."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.character.clip import Clip
from smd.character.ik import Limb, limb_of
from smd.character.kinematics import rest_in_world
from smd.character.roles import BodyPlan, LimbPlan, plan_of, reaches_ground
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray

BEHIND = (0.0, 0.0, -1.0)
"""Where the elbow of a resting arm points."""


@dataclass(frozen=True, slots=True, eq=False)
class Arm:
    """A hand and the two joints that carry it.

    Attributes
    ----------
    upper, middle, hand : indices of shoulder, elbow and wrist.
    limb : upper arm and forearm.
    """

    upper: int
    middle: int
    hand: int
    limb: Limb


@dataclass(frozen=True, slots=True, eq=False)
class Effector:
    """The end of an arm or a leg: what acts on the world.

    Attributes
    ----------
    end, base : indices of wrist and shoulder, or of ankle and hip.
    chain : joints that move the end: from the ground root's first child to the end itself.
    beyond : the end and what hangs from it.
    reach_m : how far the end may be from the base.
    is_leg : and carries the body, while it touches the ground.
    """

    end: int
    base: int
    chain: frozenset[int]
    beyond: frozenset[int]
    reach_m: float
    is_leg: bool


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """The joints of a skeleton that express Effort.

    Attributes
    ----------
    spine : joints that bend with Weight, without neck and head, so that the gaze stays.
    neck : the joint that compensates the bend; None without a head.
    head : the joint that looks; None without one.
    chest : what the arms hang from.
    upper : joints that are rescaled in a gait: spine, arms, and what hangs from them.
    every : joints that are rescaled in anything else.
    hinges : elbows and knees, which are never enlarged.
    arms : that two-bone inverse kinematics can turn.
    effectors : the ends of arms and legs.
    pelvis : the joint that holds the legs.
    pelvis_height_m : over the ground at rest.
    rest_xyzw : (j, 4) how each joint is turned in the world at rest.
    """

    spine: tuple[int, ...]
    neck: int | None
    head: int | None
    chest: int
    upper: tuple[int, ...]
    every: tuple[int, ...]
    hinges: frozenset[int]
    arms: tuple[Arm, ...]
    effectors: tuple[Effector, ...]
    pelvis: int
    pelvis_height_m: float
    rest_xyzw: FloatArray


def body_of(clip: Clip) -> Body:
    """Return the joints of a clip's skeleton that express Effort."""
    skeleton = clip.skeleton
    turned, place = rest_in_world(skeleton)
    plan = plan_of(skeleton)
    trunk = plan.spine[: plan.spine.index(plan.chest) + 1] if plan.chest in plan.spine else ()
    after = plan.spine[len(trunk) :]
    legs = {joint for limb in plan.limbs if limb.kind == "leg" for joint in limb.chain}
    lower = legs | set(plan.root)
    every = tuple(j for j in range(1, len(skeleton)) if j not in plan.root[:-1])
    reaches = reaches_ground(skeleton.parents.tolist(), place)
    if not legs and reaches[list(after)].any():
        # Feet hang from the trunk up to the head, as a caterpillar's: bent more, it is in the
        # ground, and the head that is kept level sways.
        to_head = plan.spine[: plan.spine.index(plan.head) + 1] if plan.head in plan.spine else ()
        every = tuple(j for j in every if not reaches[j] and j not in to_head)
        trunk, after = (), ()
    arms = (_arm(skeleton, limb) for limb in plan.limbs if limb.kind == "arm")
    return Body(
        spine=trunk,
        neck=after[0] if after else None,
        head=plan.head,
        chest=plan.chest,
        upper=tuple(j for j in every if j not in lower and not _below(plan, skeleton.parents, j)),
        every=every,
        hinges=frozenset(limb.middle for limb in plan.limbs),
        arms=tuple(arm for arm in arms if arm),
        effectors=tuple(_effector(skeleton, limb) for limb in plan.limbs),
        pelvis=plan.root[-1],
        pelvis_height_m=float(place[plan.root[-1], 1] - place[:, 1].min()),
        rest_xyzw=turned,
    )


def _effector(skeleton: Skeleton, plan: LimbPlan) -> Effector:
    parents, chain = skeleton.parents.tolist(), [plan.end]
    while parents[chain[-1]] > 0:
        chain.append(parents[chain[-1]])
    beyond = {plan.end}
    for joint, parent in enumerate(parents):  # parents come first
        if parent in beyond:
            beyond.add(joint)
    bones = np.linalg.norm(skeleton.rest_translation_m[[plan.middle, plan.end]], axis=-1)
    return Effector(
        end=plan.end,
        base=plan.upper,
        chain=frozenset(chain),
        beyond=frozenset(beyond),
        reach_m=float(bones.sum()),
        is_leg=plan.kind == "leg",
    )


def _arm(skeleton: Skeleton, plan: LimbPlan) -> Arm | None:
    """Return an arm, or None where its joints are not those of two bones."""
    upper, middle, hand = (skeleton.joints[j] for j in (plan.upper, plan.middle, plan.end))
    try:
        limb = limb_of(skeleton, upper, middle, hand, BEHIND)
    except CharacterError:
        return None
    return Arm(plan.upper, plan.middle, plan.end, limb)


def _below(plan: BodyPlan, parents: IntArray, joint: int) -> bool:
    """Return whether a joint is a descendant of a leg's."""
    legs = {j for limb in plan.limbs if limb.kind == "leg" for j in limb.chain}
    while joint >= 0:
        if joint in legs:
            return True
        joint = int(parents[joint])
    return False
