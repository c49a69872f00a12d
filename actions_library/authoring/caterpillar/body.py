"""The caterpillar's body: a ball a segment, melted; stumps for prolegs, a head with a face."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.body_field import Ellipsoid
from actions_library.authoring.caterpillar.skeleton import (
    HEIGHT_M,
    LENGTH_M,
    PROLEGS,
    SEGMENT_M,
    SEGMENTS,
    TAIL_M,
    TRUE_LEGS,
    segment,
    segment_ahead_m,
)
from actions_library.authoring.flesh import Lump, ball, bone, melted_mesh
from actions_library.authoring.rigging import place_of
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton

STEP_M = 0.005
"""Distance between nodes of the grid that the shape is sampled on."""

BODY_TRIANGLES = 7_000
LEAF_RGB = (0.30, 0.48, 0.10)
SPOT_RGB = (0.80, 0.62, 0.10)
HEAD_RGB = (0.42, 0.17, 0.05)
LEG_RGB = (0.12, 0.07, 0.04)
WHITE_RGB = (0.85, 0.85, 0.80)
DARK_RGB = (0.02, 0.018, 0.016)
_HEAD_M = TAIL_M + LENGTH_M


def caterpillar_character(skeleton: Skeleton, *, step_m: float = STEP_M) -> Character:
    """Return the caterpillar, on all its feet and facing +Z.

    Parameters
    ----------
    skeleton
        That of `actions_library.authoring.caterpillar.skeleton.caterpillar_rig`.
    step_m
        Coarser is quicker and loses the folds between segments.
    """
    body = melted_mesh(
        "body",
        skeleton,
        [*_trunk(), *_prolegs(skeleton)],
        step_m=step_m,
        triangle_count=BODY_TRIANGLES,
        color_rgb=LEAF_RGB,
    )
    return Character("caterpillar", skeleton, (body, *_features(skeleton)))


def radius_m(k: int) -> float:
    """Return how thick a segment is: plump in the middle, narrower at both ends."""
    along = (k - 0.5) / SEGMENTS
    return float(0.056 + 0.026 * np.sin(np.pi * (0.10 + 0.80 * along)) ** 0.6)


def _trunk() -> list[Lump]:
    lumps = []
    for k in range(1, SEGMENTS + 1):
        thick = radius_m(k)
        centre = (0.0, HEIGHT_M, segment_ahead_m(k + 0.5))
        round_ = Ellipsoid(centre, (thick, 0.96 * thick, 0.66 * SEGMENT_M))
        lumps.append(Lump(segment(k), round_, 0.022))
    return lumps


def _prolegs(skeleton: Skeleton) -> list[Lump]:
    """Stumps with a broad sole."""
    lumps = []
    for k in PROLEGS:
        left, _, ahead = place_of(skeleton, f"left_foot_{k}")
        sole = Ellipsoid((left, 0.012, ahead), (0.021, 0.012, 0.024))
        lumps += [
            bone(skeleton, f"left_hip_{k}", f"left_knee_{k}", 0.030, 0.026, reach_m=0.015),
            bone(skeleton, f"left_knee_{k}", f"left_foot_{k}", 0.023, 0.016, reach_m=0.010),
            Lump(f"left_foot_{k}", sole, 0.010),
        ]
    return lumps


def _features(skeleton: Skeleton) -> list[Mesh]:
    """A head with eyes and feelers, spots along the sides, jointed legs."""
    head = [
        Lump("head", Ellipsoid((0.0, 0.118, _HEAD_M + 0.046), (0.080, 0.076, 0.066)), 0.02),
        ball("head", (0.030, 0.090, _HEAD_M + 0.082), 0.034, reach_m=0.02),
    ]
    feelers = [
        bone(skeleton, "left_feeler", "left_feeler_tip", 0.0085, 0.0065, reach_m=0.004),
        ball("left_feeler_tip", place_of(skeleton, "left_feeler_tip"), 0.014, reach_m=0.006),
    ]
    eyes = [ball("head", (0.040, 0.140, _HEAD_M + 0.088), 0.026)]
    pupils = [ball("head", (0.041, 0.142, _HEAD_M + 0.104), 0.0145)]
    legs = []
    for k in TRUE_LEGS:
        foot = place_of(skeleton, f"left_foot_{k}")
        legs += [
            bone(skeleton, f"left_hip_{k}", f"left_knee_{k}", 0.016, 0.013, reach_m=0.006),
            bone(skeleton, f"left_knee_{k}", f"left_foot_{k}", 0.012, 0.008, reach_m=0.006),
            ball(f"left_foot_{k}", (foot[0], 0.008, foot[2]), 0.008, reach_m=0.004),
        ]
    spots = []
    for k in range(2, SEGMENTS + 1):
        thick, up = radius_m(k), np.radians(28.0)
        place = (
            float(thick * np.cos(up)),
            float(HEIGHT_M + 0.96 * thick * np.sin(up)),
            segment_ahead_m(k + 0.5),
        )
        spots.append(Lump(segment(k), Ellipsoid(place, (0.010, 0.017, 0.017)), 0.0))
    parts = (
        ("head", head, 0.004, 1_200, HEAD_RGB),
        ("feelers", feelers, 0.003, 400, LEG_RGB),
        ("eyes", eyes, 0.003, 400, WHITE_RGB),
        ("pupils", pupils, 0.002, 240, DARK_RGB),
        ("legs", legs, 0.003, 1_000, LEG_RGB),
        ("spots", spots, 0.004, 1_000, SPOT_RGB),
    )
    return [
        melted_mesh(name, skeleton, lumps, step_m=step, triangle_count=count, color_rgb=rgb)
        for name, lumps, step, count, rgb in parts
    ]
