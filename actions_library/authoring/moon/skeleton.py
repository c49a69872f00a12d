"""The moon's joints: the face and two eyes; the rest of it is shapes."""

from __future__ import annotations

from actions_library.authoring.eyes import Eye
from actions_library.authoring.moon.motions import MOON_SHAPES
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rigging import JointRow, skeleton_of, with_right_side

CENTRE_M = (0.0, 0.180, 0.0)
EYE = Eye(centre=(0.053, 0.213, 0.0800), radius=0.027)


def moon_rig() -> Rig:
    """Return the moon, whose body is its face; eyes turn in the face's own directions."""
    rows = (
        JointRow("root", "", (0.0, 0.0, 0.0), "root"),
        JointRow("face", "root", CENTRE_M, "root"),
        JointRow("left_eye", "face", EYE.centre, "end_effector"),
    )
    return Rig(
        skeleton=skeleton_of(with_right_side(rows)),
        body="face",
        chains=(Chain("left_eye", ("left_eye",)), Chain("right_eye", ("right_eye",))),
        tracks=MOON_SHAPES,
    )
