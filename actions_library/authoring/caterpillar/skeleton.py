"""The caterpillar's joints, and the parts of it that keys name.

Twelve segments from the tail to the head, as the ten of a moth caterpillar's abdomen, of which two
are one here, and the three of its thorax [1]_. Prolegs are on the last and on four in the middle,
jointed legs on the three behind the head.

References
----------
.. [1] L. I. van Griethuijsen, B. A. Trimmer, "Locomotion in caterpillars", Biological Reviews 89,
   2014.
"""

from __future__ import annotations

from actions_library.authoring.legs import RigLeg
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rigging import JointRow, Point, skeleton_of, with_right_side
from smd.character.skeleton import Role

SEGMENTS = 12
SEGMENT_M = 0.085
TAIL_M = -0.51
"""Where the first segment begins."""

LENGTH_M = SEGMENTS * SEGMENT_M
"""Of the trunk, without the head."""

HEIGHT_M = 0.105
"""Of the joints of the trunk over the ground."""

PROLEGS, TRUE_LEGS = (1, 4, 5, 6, 7), (10, 11, 12)
"""Segments that have them, from the tail."""

PAIRS = (*PROLEGS, *TRUE_LEGS)
_PROLEG: tuple[Point, ...] = ((0.040, 0.066, 0.0), (0.080, 0.046, 0.0), (0.056, 0.012, 0.0))
_TRUE_LEG: tuple[Point, ...] = ((0.036, 0.064, 0.0), (0.088, 0.058, 0.008), (0.062, 0.008, 0.014))

FOOT_AHEAD = 0.5
"""Where in its segment a pair of feet is, as a share of the segment's length."""


def segment(k: int) -> str:
    """Return the name of a segment's joint, 1 the last one of the body."""
    return f"segment_{k}"


def legs_of_pair(k: int) -> tuple[str, str]:
    """Return the names of the left and the right leg on a segment."""
    return f"left_leg_{k}", f"right_leg_{k}"


def segment_ahead_m(k: float) -> float:
    """Return where a segment's joint is at rest, ahead of the ground root."""
    return TAIL_M + (k - 1.0) * SEGMENT_M


def _rows() -> list[JointRow]:
    rows = [
        JointRow("root", "", (0.0, 0.0, 0.0), "root"),
        JointRow("trunk", "root", (0.0, HEIGHT_M, 0.0), "root"),
    ]
    for k in range(1, SEGMENTS + 1):
        holder = segment(k - 1) if k > 1 else "trunk"
        rows.append(JointRow(segment(k), holder, (0.0, HEIGHT_M, segment_ahead_m(k)), "spine"))
    head = TAIL_M + LENGTH_M
    rows += [
        JointRow("head", segment(SEGMENTS), (0.0, HEIGHT_M, head), "spine"),
        JointRow("left_feeler", "head", (0.034, 0.176, head + 0.060), "intermediate"),
        JointRow("left_feeler_tip", "left_feeler", (0.062, 0.232, head + 0.082), "end_effector"),
    ]
    for k in PAIRS:
        ahead = segment_ahead_m(k + FOOT_AHEAD)
        holder, places = segment(k), _PROLEG if k in PROLEGS else _TRUE_LEG
        for joint, (left, up, more) in zip(("hip", "knee", "foot"), places, strict=True):
            role: Role = "end_effector" if joint == "foot" else "intermediate"
            name = f"left_{joint}_{k}"
            rows.append(JointRow(name, holder, (left, up, ahead + more), role))
            holder = name
    return rows


def caterpillar_rig() -> Rig:
    """Return the caterpillar: a spine that is laid, a level head, eight pairs of feet."""
    sides = ("left", "right")
    return Rig(
        skeleton=skeleton_of(with_right_side(_rows())),
        body="trunk",
        chains=(
            Chain("spine", tuple(segment(k) for k in range(1, SEGMENTS + 1))),
            Chain("head", ("head",), steady=True),
            *(
                Chain(f"{side}_feeler", (f"{side}_feeler", f"{side}_feeler_tip"), lag_s=0.07)
                for side in sides
            ),
        ),
        legs=tuple(_leg(side, k) for k in PAIRS for side in sides),
    )


def _leg(side: str, k: int) -> RigLeg:
    return RigLeg(
        f"{side}_leg_{k}",
        f"{side}_hip_{k}",
        f"{side}_knee_{k}",
        f"{side}_foot_{k}",
        knee=(1.0, 0.3, 0.0),
    )
