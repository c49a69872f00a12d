"""Legs of any rig, two or many: by their keys, by their feet's paths, or between both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from actions_library.authoring.feet import FootPath, FootShape
from actions_library.authoring.keys import LegKey, Vector, columns_of
from actions_library.authoring.pose import Pose
from actions_library.authoring.rigging import RIGHT
from smd.character.ik import Limb, limb_of, two_bone_ik
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, normalized, quaternion_about, rotate, slerp

LEG_SOFTNESS = 0.004
"""Last part of a leg's reach that softens; short, since a foot that falls short slides."""

STRAIGHTEST_DEG = 8.0
"""Least bend of a knee whose foot is put somewhere."""

AHEAD: Vector = (0.0, 0.0, 1.0)
BEHIND: Vector = (0.0, 0.0, -1.0)
_X = (1.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class RigLeg:
    """A leg's joints, each the parent of the next, and how it stands.

    Attributes
    ----------
    name : of its keys and plants; ``right_…`` is mirrored, any other name is not.
    upper, lower, foot : the joints that bend: hip, knee and ankle, or what corresponds to them.
    toes : the joint at the ball of the foot; empty where the foot itself touches the ground.
    blade : a joint above the leg that swings along with it: a shoulder blade; or empty.
    blade_share : the part of the leg's swing that the blade turns by.
    knee : where the middle joint points when the leg bends (out, up, ahead).
    heel_behind_m : how far the heel is behind the ankle.
    on_toes : stands on its toes alone, as dogs and horses do; its foot is steep.
    """

    name: str
    upper: str
    lower: str
    foot: str
    toes: str = ""
    blade: str = ""
    blade_share: float = 0.35
    knee: Vector = AHEAD
    heel_behind_m: float = 0.0
    on_toes: bool = False

    @property
    def out(self) -> float:
        """+1 for a left leg or one of no side, -1 for a right one."""
        return -1.0 if self.name.startswith(RIGHT) else 1.0

    @property
    def touching(self) -> tuple[str, ...]:
        """The joints that touch the ground."""
        if not self.toes:
            return (self.foot,)
        return (self.toes,) if self.on_toes else (self.foot, self.toes)


def foot_shape(skeleton: Skeleton, leg: RigLeg) -> FootShape:
    """Return a foot's measures: the ball at the toes' joint, the heel on the ground."""
    height = float(skeleton.world_from_bind[skeleton.index(leg.foot), 1, 3])
    below = np.array([0.0, -height, 0.0])
    ball = skeleton.rest_translation_m[skeleton.index(leg.toes)] if leg.toes else below
    heel = ball if leg.on_toes else np.array([0.0, -height, -leg.heel_behind_m])
    return FootShape(ball=ball, heel=heel, ankle_height=height, on_toes=leg.on_toes)


def pose_leg(pose: Pose, leg: RigLeg, numbers: FloatArray | None, path: FootPath | None) -> None:
    """Pose a leg below what carries it: by its keys, by its foot's path, or between both.

    A knee points where foot and hips do, between them; in the air where its key says.
    """
    limb = _limb(pose.skeleton, leg)
    if leg.blade:
        _swing_blade(pose, leg, numbers, path)
    if path is None:
        if numbers is None:
            raise ValueError(f"{leg.name}: expected keys or plants")
        _free_leg(pose, leg, numbers, limb)
        return
    ankle, turned, toes = path.ankle_m, path.rotation_xyzw, -path.toes_up_rad
    base = pose.at(leg.upper)
    hinge = np.broadcast_to(_hinge(pose.skeleton, leg), base.shape)
    carrier = pose.parent_rotation(leg.upper)
    axis = normalized(rotate(carrier, hinge) + rotate(turned, hinge))
    pole = np.cross(axis, base - ankle)
    if path.free.any():
        if numbers is None:
            raise ValueError(f"{leg.name}: expected keys for its way through the air")
        free = path.free
        _free_leg(pose, leg, numbers, limb)
        knee_m, foot_m = (pose.position[:, pose.skeleton.index(j)] for j in (leg.lower, leg.foot))
        knee = knee_m - 0.5 * (base + foot_m)
        ankle = ankle + free[:, None] * (foot_m - ankle)
        turned = slerp(turned, pose.rotation[:, pose.skeleton.index(leg.foot)], free)
        pole = normalized(pole) + free[:, None] * (normalized(knee) - normalized(pole))
        away = ankle - base  # halfway between two places that it reaches, it may be out of reach
        reach = float(limb.span_m(np.radians(STRAIGHTEST_DEG))) / np.linalg.norm(away, axis=-1)
        ankle = np.where(free[:, None] > 0.0, base + np.minimum(reach, 1.0)[:, None] * away, ankle)
        toes = (1.0 - free) * toes + free * 0.3 * np.radians(columns_of(LegKey(), numbers)["point"])
    upper_q, lower_q = two_bone_ik(limb, base, ankle, pole, softness=LEG_SOFTNESS)
    pose.set(leg.upper, upper_q)
    pose.set(leg.lower, lower_q)
    pose.set(leg.foot, turned)
    if leg.toes:
        pose.turn(leg.toes, quaternion_about(_X, toes))


def leg_room_m(pose: Pose, leg: RigLeg, path: FootPath) -> FloatArray:
    """Return how far the hips may rise until a leg is as straight as it gets, ``(n,)``.

    Below 0 they must sink, or the foot falls short. Without limit where the leg has its own keys.
    """
    to = path.ankle_m - pose.at(leg.upper)
    straight = float(_limb(pose.skeleton, leg).span_m(np.radians(STRAIGHTEST_DEG)))
    aside = np.minimum(to[:, 0] ** 2 + to[:, 2] ** 2, straight**2)
    return np.where(path.free > 0.0, np.inf, np.sqrt(straight**2 - aside) + to[:, 1])


def _limb(skeleton: Skeleton, leg: RigLeg) -> Limb:
    return limb_of(skeleton, leg.upper, leg.lower, leg.foot, _sided(leg.knee, leg))


def _sided(vector: Vector, leg: RigLeg) -> FloatArray:
    """Return the world's direction of one away from the middle (out, up, ahead)."""
    return np.array(vector) * [leg.out, 1.0, 1.0]


def _hinge(skeleton: Skeleton, leg: RigLeg) -> FloatArray:
    """Return the axis that a resting leg folds about.

    Where the knee points level it is level, as if the leg hung straight down.
    """
    along = np.array([0.0, -1.0, 0.0])
    if leg.knee[1] != 0.0:
        upper, foot = (skeleton.index(joint) for joint in (leg.upper, leg.foot))
        along = skeleton.world_from_bind[foot, :3, 3] - skeleton.world_from_bind[upper, :3, 3]
    return normalized(np.cross(_sided(leg.knee, leg), along))


def _swing_blade(
    pose: Pose, leg: RigLeg, numbers: FloatArray | None, path: FootPath | None
) -> None:
    """Turn a shoulder blade by its share of the angle that its leg has swung ahead of rest."""
    blade, foot = (pose.skeleton.index(joint) for joint in (leg.blade, leg.foot))
    rest = pose.skeleton.world_from_bind[foot, :3, 3] - pose.skeleton.world_from_bind[blade, :3, 3]
    ahead = np.zeros(len(pose.rotation))
    free = np.ones_like(ahead) if path is None else path.free
    if path is not None:
        carrier = pose.parent_rotation(leg.blade)
        to = rotate(inverse(carrier), path.ankle_m - pose.at(leg.blade))
        ahead += (1.0 - free) * _ahead_rad(to)
    if numbers is not None:
        ahead += free * _ahead_rad(columns_of(LegKey(), numbers)["to"])
    swing = leg.blade_share * (ahead - _ahead_rad(rest))
    pose.turn(leg.blade, quaternion_about(_X, -swing))


def _ahead_rad(to: FloatArray) -> FloatArray:
    """Return how far directions are swung ahead from straight down."""
    return np.asarray(np.arctan2(to[..., 2], -to[..., 1]))


def _free_leg(pose: Pose, leg: RigLeg, numbers: FloatArray, limb: Limb) -> None:
    key = columns_of(LegKey(), numbers)
    mirror = np.array([leg.out, 1.0, 1.0])
    carrier = pose.parent_rotation(leg.upper)
    base = pose.at(leg.upper)
    to = rotate(carrier, normalized(key["to"]) * mirror)
    knee = rotate(carrier, normalized(key["knee"]) * mirror)
    span = limb.span_m(np.radians(key["bend"]))[:, None]
    upper_q, lower_q = two_bone_ik(limb, base, base + to * span, knee)
    pose.set(leg.upper, upper_q)
    pose.set(leg.lower, lower_q)
    pose.turn(leg.foot, quaternion_about(_X, np.radians(key["point"])))
    if leg.toes:
        pose.turn(leg.toes, quaternion_about(_X, np.radians(0.3 * key["point"])))
