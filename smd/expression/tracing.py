"""Tracing: the paths of hands become straighter, or more curved (Laban's Space)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from smd.character.poses import Poses
from smd.expression.aim import seen_from_root
from smd.expression.reaching import TOUCHING_M, arm_poses, with_hands_moved
from smd.expression.study import Study
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed
from smd.geometry.rotations import inverse, normalized, rotate

STRAIGHTER = 0.8
"""Share of a sweep's curvature that a direct hand loses."""

BENT_MORE, BOW, WEAVE = 0.4, 0.2, 0.06
"""What an indirect hand adds: to its own curvature; a bow and a weave, as shares of the length."""

SHORTEST_M = 0.04
"""A sweep shorter than this is unchanged: a hand that rests has no path."""

TURNING = 0.35
"""A sweep ends where the hand is slower than this share of the top speeds on both sides."""

STEADY_S = 0.03
"""Smoothing of the speed that separates sweeps, and of the bend of a path from one to the next."""

PASSING = 0.5
"""How near a redrawn hand may pass its shoulder, in reaches of its arm."""

NEAR_S = 0.1
"""How near to a frame that a path leads through no other sweep ends."""


def sweeps(
    position_m: FloatArray, rate_hz: float, through: Sequence[int] = ()
) -> list[tuple[int, int]]:
    """Return the first and last frame of each sweep of a path ``(n, 3)``, one after the other.

    A sweep ends where the speed has a minimum that is clearly lower than the maxima beside it.

    Parameters
    ----------
    through
        Frames at which one ends in any case, instead of where it is slowest near by.
    """
    speed = np.linalg.norm(np.gradient(position_m, axis=0), axis=-1)
    speed = gaussian_smoothed(speed, STEADY_S * rate_hz)
    cuts = [0]
    lowest = np.flatnonzero((speed[1:-1] < speed[:-2]) & (speed[1:-1] <= speed[2:])) + 1
    edges = [0, *lowest.tolist(), len(speed) - 1]
    for before, here, after in zip(edges, edges[1:], edges[2:], strict=False):
        tops = speed[max(before, cuts[-1]) : here + 1].max(), speed[here : after + 1].max()
        if speed[here] < TURNING * min(tops):
            cuts.append(here)
    last, near = len(speed) - 1, NEAR_S * rate_hz
    apart = [cut for cut in cuts if all(abs(cut - frame) > near for frame in through)]
    return list(pairwise(sorted({0, last, *through, *apart})))


class Held(NamedTuple):
    """What holds a hand back while its path is redrawn.

    Attributes
    ----------
    free : (n,) how freely it may be moved, from 0 to 1.
    shoulder_m : (n, e, 3) where its shoulder is in each state, in the frame of the path.
    reach_m : of its arm.
    through : frames whose places the path keeps, as in `sweeps`.
    """

    free: FloatArray
    shoulder_m: FloatArray
    reach_m: float
    through: Sequence[int]


def redrawn(
    position_m: FloatArray, space: FloatArray, rate_hz: float, held: Held | None = None
) -> FloatArray:
    """Return the displacements ``(n, e, 3)`` of a path ``(n, 3)``, zero where it turns.

    Each sweep is displaced in one shape, by one amount: what holds the hand back at one moment
    holds it back in all, since half a straight way is no straighter one.

    Parameters
    ----------
    space
        ``(e,)`` from -1, indirect: what bends bends more, what is straight bows out and weaves; to
        +1, direct: each sweep goes nearly straight. A path that returns to its start has no
        straight way, and is the less straightened the rounder it is.
    held
        What holds it back; nothing, by default.
    """
    offset = np.zeros((len(position_m), len(space), 3))
    through = held.through if held else ()
    ways = [(direct, np.flatnonzero(space > 0.0 if direct else space < 0.0)) for direct in (0, 1)]
    for start, end in sweeps(position_m, rate_hz, through):
        at = slice(start, end + 1)
        for direct, states in ways:
            if not len(states):
                continue
            shape = _displacement(position_m[at], direct=bool(direct))[:, None]
            amount = np.abs(space[states])
            if held and shape.any():
                arm = position_m[at, None] - held.shoulder_m[at, states]
                most = _most_beside(arm, shape, PASSING * held.reach_m)
                amount = np.minimum(amount * held.free[at].min(), most)
            offset[at, states] = amount[:, None] * shape
    smooth = gaussian_smoothed(offset, STEADY_S * rate_hz) if through else offset
    for frame in through:
        away = (np.arange(len(offset)) - frame) / (2.0 * STEADY_S * rate_hz)
        smooth = smooth - np.exp(-0.5 * away * away)[:, None, None] * smooth[frame]
    return smooth


def _displacement(path: FloatArray, *, direct: bool) -> FloatArray:
    """Return what is added to one sweep ``(n, 3)`` in full."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=-1)
    way = float(steps.sum())
    if len(path) < 3 or way < SHORTEST_M:
        return np.zeros_like(path)
    share = np.concatenate([[0.0], np.cumsum(steps)])[:, None] / way
    chord = path[-1] - path[0]
    bend = path - (path[0] + share * chord)
    length = float(np.linalg.norm(chord))
    if direct:
        return -STRAIGHTER * min(2.0 * length / way, 1.0) * bend
    out, aside = _across(chord, bend)
    arc = BOW * np.sin(np.pi * share) * out
    weave = WEAVE * np.sin(2.0 * np.pi * share) * np.sin(np.pi * share) * aside
    return BENT_MORE * bend + length * (arc + weave)


def _most_beside(arm_m: FloatArray, shape: FloatArray, nearest_m: float) -> FloatArray:
    """Return how much of a displacement ``(e,)`` leads hands no nearer to their shoulders than so.

    Where one is nearer anyway, it may come nearer still, by a fifth. Through the shoulder, an arm
    would turn over.

    Parameters
    ----------
    arm_m, shape
        ``(n, e, 3)`` from shoulder to hand, and ``(n, 1, 3)``, what is added to it.
    """
    far = np.sum(arm_m * arm_m, axis=-1)
    least = np.minimum(nearest_m**2, 0.64 * far)
    inward, size = -np.sum(arm_m * shape, axis=-1), np.sum(shape * shape, axis=-1)
    inside = inward * inward - size * (far - least)
    meets = (inward > 0.0) & (inside > 0.0)
    most = (inward - np.sqrt(np.maximum(inside, 0.0))) / np.maximum(size, np.finfo(float).tiny)
    return np.where(meets, most, np.inf).min(axis=0)


def _across(chord: FloatArray, bend: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two unit directions across a sweep: the first the way it bends, or up."""
    along = normalized(chord)
    mean = bend.mean(axis=0)
    if np.linalg.norm(mean) < 0.02 * np.linalg.norm(chord):
        mean = np.array([0.0, 1.0, 0.0]) if abs(along[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    out = normalized(mean - (mean @ along) * along)
    return out, np.cross(along, out)


def with_hands_redrawn(poses: Poses, study: Study, space: FloatArray) -> Poses:
    """Return a stack whose hands' paths are straighter, or wander, as seen from the ground root.

    It is seen from there that a path is straight; a chest that bows bends it. A hand that bears
    weight stays, and none goes under the ground. Where the execution begins and ends, the body is
    at an extreme of its way, and at its aim: paths lead through there.

    Parameters
    ----------
    poses
        ``(n, e, j, …)`` the study's, its trunk as it is to be.
    space
        ``(e,)``, as in `redrawn`.
    """
    clip, arms = study.clip, study.body.arms
    if not arms:
        return poses
    through = [] if clip.cyclic else sorted(set(clip.stage_end_frames[1:3].tolist()))
    pose, there = arm_poses(clip.skeleton, poses, arms), study.hands_m
    path = seen_from_root(clip, there)
    root, root_m = clip.rotation_xyzw[:, None, :1], clip.translation_m[:, None, :1]
    shoulder = rotate(inverse(root), pose.shoulder_m - root_m)
    offset = np.empty_like(pose.hand_m)
    for i, arm in enumerate(arms):
        free = 1.0 - study.bearing[:, i]
        held = Held(free, shoulder[:, :, i], arm.limb.reach_m, through)
        offset[:, :, i] = redrawn(path[:, i], space, clip.rate_hz, held)
    wanted = there[:, None] + rotate(root, offset)
    lowest = np.minimum(there[..., 1], TOUCHING_M)[:, None]
    wanted[..., 1] = np.maximum(wanted[..., 1], lowest)
    return with_hands_moved(poses, arms, pose, wanted - pose.hand_m)
