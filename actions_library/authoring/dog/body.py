"""The dog's body: round cones along its bones, melted into one skin; eyes and a nose."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.body_field import Ellipsoid
from actions_library.authoring.flesh import Lump, ball, bone, melted_mesh
from actions_library.authoring.rigging import Point
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

STEP_M = 0.005
"""Distance between nodes of the grid that the shape is sampled on."""

BODY_TRIANGLES = 9_000
COAT_RGB = (0.47, 0.27, 0.12)
DARK_RGB = (0.02, 0.018, 0.016)


def dog_character(skeleton: Skeleton, *, step_m: float = STEP_M) -> Character:
    """Return the dog, standing and facing +Z.

    Parameters
    ----------
    skeleton
        That of `actions_library.authoring.dog.skeleton.dog_rig`.
    step_m
        Coarser is quicker and loses ears and paws.
    """
    coat = melted_mesh(
        "coat",
        skeleton,
        [*_trunk(skeleton), *_head(skeleton), *_tail(skeleton), *_legs(skeleton)],
        step_m=step_m,
        triangle_count=BODY_TRIANGLES,
        color_rgb=COAT_RGB,
        magnified=_face_magnified,
    )
    return Character("dog", skeleton, (coat, *_features(skeleton)))


def _trunk(skeleton: Skeleton) -> list[Lump]:
    """A deep rib cage, a tucked-up belly, a croup that slopes to the tail."""
    return [
        bone(
            skeleton,
            "chest",
            (0.0, 0.435, 0.185),
            0.098,
            0.082,
            start=(0.0, 0.408, 0.095),
            reach_m=0.06,
        ),
        bone(
            skeleton,
            "back",
            (0.0, 0.412, 0.100),
            0.090,
            0.102,
            start=(0.0, 0.424, 0.000),
            reach_m=0.06,
        ),
        bone(
            skeleton,
            "loin",
            (0.0, 0.430, 0.000),
            0.072,
            0.084,
            start=(0.0, 0.450, -0.110),
            reach_m=0.06,
        ),
        bone(
            skeleton,
            "pelvis",
            (0.0, 0.452, -0.120),
            0.076,
            0.072,
            start=(0.0, 0.456, -0.225),
            reach_m=0.06,
        ),
        bone(skeleton, "neck", "upper_neck", 0.078, 0.062, reach_m=0.07),
        bone(skeleton, "upper_neck", "head", 0.062, 0.054, reach_m=0.05),
        bone(
            skeleton,
            "chest",
            (0.0, 0.400, 0.215),
            0.066,
            0.050,
            start=(0.0, 0.470, 0.190),
            reach_m=0.06,
        ),
    ]


def _head(skeleton: Skeleton) -> list[Lump]:
    """A skull with a stop, a muzzle over a jaw, ears that hang."""
    ear = (0.060, 0.652, 0.328)
    return [
        bone(skeleton, "head", (0.0, 0.648, 0.385), 0.058, 0.050, start=(0.0, 0.644, 0.345)),
        bone(
            skeleton,
            "head",
            (0.0, 0.624, 0.492),
            0.037,
            0.025,
            start=(0.0, 0.630, 0.410),
            reach_m=0.022,
        ),
        bone(
            skeleton,
            "jaw",
            (0.0, 0.596, 0.474),
            0.026,
            0.016,
            start=(0.0, 0.603, 0.388),
            reach_m=0.012,
        ),
        bone(
            skeleton,
            "head",
            (0.052, 0.668, 0.330),
            0.016,
            0.015,
            start=(0.034, 0.684, 0.336),
            reach_m=0.018,
        ),
        Lump("left_ear", Ellipsoid(ear, (0.011, 0.034, 0.026), _flap()), 0.010),
        Lump(
            "left_ear_tip", Ellipsoid((0.073, 0.610, 0.330), (0.009, 0.040, 0.021), _flap()), 0.012
        ),
    ]


def _flap() -> FloatArray:
    """Return the axes of an ear that hangs outward: thin across, long downward."""
    out = np.radians(24.0)
    across, down = (np.cos(out), np.sin(out), 0.0), (np.sin(out), -np.cos(out), 0.0)
    return np.column_stack([across, down, np.cross(across, down)])


def _tail(skeleton: Skeleton) -> list[Lump]:
    radius = (0.028, 0.022, 0.020, 0.018, 0.016)
    tip: Point = (0.0, 0.652, -0.500)
    lumps = [
        bone(skeleton, f"tail_{k}", f"tail_{k + 1}", radius[k - 1], radius[k], reach_m=0.02)
        for k in range(1, 5)
    ]
    return [*lumps, bone(skeleton, "tail_5", tip, radius[4], 0.009, reach_m=0.02)]


def _legs(skeleton: Skeleton) -> list[Lump]:
    return [
        bone(skeleton, "left_hip", "left_knee", 0.066, 0.044, reach_m=0.05),
        bone(skeleton, "left_knee", "left_hock", 0.042, 0.019, reach_m=0.03),
        bone(skeleton, "left_hock", "left_hind_toes", 0.019, 0.018, reach_m=0.015),
        ball("left_hock", (0.074, 0.156, -0.300), 0.016, reach_m=0.015),
        *_paw("left_hind_toes", 0.074, -0.250),
        bone(
            skeleton,
            "left_shoulder_blade",
            "left_shoulder",
            0.034,
            0.050,
            start=(0.040, 0.492, 0.140),
            reach_m=0.05,
        ),
        bone(skeleton, "left_shoulder", "left_elbow", 0.050, 0.036, reach_m=0.04),
        bone(skeleton, "left_elbow", "left_wrist", 0.033, 0.020, reach_m=0.025),
        bone(skeleton, "left_wrist", "left_fore_toes", 0.021, 0.019, reach_m=0.015),
        *_paw("left_fore_toes", 0.072, 0.162),
    ]


def _paw(joint: str, left: float, ahead: float) -> list[Lump]:
    """A broad pad and two pairs of toes."""
    pad = Lump(joint, Ellipsoid((left, 0.022, ahead), (0.028, 0.022, 0.034)), 0.015)
    toes = [
        ball(joint, (left + side, 0.016, ahead + reach), 0.0145, reach_m=0.008)
        for side, reach in ((-0.020, 0.020), (-0.007, 0.030), (0.007, 0.030), (0.020, 0.020))
    ]
    return [pad, *toes]


def _features(skeleton: Skeleton) -> list[Mesh]:
    """Eyes and a nose."""
    eye = [ball("head", (0.031, 0.663, 0.421), 0.0115)]
    nose = [Lump("head", Ellipsoid((0.0, 0.632, 0.512), (0.017, 0.013, 0.012)))]
    return [
        melted_mesh(name, skeleton, lumps, step_m=step_m, triangle_count=300, color_rgb=DARK_RGB)
        for name, lumps, step_m in (("eyes", eye, 0.002), ("nose", nose, 0.003))
    ]


def _face_magnified(points: FloatArray) -> FloatArray:
    """Return points with the head larger: looked at closely, it needs more triangles."""
    neck = np.array([0.0, 0.62, 0.32])
    on_head = np.clip((points[:, 1:2] - 0.58) / 0.03, 0.0, 1.0) * (points[:, 2:] > 0.2)
    return points + 0.6 * on_head * (points - neck)
