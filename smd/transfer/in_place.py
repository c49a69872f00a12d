"""Moves that stay where they are: idling, gestures and turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.acting.move import Move, Placement, knots
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import smootherstep
from smd.transfer.ground_root import turned
from smd.transfer.pacing import Pacing
from smd.transfer.repertoire import Piece

TURNING_RAD = np.radians(15.0)
"""A clip whose ground root turns by more is a turn; a prop that turns by less has not turned."""

MOST_TURN_PER_PASS = 1.5
"""Largest angle of a turning clip over its own; for a larger one it is played again."""

FACING_S = 0.6
"""Least time in which a pausing character turns to the heading of its next phrase."""

FACING_RAD_S = 2.5
"""Mean speed of that turn, where there is time for it."""

FACING_EARLY_S = 0.25
"""How long before that phrase the turn ends, where there is time."""


@dataclass(frozen=True, slots=True)
class Facing:
    """How a performer turns, in a pause, to the heading of its next phrase.

    Attributes
    ----------
    turn_rad : how far.
    begin_s, done_s : on the recording's clock.
    """

    turn_rad: float
    begin_s: float
    done_s: float

    def added_at(self, time_s: FloatArray) -> FloatArray:
        """Return the angle that it has turned at some times."""
        share = (time_s - self.begin_s) / max(self.done_s - self.begin_s, 1e-9)
        return self.turn_rad * smootherstep(share)


def facing(turn_rad: float, start_s: float, end_s: float) -> Facing:
    """Return how a performer turns by an angle in a pause: late in it, where there is time."""
    lasting_s = min(max(FACING_S, abs(turn_rad) / FACING_RAD_S), end_s - start_s)
    done_s = end_s - min(FACING_EARLY_S, end_s - start_s - lasting_s)
    return Facing(turn_rad, done_s - lasting_s, done_s)


def idling(
    piece: Piece, start_s: float, end_s: float, at: Placement, facing: Facing, *, clock_s: float
) -> Move[Piece]:
    """Stand where the last phrase ended, and turn to the heading at the next one's start.

    Parameters
    ----------
    at
        Where it stands; its heading is the one before it turns.
    clock_s
        Time at which the idle clip began: it goes on all the while, seen or not.
    """
    time_s = knots(start_s, end_s)
    return Move(
        piece=piece,
        start_s=start_s,
        end_s=end_s,
        time_s=time_s,
        root_m=np.broadcast_to(at.position_m, (len(time_s), 2)),
        heading_rad=at.heading_rad + facing.added_at(time_s),
        frame=(time_s - clock_s) * piece.clip.rate_hz,
        presence=np.ones(len(time_s)),
        idles=True,
    )


def whole_cycles(piece: Piece, start_s: float, end_s: float) -> Pacing:
    """Return when each frame of a cycle is shown: as many of them as its own duration allows."""
    cycles = max(round((end_s - start_s) / piece.clip.duration_s), 1)
    return Pacing(np.array([start_s, end_s]), np.array([0.0, cycles * piece.last_frame]))


def gesture(piece: Piece, pacing: Pacing, at: Placement) -> Move[Piece]:
    """Play a clip in place. The heading is held; a step that the clip itself takes is kept."""
    time_s = knots(pacing.start_s, pacing.end_s)
    frame = pacing.frame_at(time_s)
    own_frame = np.mod(frame, piece.last_frame) if piece.clip.cyclic else frame
    step = turned(piece.root.position_at(own_frame), at.heading_rad)
    return Move(
        piece=piece,
        start_s=pacing.start_s,
        end_s=pacing.end_s,
        time_s=time_s,
        root_m=at.position_m + step,
        heading_rad=np.full(len(time_s), at.heading_rad),
        frame=frame,
        presence=np.ones(len(time_s)),
        airborne=piece.airborne,
    )


def turns(piece: Piece) -> bool:
    """Return whether a clip is a turn in place."""
    return abs(piece.root.turn_rad) > TURNING_RAD


def turn_passes(piece: Piece, prop_turn_rad: float) -> tuple[float, ...]:
    """Return the angles of the passes of a turning clip that turn as far as the prop did.

    A large turn takes several passes. If the prop hardly turned, or turned the other way, the clip
    keeps its own angle: a turn to the left that was asked for is seen.
    """
    own_rad = piece.root.turn_rad
    same_way = prop_turn_rad * own_rad > 0.0 and abs(prop_turn_rad) > TURNING_RAD
    whole_rad = prop_turn_rad if same_way else own_rad
    passes = max(int(np.ceil(abs(whole_rad / own_rad) / MOST_TURN_PER_PASS)), 1)
    return (whole_rad / passes,) * passes


def turn(piece: Piece, pacing: Pacing, at: Placement, turn_rad: float) -> Move[Piece]:
    """Turn by an angle, along the clip's own heading curve."""
    time_s = knots(pacing.start_s, pacing.end_s)
    frame = pacing.frame_at(time_s)
    return Move(
        piece=piece,
        start_s=pacing.start_s,
        end_s=pacing.end_s,
        time_s=time_s,
        root_m=at.position_m + turned(piece.root.position_at(frame), at.heading_rad),
        heading_rad=at.heading_rad + piece.root.yaw_at(frame) / piece.root.turn_rad * turn_rad,
        frame=frame,
        presence=np.ones(len(time_s)),
        airborne=piece.airborne,
    )
