"""A mesh for any skeleton: solids around the bones, melted into one, each moved by its joint.

Solids off the middle have their mirror images on the other side, moved by the joint of that side:
creatures are symmetric to the last bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from actions_library.authoring.body_field import Ellipsoid, Field, RoundCone, Shape
from actions_library.authoring.body_surface import Warp, adjacency, half_surface, mirrored
from actions_library.authoring.body_weights import strongest
from actions_library.authoring.rigging import Point, other_side, place_of
from smd.character.character import Mesh
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray

REACH_M = 0.03
"""How far solids melt into each other unless they say otherwise."""

SOFTNESS = 0.12
"""Share of a solid's thickness over which a joint's hold fades beside a nearer one's."""

SMOOTHING_ROUNDS = 4
"""Rounds of averaging weights with the neighbours'."""


@dataclass(frozen=True, slots=True)
class Lump:
    """A solid in the world at rest, and the joint that moves what is nearest to it.

    Attributes
    ----------
    joint : that moves it.
    shape : a round cone or an ellipsoid.
    reach_m : how far it melts into the others.
    """

    joint: str
    shape: RoundCone | Ellipsoid
    reach_m: float = REACH_M


def bone(
    skeleton: Skeleton,
    joint: str,
    end: str | Point,
    start_radius: float,
    end_radius: float,
    *,
    start: Point | None = None,
    reach_m: float = REACH_M,
) -> Lump:
    """Return a round cone along a bone: from a joint, or a place, to a joint or a place."""
    tip = place_of(skeleton, end) if isinstance(end, str) else end
    base = place_of(skeleton, joint) if start is None else start
    return Lump(joint, RoundCone(base, tip, start_radius, end_radius), reach_m)


def ball(joint: str, centre: Point, radius: float, *, reach_m: float = REACH_M) -> Lump:
    """Return a ball."""
    return Lump(joint, RoundCone(centre, centre, radius, radius), reach_m)


def melted_mesh(
    name: str,
    skeleton: Skeleton,
    lumps: Sequence[Lump],
    *,
    step_m: float,
    triangle_count: int,
    color_rgb: tuple[float, float, float],
    hollows: Sequence[Lump] = (),
    magnified: Warp | None = None,
) -> Mesh:
    """Return the surface of lumps melted together, symmetric, with the weights of their joints.

    Parameters
    ----------
    lumps
        Melted in their order. Those on the left are mirrored; those in the middle are symmetric
        themselves.
    step_m
        Distance between nodes of the grid that the shape is sampled on; half of the thinnest
        solid's thickness, or less.
    triangle_count
        About how many triangles the whole mesh has.
    hollows
        Taken away afterwards, mirrored too: sockets of eyes, a mouth. They move nothing.
    magnified
        Moves points apart where more triangles than their size deserves are to stay.
    """
    every = _with_images(lumps)
    low, high = _bounds([lump.shape for lump in every], 2.0 * step_m)
    field = Field(([0.0, low[1], low[2]], high), step_m)
    for lump in every:
        field.add(lump.shape, lump.reach_m)
    for hollow in _with_images(hollows):
        field.carve(hollow.shape, hollow.reach_m)
    points, triangles, mirror = mirrored(*half_surface(field, triangle_count // 2, magnified))
    weights = lump_weights(points, every, skeleton)
    mean = adjacency(triangles, len(points))
    for _ in range(SMOOTHING_ROUNDS):
        weights = 0.5 * weights + 0.5 * (mean @ weights)
    twins = [skeleton.index(other_side(joint)) for joint in skeleton.joints]
    weights = 0.5 * (weights + weights[mirror][:, twins])
    return Mesh(name, points, triangles, *strongest(weights), color_rgb)


def lump_weights(points: FloatArray, lumps: Sequence[Lump], skeleton: Skeleton) -> FloatArray:
    """Return each joint's weight on each point, ``(p, j)``, sums 1: a softmax of distances.

    Where two solids are equally near, their joints share evenly; a joint's hold fades over a
    share of its own solids' thickness.
    """
    columns = [lump.shape.distance(*points.T) for lump in lumps]
    distance = np.stack(columns, axis=1)
    distance -= distance.min(axis=1, keepdims=True)
    thickness = np.array([_thickness_m(lump.shape) for lump in lumps])
    hold = np.exp(-distance / (SOFTNESS * thickness))
    weights = np.zeros((len(points), len(skeleton)))
    for lump, column in zip(lumps, hold.T, strict=True):
        j = skeleton.index(lump.joint)
        weights[:, j] = np.maximum(weights[:, j], column)
    return weights / weights.sum(axis=1, keepdims=True)


def _thickness_m(shape: RoundCone | Ellipsoid) -> float:
    if isinstance(shape, RoundCone):
        return shape.start_radius + shape.end_radius
    return 2.0 * sorted(shape.radii)[1]


def _bounds(shapes: Sequence[Shape], margin_m: float) -> tuple[FloatArray, FloatArray]:
    corners = [shape.bounds() for shape in shapes]
    low = np.min([corner for corner, _ in corners], axis=0) - margin_m
    high = np.max([corner for _, corner in corners], axis=0) + margin_m
    return low, high


def _with_images(lumps: Sequence[Lump]) -> list[Lump]:
    """Return lumps and the mirror images of those that are off the middle."""
    return [*lumps, *(_mirror(lump) for lump in lumps if _off_the_middle(lump.shape))]


def _off_the_middle(shape: RoundCone | Ellipsoid) -> bool:
    if isinstance(shape, RoundCone):
        return shape.start[0] != 0.0 or shape.end[0] != 0.0
    return shape.centre[0] != 0.0


def _mirror(lump: Lump) -> Lump:
    """Return the image of a lump in the plane x = 0."""
    shape = lump.shape
    image: RoundCone | Ellipsoid
    if isinstance(shape, RoundCone):
        image = replace(shape, start=_image(shape.start), end=_image(shape.end))
    else:
        axes = shape.axes * np.array([[-1.0], [1.0], [1.0]])
        image = replace(shape, centre=_image(shape.centre), axes=axes)
    return Lump(other_side(lump.joint), image, lump.reach_m)


def _image(point: Point) -> Point:
    return -point[0], point[1], point[2]
