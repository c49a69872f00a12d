"""Traits: what verification compares of one gesture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
)
from smd.recognition.embedding import (
    PoseSequence,
    embed_poses,
    extent_m,
    heading_frame,
    scaled,
    seen_from,
)

SAMPLES = 40
"""Samples of a course: one every 50 ms of a gesture of 2 s. 64 are no more accurate."""

COURSES = ("shape_heading", "shape_prop", "flow_heading", "flow_prop")
"""What is aligned: the poses (shape) and the velocities (flow) of a gesture, each in two frames:
the heading frame (up is the world's, front the prop's) and the prop's own."""

MEASURES = ("duration", "extent", "path", "turning")
"""Numbers that are compared, as logarithms: the duration, the root mean square distance of the
positions from their mean, the length of the path, and the total rotation."""

_SMALLEST_EXTENT = 0.17
_SLOWEST = 0.3
_SLOWEST_RAD_S = 0.5
"""Added to sizes before division, in figure heights, heights and radians a second: small movements
are not scaled up to the common size, or noise would have a shape."""

_LEVER = 0.25
"""Figure heights from the prop's centre about which hands turn it. The translation that this causes
is added to the size that shapes are divided by."""

_RADIAN_IN_SHAPE = 0.4
"""Length of a radian, in a shape whose positions lie at distance 1 from their mean."""

_RADIAN_IN_FLOW = 0.5
FLOORS = (0.05, 0.1, 0.2, 0.1)
"""Added to each measure before the logarithm: s, heights, heights, rad."""


class Traits(NamedTuple):
    """What verification compares of a gesture, or with a leading axis of several.

    Attributes
    ----------
    courses : in the order of `COURSES`, each ``(…, SAMPLES, d)``; place, heading and size removed.
    measures : (…, 4), logarithms in the order of `MEASURES`.
    """

    courses: tuple[FloatArray, ...]
    measures: FloatArray


def traits_of(motion: RigidMotion, *, figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M) -> Traits:
    """Return the traits of a gesture that fills a motion from its first sample to its last.

    Parameters
    ----------
    motion
        Smooth; at least one sample.
    figure_height_m
        Height of the figurine that the prop stands for; lengths are counted in it.
    """
    whole = float(motion.time_s[0]), float(motion.time_s[-1])
    one = traits_of_parts(motion, [whole], figure_height_m=figure_height_m)
    return Traits(tuple(course[0] for course in one.courses), one.measures[0])


def traits_of_parts(
    motion: RigidMotion,
    spans_s: Sequence[tuple[float, float]],
    *,
    figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M,
    every: int = 1,
) -> Traits:
    """Return the traits of parts of a motion, each as if it were alone, all at once.

    Parameters
    ----------
    motion
        Smooth.
    spans_s
        When each part begins and ends; it has the samples in between, at least one. There is at
        least one part.
    figure_height_m
        Height of the figurine that the prop stands for; lengths are counted in it.
    every
        Only every so many-th sample of the courses is computed.
    """
    spans = np.asarray(spans_s, dtype=np.float64)
    time_s = motion.time_s
    start_s = time_s[np.searchsorted(time_s, spans[:, 0] - 1e-9)]
    end_s = time_s[np.searchsorted(time_s, spans[:, 1] + 1e-9, side="right") - 1]
    at_s = np.linspace(start_s, end_s, SAMPLES, axis=-1)[:, ::every]

    poses = scaled(
        PoseSequence(
            interpolate_linear(time_s, motion.position_m, at_s),
            interpolate_rotation(time_s, motion.orientation_xyzw, at_s),
        ),
        1.0 / figure_height_m,
    )
    extent = extent_m(poses)
    heading = heading_frame(poses)
    own = _mean_orientation(poses)
    turned = rotvec_from_quaternion(multiply(inverse(own)[:, None], poses.orientation_xyzw))
    lever = _LEVER * _rms(np.linalg.norm(turned, axis=-1))
    alike = scaled(poses, 1.0 / (extent + _SMALLEST_EXTENT + lever))

    velocity = rotate(inverse(motion.orientation_xyzw), motion.velocity_m_s) / figure_height_m
    moving = interpolate_linear(time_s, velocity, at_s)
    turning = interpolate_linear(time_s, motion.angular_velocity_rad_s, at_s)
    speed, rate = (np.linalg.norm(v, axis=-1) for v in (moving, turning))
    moving = moving / (_rms(speed) + _SLOWEST)[:, None, None]
    turning = turning * (_RADIAN_IN_FLOW / (_rms(rate) + _SLOWEST_RAD_S))[:, None, None]
    heading_from_prop = multiply(inverse(heading)[:, None], poses.orientation_xyzw)

    duration_s = end_s - start_s
    way = duration_s * speed.mean(axis=-1)
    turns = duration_s * rate.mean(axis=-1)
    sizes = np.stack([duration_s, extent + lever, way + lever, turns], axis=-1)
    courses = (
        _shape(alike, heading),
        _shape(alike, own),
        np.concatenate(
            [rotate(heading_from_prop, moving), rotate(heading_from_prop, turning)], axis=-1
        ),
        np.concatenate([moving, turning], axis=-1),
    )
    measures = np.log(sizes + FLOORS)
    return Traits(courses, measures)


def fitted(
    shapes: FloatArray, target: FloatArray, *, facing_rad: float, askew_rad: float
) -> FloatArray:
    """Return shapes rotated to fit another one better, within the tolerances of hands.

    A hand faces only roughly where its user means to, and holds the prop a little askew. Both are
    constant rotations, about the world's up axis and along the prop's own axes, and are removed, up
    to a limit. The first minimizes the distances of simultaneous points: it is the angle of the sum
    of their products, as complex numbers of the ground plane. The second follows from the sum of
    the cross products of simultaneous axes: for one constant rotation, its sine times its axis.

    Parameters
    ----------
    shapes
        ``(m, n, 12)``: a position and three axes a sample.
    target
        ``(m, n, 12)``, or ``(n, 12)`` for all.
    facing_rad, askew_rad
        Limits of the two rotations; non-negative.

    Returns
    -------
    ndarray
        ``(m, n, 12)``.
    """
    m, n, _ = shapes.shape
    # Sums over the samples of products of our numbers with theirs: (m, vector, its axis, …)
    products = np.matmul(np.swapaxes(shapes, -1, -2), target).reshape(m, 4, 3, 4, 3)
    same = np.einsum("mrkrl->mkl", products)
    along, across = same[:, 0, 0] + same[:, 2, 2], same[:, 2, 0] - same[:, 0, 2]
    angle = np.clip(np.arctan2(across, along), -facing_rad, facing_rad)
    facing = matrix_from_quaternion(quaternion_about([0.0, 1.0, 0.0], angle))

    # (m, 3, 3), the mean of (our frame)^T (their frame), each of unit axes, ours turned
    between = np.einsum("mkl,mrlck->mrc", facing, products[:, 1:, :, 1:])
    between /= n * 0.5 * _RADIAN_IN_SHAPE**2
    sine_axis = 0.5 * np.stack(
        [
            between[:, 2, 1] - between[:, 1, 2],
            between[:, 0, 2] - between[:, 2, 0],
            between[:, 1, 0] - between[:, 0, 1],
        ],
        axis=-1,
    )
    size = np.linalg.norm(sine_axis, axis=-1, keepdims=True)
    most = np.minimum(np.arcsin(np.minimum(size, 1.0)), askew_rad)
    held = matrix_from_quaternion(
        quaternion_from_rotvec(sine_axis / np.maximum(size, 1e-12) * -most)
    )
    # The position is turned by facing; the axes are, and are mixed by held.
    turned = np.empty_like(shapes)
    np.matmul(shapes[..., :3], np.swapaxes(facing, 1, 2), out=turned[..., :3])
    mixed = np.einsum("mrc,mlk->mckrl", held, facing).reshape(m, 9, 9)
    np.matmul(shapes[..., 3:], mixed, out=turned[..., 3:])
    return turned


def _shape(poses: PoseSequence, frame_xyzw: FloatArray) -> FloatArray:
    """Return poses seen from a frame as points ``(…, n, 12)``: four vectors a sample."""
    points = embed_poses(seen_from(poses, frame_xyzw), metres_per_radian=_RADIAN_IN_SHAPE)
    # From rows of the matrix to its columns, the prop's axes: vectors that a frame's turn turns.
    rows = points[..., 3:].reshape(*points.shape[:-1], 3, 3)
    axes = np.swapaxes(rows, -1, -2).reshape(*points.shape[:-1], 9)
    return np.concatenate([points[..., :3], axes], axis=-1)


def _mean_orientation(poses: PoseSequence) -> FloatArray:
    """Return the unit quaternion nearest to all of the orientations, ``(…, 4)``."""
    q = poses.orientation_xyzw
    return np.asarray(np.linalg.eigh(np.swapaxes(q, -1, -2) @ q)[1][..., -1], dtype=np.float64)


def _rms(values: FloatArray) -> FloatArray:
    """Return the root mean square over the last axis."""
    return np.sqrt(np.mean(values * values, axis=-1))
