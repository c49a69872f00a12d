"""What is measured of a performance: feet, path, boundaries, and how smoothly joints turn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from actions_library.library import Library
from smd.acting.legs import feet_of, legs_of
from smd.acting.move import Move
from smd.acting.moving import Idling, own_poses, rows_of, stepped
from smd.acting.performance import Actor, Performance
from smd.acting.standing import standing
from smd.cast import cast_of
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics, joints_in_world
from smd.character.poses import Poses
from smd.character.skeleton import Skeleton
from smd.doodle import Doodle, Recording
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import inverse, multiply, rotate, rotvec_from_quaternion
from smd.score import Score
from smd.smoothing import smooth
from smd.transfer.pacing import core_frame
from smd.transfer.path import GroundPath, ground_path
from smd.transfer.repertoire import Piece
from smd.transfer.scene import scene_scale
from smd.transfer.staging import entrances, kept_apart

LOW_TOES_M, FAST_TOES_M_S = 0.05, 0.2
"""NVIDIA kimodo's: toes below the first height are taken to touch, above the speed to skate."""

ON_GROUND_M = 0.005
"""Height of a sole up to which it is on the ground."""

RATE_HZ = 60.0
"""Frames a second of all that is measured."""

POP_DEG = 8.0
"""A turn of a joint from one frame to the next, at 60 Hz, that its clip does not have."""


@dataclass(frozen=True, slots=True)
class Feet:
    """Speeds (m/s) over the ground and heights (m); each speed is of one step of one point.

    Attributes
    ----------
    labelled_m_s : of the sole, while its foot is labelled as standing and is on the ground.
    near_m_s : of heels and balls within 5 mm of the ground, labelled or not.
    toes_m_s : of toes below 5 cm.
    lowest_m : of any sole.
    """

    labelled_m_s: FloatArray
    near_m_s: FloatArray
    toes_m_s: FloatArray
    lowest_m: float


class Played(NamedTuple):
    """An actor, with what it acts by.

    Attributes
    ----------
    actor : with poses at ``time_s (n,)``.
    moves : one after the other.
    idling : what is seen between them.
    path : of the prop, on the stage, as drawn; planned : the same as planned.
    feet : joints; ``stands (n, feet)`` when each should stand.
    """

    actor: Actor
    time_s: FloatArray
    moves: tuple[Move[Piece], ...]
    idling: Idling
    path: GroundPath
    planned: GroundPath
    feet: tuple[int, ...]
    stands: BoolArray

    @property
    def poses(self) -> Poses:
        """Return what is seen."""
        return self.actor.poses


def played(
    performance: Performance, recording: Recording, score: Score, library: Library, **options: Any
) -> Iterator[Played]:
    """Yield the actors of a performance, in full Effort, with their moves.

    Parameters
    ----------
    **options
        What else the performance was made with, for `entrances`.
    """
    stage = scene_scale(recording, library.character.height_m, score.figure_height_m)
    time_s = performance.start_s + np.arange(len(performance)) / performance.rate_hz
    cast = cast_of(library)
    alone = entrances(score, recording, cast, time_s, expressiveness=1.0, heading="prop", **options)
    for actor, one in zip(performance.actors, kept_apart(alone, cast), strict=True):
        feet = tuple(leg.foot for leg in one.pieces.legs)
        stands, _ = stepped(one.moves, time_s, one.idling)
        path = ground_path(recording.of(actor.name), stage)
        yield Played(actor, time_s, one.moves, one.idling, path, one.plan.path, feet, stands)


def measured_feet(
    skeleton: Skeleton, poses: Poses, feet: Sequence[int], stands: BoolArray, rate_hz: float
) -> Feet:
    """Measure the feet of poses in the world; ``stands (n, feet)`` is when each should."""
    labelled, near, toes, lowest = [], [], [], np.inf
    legs = legs_of(skeleton, feet)
    foot_q, ankle = joints_in_world(skeleton, [leg.foot for leg in legs], *poses)
    for i, leg in enumerate(legs):
        on = stands[:, list(feet).index(leg.foot)]
        points = [ankle[:, i] + rotate(foot_q[:, i], p) for p in (leg.heel_m, leg.ball_m)]
        heel, ball = points
        ups = [heel[:, 1], ball[:, 1] - leg.ball_height_m]
        lowest = min(lowest, *(float(up.min()) for up in ups))
        for point, up in zip(points, ups, strict=True):
            near.append(_speeds(point, up < ON_GROUND_M, rate_hz))
        on_heel = ups[0] < ups[1]  # what a rolling foot stands on
        for point, up, bears in zip(points, ups, (on_heel, ~on_heel), strict=True):
            labelled.append(_speeds(point, on & bears & (up < ON_GROUND_M), rate_hz))
        toes.append(_speeds(ball, ball[:, 1] < LOW_TOES_M, rate_hz))
    return Feet(np.concatenate(labelled), np.concatenate(near), np.concatenate(toes), lowest)


def toes_of_clips_m_s(seen: Played) -> FloatArray:
    """Return speeds of low toes as the clips have them, played as fast as they are here.

    A clip that is played twice as fast has toes twice as fast: what is beyond that is transfer's.
    """
    legs = legs_of(seen.actor.character.skeleton, seen.feet)
    found = [np.zeros(0)]
    for move, rows in zip(seen.moves, rows_of(seen.moves, seen.time_s), strict=True):
        if rows.stop - rows.start < 2:
            continue
        clip, last = move.piece.clip, move.piece.last_frame
        frame = move.frame_at(seen.time_s[rows])
        middle = 0.5 * (frame[1:] + frame[:-1])
        middle = np.mod(middle, last) if clip.cyclic else np.clip(middle, 0.0, last)
        pace = np.diff(frame) * move.presence_at(seen.time_s[rows])[1:]
        local = clip.rotation_xyzw, clip.translation_m
        foot_q, ankle = joints_in_world(clip.skeleton, [leg.foot for leg in legs], *local)
        for i, leg in enumerate(legs):
            ball = ankle[:, i] + rotate(foot_q[:, i], leg.ball_m)
            steps = np.hypot(*np.diff(ball, axis=0)[:, [0, 2]].T)  # a frame of the clip
            speed = np.interp(middle, np.arange(len(steps)) + 0.5, steps) * pace * RATE_HZ
            height = np.interp(middle, np.arange(len(ball)), ball[:, 1])
            found.append(speed[height < LOW_TOES_M])
    return np.concatenate(found)


def feet_of_clip(clip: Clip) -> Feet | None:
    """Measure the feet of a neutral clip; None where it has none."""
    feet = feet_of(clip)
    if not feet:
        return None
    stands = standing(clip, legs_of(clip.skeleton, feet), feet)
    labels = np.stack([stands[foot] for foot in feet], axis=-1)
    poses = Poses(clip.rotation_xyzw, clip.translation_m)
    return measured_feet(clip.skeleton, poses, feet, labels, clip.rate_hz)


def _speeds(place_m: FloatArray, low: BoolArray, rate_hz: float) -> FloatArray:
    """Return speeds over the ground between two frames that are both low."""
    steps = np.diff(place_m, axis=0)[low[1:] & low[:-1]]
    return np.hypot(steps[:, 0], steps[:, 2]) * rate_hz


def path_errors_m(seen: Played) -> FloatArray:
    """Return distances of the ground root from the smoothed path in travelling phrases."""
    errors = [np.zeros(0)]
    for phrase, move in zip(seen.actor.phrases, first_moves(seen), strict=True):
        if move is None or not move.piece.travels:
            continue
        start_s = move.start_s  # of a gait perhaps earlier than the phrase's
        rows = (seen.time_s >= start_s) & (seen.time_s <= phrase.end_s)
        # The character goes on from where it stood: the path is put there.
        wanted = seen.planned.at(np.arange(start_s, phrase.end_s, 1e-3))
        wanted += move.root_m[0] - seen.planned.at(start_s)
        root = seen.actor.poses.translation_m[rows][:, 0, [0, 2]]
        gaps = np.linalg.norm(root[:, None] - wanted[None], axis=-1)
        errors.append(gaps.min(axis=1, initial=np.inf))
    return np.concatenate(errors)


def first_moves(seen: Played) -> list[Move | None]:
    """Return the move with which each phrase begins."""
    acting = [move for move in seen.moves if not move.idles]
    found: list[Move | None] = []
    for phrase in seen.actor.phrases:
        of = [m for m in acting if m.piece.clip.name == phrase.action and m.end_s > phrase.start_s]
        found.append(of[0] if of and of[0].start_s < phrase.end_s else None)
    return found


def boundary_gaps_s(seen: Played) -> tuple[FloatArray, FloatArray]:
    """Return how far each phrase's clip begins, and has shown what it is about, off the Score.

    A clip that is done earlier is not late: 0.
    """
    begins, ends = [], []
    for phrase, move in zip(seen.actor.phrases, first_moves(seen), strict=True):
        if move is None:
            continue
        begins.append(abs(move.start_s - phrase.start_s))
        if not move.piece.clip.cyclic:
            done = np.searchsorted(move.frame, core_frame(move.piece.clip) - 0.5)
            done_s = float(move.time_s[min(done, len(move.time_s) - 1)])
            ends.append(max(done_s - phrase.end_s, 0.0))
        else:
            ends.append(abs(move.end_s - phrase.end_s))
    return np.array(begins), np.array(ends)


def lateness_s(seen: Played, doodles: Sequence[Doodle]) -> FloatArray:
    """Return how much later than the prop a body is halfway through what is played once.

    Halfway along the joints' way, as seen from the ground root, from the phrase's start until the
    body has come back; the prop's, of place and of turning (a radian counting as 5 cm).
    """
    late = []
    skeleton = seen.actor.character.skeleton
    for phrase, move in zip(seen.actor.phrases, first_moves(seen), strict=True):
        if move is None or move.piece.clip.cyclic or move.start_s != phrase.start_s:
            continue
        rows = (seen.time_s >= phrase.start_s) & (seen.time_s <= move.end_s)
        place = forward_kinematics(skeleton, *(part[rows] for part in seen.poses))[1]
        steps = np.linalg.norm(np.diff(place - place[:, :1], axis=0), axis=-1).mean(axis=-1)
        drawn = drawn_between(doodles, phrase.start_s, phrase.end_s)
        if drawn is not None and len(steps) > 1:
            late.append(halfway_s(seen.time_s[rows][1:], steps) - halfway_s(*drawn))
    return np.array(late)


def drawn_between(
    doodles: Sequence[Doodle], start_s: float, end_s: float
) -> tuple[FloatArray, FloatArray] | None:
    """Return times in a phrase, and how fast the prop goes and turns there; None if it is lost."""
    for doodle in doodles:
        if doodle.time_s[0] <= start_s and end_s <= doodle.time_s[-1]:
            motion = smooth(doodle)
            inside = (motion.time_s >= start_s) & (motion.time_s <= end_s)
            speed = np.linalg.norm(motion.velocity_m_s, axis=-1)
            turning = np.linalg.norm(motion.angular_velocity_rad_s, axis=-1)
            return motion.time_s[inside], (speed + 0.05 * turning)[inside]
    return None


def halfway_s(time_s: FloatArray, steps: FloatArray) -> float:
    way = np.cumsum(steps)
    return float(np.interp(0.5 * way[-1], way, time_s))


def turns_deg(rotation_xyzw: FloatArray) -> FloatArray:
    """Return how far each joint turns from frame to frame ``(n - 1, j)``."""
    between = multiply(inverse(rotation_xyzw[:-1]), rotation_xyzw[1:])
    return np.degrees(np.linalg.norm(rotvec_from_quaternion(between), axis=-1))


def pops(seen: Played) -> tuple[int, int, float]:
    """Return how many turns of a joint in a frame exceed the clip's own by `POP_DEG`.

    Returns
    -------
    count, of, worst_deg
        Turns in all, and the largest excess.
    """
    own = np.full(len(seen.time_s) - 1, 0.0)[:, None] * np.ones(
        seen.actor.poses.rotation_xyzw.shape[1]
    )
    for move, rows in zip(seen.moves, rows_of(seen.moves, seen.time_s), strict=True):
        if rows.stop - rows.start < 2:
            continue
        poses = own_poses(move, seen.time_s[rows], seen.idling)
        own[rows.start : rows.stop - 1] = turns_deg(poses.rotation_xyzw)
    excess = (turns_deg(seen.actor.poses.rotation_xyzw) - own)[:, 1:]
    return int(np.count_nonzero(excess > POP_DEG)), excess.size, float(excess.max())


def accelerations(seen: Played) -> tuple[FloatArray, FloatArray]:
    """Return the joints' angular accelerations, deg/s², inside phrases and across boundaries.

    Returns
    -------
    inside, across
        ``(m, j)`` each.
    """
    q = seen.actor.poses.rotation_xyzw[:, 1:]
    speed = np.degrees(rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:]))) * RATE_HZ
    acceleration = np.linalg.norm(np.diff(speed, axis=0), axis=-1) * RATE_HZ
    time_s = seen.time_s[1:-1]
    acts, at = np.zeros(len(time_s), dtype=bool), np.zeros(len(time_s), dtype=bool)
    for phrase in seen.actor.phrases:
        acts |= (time_s > phrase.start_s) & (time_s < phrase.end_s)
        for edge_s in (phrase.start_s, phrase.end_s):
            at |= np.abs(time_s - edge_s) < 1.0 / RATE_HZ
    return acceleration[acts & ~at], acceleration[at]
