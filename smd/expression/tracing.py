"""Tracing: the paths of hands become straighter, or more curved (Laban's Space)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from smd.character.clip import Clip
from smd.character.kinematics import joints_in_world
from smd.expression.body import Body
from smd.expression.reaching import arm_poses, with_hand_moved
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
"""Smoothing of the speed that separates sweeps."""


def sweeps(position_m: FloatArray, rate_hz: float) -> list[tuple[int, int]]:
    """Return the first and last frame of each sweep of a path ``(n, 3)``, one after the other.

    A sweep ends where the speed has a minimum that is clearly lower than the maxima beside it.
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
    return list(pairwise([*cuts, len(speed) - 1]))


def redrawn(position_m: FloatArray, space: float, rate_hz: float) -> FloatArray:
    """Return the displacement ``(n, 3)`` of a path ``(n, 3)``, zero where it turns.

    Parameters
    ----------
    space
        From -1, indirect: what bends bends more, what is straight bows out and weaves; to +1,
        direct: each sweep goes nearly straight. A path that returns to its start has no straight
        way, and is the less straightened the rounder it is.
    """
    offset = np.zeros_like(position_m)
    for start, end in sweeps(position_m, rate_hz):
        path = position_m[start : end + 1]
        steps = np.linalg.norm(np.diff(path, axis=0), axis=-1)
        way = float(steps.sum())
        if end - start < 2 or way < SHORTEST_M:
            continue
        share = np.concatenate([[0.0], np.cumsum(steps)])[:, None] / way
        chord = path[-1] - path[0]
        bend = path - (path[0] + share * chord)
        length = float(np.linalg.norm(chord))
        if space > 0.0:
            offset[start : end + 1] = -STRAIGHTER * space * min(2.0 * length / way, 1.0) * bend
            continue
        out, aside = _across(chord, bend)
        arc = BOW * np.sin(np.pi * share) * out
        weave = WEAVE * np.sin(2.0 * np.pi * share) * np.sin(np.pi * share) * aside
        offset[start : end + 1] = -space * (BENT_MORE * bend + length * (arc + weave))
    return offset


def _across(chord: FloatArray, bend: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two unit directions across a sweep: the first the way it bends, or up."""
    along = normalized(chord)
    mean = bend.mean(axis=0)
    if np.linalg.norm(mean) < 0.02 * np.linalg.norm(chord):
        mean = np.array([0.0, 1.0, 0.0]) if abs(along[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    out = normalized(mean - (mean @ along) * along)
    return out, np.cross(along, out)


def with_hands_redrawn(clip: Clip, body: Body, space: float, bearing: FloatArray) -> Clip:
    """Return a clip whose hands' paths are straighter, or wander, in the chest's coordinate frame.

    Parameters
    ----------
    space
        As in `redrawn`.
    bearing
        ``(n, a)`` how surely each arm's hand rests on the ground: it stays there.
    """
    local = clip.rotation_xyzw, clip.translation_m
    chest_q, chest = (part[:, 0] for part in joints_in_world(clip.skeleton, [body.chest], *local))
    poses = arm_poses(clip, body.arms)
    for arm, pose, rests in zip(body.arms, poses, bearing.T, strict=True):
        seen = rotate(inverse(chest_q), pose.hand_m - chest)
        offset = rotate(chest_q, redrawn(seen, space, clip.rate_hz))
        clip = with_hand_moved(clip, arm, pose, (1.0 - rests)[:, None] * offset)
    return clip
