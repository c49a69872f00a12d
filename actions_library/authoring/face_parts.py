"""What the face has beside skin: eyeballs, lashes, brows, lips, teeth, tongue, the dark between."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.body_field import Ellipsoid, Field, RoundCone, united
from actions_library.authoring.body_shape import Parts
from actions_library.authoring.face_shape import (
    EYE_HALF_WIDTH,
    EYE_M,
    EYE_RADIUS_M,
    LID_OUTER_M,
    MOUTH_M,
    lid_elevations,
    lip_front_m,
    lips,
)
from smd.geometry.arrays import FloatArray, IntArray

STEP_M = 0.0007
"""What is small has a fine grid."""

BROW_BOX = ((0.005, 1.635, 0.065), (0.065, 1.670, 0.110))
LASH_BOX = ((0.010, 1.605, 0.070), (0.056, 1.645, 0.095))
MOUTH_BOX = ((0.0, 1.540, 0.045), (0.040, 1.590, 0.100))

SHEET_M = 0.0010
"""How far the lips' colour lies over the skin."""

BITE_M = MOUTH_M[1] - 0.0032
"""Height at which upper and lower teeth meet, a little below the line between the lips."""

IRIS_M, PUPIL_M = 0.0066, 0.0031
"""Radii of the iris and the pupil."""


def front_z_m(head: Field, x: float, y: float) -> float:
    """Return how far to the front the face reaches at a place."""
    z = np.linspace(0.0, 0.16, 641)
    inside = head.sample(np.column_stack([np.full_like(z, x), np.full_like(z, y), z])) < 0.0
    return float(z[inside].max())


def _strip(places: FloatArray, radii: FloatArray) -> Parts:
    """Return a band through places ``(k, 3)`` with the given radii."""
    points = [(float(x), float(y), float(z)) for x, y, z in places]
    return [
        (RoundCone(points[k], points[k + 1], float(radii[k]), float(radii[k + 1])), 0.002)
        for k in range(len(points) - 1)
    ]


def brows(head: Field) -> Field:
    """Return the left eyebrow."""
    places = np.array([[0.016, 1.6495], [0.027, 1.6545], [0.040, 1.6550], [0.052, 1.6475]])
    z = np.array([front_z_m(head, x, y) for x, y in places]) - 0.0008
    radii = np.array([0.0038, 0.0042, 0.0036, 0.0020])
    return united(BROW_BOX, STEP_M, _strip(np.column_stack([places, z]), radii))


def lashes() -> Field:
    """Return the left upper lid's lashes, a line along its margin."""
    u = np.linspace(-0.90, 1.0, 15) * EYE_HALF_WIDTH
    upper, _ = lid_elevations(u)
    away = np.sqrt(
        np.maximum((EYE_RADIUS_M + LID_OUTER_M - 0.0004) ** 2 - (EYE_RADIUS_M * u) ** 2, 0)
    )
    ring = np.column_stack([EYE_RADIUS_M * u, away * np.sin(upper), away * np.cos(upper)])
    radii = 0.0007 + 0.0006 * np.clip(1.0 - np.abs(u - 0.2), 0.0, 1.0)
    return united(LASH_BOX, STEP_M, _strip(EYE_M + ring, radii))


def lips_field(head: Field) -> Field:
    """Return the skin of both lips, apart as modelled, as a sheet that lies over the head's."""
    field = Field(MOUTH_BOX, STEP_M)
    nodes = np.stack(
        np.meshgrid(
            *(
                STEP_M * (start + np.arange(n))
                for start, n in zip(field.first, field.values.shape, strict=True)
            ),
            indexing="ij",
        ),
        axis=-1,
    )
    over = head.sample(nodes.reshape(-1, 3)).reshape(field.values.shape) - SHEET_M
    inside = Ellipsoid((0.0, MOUTH_M[1], 0.0765), (0.027, 0.0115, 0.0125))
    field.add(inside, 0.0)
    for lip in lips(0.0013):
        field.merge(united(MOUTH_BOX, STEP_M, lip), 0.0)
    field.values = np.maximum(field.values, over.astype(np.float32))
    return field


def inside_of_mouth() -> Field:
    """Return the dark that fills the mouth behind the teeth; most of it is in the flesh."""
    shape = Ellipsoid((0.0, MOUTH_M[1] - 0.001, 0.0655), (0.029, 0.017, 0.0110))
    return united(MOUTH_BOX, STEP_M, [(shape, 0.0)])


def teeth(side: float) -> Field:
    """Return the left half of the upper (side 1) or lower (-1) row of teeth."""
    x = np.array([0.0022, 0.0072, 0.0120, 0.0164])
    z = lip_front_m(np.zeros(4)) - 0.0092 - 17.0 * x**2
    wide, tall = (0.0027, 0.0070) if side > 0 else (0.0024, 0.0055)
    edge = BITE_M + side * (wide + 0.0004)
    rows: Parts = [
        (RoundCone((a, edge, c), (a, edge + side * tall, c - 0.0005), wide, wide), 0.0030)
        for a, c in zip(x.tolist(), z.tolist(), strict=True)
    ]
    return united(MOUTH_BOX, STEP_M, rows)


def tongue() -> Field:
    """Return the tongue, as it lies in the mouth."""
    shape = Ellipsoid((0.0, MOUTH_M[1] - 0.0085, 0.0715), (0.0145, 0.0050, 0.0105))
    return united(MOUTH_BOX, STEP_M, [(shape, 0.0)])


def eye_parts() -> dict[str, tuple[FloatArray, IntArray]]:
    """Return points and triangles of the left eyeball and what lies on it, by name."""
    ahead = EYE_M + np.array([0.0, 0.0, np.sqrt(EYE_RADIUS_M**2 - IRIS_M**2)])
    front = EYE_M + np.array([0.0, 0.0, EYE_RADIUS_M - 0.00005])
    glint = EYE_M + np.array([-0.0026, 0.0030, EYE_RADIUS_M - 0.00035])
    return {
        "eyes": _ball(EYE_M, (EYE_RADIUS_M,) * 3, 12, 24),
        "irises": _ball(ahead, (IRIS_M, IRIS_M, 0.0018), 8, 24),
        "pupils": _ball(front, (PUPIL_M, PUPIL_M, 0.00055), 6, 20),
        "glints": _ball(glint, (0.0016, 0.0016, 0.0008), 6, 12),
    }


def _ball(
    centre: FloatArray, radii: tuple[float, float, float], rings: int, around: int
) -> tuple[FloatArray, IntArray]:
    """Return an ellipsoid whose poles are at the front and the back."""
    polar = np.pi * np.arange(1, rings) / rings
    turn = 2.0 * np.pi * np.arange(around) / around
    ring = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.sin(polar), np.sin(turn)),
            np.outer(np.cos(polar), np.ones(around)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    points = np.concatenate([[[0.0, 0.0, 1.0]], ring, [[0.0, 0.0, -1.0]]])
    k = np.arange(around)
    after, last = (k + 1) % around, len(points) - 1
    faces = [np.column_stack([0 * k, 1 + k, 1 + after])]
    for r in range(rings - 2):
        a, b = 1 + r * around + k, 1 + r * around + after
        faces += [np.column_stack([a, a + around, b]), np.column_stack([b, a + around, b + around])]
    end = 1 + (rings - 2) * around
    faces.append(np.column_stack([end + k, 0 * k + last, end + after]))
    return np.asarray(centre) + points * np.array(radii), np.concatenate(faces).astype(np.int64)
