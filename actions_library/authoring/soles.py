"""The soles: points on them, and the area of the ground that carries a standing body."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.feet import FootShape
from actions_library.authoring.humanoid import LEGS
from actions_library.authoring.legs import foot_shape
from actions_library.authoring.mass import SIDES
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import rotate

TOE_LENGTH_M = 0.088
FOOT_HALF_WIDTH_M = 0.040

ON_GROUND_M = 0.010
"""Height of a point of a sole up to which it carries."""

SEATED_M = 0.30
"""Height of the trunk's joints below which a body rests on more than its soles."""

PROPPED_M = 0.12
"""Height of a wrist below which a hand carries too."""


def sole_points(shape: FootShape) -> tuple[FloatArray, FloatArray]:
    """Return sole points from the ankle (heel, ball) and from the toes' joint (ball, tip)."""
    aside = FOOT_HALF_WIDTH_M * np.array([1.0, 0.0, 0.0])
    toe_height = shape.ankle_height + shape.ball[1]
    ball = np.array([shape.ball[0], -shape.ankle_height, shape.ball[2]])
    tip = np.array([0.0, -toe_height, TOE_LENGTH_M])
    root = np.array([0.0, -toe_height, 0.0])
    return np.stack([shape.heel, ball + aside, ball - aside]), np.stack(
        [root + aside, root - aside, tip]
    )


def sole_parts(skeleton: Skeleton) -> list[tuple[str, FloatArray]]:
    """Return each foot and toes joint with its sole points, in its own frame."""
    return [
        (f"{side}_{joint}", points)
        for side in SIDES
        for joint, points in zip(
            ("foot", "toes"), sole_points(foot_shape(skeleton, LEGS[side])), strict=True
        )
    ]


def soles_in_world(skeleton: Skeleton, rotation: FloatArray, position: FloatArray) -> FloatArray:
    """Return the points of both soles, ``(n, 12, 3)``, from joints in the world."""
    parts = []
    for joint, local in sole_parts(skeleton):
        j = skeleton.index(joint)
        parts.append(position[:, j, None] + rotate(rotation[:, j, None], local))
    return np.concatenate(parts, axis=1)


def on_more_than_soles(skeleton: Skeleton, position: FloatArray) -> BoolArray:
    """Return in which frames the body also rests on its seat, its back or its hands, ``(n,)``."""
    trunk = [skeleton.index(name) for name in ("hips", "spine", "upper_chest", "head")]
    hands = [skeleton.index(f"{side}_hand") for side in SIDES]
    low = position[:, trunk, 1].min(axis=1) < SEATED_M
    return np.asarray(low | (position[:, hands, 1].min(axis=1) < PROPPED_M))
