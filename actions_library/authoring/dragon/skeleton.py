"""The dragon's joints, and the parts of it that keys name.

Fore and hind legs are a dog's in kind. A wing is a hand: arm, forearm, and three fingers that
spread its skin. The joint that holds it beats and tilts its plane; those after it fold it in that
plane.
"""

from __future__ import annotations

from actions_library.authoring.eyes import Eye
from actions_library.authoring.quadruped import fore_leg, hind_leg
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rigging import JointRow, Point, skeleton_of, with_right_side

TAIL: tuple[Point, ...] = (
    (0.0, 0.452, -0.300),
    (0.0, 0.425, -0.385),
    (0.0, 0.390, -0.465),
    (0.0, 0.355, -0.545),
    (0.0, 0.330, -0.625),
    (0.0, 0.320, -0.705),
    (0.0, 0.330, -0.785),
    (0.0, 0.358, -0.860),
)
TAIL_TIP: Point = (0.0, 0.405, -0.930)
NECK: tuple[Point, ...] = (
    (0.0, 0.505, 0.205),
    (0.0, 0.575, 0.262),
    (0.0, 0.655, 0.300),
    (0.0, 0.735, 0.325),
)
HEAD_M: Point = (0.0, 0.805, 0.350)
EYE = Eye(
    centre=(0.0500, 0.862, 0.4180),
    radius=0.031,
    out_deg=34.0,
    iris_deg=40.0,
    pupil_deg=30.0,
    slit=0.36,
    upper_deg=40.0,
    lower_deg=-34.0,
)

ELBOW: Point = (0.215, 0.640, 0.010)
WRIST: Point = (0.400, 0.665, 0.140)
FINGER_TIPS: tuple[Point, ...] = (
    (0.820, 0.640, 0.090),
    (0.770, 0.615, -0.190),
    (0.570, 0.595, -0.340),
)

SHAPES = (
    *("jaw_open", "snarl", "brow_angry", "brow_raise", "nostril_flare"),
    *("throat_puff", "crest_raise", "left_blink", "right_blink"),
)
"""Of the dragon's face."""

_ROWS = (
    JointRow("root", "", (0.0, 0.0, 0.0), "root"),
    JointRow("pelvis", "root", (0.0, 0.470, -0.220), "root"),
    JointRow("loin", "pelvis", (0.0, 0.478, -0.125), "spine"),
    JointRow("back", "loin", (0.0, 0.482, -0.010), "spine"),
    JointRow("chest", "back", (0.0, 0.480, 0.105), "spine"),
    *(
        JointRow(f"neck_{k}", f"neck_{k - 1}" if k > 1 else "chest", place, "spine")
        for k, place in enumerate(NECK, 1)
    ),
    JointRow("head", "neck_4", HEAD_M, "spine"),
    JointRow("left_eye", "head", EYE.centre, "end_effector"),
    *(
        JointRow(
            f"tail_{k}",
            f"tail_{k - 1}" if k > 1 else "pelvis",
            place,
            "end_effector" if k == len(TAIL) else "intermediate",
        )
        for k, place in enumerate(TAIL, 1)
    ),
    JointRow("left_wing", "chest", (0.055, 0.580, 0.075), "intermediate"),
    JointRow("left_wing_arm", "left_wing", (0.070, 0.590, 0.070), "intermediate"),
    JointRow("left_wing_forearm", "left_wing_arm", ELBOW, "intermediate"),
    *(
        JointRow(f"left_finger_{k}", "left_wing_forearm", WRIST, "end_effector")
        for k in range(1, 4)
    ),
    JointRow("left_hip", "pelvis", (0.078, 0.452, -0.250), "intermediate"),
    JointRow("left_knee", "left_hip", (0.104, 0.302, -0.170), "intermediate"),
    JointRow("left_hock", "left_knee", (0.102, 0.150, -0.290), "intermediate"),
    JointRow("left_hind_toes", "left_hock", (0.102, 0.028, -0.256), "end_effector"),
    JointRow("left_shoulder_blade", "chest", (0.056, 0.525, 0.120), "intermediate"),
    JointRow("left_shoulder", "left_shoulder_blade", (0.088, 0.398, 0.200), "intermediate"),
    JointRow("left_elbow", "left_shoulder", (0.100, 0.284, 0.100), "intermediate"),
    JointRow("left_wrist", "left_elbow", (0.100, 0.112, 0.124), "intermediate"),
    JointRow("left_fore_toes", "left_wrist", (0.100, 0.028, 0.152), "end_effector"),
)


def dragon_rig() -> Rig:
    """Return the dragon; its neck keeps the head level, its tail follows."""
    sides = ("left", "right")
    wings = tuple(
        Chain(f"{side}_{part}", (f"{side}_{part}",))
        for side in sides
        for part in ("wing", "wing_arm", "wing_forearm", *(f"finger_{k}" for k in range(1, 4)))
    )
    return Rig(
        skeleton=skeleton_of(with_right_side(_ROWS)),
        body="pelvis",
        pivot_m=(0.0, 0.0, 0.22),
        chains=(
            Chain("spine", ("loin", "back", "chest")),
            Chain("neck", tuple(f"neck_{k}" for k in range(1, 5)), lag_s=0.03),
            Chain("head", ("head",), steady=True),
            Chain("tail_root", ("tail_1",)),
            Chain("tail", tuple(f"tail_{k}" for k in range(2, len(TAIL) + 1)), lag_s=0.04),
            *wings,
            *(Chain(f"{side}_eye", (f"{side}_eye",)) for side in sides),
        ),
        legs=(*(hind_leg(side) for side in sides), *(fore_leg(side) for side in sides)),
        tracks=SHAPES,
    )
