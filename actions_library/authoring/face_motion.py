"""The shipped humanoid's expressions: smooth displacements around landmarks of its face.

Each shape bears the name that ARKit gives it [1]_, as programs for avatars expect. What is
described is the left side's; the right side is its mirror image. Of points near the lips it must be
known to which lip they belong: they touch.

References
----------
.. [1] Apple, "ARFaceAnchor.BlendShapeLocation", ARKit documentation.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from actions_library.authoring.displacement import near, step
from actions_library.authoring.face_shape import (
    EYE_M,
    EYE_RADIUS_M,
    MOUTH_M,
    PARTED_M,
    in_eye,
    lid_elevations,
    lip_front_m,
    lip_line_m,
    parting,
)
from smd.character.blend_shape import BlendShape
from smd.geometry.arrays import FloatArray

JAW_M = (0.0, 1.592, 0.004)
JAW_RAD = np.radians(17.0)
"""Where the jaw turns, and how far it opens."""

LEAST_M = 1e-5
"""Smaller offsets are left out."""

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class FacePoints:
    """Points of the face with its lips closed.

    Attributes
    ----------
    at_m : (p, 3).
    side : (p,) 1 from the line between the lips up, -1 below it; in the mouth from 1 to -1.
    """

    at_m: FloatArray
    side: FloatArray


Motion = Callable[[FacePoints], FloatArray]


def magnified(points: FloatArray) -> FloatArray:
    """Return points with the face larger, most of all eyes and lips: they need more triangles.

    Where two places overlap their shares may sum to 2.2 at most: beyond, space would fold.
    """
    seen = points.copy()
    lips = np.array([0.0, MOUTH_M[1], MOUTH_M[2]])
    places = ((np.array([0.0, 1.600, 0.085]), 0.055, 0.8), (EYE_M, 0.019, 1.15), (lips, 0.026, 1.0))
    for centre, reach_m, more in places:
        away = points - centre
        near = np.exp(-((away / reach_m) ** 2).sum(axis=1, keepdims=True))
        seen = seen + more * near * away
    return seen


def resting(modelled_m: FloatArray) -> FacePoints:
    """Return the face with its lips closed, from points as modelled, with its lips apart."""
    x, y, z = modelled_m.T
    above = y - lip_line_m(np.abs(x))
    gap = PARTED_M * parting(x)
    # Behind the lips is a wall from the one to the other: there the one passes into the other.
    side = np.clip(above / np.maximum(0.3 * gap, 1e-9), -1.0, 1.0)
    depth = lip_front_m(x) - z
    moved = np.minimum(gap, 0.985 * np.abs(above)) * (1.0 - step(depth, 0.007, 0.013))
    moved = moved * (1.0 - step(np.abs(above), gap + 0.009, 0.032))
    return FacePoints(modelled_m - np.outer(np.sign(above) * moved, [0.0, 1.0, 0.0]), side)


def face_shapes(face: FacePoints, mirror: NDArray[np.int64]) -> tuple[BlendShape, ...]:
    """Return the shapes that move any of the points given.

    Parameters
    ----------
    face
        Both sides.
    mirror
        (p,) each point's image in the plane x = 0.
    """
    found = []
    for name, motion in _MIDDLE.items():
        found.append((name, motion(face)))
    for name, motion in _BOTH.items():
        left = motion(face)
        found.append((name, left + _reflected(left, mirror)))
    for name, motion in _LEFT.items():
        left = motion(face)
        found.append((f"{name}Left", left))
        found.append((f"{name}Right", _reflected(left, mirror)))
    return _sparse(found)


def jaw_shapes(points: FloatArray, share: FloatArray) -> tuple[BlendShape, ...]:
    """Return the one shape of what is inside the mouth: the jaw takes along a share of it."""
    return _sparse([("jawOpen", share[:, None] * _jaw_turned(points))])


def _sparse(named: list[tuple[str, FloatArray]]) -> tuple[BlendShape, ...]:
    shapes = []
    for name, offsets in named:
        far = np.linalg.norm(offsets, axis=1, keepdims=True) >= LEAST_M
        shapes.append(BlendShape.sparse(name, np.where(far, offsets, 0.0)))
    return tuple(shape for shape in shapes if len(shape.indices))


def _reflected(offsets: FloatArray, mirror: NDArray[np.int64]) -> FloatArray:
    return offsets[mirror] * np.array([-1.0, 1.0, 1.0])


def _pull(face: FacePoints, centre: Vector, reach_m: Vector, by_mm: Vector) -> FloatArray:
    """Return how points follow a landmark that moves (out, up, ahead; mm)."""
    return near(face.at_m, centre, reach_m) * (0.001 * np.array(by_mm))


# Lids -------------------------------------------------------------------------------------------


def _lids(face: FacePoints, upper_share: float, lower_share: float, more_rad: float) -> FloatArray:
    """Return how lids turn about the eye's axis outward.

    Parameters
    ----------
    upper_share, lower_share
        Of each lid's way to where both meet; negative opens the eye.
    more_rad
        How far the upper lid goes on beyond.
    """
    u, elevation, away = in_eye(face.at_m)
    upper, lower = lid_elevations(u)
    open_rad = np.maximum(upper - lower, 0.0)
    meet = lower + 0.22 * open_rad
    fall = -upper_share * (0.78 * open_rad + more_rad * step(open_rad, 0.0, 0.3))
    rise = lower_share * 0.22 * open_rad
    by_rad = np.where(
        elevation > meet,
        fall * (1.0 - step(elevation, upper, upper + 0.85)),
        rise * step(elevation, lower - 0.9, lower),
    )
    by_rad = by_rad * (1.0 - step(away, EYE_RADIUS_M + 0.0038, EYE_RADIUS_M + 0.0105))
    y, z = face.at_m[:, 1] - EYE_M[1], face.at_m[:, 2] - EYE_M[2]
    cosine, sine = np.cos(by_rad), np.sin(by_rad)
    moved = [np.zeros_like(y), cosine * y + sine * z - y, cosine * z - sine * y - z]
    return np.where(by_rad[:, None] != 0.0, np.column_stack(moved), 0.0)


def _blink(face: FacePoints) -> FloatArray:
    return _lids(face, 1.0, 1.0, np.radians(3.0))


def _wide(face: FacePoints) -> FloatArray:
    return _lids(face, -0.33, -0.45, 0.0)


def _squint(face: FacePoints) -> FloatArray:
    cheek = _pull(face, (0.036, 1.600, 0.086), (0.026, 0.018, 0.030), (0.0, 1.8, 0.8))
    return _lids(face, 0.26, 1.25, 0.0) + cheek


# Brows, nose, cheeks -----------------------------------------------------------------------------


def _brow_inner_up(face: FacePoints) -> FloatArray:
    return _pull(face, (0.014, 1.653, 0.097), (0.026, 0.026, 0.035), (-0.6, 8.0, 0.8))


def _brow_outer_up(face: FacePoints) -> FloatArray:
    return _pull(face, (0.043, 1.653, 0.086), (0.028, 0.026, 0.040), (0.3, 7.5, 0.3))


def _brow_down(face: FacePoints) -> FloatArray:
    inner = _pull(face, (0.017, 1.651, 0.097), (0.024, 0.022, 0.035), (-3.2, -7.5, 1.2))
    outer = _pull(face, (0.038, 1.653, 0.088), (0.026, 0.022, 0.035), (-1.5, -2.8, 0.4))
    return inner + outer


def _nose_sneer(face: FacePoints) -> FloatArray:
    wing = _pull(face, (0.015, 1.596, 0.098), (0.016, 0.020, 0.030), (0.8, 4.0, 0.4))
    root = _pull(face, (0.011, 1.622, 0.098), (0.012, 0.020, 0.025), (0.2, 2.5, 1.4))
    lip = _pull(face, (0.015, 1.574, 0.090), (0.018, 0.012, 0.025), (0.4, 2.4, 0.0))
    return wing + root + np.maximum(face.side, 0.0)[:, None] * lip


def _cheek_squint(face: FacePoints) -> FloatArray:
    cheek = _pull(face, (0.042, 1.598, 0.078), (0.030, 0.024, 0.040), (0.6, 5.0, 2.6))
    return cheek + _lids(face, 0.0, 0.9, 0.0)


def _cheek_puff(face: FacePoints) -> FloatArray:
    cheek = _pull(face, (0.050, 1.570, 0.062), (0.034, 0.034, 0.045), (10.0, 0.0, 6.0))
    lip = _pull(face, (0.012, 1.564, 0.090), (0.026, 0.022, 0.030), (0.0, 0.0, 1.6))
    return cheek + lip


# Jaw and lips ------------------------------------------------------------------------------------


def _jaw_turned(points: FloatArray) -> FloatArray:
    y, z = points[:, 1] - JAW_M[1], points[:, 2] - JAW_M[2]
    cosine, sine = np.cos(JAW_RAD), np.sin(JAW_RAD)
    return np.column_stack([np.zeros_like(y), cosine * y - sine * z - y, cosine * z + sine * y - z])


def _on_lips(face: FacePoints, reach_m: Vector = (0.034, 0.024, 0.036)) -> FloatArray:
    return near(face.at_m, (0.0, MOUTH_M[1], 0.088), reach_m)


def _below_lips(face: FacePoints) -> FloatArray:
    """Return how far points belong to the lower lip and what is below: 1, or 0 above.

    Along each lip it passes from the middle's to that of the corner, which is the same for both.
    """
    x = np.abs(face.at_m[:, 0])
    along = np.minimum(x / MOUTH_M[0], 1.0) ** 2.5
    far = 0.5 - 0.5 * face.side
    lip = far * (1.0 - 0.55 * along) + (1.0 - far) * 0.45 * along
    away = np.abs(face.at_m[:, 1] - lip_line_m(x))
    return np.asarray(lip + (far - lip) * step(away, 0.0, 0.036))


def _jaw_open(face: FacePoints) -> FloatArray:
    _, y, z = face.at_m.T
    jaw = _below_lips(face) * step(z, -0.004, 0.040) * step(y, 1.450, 1.530)
    narrower = sum(
        _pull(face, (out * 0.040, 1.566, 0.072), (0.034, 0.040, 0.045), (out * -5.0, 0.0, 0.0))
        for out in (1.0, -1.0)
    )
    return jaw[:, None] * _jaw_turned(face.at_m) + narrower


def _smile(face: FacePoints) -> FloatArray:
    corner = _pull(face, (0.027, 1.566, 0.083), (0.028, 0.026, 0.040), (5.5, 9.5, -3.5))
    cheek = _pull(face, (0.042, 1.594, 0.078), (0.028, 0.022, 0.040), (1.5, 3.0, 3.2))
    return corner + cheek


def _frown(face: FacePoints) -> FloatArray:
    corner = _pull(face, (0.026, 1.563, 0.083), (0.026, 0.026, 0.040), (1.5, -9.0, -1.0))
    chin = _pull(face, (0.0, 1.545, 0.092), (0.020, 0.016, 0.030), (0.0, 0.9, 0.8))
    return corner + chin


def _stretch(face: FacePoints) -> FloatArray:
    return _pull(face, (0.027, 1.564, 0.083), (0.028, 0.026, 0.040), (8.5, -1.0, -5.0))


def _pucker(face: FacePoints) -> FloatArray:
    x = face.at_m[:, :1]
    ahead = np.concatenate([-0.50 * x, 0.0 * x, 0.0090 + 0.0 * x], axis=1)
    return _on_lips(face, (0.044, 0.026, 0.042)) * ahead


def _funnel(face: FacePoints) -> FloatArray:
    x = face.at_m[:, :1]
    apart = np.where(face.side > 0.0, 0.0050, 0.0060) * face.side
    open_m = (parting(face.at_m[:, 0]) * apart)[:, None]
    way = np.concatenate([-0.34 * x, open_m, 0.0065 + 0.0 * x], axis=1)
    return _on_lips(face, (0.044, 0.028, 0.042)) * way


def _left_half(face: FacePoints) -> FloatArray:
    """Return what of the lips is the left side's, ``(p, 1)``; with the right side's it is 1."""
    return step(face.at_m[:, :1], -0.012, 0.012)


def _press(face: FacePoints) -> FloatArray:
    y = face.at_m[:, 1] - lip_line_m(np.abs(face.at_m[:, 0]))
    way = np.column_stack([np.zeros_like(y), -0.38 * y, np.full_like(y, -0.0028)])
    return _left_half(face) * _on_lips(face, (0.036, 0.017, 0.030)) * way


def _upper_up(face: FacePoints) -> FloatArray:
    up = 0.0065 * np.maximum(face.side, 0.0) * parting(face.at_m[:, 0]) ** 0.7
    way = np.outer(up, [0.0, 1.0, 0.12])
    return _left_half(face) * _on_lips(face, (0.040, 0.024, 0.036)) * way


def _lower_down(face: FacePoints) -> FloatArray:
    down = 0.0065 * np.maximum(-face.side, 0.0) * parting(face.at_m[:, 0]) ** 0.7
    way = np.outer(down, [0.0, -1.0, 0.10])
    return _left_half(face) * _on_lips(face, (0.040, 0.026, 0.036)) * way


_MIDDLE: dict[str, Motion] = {
    "jawOpen": _jaw_open,
    "mouthPucker": _pucker,
    "mouthFunnel": _funnel,
}
_BOTH: dict[str, Motion] = {"browInnerUp": _brow_inner_up, "cheekPuff": _cheek_puff}
_LEFT: dict[str, Motion] = {
    "browDown": _brow_down,
    "browOuterUp": _brow_outer_up,
    "eyeBlink": _blink,
    "eyeWide": _wide,
    "eyeSquint": _squint,
    "cheekSquint": _cheek_squint,
    "mouthSmile": _smile,
    "mouthFrown": _frown,
    "mouthStretch": _stretch,
    "mouthPress": _press,
    "mouthUpperUp": _upper_up,
    "mouthLowerDown": _lower_down,
    "noseSneer": _nose_sneer,
}

SHAPE_NAMES = (
    *_MIDDLE,
    *_BOTH,
    *(f"{name}{side}" for name in _LEFT for side in ("Left", "Right")),
)
"""All shapes of the face, in their order."""
