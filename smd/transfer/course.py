"""Course: the moves of one performer in order, each starting where the last one ended.

This is where the running offset of section 6.2 of the paper lives. Read as a vector, it is the
difference between where the prop is and where the character stands: it grows by whatever the prop
moved while the character stayed in place, and so every travelling phrase goes on from where the
character stood. Carrying that place along says the same with less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from smd.acting.move import Move, Placement, nearest_turn
from smd.cast import IDLE
from smd.geometry.easing import smootherstep
from smd.score import Phrase
from smd.transfer.body_time import body_pacing
from smd.transfer.gait import phase_after
from smd.transfer.in_place import (
    Facing,
    facing,
    gesture,
    idling,
    turn,
    turn_passes,
    turns,
    whole_cycles,
)
from smd.transfer.pacing import Pacing, paced
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Piece, Repertoire, pieces_of
from smd.transfer.swings import Swing, at_own_tempo, with_periods
from smd.transfer.timeline import Span
from smd.transfer.travelling import along_path, leap


def course(
    spans: Sequence[Span], path: GroundPath, pieces: Repertoire, *, clock_s: float
) -> tuple[Move[Piece], ...]:
    """Return the moves of a performer.

    Places come from the path's differences, headings from the prop itself: the character stands
    where its last phrase left it, and from the next phrase on faces where the prop faces.

    Parameters
    ----------
    clock_s
        Time at which its idling began; no later than the first span.
    """
    start_s = spans[0].start_s
    at = Placement(path.at(start_s), float(path.heading_at(start_s)))
    moves: list[Move[Piece]] = []
    rest = IDLE
    cast = [None if span.phrase is None else pieces.of(span.phrase) for span in spans]
    for i, (span, piece) in enumerate(zip(spans, cast, strict=True)):
        last = i + 1 == len(spans)
        following = None if last else spans[i + 1]
        if piece is None:
            after = None if following is None else following.phrase
            rises_s = _rising_s(span, rest, after, pieces)
            begin_s = max(span.start_s, moves[-1].end_s) if moves else span.start_s
            turning = _facing(span, following, path, at.heading_rad)
            if moves:  # the body may still be coming back
                added = turning.added_at(moves[-1].time_s)
                moves[-1] = replace(moves[-1], heading_rad=moves[-1].heading_rad + added)
            resting = pieces.pieces[rest]
            move = idling(resting, begin_s, rises_s, at, turning, clock_s=clock_s)
            moves.append(move)
            if rises_s < span.end_s:
                leaving = pieces.pieces[pieces.leaving[rest]]
                pacing = paced(leaving.clip, leaving.near, rises_s, span.end_s, 0.0)
                moves.append(gesture(leaving, pacing, move.end))
                rest = IDLE
        else:
            before = moves[-1] if i > 0 and goes_on(cast[i - 1], piece) else None
            into_gait = not last and goes_on(piece, cast[i + 1])
            assert span.phrase is not None
            rest = pieces.rest_after(span.phrase.action)
            pause_s = _pause_s(spans[i + 1 : i + 3], rest, pieces)
            acted = _acted(piece, span, pause_s, path, at, before, pieces, into_gait=into_gait)
            moves += [_turning(acted[0], at.heading_rad, span.turning_rad_s), *acted[1:]]
        at = moves[-1].end
    return tuple(moves)


def _facing(span: Span, following: Span | None, path: GroundPath, heading_rad: float) -> Facing:
    """Return how a performer turns in a pause to the heading of its next phrase."""
    turn_rad = 0.0
    if following is not None:
        turn_rad = nearest_turn(float(path.heading_at(span.end_s)), heading_rad) - heading_rad
    return facing(turn_rad, span.start_s, span.end_s)


def _pause_s(following: Sequence[Span], rest: str, pieces: Repertoire) -> float:
    """Return how long nothing is performed after a phrase, given the two spans that follow it."""
    if not following or following[0].phrase is not None:
        return 0.0
    after = following[1].phrase if len(following) > 1 else None
    return _rising_s(following[0], rest, after, pieces) - following[0].start_s


def _rising_s(span: Span, rest: str, following: Phrase | None, pieces: Repertoire) -> float:
    """Return when, while idling, a character gets up for what follows; else the end.

    A seated character that is to walk next stands up first, even if that was not drawn. This takes
    the clip's own duration, but at most two thirds of the pause.
    """
    if following is None or rest not in pieces.leaving:
        return span.end_s
    if following.action == pieces.leaving[rest]:
        return span.end_s
    wanted_s = pieces.pieces[pieces.leaving[rest]].clip.duration_s
    return span.end_s - min(wanted_s, (span.end_s - span.start_s) * 2.0 / 3.0)


def goes_on(before: Piece | None, after: Piece | None) -> bool:
    """Return whether one piece follows the path after another without coming to rest."""
    if before is None or after is None or before.gait is None or after.gait is None:
        return False
    return before is after or bool(before.gait.passings and after.gait.passings)


def _acted(
    piece: Piece,
    span: Span,
    pause_s: float,
    path: GroundPath,
    at: Placement,
    before: Move[Piece] | None,
    pieces: Repertoire,
    *,
    into_gait: bool,
) -> list[Move[Piece]]:
    """Return the moves of a phrase: one, except for a turn that takes several passes.

    Parameters
    ----------
    pause_s
        How long nothing is performed after the phrase.
    before
        The move that this one goes on from along the path, if it does.
    """
    assert span.phrase is not None
    # A phrase that goes on from a gait fills the short gap between them, any other waits.
    start_s = span.start_s if before else max(span.start_s, span.phrase.start_s)
    end_s = span.end_s
    if piece.gait is not None:
        phase = None
        if before is not None and before.piece.gait is not None and piece.gait.passings:
            ended = float(before.frame[-1]) / before.piece.last_frame
            phase = phase_after(before.piece.gait, ended, piece.gait)
        move = along_path(
            piece,
            path,
            start_s,
            end_s,
            at,
            phase=phase,
            from_gait=before is not None,
            into_gait=into_gait,
            standing_s=span.standing_s,
        )
        return [move]
    if piece.travels:
        pacing = _pacing(piece, span, start_s, end_s, pause_s)
        return [leap(piece, path, pacing, end_s, at, run_up_s=span.run_up_s)]
    at = Placement(at.position_m, nearest_turn(float(path.heading_at(start_s)), at.heading_rad))
    if not turns(piece):
        pacing = _pacing(piece, span, start_s, end_s, pause_s)
        if piece.swing is not None and span.planned is not None:
            piece, pacing = _at_own_tempo(piece, piece.swing, pacing, pieces)
        return [gesture(piece, pacing, at)]
    passes = turn_passes(piece, float(path.heading_at(end_s) - path.heading_at(start_s)))
    if len(passes) == 1:
        return [turn(piece, _pacing(piece, span, start_s, end_s, pause_s), at, passes[0])]
    edges = [start_s + (end_s - start_s) * i / len(passes) for i in range(len(passes) + 1)]
    moves: list[Move[Piece]] = []
    for first_s, last_s, turn_rad in zip(edges[:-1], edges[1:], passes, strict=True):
        after_s = pause_s if last_s == edges[-1] else 0.0
        pacing = paced(piece.clip, piece.near, first_s, last_s, after_s)
        moves.append(turn(piece, pacing, at, turn_rad))
        at = moves[-1].end
    return moves


def _at_own_tempo(
    piece: Piece, swing: Swing, pacing: Pacing, pieces: Repertoire
) -> tuple[Piece, Pacing]:
    """Return a piece that swings as often as there is time for, and when its frames are shown."""
    count, pacing = at_own_tempo(pacing, swing)
    if count != swing.periods:
        clip = with_periods(piece.clip, swing, count)
        (piece,) = pieces_of(
            [clip], travels=False, legs=pieces.legs, neutral=piece, mass=pieces.mass
        )
        piece = replace(piece, swing=swing._replace(periods=count))
    return piece, pacing


def _turning(move: Move[Piece], from_rad: float, speed_rad_s: float) -> Move[Piece]:
    """Return a move that begins in another heading, and turns to its own in its first half."""
    off_rad = from_rad - nearest_turn(float(move.heading_rad[0]), from_rad)
    if np.isinf(speed_rad_s) or abs(off_rad) < 1e-6:
        return move
    over_s = min(abs(off_rad) / speed_rad_s, 0.5 * (move.end_s - move.start_s))
    left = 1.0 - smootherstep((move.time_s - move.start_s) / over_s)
    return replace(move, heading_rad=move.heading_rad + off_rad * left)


def _pacing(piece: Piece, span: Span, start_s: float, end_s: float, pause_s: float) -> Pacing:
    """Return when each frame of a phrase's clip is shown, as planned where it is."""
    if piece.clip.cyclic:
        return whole_cycles(piece, start_s, end_s)
    if span.planned is None:
        return paced(piece.clip, piece.near, start_s, end_s, pause_s)
    body_time, strike_s = span.planned
    return body_pacing(body_time, start_s, strike_s, end_s, pause_s)
