"""Moving: a performer's moves as poses, tracks and footwork at even times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from smd.acting.move import Footwork, Move, Playable
from smd.acting.transitions import carried_over, transition_s
from smd.character.poses import Poses, mixed
from smd.character.tracks import NO_TRACKS, Tracks
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import quaternion_about

SEEN = 0.1
"""Blend weight from which a clip decides which feet stand: a foot that swings in it must be
released early, or the rest of its swing is too short for the distance."""

TURNING_S = 0.1
"""Smoothing of a performer's heading, so that turns at a phrase's ends are gentle."""

_STEP_S = 1e-3
"""Time over which the velocities on both sides of a boundary are taken."""


@dataclass(frozen=True, slots=True, eq=False)
class Idling:
    """The idle clip, seen where the blend weight of a move is below 1.

    Attributes
    ----------
    piece : what is played, repeatedly.
    rate_hz : its frames a second.
    began_s : time of its frame 0.
    """

    piece: Playable
    rate_hz: float
    began_s: float

    def frame_at(self, time_s: FloatArray) -> FloatArray:
        """Return its fractional frame at some times."""
        return (time_s - self.began_s) * self.rate_hz


def posed(
    moves: Sequence[Move[Playable]],
    time_s: FloatArray,
    idling: Idling,
    joints: IntArray | None = None,
) -> Poses:
    """Return local poses at each time, with transitions, the ground root left at its origin.

    Parameters
    ----------
    moves
        One after the other; each acts from where the one before it ends.
    time_s
        ``(n,)`` increasing, from the first move's start to the last one's end.
    joints
        Those whose turns decide how long a transition takes; by default all.
    """
    pieces: list[Poses] = []
    for i, (move, rows) in enumerate(zip(moves, rows_of(moves, time_s), strict=True)):
        now_s = time_s[rows]
        poses = own_poses(move, now_s, idling)
        if i > 0 and len(now_s) > 0:
            poses = _joined(moves[i - 1], move, poses, now_s, idling, joints)
        pieces.append(poses)
    return Poses(
        np.concatenate([piece.rotation_xyzw for piece in pieces]),
        np.concatenate([piece.translation_m for piece in pieces]),
    )


def tracked(
    moves: Sequence[Move[Playable]],
    time_s: FloatArray,
    idling: Idling,
    joints: IntArray | None = None,
) -> Tracks:
    """Return the tracks at each time, of all names that any clip has; parameters as in `posed`.

    At a boundary they are mixed from their last values into the next move's, in as much time as
    the joints take. What is mixed stays between the two: a difference that decays, as that of
    joints does, would open a mouth farther than either move.
    """
    played = (idling.piece, *(move.piece for move in moves))
    first = np.zeros(1)
    names = tuple(dict.fromkeys(name for one in played for name in one.tracks_at(first).names))
    if not names:
        return NO_TRACKS
    value = np.empty((len(time_s), len(names)))
    for i, (move, rows) in enumerate(zip(moves, rows_of(moves, time_s), strict=True)):
        now_s = time_s[rows]
        value[rows] = _own_values(move, now_s, idling, names)
        if i > 0 and len(now_s) > 0:
            before = moves[i - 1]
            at_s = before.end_s
            last = _own_values(before, np.array([at_s]), idling, names)
            over_s = _over_s(before, move, *_ends(before, move, idling), joints)
            got = smootherstep((now_s - at_s) / over_s)[:, None] if over_s > 0.0 else 1.0
            value[rows] = last + got * (value[rows] - last)
    return Tracks(names, value)


def _own_values(
    move: Move[Playable], time_s: FloatArray, idling: Idling, names: tuple[str, ...]
) -> FloatArray:
    """Return a move's tracks ``(n, k)`` by itself, without the transition into it."""
    resting = idling.piece.tracks_at(idling.frame_at(time_s)).of(names)
    own = move.piece.tracks_at(move.frame_at(time_s)).of(names)
    return np.asarray(resting + move.presence_at(time_s)[:, None] * (own - resting))


def stepped(moves: Sequence[Move[Playable]], time_s: FloatArray, idling: Idling) -> Footwork:
    """Return the foot contacts at each time; pivots add up, by their blend weights."""
    seen = []
    for move, rows in zip(moves, rows_of(moves, time_s), strict=True):
        now_s = time_s[rows]
        own, resting = (
            move.piece.stands_at(move.frame_at(now_s)),
            idling.piece.stands_at(idling.frame_at(now_s)),
        )
        presence = move.presence_at(now_s)[:, None]
        turned_rad = np.zeros_like(own.pivot_rad)
        turned_rad[1:] = presence[1:] * np.diff(own.pivot_rad, axis=0)
        seen.append(Footwork(np.where(presence >= SEEN, own.stands, resting.stands), turned_rad))
    return Footwork(
        np.concatenate([one.stands for one in seen]),
        np.cumsum(np.concatenate([one.pivot_rad for one in seen]), axis=0),
    )


def placed(
    poses: Poses, moves: Sequence[Move[Playable]], time_s: FloatArray, rate_hz: float
) -> Poses:
    """Put the ground root of poses where the moves have it."""
    heading = np.empty(len(time_s))
    translation = poses.translation_m.copy()
    for move, rows in zip(moves, rows_of(moves, time_s), strict=True):
        translation[rows, 0, ::2] = move.root_at(time_s[rows])
        heading[rows] = move.heading_at(time_s[rows])
    rotation = poses.rotation_xyzw.copy()
    heading = gaussian_smoothed(heading, TURNING_S * rate_hz)
    rotation[:, 0] = quaternion_about([0.0, 1.0, 0.0], heading)
    return Poses(rotation, translation)


def rows_of(moves: Sequence[Move[Playable]], time_s: FloatArray) -> list[slice]:
    """Return which of the times each move acts at; the last one acts at its end too."""
    cuts = np.searchsorted(time_s, [move.end_s for move in moves[:-1]])
    edges = [0, *cuts.tolist(), len(time_s)]
    return [slice(a, b) for a, b in pairwise(edges)]


def own_poses(move: Move[Playable], time_s: FloatArray, idling: Idling) -> Poses:
    """Return a move's poses ``(n, …)`` by itself, without the transition into it."""
    poses = move.piece.sampled(move.frame_at(time_s))
    presence = move.presence_at(time_s)
    faint = np.flatnonzero(presence < 1.0)
    if len(faint) == 0:
        return poses
    standing_still = idling.piece.sampled(idling.frame_at(time_s[faint]))
    some = Poses(poses.rotation_xyzw[faint], poses.translation_m[faint])
    some = mixed(standing_still, some, presence[faint])
    poses.rotation_xyzw[faint], poses.translation_m[faint] = some
    return poses


def _joined(
    before: Move[Playable],
    move: Move[Playable],
    poses: Poses,
    now_s: FloatArray,
    idling: Idling,
    joints: IntArray | None,
) -> Poses:
    """Let the difference to the previous move decay over the first poses of this one."""
    at_s = before.end_s
    ends = _ends(before, move, idling)
    over_s = _over_s(before, move, *ends, joints)
    count = int(np.searchsorted(now_s, at_s + over_s))
    if count == 0:
        return poses
    first = Poses(poses.rotation_xyzw[:count], poses.translation_m[:count])
    first = carried_over(*ends, first, now_s[:count] - at_s, over_s=over_s, step_s=_STEP_S)
    poses.rotation_xyzw[:count], poses.translation_m[:count] = first
    return poses


def _ends(before: Move[Playable], move: Move[Playable], idling: Idling) -> tuple[Poses, Poses]:
    """Return two poses on either side of the boundary between two moves."""
    return (
        own_poses(before, before.end_s + np.array([-_STEP_S, 0.0]), idling),
        own_poses(move, before.end_s + np.array([0.0, _STEP_S]), idling),
    )


def _over_s(
    before: Move[Playable],
    move: Move[Playable],
    left: Poses,
    right: Poses,
    joints: IntArray | None,
) -> float:
    """Return how long the transition from one move into the next takes."""
    over_s = max(transition_s(left, right, joints), move.waits_s)
    return min(over_s, move.start_s - before.end_s + move.room_s)
