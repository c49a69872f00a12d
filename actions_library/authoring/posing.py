"""From keys and plants to a clip: the humanoid's rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from actions_library.authoring.feet import FootPath, FootShape, Plant, foot_path
from actions_library.authoring.keys import PARTS, Arm, Key, Leg, part_curve
from smd.character.clip import Clip
from smd.character.ik import limb_of, two_bone_ik
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    inverse,
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_euler,
    rotate,
    slerp,
)

RATE_HZ = 60.0

LEG_SOFTNESS = 0.004
"""Last part of a leg's reach that softens; short, since a foot that falls short slides."""

HEEL_BEHIND_ANKLE_M = 0.078

_SPINE_SHARE = {"spine": 0.30, "chest": 0.65, "upper_chest": 1.0}
_NECK_SHARE = 0.45
_FOREARM_TWIST_SHARE = 0.5

Numbers = dict[str, FloatArray]


@dataclass(frozen=True, slots=True, eq=False)
class GroundPath:
    """The ground root over time: ``left_m``, ``ahead_m`` and ``yaw_rad``, each ``(n,)``."""

    left_m: FloatArray
    ahead_m: FloatArray
    yaw_rad: FloatArray


class Pose:
    """World rotations and positions of the joints as they are worked out, root to tip."""

    def __init__(self, skeleton: Skeleton, frames: int) -> None:
        self.skeleton = skeleton
        self.rotation = np.tile(IDENTITY_XYZW, (frames, len(skeleton), 1))
        self.position = np.zeros((frames, len(skeleton), 3))

    def set(self, joint: str, world_xyzw: FloatArray) -> None:
        """Give a joint its rotation in the world; its parent must have been set."""
        j = self.skeleton.index(joint)
        parent = int(self.skeleton.parents[j])
        bone = self.skeleton.rest_translation_m[j]
        self.rotation[:, j] = world_xyzw
        self.position[:, j] = self.position[:, parent] + rotate(self.rotation[:, parent], bone)

    def turn(self, joint: str, local_xyzw: FloatArray) -> None:
        """Give a joint its rotation from its parent's."""
        self.set(joint, multiply(self.parent_rotation(joint), local_xyzw))

    def parent_rotation(self, joint: str) -> FloatArray:
        """Return the rotation in the world of a joint's parent."""
        return self.rotation[:, int(self.skeleton.parents[self.skeleton.index(joint)])]

    def at(self, joint: str) -> FloatArray:
        """Return where a joint will be, its parent being set."""
        j = self.skeleton.index(joint)
        parent = int(self.skeleton.parents[j])
        bone = self.skeleton.rest_translation_m[j]
        return self.position[:, parent] + rotate(self.rotation[:, parent], bone)

    def local(self) -> tuple[FloatArray, FloatArray]:
        """Return local rotations ``(n, j, 4)`` and translations ``(n, j, 3)``."""
        rotation, position = self.rotation.copy(), self.position.copy()
        for j, parent in enumerate(self.skeleton.parents):
            if parent >= 0:
                turn_back = inverse(self.rotation[:, parent])
                rotation[:, j] = multiply(turn_back, self.rotation[:, j])
                position[:, j] = rotate(turn_back, self.position[:, j] - self.position[:, parent])
        return rotation, position


def make_clip(
    skeleton: Skeleton,
    name: str,
    keys: Sequence[Key],
    ground: GroundPath,
    *,
    left_foot: Sequence[Plant] = (),
    right_foot: Sequence[Plant] = (),
    stage_ends_s: Sequence[float],
    cyclic: bool = False,
) -> Clip:
    """Pose the humanoid at every frame and return the clip.

    Parameters
    ----------
    keys
        Every part but the legs has at least one key; legs need one where there are no plants.
    ground
        Its length is the clip's. A cyclic clip's keys are carried along by it.
    left_foot, right_foot
        Plants in the clip's world, covering the clip's time.
    stage_ends_s
        When each of the five stages ends; the last is the clip's end.
    """
    frames = len(ground.yaw_rad)
    numbers = {
        part: curve
        for part in PARTS
        if (curve := part_curve(keys, part, frames, RATE_HZ, cyclic=cyclic)) is not None
    }
    pose = Pose(skeleton, frames)
    _stand_on_ground(pose, ground)
    _pose_trunk(pose, numbers, ground if cyclic else None)
    contacts = {}
    time_s = np.arange(frames) / RATE_HZ
    for side, out, plants in (("left", 1.0, left_foot), ("right", -1.0, right_foot)):
        _pose_arm(pose, side, out, numbers[f"{side}_arm"])
        if plants:
            path = foot_path(plants, foot_shape(skeleton, side), out, time_s)
            _pose_standing_leg(pose, side, path)
            contacts[f"{side}_foot"], contacts[f"{side}_toes"] = path.sole_down, path.toes_down
        else:
            _pose_free_leg(pose, side, out, numbers[f"{side}_leg"])
    rotation, translation = pose.local()
    return Clip(
        name=name,
        skeleton=skeleton,
        rate_hz=RATE_HZ,
        rotation_xyzw=rotation,
        translation_m=translation,
        stage_end_frames=np.round(np.asarray(stage_ends_s) * RATE_HZ).astype(np.int64),
        contact_joints=tuple(contacts),
        contacts=np.array(list(contacts.values()), dtype=bool).reshape(-1, frames).T,
        cyclic=cyclic,
    )


def _turn(yaw_lean_tilt_deg: FloatArray) -> FloatArray:
    return quaternion_from_euler("YXZ", np.radians(yaw_lean_tilt_deg))


def _stand_on_ground(pose: Pose, ground: GroundPath) -> None:
    pose.rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], ground.yaw_rad)
    zero = np.zeros_like(ground.left_m)
    pose.position[:, 0] = np.column_stack([ground.left_m, zero, ground.ahead_m])


def _pose_trunk(pose: Pose, numbers: Numbers, carrier: GroundPath | None) -> None:
    """Pose hips, spine, neck and head; the spine shares the way from hips to chest."""
    hips, chest, head = (_turn(numbers[part]) for part in ("hips", "chest", "head"))
    j = pose.skeleton.index("hips")
    pose.rotation[:, j] = hips
    pose.position[:, j] = numbers["place"] + pose.skeleton.rest_translation_m[j]
    if carrier is not None:
        pose.position[:, j] += pose.position[:, 0]
    for joint, share in _SPINE_SHARE.items():
        pose.set(joint, slerp(hips, chest, np.full(len(hips), share)))
    pose.set("neck", slerp(chest, head, np.full(len(hips), _NECK_SHARE)))
    pose.set("head", head)


def _columns(part: Arm | Leg, numbers: FloatArray) -> Numbers:
    """Return a part's numbers ``(n, c)`` by its fields' names; directions have three columns."""
    widths = {field.name: np.size(getattr(part, field.name)) for field in fields(part)}
    ends = np.cumsum(list(widths.values()))
    return {
        name: numbers[:, end - width : end] if width > 1 else numbers[:, end - 1]
        for (name, width), end in zip(widths.items(), ends, strict=True)
    }


def _pose_arm(pose: Pose, side: str, out: float, numbers: FloatArray) -> None:
    arm = _columns(Arm(), numbers)
    mirror = np.array([out, 1.0, 1.0])
    chest = pose.rotation[:, pose.skeleton.index("upper_chest")]
    frame = slerp(np.broadcast_to(IDENTITY_XYZW, chest.shape), chest, arm["follow"])
    to = rotate(frame, normalized(arm["to"]) * mirror)
    elbow = rotate(frame, normalized(arm["elbow"]) * mirror)
    pose.turn(f"{side}_shoulder", _shoulder(rotate(inverse(chest), to) * mirror, arm, out))

    upper, lower, hand = f"{side}_upper_arm", f"{side}_lower_arm", f"{side}_hand"
    limb = limb_of(pose.skeleton, upper, lower, hand, [0.0, 0.0, -1.0])
    base = pose.at(upper)
    span = limb.span_m(np.radians(arm["bend"]))[:, None]
    upper_q, lower_q = two_bone_ik(limb, base, base + to * span, elbow)
    pose.set(upper, upper_q)

    along = normalized(pose.skeleton.rest_translation_m[pose.skeleton.index(hand)])
    twist = out * np.radians(arm["twist"])
    pose.set(lower, multiply(lower_q, quaternion_about(along, _FOREARM_TWIST_SHARE * twist)))
    fold = np.array([0.0, 0.0, -out])
    wrist = multiply(
        quaternion_about(along, (1.0 - _FOREARM_TWIST_SHARE) * twist),
        quaternion_about(fold, np.radians(arm["flex"])),
    )
    pose.turn(hand, wrist)
    pose.turn(f"{side}_fingers", quaternion_about(fold, np.radians(arm["curl"])))
    over_palm = quaternion_about([1.0, -out, 0.0], np.radians(0.35 * arm["curl"]))
    across = quaternion_about([1.0, out, 0.0], np.radians(0.40 * arm["curl"]))
    pose.turn(f"{side}_thumb", multiply(across, over_palm))


def _shoulder(to: FloatArray, arm: Numbers, out: float) -> FloatArray:
    """Return the collar bone's turn: it rises with a raised arm and goes along with a reach."""
    raised = np.clip((to[:, 1] + 0.3) / 1.3, 0.0, 1.0)
    lift = 24.0 * raised * raised * (3.0 - 2.0 * raised) + arm["shrug"]
    straight = np.clip(1.0 - arm["bend"] / 150.0, 0.0, 1.0)
    forward = 14.0 * to[:, 2] * straight
    return _turn(np.column_stack([-out * forward, np.zeros_like(lift), out * lift]))


def foot_shape(skeleton: Skeleton, side: str) -> FootShape:
    """Return a foot's measures: the ball at the toes' joint, the heel on the ground."""
    ankle_height = float(skeleton.world_from_bind[skeleton.index(f"{side}_foot"), 1, 3])
    return FootShape(
        ball=skeleton.rest_translation_m[skeleton.index(f"{side}_toes")],
        heel=np.array([0.0, -ankle_height, -HEEL_BEHIND_ANKLE_M]),
        ankle_height=ankle_height,
    )


def _pose_standing_leg(pose: Pose, side: str, path: FootPath) -> None:
    """Bring the foot to its path; the knee points where foot and hips do, between them."""
    upper, lower, foot = f"{side}_upper_leg", f"{side}_lower_leg", f"{side}_foot"
    limb = limb_of(pose.skeleton, upper, lower, foot, [0.0, 0.0, 1.0])
    base = pose.at(upper)
    left = np.broadcast_to([1.0, 0.0, 0.0], base.shape)
    hips = pose.rotation[:, pose.skeleton.index("hips")]
    axis = normalized(rotate(hips, left) + rotate(path.rotation_xyzw, left))
    pole = np.cross(axis, base - path.ankle_m)
    upper_q, lower_q = two_bone_ik(limb, base, path.ankle_m, pole, softness=LEG_SOFTNESS)
    pose.set(upper, upper_q)
    pose.set(lower, lower_q)
    pose.set(foot, path.rotation_xyzw)
    pose.turn(f"{side}_toes", quaternion_about([1.0, 0.0, 0.0], -path.toes_up_rad))


def _pose_free_leg(pose: Pose, side: str, out: float, numbers: FloatArray) -> None:
    leg = _columns(Leg(), numbers)
    mirror = np.array([out, 1.0, 1.0])
    hips = pose.rotation[:, pose.skeleton.index("hips")]
    upper, lower, foot = f"{side}_upper_leg", f"{side}_lower_leg", f"{side}_foot"
    limb = limb_of(pose.skeleton, upper, lower, foot, [0.0, 0.0, 1.0])
    base = pose.at(upper)
    to = rotate(hips, normalized(leg["to"]) * mirror)
    knee = rotate(hips, normalized(leg["knee"]) * mirror)
    span = limb.span_m(np.radians(leg["bend"]))[:, None]
    upper_q, lower_q = two_bone_ik(limb, base, base + to * span, knee)
    pose.set(upper, upper_q)
    pose.set(lower, lower_q)
    pose.turn(foot, quaternion_about([1.0, 0.0, 0.0], np.radians(leg["point"])))
    pose.turn(f"{side}_toes", quaternion_about([1.0, 0.0, 0.0], np.radians(0.3 * leg["point"])))
