"""The shipped humanoid: skeleton and skinned meshes, made by this code alone.

Solids around the bones melt into one distance field, whose zero surface becomes the body's mesh.
Run once when the library is authored; takes seconds, gives the same bytes each time.
"""

from __future__ import annotations

from actions_library.authoring.body_shape import body_fields
from actions_library.authoring.body_surface import half_surface, mirrored
from actions_library.authoring.body_weights import body_weights
from actions_library.authoring.humanoid import humanoid_skeleton
from smd.character.character import Character, Mesh

BODY_TRIANGLES = 18_000
"""About how many triangles the body has."""

BODY_COLOR = (0.62, 0.56, 0.48)


def humanoid_character(*, step_m: float = 0.003) -> Character:
    """Return the shipped humanoid, 1.75 m tall, bound with its arms 45° down, facing +Z.

    Parameters
    ----------
    step_m
        Distance between nodes of the grid that the shape is sampled on. Coarser is quicker and
        loses fingers and face.
    """
    skeleton = humanoid_skeleton()
    fields = body_fields(step_m)
    points, triangles, mirror = mirrored(*half_surface(fields.whole, BODY_TRIANGLES // 2))
    points[:, 1] -= points[:, 1].min()
    indices, weights = body_weights(points, triangles, mirror, fields, skeleton)
    body = Mesh("body", points, triangles, indices, weights, BODY_COLOR)
    return Character("humanoid", skeleton, (body,))
