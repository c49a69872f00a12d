"""The shipped humanoid: skeleton and skinned meshes, made by this code alone.

Solids around the bones melt into one distance field, whose zero surface becomes the body's mesh.
Run once when the library is authored; takes seconds, gives the same bytes each time.
"""

from __future__ import annotations

import numpy as np

from actions_library.authoring.body_shape import DOWN_45, WRIST, body_fields
from actions_library.authoring.body_surface import half_surface, mirrored
from actions_library.authoring.body_wardrobe import Garment, wardrobe
from actions_library.authoring.body_weights import (
    body_weights,
    strongest,
    weights_of_skin,
)
from actions_library.authoring.humanoid import humanoid_skeleton
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

STEP_M = 0.003
"""Distance between nodes of the grid that the shape is sampled on."""

BODY_TRIANGLES = 18_000
"""About how many triangles the body has."""

SKIN_RGB = (0.66, 0.40, 0.27)


def humanoid_character(*, step_m: float = STEP_M) -> Character:
    """Return the shipped humanoid, 1.75 m tall, bound with its arms 45° down, facing +Z.

    Parameters
    ----------
    step_m
        Distance between nodes of the grid that the shape is sampled on. Coarser is quicker and
        loses fingers and face.
    """
    skeleton = humanoid_skeleton()
    fields = body_fields(step_m)
    half = half_surface(fields.skin, BODY_TRIANGLES // 2, _face_and_hands_magnified)
    points, triangles, mirror = mirrored(*half)
    weights = body_weights(points, triangles, mirror, fields, skeleton)
    body = Mesh("body", points, triangles, *strongest(weights), SKIN_RGB)
    worn = [_worn(piece, points, weights, skeleton) for piece in wardrobe(fields)]
    return Character("humanoid", skeleton, (body, *worn))


def _worn(
    piece: Garment, body_points: FloatArray, weights_of_body: FloatArray, skeleton: Skeleton
) -> Mesh:
    """Return a piece's mesh, which moves as the skin below it or with the head."""
    half = half_surface(piece.field, piece.triangle_count // 2)
    points, triangles, _ = mirrored(*half)
    if piece.on_head:
        weights = np.zeros((len(points), len(skeleton)))
        weights[:, skeleton.index("head")] = 1.0
    else:
        weights = weights_of_skin(points, body_points, weights_of_body, skeleton)
    return Mesh(piece.name, points, triangles, *strongest(weights), piece.color_rgb)


def _face_and_hands_magnified(points: FloatArray) -> FloatArray:
    """Return points with head and hands larger: looked at closely, they need more triangles."""
    neck, wrist = np.array([0.0, 1.52, 0.0]), np.array(WRIST)
    on_head = np.clip((points[:, 1:2] - neck[1]) / 0.04, 0.0, 1.0)
    on_hand = np.clip((points - wrist) @ np.array(DOWN_45) / 0.06, 0.0, 1.0)[:, None]
    return points + 0.7 * on_head * (points - neck) + 1.2 * on_hand * (points - wrist)
