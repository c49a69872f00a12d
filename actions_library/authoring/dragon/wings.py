"""The dragon's wings: skin between arm, forearm and fingers, thin; and how they fold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.dragon.skeleton import ELBOW, FINGER_TIPS, WRIST
from actions_library.authoring.keys import Turn
from actions_library.authoring.rig_keys import Part
from actions_library.authoring.rigging import Point, other_side
from actions_library.authoring.solids import Solid, capsule
from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray

THICKNESS_M = 0.003

FLANK: Point = (0.082, 0.538, -0.140)
"""Where the skin ends at the body."""

TRAILING: Point = (0.300, 0.585, -0.265)
"""Where it ends behind the elbow."""

_DOWN, _ACROSS = 8, 6
"""Cells of each panel, from the bone to its edge and from line to line."""

_FOLD = {
    "wing_arm": 56.0,
    "wing_forearm": -100.0,
    "finger_1": 126.0,
    "finger_2": 95.0,
    "finger_3": 70.0,
}
"""How far each joint turns back in the wing's plane when it is folded (°)."""

Weights = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class _Line:
    """A line of the skin from a bone to its edge: its ends, and who moves each."""

    start: Point
    end: Point
    holds_start: Weights
    holds_end: Weights


_LINES = (
    _Line((0.055, 0.575, 0.075), FLANK, {"left_wing": 1.0}, {"back": 0.5, "loin": 0.5}),
    _Line(
        ELBOW,
        TRAILING,
        {"left_wing_arm": 0.5, "left_wing_forearm": 0.5},
        {"left_wing_arm": 0.25, "left_wing": 0.5, "left_finger_3": 0.25},
    ),
    _Line(WRIST, FINGER_TIPS[2], {"left_wing_forearm": 1.0}, {"left_finger_3": 1.0}),
    _Line(WRIST, FINGER_TIPS[1], {"left_wing_forearm": 1.0}, {"left_finger_2": 1.0}),
    _Line(WRIST, FINGER_TIPS[0], {"left_wing_forearm": 1.0}, {"left_finger_1": 1.0}),
)
"""From the body to the leading finger."""


def wing_pose(
    folded: float = 1.0, *, raised: float = 0.0, twisted: float = 0.0, swept: float = 0.0
) -> dict[str, Part]:
    """Return the turns of both wings.

    Parameters
    ----------
    folded
        1 folded over the back, 0 spread.
    raised, twisted, swept
        Of its plane: up, its leading edge down, back (°).
    """
    parts: dict[str, Part] = {
        "left_wing": Turn(yaw=swept, lean=twisted, tilt=raised),
        **{f"left_{name}": Turn(yaw=folded * angle) for name, angle in _FOLD.items()},
    }
    for name, part in tuple(parts.items()):
        if isinstance(part, Turn):
            parts[other_side(name)] = Turn(-part.yaw, part.lean, -part.tilt)
    return parts


def wing_bones() -> list[Solid]:
    """Return the left wing's bones, claws on the wrist and the fingers."""
    arm: Point = (0.050, 0.572, 0.072)
    bones = [
        capsule("left_wing_arm", arm, ELBOW, 0.024, 0.015),
        capsule("left_wing_forearm", ELBOW, WRIST, 0.015, 0.012),
    ]
    for k, (tip, radius) in enumerate(zip(FINGER_TIPS, (0.011, 0.009, 0.008), strict=True), 1):
        bones.append(capsule(f"left_finger_{k}", WRIST, tip, radius, 0.0035))
    return bones


def wing_claw() -> Solid:
    """Return the claw on the left wrist."""
    x, y, z = WRIST
    return capsule(
        "left_finger_1", (x, y, z + 0.006), (x + 0.004, y + 0.02, z + 0.05), 0.009, 0.001
    )


def wing_skin(skeleton: Skeleton, color_rgb: tuple[float, float, float]) -> Mesh:
    """Return the skin of both wings."""
    points, weights, faces = _sheet(skeleton)
    image = points * np.array([-1.0, 1.0, 1.0])
    twins = [skeleton.index(other_side(joint)) for joint in skeleton.joints]
    both = np.concatenate([weights, weights[:, twins]])
    order = np.argsort(-both, axis=1, kind="stable")[:, :4]
    held = np.take_along_axis(both, order, axis=1)
    return Mesh(
        "wings",
        np.concatenate([points, image]),
        np.concatenate([faces, faces[:, ::-1] + len(points)]),
        order,
        held / held.sum(axis=1, keepdims=True),
        color_rgb,
    )


def _sheet(skeleton: Skeleton) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the left wing's upper and lower side."""
    columns = _ACROSS * (len(_LINES) - 1) + 1
    down = np.linspace(0.0, 1.0, _DOWN + 1)
    grid = np.zeros((_DOWN + 1, columns, 3))
    weights = np.zeros((_DOWN + 1, columns, len(skeleton)))
    for c in range(columns):
        panel = min(c // _ACROSS, len(_LINES) - 2)
        t = c / _ACROSS - panel
        near, far = _LINES[panel], _LINES[panel + 1]
        edge = 1.0 - 0.16 * 4.0 * t * (1.0 - t)  # scalloped between the lines
        hangs_m = 0.020 if panel else -0.012  # folded, the inner one must not lie in the back
        bow = hangs_m * 4.0 * t * (1.0 - t)
        for line, share in ((near, 1.0 - t), (far, t)):
            start, end = np.array(line.start), np.array(line.end)
            grid[:, c] += share * (start + np.outer(down * edge, end - start))
            for holds, part in ((line.holds_start, 1.0 - down), (line.holds_end, down)):
                for joint, weight in holds.items():
                    weights[:, c, skeleton.index(joint)] += share * weight * part
        grid[:, c, 1] -= bow * down
    for row in range(1, _DOWN + 1):  # along fingers it is rigid, from the knuckle on
        for number in range(2, len(_LINES)):
            c = number * _ACROSS
            weights[row, c] = 0.0
            weights[row, c, skeleton.index(f"left_finger_{5 - number}")] = 1.0
    half = 0.5 * THICKNESS_M * np.array([0.0, 1.0, 0.0])
    points = np.concatenate([(grid + half).reshape(-1, 3), (grid - half).reshape(-1, 3)])
    k = (np.arange(_DOWN)[:, None] * columns + np.arange(columns - 1)).ravel()
    top = np.concatenate(
        [
            np.column_stack([k, k + 1, k + columns]),
            np.column_stack([k + 1, k + columns + 1, k + columns]),
        ]
    )
    corners = grid.reshape(-1, 3)[top]
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 1]
    top = np.where((up >= 0.0)[:, None], top, top[:, ::-1])
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    top = top[area > 1e-9]  # fingers begin at one place
    faces = np.concatenate([top, top[:, ::-1] + grid.shape[0] * columns])
    flat = weights.reshape(-1, len(skeleton))
    return points, np.concatenate([flat, flat]), faces
