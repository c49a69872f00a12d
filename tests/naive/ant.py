"""A small rig with six legs that stand out sideways, and a tail: what no shipped character has."""

from __future__ import annotations

from actions_library.authoring.legs import RigLeg
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rigging import JointRow, skeleton_of, with_right_side

PLACES = {"hind": -0.08, "middle": 0.0, "fore": 0.08}


def ant_legs() -> list[tuple[str, str]]:
    """Names of the pairs of legs, from hind to fore."""
    return [(f"left_{place}", f"right_{place}") for place in PLACES]


def ant_rig() -> Rig:
    """Knees point up and out; the feet have no toes."""
    rows = [
        JointRow("root", "", (0.0, 0.0, 0.0), "root"),
        JointRow("body", "root", (0.0, 0.10, 0.0), "root"),
        JointRow("tail_1", "body", (0.0, 0.10, -0.12), "intermediate"),
        JointRow("tail_2", "tail_1", (0.0, 0.12, -0.20), "intermediate"),
        JointRow("tail_3", "tail_2", (0.0, 0.15, -0.26), "end_effector"),
    ]
    for place, z in PLACES.items():
        rows += [
            JointRow(f"left_{place}_hip", "body", (0.03, 0.10, z), "intermediate"),
            JointRow(f"left_{place}_knee", f"left_{place}_hip", (0.10, 0.15, z), "intermediate"),
            JointRow(f"left_{place}_foot", f"left_{place}_knee", (0.15, 0.01, z), "end_effector"),
        ]
    legs = [
        RigLeg(name, f"{name}_hip", f"{name}_knee", f"{name}_foot", knee=(0.5, 1.0, 0.0))
        for pair in ant_legs()
        for name in pair
    ]
    return Rig(
        skeleton=skeleton_of(with_right_side(rows)),
        body="body",
        chains=(Chain("tail", ("tail_1", "tail_2", "tail_3"), lag_s=0.05),),
        legs=tuple(legs),
        tracks=("glow",),
    )
