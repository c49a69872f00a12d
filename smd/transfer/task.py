"""Task: a phrase that is to be planned, with the clip it is played with and the time that asks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from smd.acting.flight import Height, fall_s
from smd.cast import IDLE
from smd.score import Phrase
from smd.transfer.allotment import Share, Wish
from smd.transfer.body_time import BodyTime, body_time
from smd.transfer.gait import planned_m_s
from smd.transfer.in_place import turn_passes, turns
from smd.transfer.limits import Limits
from smd.transfer.path import GroundPath
from smd.transfer.planned_path import STILL
from smd.transfer.repertoire import ACROSS, Piece, Repertoire
from smd.transfer.speeding import Way, least_s, roundest
from smd.transfer.timeline import Cue
from smd.transfer.travelling import NOWHERE_M

NEAR_M = 0.05
"""Way of the centre of mass up to which a pose is near enough to get into at once."""

RUN_UP_S = 0.5
"""Time in which a body gathers speed before it takes off, and loses it after it lands."""


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """A phrase that is to be planned.

    Attributes
    ----------
    drawn : the phrase of the Score.
    action : whose clip is played: another gait than the drawn one, where that is too slow.
    piece : that clip.
    way : where it goes, as round as it may become; None where it goes nowhere.
    passes : how often the clip is played: a large turn takes several passes.
    entry_s : time to get into its first pose from where the body is.
    body_time : time that the clip needs; None for a cycle.
    needed_s : time that the cycle needs, instead.
    """

    drawn: Phrase
    action: str
    piece: Piece
    way: Way | None
    passes: int
    entry_s: float
    body_time: BodyTime | None
    needed_s: float

    @property
    def wish(self) -> Wish:
        """The time that it asks for."""
        start_s, end_s, time = self.drawn.start_s, self.drawn.end_s, self.body_time
        if time is None:
            return Wish(start_s, end_s, self.needed_s)
        struck = self.passes - 1 + time.struck / self.piece.last_frame
        return Wish(
            start_s,
            end_s,
            (self.passes - 1) * self.piece.clip.duration_s + time.before_s,
            time.after_s,
            time.return_s,
            start_s + (end_s - start_s) * struck / self.passes,
        )

    def hurry(self, share: Share) -> float:
        """Return the time that it asks for over the time it has; 1 where that is enough."""
        wish = self.wish
        return max((wish.before_s + wish.after_s) / (share.end_s - share.start_s), 1.0)

    def phrase(self, share: Share) -> Phrase:
        """Return the phrase that is played, and when."""
        return replace(self.drawn, action=self.action, start_s=share.start_s, end_s=share.end_s)

    def cue(self, share: Share, pieces: Repertoire, limits: Limits) -> Cue:
        """Return how it is played in its share of the time."""
        turning_rad_s = 0.5 * limits.turning_rad_s
        if self.body_time is None or share.strike_s is None:
            drawn = pieces.like(self.drawn)
            apart_rad = self.piece.direction_rad - drawn.direction_rad
            along = self.piece is not drawn and bool(np.cos(apart_rad) < ACROSS)
            return Cue(standing_s=self.entry_s, turning_rad_s=turning_rad_s, along=along)
        if self.passes > 1:
            return Cue(turning_rad_s=turning_rad_s)
        planned = self.body_time, share.strike_s
        return Cue(planned, run_up_s=RUN_UP_S, turning_rad_s=turning_rad_s)

    def quick_enough(self, share: Share, pieces: Repertoire, limits: Limits) -> str:
        """Return the action of the slowest gait that is fast enough for its share of the time.

        Where none is, it is the fastest.
        """
        gait = self.piece.gait
        if gait is None or not gait.passings or self.way is None:
            return self.action
        action = self.action
        for action in (self.action, *pieces.faster.get(self.action, ())):
            if _gait_s(self.way, pieces.pieces[action], limits) <= share.end_s - share.start_s:
                break
        return action


def tasks_of(
    phrases: Sequence[Phrase],
    actions: Sequence[str],
    ways: Sequence[Way | None],
    path: GroundPath,
    height: Height,
    pieces: Repertoire,
    limits: Limits,
) -> list[Task]:
    """Return what is to be planned of the phrases of a performer.

    Parameters
    ----------
    actions
        Whose clip each is played with.
    ways
        `way_of_phrase` of each that travels.
    path, height
        Of its prop, as drawn.
    """
    tasks, rest = [], IDLE
    for drawn, action, way in zip(phrases, actions, ways, strict=True):
        piece = pieces.like(replace(drawn, action=action))
        # Whoever is to stand up while standing sits down first.
        leaves = pieces.leaving.get(rest, action)
        entry_s = _entry_s(pieces.pieces[rest if leaves == action else IDLE], piece, limits)
        rest = pieces.rest_after(action)
        time, needed_s = None, 0.0
        if piece.clip.cyclic:
            needed_s = _cycle_s(drawn, way, piece, limits) + 2.0 * STILL * entry_s
        else:
            flies = piece.airborne
            rise_m = height.rise_m(drawn.start_s, drawn.end_s)
            flight_s = None if flies is None else fall_s(rise_m, flies)
            time = body_time(piece, way, flight_s, entry_s, limits)
        passes = _passes(drawn, piece, path)
        tasks.append(Task(drawn, action, piece, way, passes, entry_s, time, needed_s))
    return tasks


def way_of_phrase(phrase: Phrase, path: GroundPath, limits: Limits) -> Way | None:
    """Return the way of a phrase, as round as it may become; None where it leads nowhere."""
    inside = (path.time_s > phrase.start_s) & (path.time_s < phrase.end_s)
    time_s = np.concatenate([[phrase.start_s], path.time_s[inside], [phrase.end_s]])
    way = roundest(path.at(time_s), limits)
    return way if way is not None and way.gone_m[-1] > NOWHERE_M else None


def _entry_s(before: Piece, after: Piece, limits: Limits) -> float:
    """Return the time in which a body gets from the first pose of one clip into another clip."""
    if before.body is None or after.body is None:
        return 0.0
    into_m = after.body.centre_m.mean(axis=0) if after.clip.cyclic else after.body.centre_m[0]
    far_m = float(np.linalg.norm(into_m - before.body.centre_m[0]))
    # The peak of a smootherstep's acceleration is 5.77 times the way over the time squared.
    return float(np.sqrt(5.77 * far_m / limits.acceleration_m_s2)) if far_m > NEAR_M else 0.0


def _cycle_s(drawn: Phrase, way: Way | None, piece: Piece, limits: Limits) -> float:
    """Return the time that a phrase of whole cycles needs."""
    if piece.gait is None:
        own_s = piece.clip.duration_s
        return max(round((drawn.end_s - drawn.start_s) / own_s), 1) * own_s
    return piece.clip.duration_s if way is None else _gait_s(way, piece, limits)


def _gait_s(way: Way, piece: Piece, limits: Limits) -> float:
    """Return the least time in which a gait goes a way."""
    assert piece.gait is not None
    return least_s(way, planned_m_s(piece.gait, limits.speed_m_s), limits)


def _passes(phrase: Phrase, piece: Piece, path: GroundPath) -> int:
    """Return how often a clip is played in a phrase."""
    if piece.travels or not turns(piece):
        return 1
    turned_rad = float(path.heading_at(phrase.end_s) - path.heading_at(phrase.start_s))
    return len(turn_passes(piece, turned_rad))
