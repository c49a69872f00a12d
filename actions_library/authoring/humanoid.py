"""The shipped humanoid's skeleton: 1.75 m tall, bound with its arms 45° down, facing +Z."""

from __future__ import annotations

from actions_library.authoring.hand_shape import left_fingers
from actions_library.authoring.legs import RigLeg
from actions_library.authoring.rigging import JointRow, skeleton_of, with_right_side
from smd.character.skeleton import Skeleton

HEIGHT_M = 1.75


def _finger_rows() -> list[JointRow]:
    """Return the left fingers' joints, each finger's from the hand to the tip."""
    return [
        JointRow(
            f"left_{joint}",
            f"left_{parent}",
            tuple(finger.places[k].tolist()),
            "end_effector" if k == 2 else "intermediate",
        )
        for finger in left_fingers()
        for k, (joint, parent) in enumerate(
            zip(finger.joints, ("hand", *finger.joints), strict=False)
        )
    ]


_ROWS = (
    JointRow("root", "", (0.0, 0.0, 0.0), "root"),
    JointRow("hips", "root", (0.0, 0.955, 0.0), "root"),
    JointRow("spine", "hips", (0.0, 1.045, -0.005), "spine"),
    JointRow("chest", "spine", (0.0, 1.155, -0.012), "spine"),
    JointRow("upper_chest", "chest", (0.0, 1.275, -0.012), "spine"),
    JointRow("neck", "upper_chest", (0.0, 1.455, -0.005), "spine"),
    JointRow("head", "neck", (0.0, 1.545, 0.015), "spine"),
    JointRow("left_eye", "head", (0.033, 1.624, 0.0715), "end_effector"),
    JointRow("left_shoulder", "upper_chest", (0.030, 1.410, 0.005), "intermediate"),
    JointRow("left_upper_arm", "left_shoulder", (0.175, 1.405, -0.010), "intermediate"),
    JointRow("left_lower_arm", "left_upper_arm", (0.375, 1.205, -0.020), "intermediate"),
    JointRow("left_hand", "left_lower_arm", (0.553, 1.027, 0.000), "intermediate"),
    *_finger_rows(),
    JointRow("left_upper_leg", "hips", (0.092, 0.905, 0.000), "intermediate"),
    JointRow("left_lower_leg", "left_upper_leg", (0.094, 0.492, 0.008), "intermediate"),
    JointRow("left_foot", "left_lower_leg", (0.096, 0.085, -0.020), "intermediate"),
    JointRow("left_toes", "left_foot", (0.100, 0.022, 0.115), "end_effector"),
)

LEGS = {
    side: RigLeg(
        f"{side}_leg",
        f"{side}_upper_leg",
        f"{side}_lower_leg",
        f"{side}_foot",
        f"{side}_toes",
        heel_behind_m=0.078,
    )
    for side in ("left", "right")
}


def humanoid_skeleton() -> Skeleton:
    """Return the skeleton: 55 joints, all rest rotations identity."""
    return skeleton_of(with_right_side(_ROWS))
