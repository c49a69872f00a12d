"""The dog's joints, and the parts of it that keys name.

It stands on its toes: what looks like a knee turned round is its ankle (hind) or wrist (fore).
"""

from __future__ import annotations

from actions_library.authoring.quadruped import fore_leg, hind_leg
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rigging import JointRow, skeleton_of, with_right_side

SHOULDER_HEIGHT_M = 0.55

_ROWS = (
    JointRow("root", "", (0.0, 0.0, 0.0), "root"),
    JointRow("pelvis", "root", (0.0, 0.470, -0.220), "root"),
    JointRow("loin", "pelvis", (0.0, 0.482, -0.125), "spine"),
    JointRow("back", "loin", (0.0, 0.486, -0.010), "spine"),
    JointRow("chest", "back", (0.0, 0.478, 0.105), "spine"),
    JointRow("neck", "chest", (0.0, 0.490, 0.225), "spine"),
    JointRow("upper_neck", "neck", (0.0, 0.560, 0.285), "spine"),
    JointRow("head", "upper_neck", (0.0, 0.630, 0.335), "spine"),
    JointRow("jaw", "head", (0.0, 0.604, 0.375), "end_effector"),
    JointRow("left_ear", "head", (0.046, 0.676, 0.328), "intermediate"),
    JointRow("left_ear_tip", "left_ear", (0.068, 0.632, 0.326), "end_effector"),
    JointRow("tail_1", "pelvis", (0.0, 0.492, -0.292), "intermediate"),
    JointRow("tail_2", "tail_1", (0.0, 0.500, -0.352), "intermediate"),
    JointRow("tail_3", "tail_2", (0.0, 0.522, -0.408), "intermediate"),
    JointRow("tail_4", "tail_3", (0.0, 0.556, -0.454), "intermediate"),
    JointRow("tail_5", "tail_4", (0.0, 0.600, -0.486), "end_effector"),
    JointRow("left_hip", "pelvis", (0.058, 0.452, -0.250), "intermediate"),
    JointRow("left_knee", "left_hip", (0.076, 0.302, -0.170), "intermediate"),
    JointRow("left_hock", "left_knee", (0.074, 0.150, -0.290), "intermediate"),
    JointRow("left_hind_toes", "left_hock", (0.074, 0.026, -0.262), "end_effector"),
    JointRow("left_shoulder_blade", "chest", (0.042, 0.530, 0.125), "intermediate"),
    JointRow("left_shoulder", "left_shoulder_blade", (0.066, 0.398, 0.212), "intermediate"),
    JointRow("left_elbow", "left_shoulder", (0.072, 0.284, 0.110), "intermediate"),
    JointRow("left_wrist", "left_elbow", (0.072, 0.112, 0.128), "intermediate"),
    JointRow("left_fore_toes", "left_wrist", (0.072, 0.026, 0.150), "end_effector"),
)


def dog_rig() -> Rig:
    """Return the dog: a spine, a neck that keeps the head level, a tail and ears that follow."""
    sides = ("left", "right")
    return Rig(
        skeleton=skeleton_of(with_right_side(_ROWS)),
        body="pelvis",
        pivot_m=(0.0, 0.0, 0.22),
        chains=(
            Chain("spine", ("loin", "back", "chest")),
            Chain("head", ("neck", "upper_neck", "head"), (0.3, 0.3, 0.4), steady=True),
            Chain("jaw", ("jaw",)),
            *(
                Chain(f"{side}_ear", (f"{side}_ear", f"{side}_ear_tip"), lag_s=0.06)
                for side in sides
            ),
            Chain("tail", tuple(f"tail_{k}" for k in range(1, 6)), lag_s=0.04),
        ),
        legs=(*(hind_leg(side) for side in sides), *(fore_leg(side) for side in sides)),
    )
