"""From keys and plants to a clip: the humanoid's rig."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.feet import FootPath, FootShape, Plant, foot_path
from actions_library.authoring.humanoid import LEGS
from actions_library.authoring.keys import PARTS, Key, Numbers, part_curve
from actions_library.authoring.legs import foot_shape, leg_room_m, pose_leg
from actions_library.authoring.limbs import palm_shape, pose_arm
from actions_library.authoring.mass import SIDES, centre_of_mass
from actions_library.authoring.pose import Pose
from actions_library.authoring.soles import on_more_than_soles, soles_in_world
from actions_library.authoring.support import support_of
from actions_library.authoring.weight import CarriedBody, shift_of_hips
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import quaternion_about, quaternion_from_euler, slerp

RATE_HZ = 60.0

_SPINE_SHARE = {"spine": 0.30, "chest": 0.65, "upper_chest": 1.0}
_NECK_SHARE = 0.45

_ROUNDS = 3
"""How often the hips are moved: the mass centre does not quite follow them."""


@dataclass(frozen=True, slots=True, eq=False)
class RootCourse:
    """The ground root over time: ``left_m``, ``ahead_m`` and ``yaw_rad``, each ``(n,)``."""

    left_m: FloatArray
    ahead_m: FloatArray
    yaw_rad: FloatArray


def make_clip(
    skeleton: Skeleton,
    name: str,
    keys: Sequence[Key],
    ground: RootCourse,
    *,
    left_foot: Sequence[Plant] = (),
    right_foot: Sequence[Plant] = (),
    left_palm: Sequence[Plant] = (),
    right_palm: Sequence[Plant] = (),
    stage_ends_s: Sequence[float],
    cyclic: bool = False,
) -> Clip:
    """Pose the humanoid at every frame and return the clip; its hips follow its weight.

    Parameters
    ----------
    keys
        Trunk, head and arms have at least one key each; legs need one where they have no plants,
        or plants between which they swing by their own keys.
    ground
        Its length is the clip's. A cyclic clip's keys are carried along by it.
    left_foot, right_foot, left_palm, right_palm
        Plants in the clip's world, covering the clip's time; of a palm, those of the wrist.
    stage_ends_s
        When each of the five stages ends; the last is the clip's end.
    """
    frames = len(ground.yaw_rad)
    numbers = {
        part: curve
        for part in PARTS
        if (curve := part_curve(keys, part, frames, RATE_HZ, cyclic=cyclic)) is not None
    }
    if cyclic:
        for part in ("place", "left_hand", "right_hand"):
            if part in numbers:
                numbers[part] = _carried(numbers[part], part, ground)
    time_s = np.arange(frames) / RATE_HZ
    feet = _paths(skeleton, _humanoid_foot, left_foot, right_foot, time_s)
    palms = _paths(skeleton, palm_shape, left_palm, right_palm, time_s)
    pose = _posed(skeleton, numbers, ground, feet, palms)
    if any(feet.values()):
        for _ in range(_ROUNDS):
            shift = shift_of_hips(_on_feet(pose, feet, cyclic=cyclic))
            numbers["place"] = numbers["place"] + shift
            pose = _posed(skeleton, numbers, ground, feet, palms)
    contacts = {}
    for side in SIDES:
        contacts.update(_contacts(feet[side], f"{side}_foot", f"{side}_toes"))
        contacts.update(_contacts(palms[side], f"{side}_hand", f"{side}_middle_proximal"))
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


def _paths(
    skeleton: Skeleton,
    shape_of: Callable[[Skeleton, str], FootShape],
    left: Sequence[Plant],
    right: Sequence[Plant],
    time_s: FloatArray,
) -> dict[str, FootPath | None]:
    """Return the ways of both feet, or of both palms; None where there are no plants."""
    return {
        side: foot_path(plants, shape_of(skeleton, side), out, time_s) if plants else None
        for side, out, plants in (("left", 1.0, left), ("right", -1.0, right))
    }


def _humanoid_foot(skeleton: Skeleton, side: str) -> FootShape:
    return foot_shape(skeleton, LEGS[side])


def _posed(
    skeleton: Skeleton,
    numbers: Numbers,
    ground: RootCourse,
    feet: Mapping[str, FootPath | None],
    palms: Mapping[str, FootPath | None],
) -> Pose:
    """Return the pose at every frame."""
    pose = Pose(skeleton, len(ground.yaw_rad))
    _stand_on_ground(pose, ground)
    _pose_trunk(pose, numbers)
    for side, out in (("left", 1.0), ("right", -1.0)):
        arm, hand = numbers[f"{side}_arm"], numbers.get(f"{side}_hand")
        pose_arm(pose, side, out, arm, hand, palms[side])
        pose_leg(pose, LEGS[side], numbers.get(f"{side}_leg"), feet[side])
    return pose


def _on_feet(pose: Pose, feet: Mapping[str, FootPath | None], *, cyclic: bool) -> CarriedBody:
    """Return the body's mass centre and what carries it."""
    rooms = [leg_room_m(pose, LEGS[side], path) for side, path in feet.items() if path]
    soles = soles_in_world(pose.skeleton, pose.rotation, pose.position)
    return CarriedBody(
        centre_m=centre_of_mass(pose.skeleton, pose.position),
        support=support_of(soles),
        free=on_more_than_soles(pose.skeleton, pose.position),
        room_m=np.min(rooms, axis=0),
        rate_hz=RATE_HZ,
        cyclic=cyclic,
    )


def _contacts(path: FootPath | None, sole: str, toes: str) -> dict[str, np.ndarray]:
    """Return when a sole and its toes are down, by the joint."""
    return {} if path is None else {sole: path.sole_down, toes: path.toes_down}


def _carried(numbers: FloatArray, part: str, ground: RootCourse) -> FloatArray:
    """Return places that a cyclic clip's steady travel carries along: three first columns."""
    out = -1.0 if part == "right_hand" else 1.0
    numbers = numbers.copy()
    numbers[:, 0] += out * ground.left_m
    numbers[:, 2] += ground.ahead_m
    return numbers


def _turn(yaw_lean_tilt_deg: FloatArray) -> FloatArray:
    return quaternion_from_euler("YXZ", np.radians(yaw_lean_tilt_deg))


def _stand_on_ground(pose: Pose, ground: RootCourse) -> None:
    pose.rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], ground.yaw_rad)
    zero = np.zeros_like(ground.left_m)
    pose.position[:, 0] = np.column_stack([ground.left_m, zero, ground.ahead_m])


def _pose_trunk(pose: Pose, numbers: Numbers) -> None:
    """Pose hips, spine, neck, head and eyes; the spine shares the way from hips to chest."""
    hips, chest, head = (_turn(numbers[part]) for part in ("hips", "chest", "head"))
    j = pose.skeleton.index("hips")
    pose.rotation[:, j] = hips
    pose.position[:, j] = numbers["place"] + pose.skeleton.rest_translation_m[j]
    for joint, share in _SPINE_SHARE.items():
        pose.set(joint, slerp(hips, chest, np.full(len(hips), share)))
    pose.set("neck", slerp(chest, head, np.full(len(hips), _NECK_SHARE)))
    pose.set("head", head)
    left_up = numbers.get("gaze", np.zeros((len(head), 2)))
    yaw_pitch = np.radians(left_up * [1.0, -1.0])
    eyes = quaternion_from_euler("YXZ", np.column_stack([yaw_pitch, np.zeros(len(head))]))
    for side in SIDES:
        pose.turn(f"{side}_eye", eyes)
