"""The shipped humanoid: skeleton and skinned meshes, made by this code alone.

Solids around the bones melt into one distance field, whose zero surface becomes the body's mesh.
Run once when the library is authored; takes seconds, gives the same bytes each time.
"""

from __future__ import annotations

import numpy as np

from actions_library.authoring import face_parts
from actions_library.authoring.body_field import Field, RoundCone
from actions_library.authoring.body_shape import BodyFields, body_fields
from actions_library.authoring.body_surface import half_surface, mirrored
from actions_library.authoring.body_wardrobe import HAIR_RGB, Color, Garment, wardrobe
from actions_library.authoring.body_weights import (
    body_weights,
    strongest,
    weights_of_skin,
)
from actions_library.authoring.face_motion import (
    face_shapes,
    jaw_shapes,
    magnified,
    resting,
)
from actions_library.authoring.face_shape import MOUTH_M, NECK_CUT, head_field
from actions_library.authoring.hand_shape import DOWN_45, WRIST
from actions_library.authoring.humanoid import humanoid_skeleton
from smd.character.character import Character, Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray

STEP_M = 0.003
"""Distance between nodes of the grid that the shape is sampled on."""

BODY_TRIANGLES, HEAD_TRIANGLES = 13_000, 10_000
"""About how many triangles the body has, and the head with its neck."""

SKIN_RGB: Color = (0.66, 0.40, 0.27)
LIP_RGB: Color = (0.48, 0.205, 0.150)
EYE_RGB: dict[str, Color] = {
    "eyes": (0.80, 0.79, 0.76),
    "irises": (0.055, 0.145, 0.165),
    "pupils": (0.006, 0.006, 0.007),
    "glints": (0.95, 0.95, 0.95),
}


def humanoid_character(*, step_m: float = STEP_M) -> Character:
    """Return the shipped humanoid, 1.75 m tall, bound with its arms 45° down, facing +Z.

    Parameters
    ----------
    step_m
        Distance between nodes of the grid that body and clothes are sampled on. Coarser is
        quicker and loses fingers; the head has a grid of its own.
    """
    skeleton = humanoid_skeleton()
    fields = body_fields(step_m)
    skin = fields.skin.grown(0.0)
    skin.carve(RoundCone(*NECK_CUT, 0.092, 0.160), 0.0)
    half = half_surface(skin, BODY_TRIANGLES // 2, _hands_magnified)
    points, triangles, mirror = mirrored(*half)
    weights = body_weights(points, triangles, mirror, fields, skeleton)
    body = Mesh("body", points, triangles, *strongest(weights), SKIN_RGB)
    front = head_field()
    head, weights_of_head = _head(front, fields, skeleton)
    every = np.concatenate([points, head.points_m])
    weights = np.concatenate([weights, weights_of_head])
    worn = [_worn(piece, every, weights, skeleton) for piece in wardrobe(fields)]
    meshes = (body, head, *worn, *_eyes(skeleton), *_features(front, skeleton))
    return Character("humanoid", skeleton, meshes)


def _head(front: Field, fields: BodyFields, skeleton: Skeleton) -> tuple[Mesh, FloatArray]:
    """Return the head with its shapes, its lips closed, and its points' weights."""
    half = half_surface(front, HEAD_TRIANGLES // 2, magnified)
    points, triangles, mirror = mirrored(*half)
    weights = body_weights(points, triangles, mirror, fields, skeleton)
    face = resting(points)
    shapes = face_shapes(face, mirror)
    head = Mesh("head", face.at_m, triangles, *strongest(weights), SKIN_RGB, shapes)
    return head, weights


def _worn(
    piece: Garment, skin_points: FloatArray, weights_of_body: FloatArray, skeleton: Skeleton
) -> Mesh:
    """Return a piece's mesh, which moves as the skin below it or with the head."""
    half = half_surface(piece.field, piece.triangle_count // 2)
    points, triangles, _ = mirrored(*half)
    if piece.on_head:
        bound = _bound_to(skeleton, "head", len(points))
    else:
        bound = strongest(weights_of_skin(points, skin_points, weights_of_body, skeleton))
    return Mesh(piece.name, points, triangles, *bound, piece.color_rgb)


def _bound_to(skeleton: Skeleton, joint: str, count: int) -> tuple[IntArray, FloatArray]:
    """Return indices and weights of points that follow one joint."""
    weights = np.zeros((count, len(skeleton)))
    weights[:, skeleton.index(joint)] = 1.0
    return strongest(weights)


def _eyes(skeleton: Skeleton) -> list[Mesh]:
    """Return eyeballs, irises, pupils and glints, each side's with its own joint."""
    meshes = []
    for name, (points, triangles) in face_parts.eye_parts().items():
        p = len(points)
        both = np.concatenate([points, points * [-1.0, 1.0, 1.0]])
        faces = np.concatenate([triangles, p + triangles[:, ::-1]])
        bound = [_bound_to(skeleton, f"{side}_eye", p) for side in ("left", "right")]
        indices, weights = (np.concatenate(pair) for pair in zip(*bound, strict=True))
        meshes.append(Mesh(name, both, faces, indices, weights, EYE_RGB[name]))
    return meshes


def _features(front: Field, skeleton: Skeleton) -> list[Mesh]:
    """Return what else the face has: on its skin, and in its mouth."""
    on_skin: list[tuple[str, Field, int, Color]] = [
        ("brows", face_parts.brows(front), 500, HAIR_RGB),
        ("lashes", face_parts.lashes(), 700, HAIR_RGB),
        ("lips", face_parts.lips_field(front), 1500, LIP_RGB),
    ]
    meshes = []
    for name, field, count, color in on_skin:
        points, triangles, mirror = mirrored(*half_surface(field, count // 2))
        face = resting(points)
        bound = _bound_to(skeleton, "head", len(points))
        shapes = face_shapes(face, mirror)
        meshes.append(Mesh(name, face.at_m, triangles, *bound, color, shapes))
    in_mouth: list[tuple[str, Field, int, Color]] = [
        ("mouth", face_parts.inside_of_mouth(), 400, (0.030, 0.006, 0.006)),
        ("upper_teeth", face_parts.teeth(1.0), 500, (0.80, 0.78, 0.70)),
        ("lower_teeth", face_parts.teeth(-1.0), 500, (0.80, 0.78, 0.70)),
        ("tongue", face_parts.tongue(), 240, (0.40, 0.105, 0.090)),
    ]
    for name, field, count, color in in_mouth:
        points, triangles, _ = mirrored(*half_surface(field, count // 2))
        bound = _bound_to(skeleton, "head", len(points))
        shapes = jaw_shapes(points, _with_jaw(name, points))
        meshes.append(Mesh(name, points, triangles, *bound, color, shapes))
    return meshes


def _with_jaw(name: str, points: FloatArray) -> FloatArray:
    """Return how far parts of the mouth go with the jaw; the dark is stretched between."""
    if name == "upper_teeth":
        return np.zeros(len(points))
    if name == "mouth":
        t = np.clip((MOUTH_M[1] + 0.004 - points[:, 1]) / 0.008, 0.0, 1.0)
        return np.asarray(t * t * (3.0 - 2.0 * t))
    return np.ones(len(points))


def _hands_magnified(points: FloatArray) -> FloatArray:
    """Return points with the hands larger: looked at closely, they need more triangles."""
    wrist = np.array(WRIST)
    on_hand = np.clip((points - wrist) @ np.array(DOWN_45) / 0.06, 0.0, 1.0)[:, None]
    return np.asarray(points + 1.2 * on_hand * (points - wrist))
