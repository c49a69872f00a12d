"""Traits: what verification looks at in one gesture."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from laban import RigidMotion
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear
from smd.geometry.rotations import inverse, multiply, rotate
from smd.recognition.embedding import (
    Poses,
    embed_poses,
    extent_m,
    heading_frame,
    sample_poses,
    scaled,
    seen_from,
)

SAMPLES = 40
"""Points a course has: one every 50 ms of a gesture of 2 s. 64 are no more accurate."""

COURSES = ("shape_heading", "shape_prop", "flow_heading", "flow_prop")
"""What is aligned: where the gesture goes and how it moves on, each seen twice: from the heading
frame (up is the world's, front the prop's) and from the prop's own."""

MEASURES = ("duration", "extent", "path", "turning")
"""What is compared as a number, by its logarithm: how long the gesture lasts, the root mean square
distance of its positions from their mean, the length of its way, and how far it turns in all."""

_SMALLEST_EXTENT = 0.17
_SLOWEST = 0.3
_SLOWEST_RAD_S = 0.5
"""What counts as no movement, in figure heights, heights and radians a second: smaller sizes are
not blown up to the common one, or noise would have a shape."""

_RADIAN_IN_SHAPE = 0.4
"""How far turning by a radian is, in a shape whose positions lie at distance 1 from their mean."""

_RADIAN_IN_FLOW = 0.5
_FLOORS = (0.05, 0.1, 0.2, 0.1)
"""Added to each measure before the logarithm: s, heights, heights, rad."""


class Traits(NamedTuple):
    """What verification looks at in one gesture.

    Attributes
    ----------
    courses : by the names in `COURSES`, each ``(SAMPLES, d)``: free of place, heading, and size.
    measures : (4,), logarithms in the order of `MEASURES`.
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
    poses = scaled(sample_poses(motion, SAMPLES), 1.0 / figure_height_m)
    extent = extent_m(poses)
    alike = scaled(poses, 1.0 / (extent + _SMALLEST_EXTENT))
    heading = heading_frame(poses)
    own = _mean_orientation(poses)

    at_s = np.linspace(motion.time_s[0], motion.time_s[-1], SAMPLES)
    velocity = rotate(inverse(motion.orientation_xyzw), motion.velocity_m_s) / figure_height_m
    moving = interpolate_linear(motion.time_s, velocity, at_s)
    turning = interpolate_linear(motion.time_s, motion.angular_velocity_rad_s, at_s)
    speed, rate = (np.linalg.norm(v, axis=-1) for v in (moving, turning))
    moving = moving / (_rms(speed) + _SLOWEST)
    turning = turning * (_RADIAN_IN_FLOW / (_rms(rate) + _SLOWEST_RAD_S))
    heading_from_prop = multiply(inverse(heading), poses.orientation_xyzw)

    duration_s = float(motion.time_s[-1] - motion.time_s[0])
    sizes = (duration_s, extent, duration_s * speed.mean(), duration_s * rate.mean())
    return Traits(
        courses=(
            _shape(alike, heading),
            _shape(alike, own),
            np.hstack([rotate(heading_from_prop, moving), rotate(heading_from_prop, turning)]),
            np.hstack([moving, turning]),
        ),
        measures=np.log(np.asarray(sizes) + _FLOORS),
    )


def turned_towards(shape: FloatArray, targets: FloatArray, most_rad: float) -> FloatArray:
    """Return a shape turned about up to fit each target best, by ``most_rad`` at most.

    A hand shows where it faces only roughly. The turn about +Y that brings simultaneous points
    nearest to each other has a closed form: the angle of the sum of their products, as complex
    numbers of the level plane.

    Parameters
    ----------
    shape
        ``(n, 3 k)``: k vectors a sample, all of which turn.
    targets
        ``(m, n, 3 k)``.

    Returns
    -------
    ndarray
        ``(m, n, 3 k)``.
    """
    n, width = shape.shape
    ours = shape.reshape(n, width // 3, 3)
    theirs = targets.reshape(-1, n, width // 3, 3)
    along = np.einsum("nki,mnki->m", ours[..., ::2], theirs[..., ::2])
    across = np.einsum("nk,mnk->m", ours[..., 2], theirs[..., 0]) - np.einsum(
        "nk,mnk->m", ours[..., 0], theirs[..., 2]
    )
    angle = np.clip(np.arctan2(across, along), -most_rad, most_rad)[:, None, None]
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = np.empty_like(theirs)
    turned[..., 0] = cosine * ours[..., 0] + sine * ours[..., 2]
    turned[..., 1] = ours[..., 1]
    turned[..., 2] = cosine * ours[..., 2] - sine * ours[..., 0]
    return turned.reshape(targets.shape)


def _shape(poses: Poses, frame_xyzw: FloatArray) -> FloatArray:
    """Return poses seen from a frame as points ``(n, 12)``: four vectors a sample."""
    points = embed_poses(seen_from(poses, frame_xyzw), metres_per_radian=_RADIAN_IN_SHAPE)
    # From rows of the matrix to its columns, the prop's axes: vectors that a frame's turn turns.
    axes = points[:, 3:].reshape(-1, 3, 3).transpose(0, 2, 1).reshape(-1, 9)
    return np.hstack([points[:, :3], axes])


def _mean_orientation(poses: Poses) -> FloatArray:
    """Return the unit quaternion nearest to all of the orientations, ``(4,)``."""
    q = poses.orientation_xyzw
    return np.asarray(np.linalg.eigh(q.T @ q)[1][:, -1], dtype=np.float64)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values * values)))
