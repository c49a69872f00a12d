"""Shapes as smooth displacements around landmarks, for the face of anything.

A motion says how far points of a face go: ``(p, 3)`` in, ``(p, 3)`` out, in metres. What is
described is the left side's; `sided` and `on_both` have the mirror image, so that right shapes are
exactly those of the left.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from actions_library.authoring.rigging import LEFT, RIGHT, Point
from smd.character.blend_shape import BlendShape
from smd.character.character import Mesh
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep
from smd.geometry.rotations import normalized, quaternion_about, rotate

Motion = Callable[[FloatArray], FloatArray]

LEAST_M = 1e-5
"""Smaller offsets are left out."""

_IMAGE = np.array([-1.0, 1.0, 1.0])


def step(value: FloatArray, low: ArrayLike, high: ArrayLike) -> FloatArray:
    """Return 0 below ``low``, 1 above ``high`` and a step between whose ends are smooth."""
    return smootherstep((value - np.asarray(low)) / (np.asarray(high) - np.asarray(low)))


def near(points: FloatArray, centre: Point, reach_m: Point) -> FloatArray:
    """Return 1 at a landmark, 0 from an ellipsoid around it on, ``(p, 1)``."""
    away2 = (((points - np.array(centre)) / np.array(reach_m)) ** 2).sum(axis=1, keepdims=True)
    return np.asarray(np.maximum(1.0 - away2, 0.0) ** 3)


def pulled(centre: Point, reach_m: Point, by_mm: Point) -> Motion:
    """Return the motion of points that follow a landmark which moves (left, up, ahead; mm)."""
    return lambda points: near(points, centre, reach_m) * (0.001 * np.array(by_mm))


def puffed(centre: Point, reach_m: Point, by_mm: float, middle: Point) -> Motion:
    """Return the motion of points around a landmark that go away from a ``middle`` below them."""
    return lambda points: (
        near(points, centre, reach_m) * 0.001 * by_mm * normalized(points - np.array(middle))
    )


def swung(pivot: Point, axis: Point, angle_deg: float) -> Motion:
    """Return the motion of points that turn about an axis through a pivot."""
    turn = quaternion_about(np.array(axis), np.radians(angle_deg))

    def motion(points: FloatArray) -> FloatArray:
        arm = points - np.array(pivot)
        return rotate(np.broadcast_to(turn, (len(points), 4)), arm) - arm

    return motion


def summed(*motions: Motion) -> Motion:
    """Return the motion of points that follow several."""
    return lambda points: np.sum([motion(points) for motion in motions], axis=0)


def image_of(motion: Motion) -> Motion:
    """Return a motion's mirror image in the plane x = 0."""
    return lambda points: motion(points * _IMAGE) * _IMAGE


def on_both(motion: Motion) -> Motion:
    """Return the motion of both sides at once, from that of the left."""
    return summed(motion, image_of(motion))


def sided(motions: Mapping[str, Motion]) -> dict[str, Motion]:
    """Return ``left_…`` and ``right_…`` of each motion of the left side."""
    found = {}
    for name, motion in motions.items():
        found[LEFT + name] = motion
        found[RIGHT + name] = image_of(motion)
    return found


def with_shapes(mesh: Mesh, motions: Mapping[str, Motion]) -> Mesh:
    """Return the mesh with a shape for each motion that moves any of its points."""
    shapes = []
    for name, motion in motions.items():
        offsets = motion(mesh.points_m)
        far = np.linalg.norm(offsets, axis=1, keepdims=True) >= LEAST_M
        shape = BlendShape.sparse(name, np.where(far, offsets, 0.0))
        if len(shape.indices):
            shapes.append(shape)
    return replace(mesh, shapes=(*mesh.shapes, *shapes))
