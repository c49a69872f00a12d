"""Average: the mean doodle of several ones of the same gesture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import matrix_from_quaternion, quaternion_about, sign_continuous
from smd.recognition.alignment import align, distances
from smd.recognition.embedding import (
    PoseSequence,
    embed_poses,
    heading_frame,
    sample_poses,
    seen_from,
)

RATE_HZ = 60.0
"""Rate of an average doodle, that of smoothed motion."""

MOST_SAMPLES = 600
"""Ten seconds; a longer average is sampled more coarsely, since warping takes quadratic time."""

ROUNDS = 4
"""How often the average is taken as the next reference. Between the third and the fourth it moves
by less than a hundredth of the extent of simulated gestures that move."""

UP = (0.0, 1.0, 0.0)


def average_doodle(
    doodles: Sequence[Doodle], *, figure_height_m: float = DEFAULT_FIGURE_HEIGHT_M
) -> Doodle:
    """Return the mean of several doodles of one gesture.

    Section 4.3 of the paper [1]_: dynamic time warping finds which samples belong together, and
    the mean of each such set is taken; of the positions, of the rotations [2]_, and of the times,
    so that the average lasts as long as the examples on average. The examples are first brought
    to one place and heading; their sizes are kept, and averaged. The reference for warping is the
    example that is nearest to all others, and then, a few times, the average itself [3]_, so that
    the order of the examples does not matter.

    Parameters
    ----------
    doodles
        At least one, of at least two samples each.
    figure_height_m
        A translation by this counts as much as a rotation by a radian.

    Returns
    -------
    Doodle
        Even times from 0 at 60 Hz (fewer, 600 samples, where it lasts longer than ten seconds),
        its mean position at the origin, its mean front ahead; of the first one's device.

    Raises
    ------
    DoodleError
        If there are no doodles, or one has a single sample.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
    .. [2] F. L. Markley et al., "Averaging Quaternions", Journal of Guidance, Control, and
       Dynamics 30(4), 2007.
    .. [3] F. Petitjean, A. Ketterlin, P. Gancarski, "A global averaging method for dynamic time
       warping, with applications to clustering", Pattern Recognition 44(3), 2011.
    """
    if not doodles:
        raise DoodleError("average: expected at least one doodle, got none")
    for number, doodle in enumerate(doodles, start=1):
        if len(doodle) < 2:
            raise DoodleError(f"average: doodle {number}: expected at least 2 samples, got 1")
    duration_s = np.array([doodle.duration_s for doodle in doodles])
    samples = int(np.clip(round(float(duration_s.mean()) * RATE_HZ) + 1, 2, MOST_SAMPLES))
    upright = [_upright(sample_poses(doodle, samples)) for doodle in doodles]
    reference = upright[
        _medoid([embed_poses(p, metres_per_radian=figure_height_m) for p in upright])
    ]
    for _ in range(ROUNDS):
        mean, own_s = _mean_along(reference, upright, duration_s, figure_height_m)
        reference = _upright(_even(mean, own_s, samples))
    # The ends of the mean times stand for several samples each, and so lie within the duration.
    time_s = np.linspace(0.0, float(duration_s.mean()), samples)
    return Doodle(time_s, reference.position_m, reference.orientation_xyzw, doodles[0].device)


def _upright(poses: PoseSequence) -> PoseSequence:
    """Return poses around the origin, facing ahead."""
    return seen_from(poses, heading_frame(poses))


def _medoid(courses: Sequence[FloatArray]) -> int:
    """Return which course is nearest to all others; coarsely, as it is only where to begin."""
    if len(courses) < 3:
        return 0
    step = max(len(courses[0]) // 32, 1)
    coarse = [course[::step] for course in courses]
    total = np.zeros(len(coarse))
    for i in range(len(coarse) - 1):
        apart = distances(coarse[i], coarse[i + 1 :])
        total[i] += apart.sum()
        total[i + 1 :] += apart
    return int(total.argmin())


def _mean_along(
    reference: PoseSequence,
    examples: Sequence[PoseSequence],
    duration_s: FloatArray,
    figure_height_m: float,
) -> tuple[PoseSequence, FloatArray]:
    """Return the mean pose and the mean time of what belongs to each pose of the reference."""
    n = len(reference.position_m)
    ours = embed_poses(reference, metres_per_radian=figure_height_m)
    position, time_s, spread = np.zeros((n, 3)), np.zeros(n), np.zeros((n, 4, 4))
    for example, lasts_s in zip(examples, duration_s, strict=True):
        theirs = embed_poses(example, metres_per_radian=figure_height_m)
        path = align(ours, theirs).path
        turned = _turned_towards(reference, example, path, figure_height_m)
        mine, other = path.T
        share = 1.0 / np.bincount(mine)[mine]
        q = turned.orientation_xyzw[other]
        np.add.at(position, mine, share[:, None] * turned.position_m[other])
        np.add.at(time_s, mine, share * other * (lasts_s / (n - 1)))
        np.add.at(spread, mine, share[:, None, None] * q[:, :, None] * q[:, None, :])
    # The unit quaternion whose squared dot products with all of them add up to most: signs drop.
    mean_xyzw = sign_continuous(np.linalg.eigh(spread)[1][:, :, -1])
    return PoseSequence(position / len(examples), mean_xyzw), time_s / len(examples)


def _turned_towards(
    reference: PoseSequence, example: PoseSequence, path: np.ndarray, figure_height_m: float
) -> PoseSequence:
    """Return an example, turned about up so that paired poses are nearest in least squares."""
    mine, other = path.T
    matched = np.concatenate(
        [
            reference.position_m[mine, :, None] * example.position_m[other, None, :],
            0.5
            * figure_height_m**2
            * matrix_from_quaternion(reference.orientation_xyzw[mine])
            @ np.swapaxes(matrix_from_quaternion(example.orientation_xyzw[other]), -1, -2),
        ]
    ).sum(axis=0)
    # The trace of a turn about y times this is a cos + b sin; an undecided one is left as it is.
    a, b = matched[0, 0] + matched[2, 2], matched[0, 2] - matched[2, 0]
    return seen_from(example, quaternion_about(UP, -np.arctan2(b, a)))


def _even(poses: PoseSequence, time_s: FloatArray, samples: int) -> PoseSequence:
    """Return poses at even times; where time stands still, the first of the poses counts."""
    kept = np.flatnonzero(np.diff(time_s, prepend=-np.inf) > 1e-9)
    at_s = np.linspace(time_s[0], time_s[-1], samples)
    return PoseSequence(
        interpolate_linear(time_s[kept], poses.position_m[kept], at_s),
        interpolate_rotation(time_s[kept], poses.orientation_xyzw[kept], at_s),
    )
