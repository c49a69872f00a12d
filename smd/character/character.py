"""Mesh and Character: what a viewer sees, and the skeleton that moves it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from laban.frozen import Frozen
from smd.character.blend_shape import BlendShape
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array

MAX_INFLUENCES = 4
"""Joints that may move one point: what game engines and most viewers allow."""


@dataclass(frozen=True, slots=True, eq=False)
class Mesh(Frozen):
    """A triangle mesh bound to a skeleton.

    Attributes
    ----------
    name : unique in its character.
    points_m : (p, 3) float64, in the bind pose.
    triangles : (t, 3) int64, counter-clockwise seen from outside.
    joint_indices : (p, 4) int64, the joints that move each point.
    joint_weights : (p, 4) float64, not negative, sum 1; unused places have weight 0.
    color_rgb : linear colour, each in [0, 1].
    shapes : what its points may be mixed with, each of a name of its own.
    """

    name: str
    points_m: FloatArray
    triangles: IntArray
    joint_indices: IntArray
    joint_weights: FloatArray
    color_rgb: tuple[float, float, float] = (0.8, 0.8, 0.8)
    shapes: tuple[BlendShape, ...] = ()

    def __post_init__(self) -> None:
        points = frozen_array("points_m", self.points_m, (None, 3), CharacterError)
        p = len(points)
        triangles = frozen_array("triangles", self.triangles, (None, 3), CharacterError, np.int64)
        if len(triangles) == 0 or triangles.min() < 0 or triangles.max() >= p:
            raise CharacterError(f"mesh {self.name!r}: triangles: expected indices below {p}")
        shape = (p, MAX_INFLUENCES)
        indices = frozen_array("joint_indices", self.joint_indices, shape, CharacterError, np.int64)
        weights = frozen_array("joint_weights", self.joint_weights, shape, CharacterError)
        if weights.min() < 0 or np.abs(weights.sum(axis=1) - 1.0).max() > 1e-4:
            raise CharacterError(f"mesh {self.name!r}: joint_weights: expected sums of 1")
        shapes = tuple(self.shapes)
        if len({shape.name for shape in shapes}) != len(shapes):
            raise CharacterError(f"mesh {self.name!r}: shapes: expected unique names")
        for each in shapes:
            if len(each.indices) and each.indices[-1] >= p:
                raise CharacterError(
                    f"mesh {self.name!r}: shape {each.name!r}: expected indices below {p}, got "
                    f"{each.indices[-1]}"
                )
        object.__setattr__(self, "shapes", shapes)
        object.__setattr__(self, "points_m", points)
        object.__setattr__(self, "triangles", triangles)
        object.__setattr__(self, "joint_indices", indices)
        object.__setattr__(self, "joint_weights", weights)


@dataclass(frozen=True, slots=True, eq=False)
class Character:
    """A skeleton and the meshes it moves; standing at the origin, facing +Z, when bound."""

    name: str
    skeleton: Skeleton
    meshes: tuple[Mesh, ...]

    def __post_init__(self) -> None:
        for mesh in self.meshes:
            if mesh.joint_indices.min() < 0 or mesh.joint_indices.max() >= len(self.skeleton):
                raise CharacterError(f"mesh {mesh.name!r}: joint_indices beyond the skeleton")
        object.__setattr__(self, "meshes", tuple(self.meshes))

    @property
    def shapes(self) -> tuple[str, ...]:
        """Names of its meshes' shapes, each once."""
        return shape_names(self.meshes)

    @property
    def height_m(self) -> float:
        """Height of the bound figure, from the ground to its highest point."""
        return float(max(mesh.points_m[:, 1].max() for mesh in self.meshes))


def shape_names(meshes: Iterable[Mesh]) -> tuple[str, ...]:
    """Return the names of all meshes' shapes, each once."""
    return tuple(dict.fromkeys(shape.name for mesh in meshes for shape in mesh.shapes))
