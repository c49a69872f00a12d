"""Acting: the moves of a course as poses at even times."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from smd.acting.move import Move
from smd.acting.transitions import carried_over, transition_s
from smd.character.poses import Poses, mixed, sampled
from smd.geometry.arrays import BoolArray, FloatArray
from smd.transfer.repertoire import Piece

SEEN = 0.1
"""Presence from which a clip says which feet stand: a foot that swings there must be free early,
or what is left of its swing is too short for the way."""

_STEP_S = 1e-3
"""Time over which the velocities on both sides of a boundary are taken."""


def acted_poses(moves: Sequence[Move], time_s: FloatArray, idle: Piece, *, clock_s: float) -> Poses:
    """Return local poses at each time, with transitions, the ground root left at its origin.

    Parameters
    ----------
    moves
        One after the other; each acts from where the one before it ends.
    time_s
        ``(n,)`` increasing, from the first move's start to the last one's end.
    idle
        What is seen as far as a move is not.
    clock_s
        Time at which idling began.
    """
    pieces: list[Poses] = []
    for i, (move, rows) in enumerate(zip(moves, rows_of(moves, time_s), strict=True)):
        now_s = time_s[rows]
        poses = own_poses(move, now_s, idle, clock_s)
        if i > 0 and len(now_s) > 0:
            poses = _joined(moves[i - 1], move, poses, now_s, idle, clock_s)
        pieces.append(poses)
    return Poses(
        np.concatenate([piece.rotation_xyzw for piece in pieces]),
        np.concatenate([piece.translation_m for piece in pieces]),
    )


def acted_contacts(
    moves: Sequence[Move],
    time_s: FloatArray,
    idle: Piece,
    feet: Sequence[int],
    *,
    clock_s: float,
) -> tuple[BoolArray, FloatArray]:
    """Return when each foot should stand, and how far it has pivoted, as the clips say.

    Returns
    -------
    stands, pivot_rad
        ``(n, feet)``; the pivots of all clips that were seen add up.
    """
    stands = np.zeros((len(time_s), len(feet)), dtype=bool)
    pivots = np.zeros((len(time_s), len(feet)))
    for move, rows in zip(moves, rows_of(moves, time_s), strict=True):
        now_s = time_s[rows]
        frame, idle_frame = move.frame_at(now_s), (now_s - clock_s) * idle.clip.rate_hz
        presence = move.presence_at(now_s)
        for column, foot in enumerate(feet):
            stands[rows, column] = np.where(
                presence >= SEEN,
                move.piece.stands_at(foot, frame),
                idle.stands_at(foot, idle_frame),
            )
            pivots[rows, column][1:] = presence[1:] * np.diff(move.piece.yaw_at(foot, frame))
    return stands, np.cumsum(pivots, axis=0)


def rows_of(moves: Sequence[Move], time_s: FloatArray) -> list[slice]:
    """Return which of the times each move acts at; the last one acts at its end too."""
    cuts = np.searchsorted(time_s, [move.end_s for move in moves[:-1]])
    edges = [0, *cuts.tolist(), len(time_s)]
    return [slice(a, b) for a, b in pairwise(edges)]


def own_poses(move: Move, time_s: FloatArray, idle: Piece, clock_s: float) -> Poses:
    """Return a move's poses ``(n, …)`` by itself, without the transition into it."""
    poses = sampled(move.piece.clip, move.frame_at(time_s))
    presence = move.presence_at(time_s)
    faint = np.flatnonzero(presence < 1.0)
    if len(faint) == 0:
        return poses
    standing_still = sampled(idle.clip, (time_s[faint] - clock_s) * idle.clip.rate_hz)
    some = Poses(poses.rotation_xyzw[faint], poses.translation_m[faint])
    some = mixed(standing_still, some, presence[faint])
    poses.rotation_xyzw[faint], poses.translation_m[faint] = some
    return poses


def _joined(
    before: Move, move: Move, poses: Poses, now_s: FloatArray, idle: Piece, clock_s: float
) -> Poses:
    """Let the difference to the move before die away over this one's first poses."""
    at_s = before.end_s
    ends = (
        own_poses(before, at_s + np.array([-_STEP_S, 0.0]), idle, clock_s),
        own_poses(move, at_s + np.array([0.0, _STEP_S]), idle, clock_s),
    )
    over_s = min(transition_s(*ends), move.start_s - at_s + move.room_s)
    count = int(np.searchsorted(now_s, at_s + over_s))
    if count == 0:
        return poses
    first = Poses(poses.rotation_xyzw[:count], poses.translation_m[:count])
    first = carried_over(*ends, first, now_s[:count] - at_s, over_s=over_s, step_s=_STEP_S)
    poses.rotation_xyzw[:count], poses.translation_m[:count] = first
    return poses
