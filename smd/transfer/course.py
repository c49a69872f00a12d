"""Course: the moves of one performer, one after the other, each from where the last one ended.

This is where the running offset of section 6.2 of the paper lives. Read as a vector, it is the
difference between where the prop is and where the character stands: it grows by whatever the prop
moved while the character stayed in place, and so every travelling phrase goes on from where the
character stood. Carrying that place along says the same with less.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from actions_library.library import IDLE, Library
from smd.character.clip import Clip
from smd.transfer.gait import gait_of, phase_after
from smd.transfer.in_place import gesture, idling, turn, turn_passes, turns
from smd.transfer.move import Move, Placement, nearest_turn
from smd.transfer.path import GroundPath
from smd.transfer.timeline import Span
from smd.transfer.travelling import along_path, leap


def course(spans: Sequence[Span], path: GroundPath, library: Library) -> tuple[Move, ...]:
    """Return the moves of a performer.

    Places come from the path's differences, headings from the prop itself: the character stands
    where its last phrase left it, and from the next phrase on faces where the prop faces.
    """
    cast = [_cast(span, library) for span in spans]
    clock_s = spans[0].start_s
    at = Placement(path.at(clock_s), float(path.heading_at(clock_s)))
    moves: list[Move] = []
    for i, span in enumerate(spans):
        if span.phrase is None:
            facing_rad = at.heading_rad
            if i + 1 < len(spans):
                facing_rad = nearest_turn(float(path.heading_at(span.end_s)), at.heading_rad)
            clip = library.clip(IDLE)
            move = idling(
                clip, span.start_s, span.end_s, at, facing_rad=facing_rad, clock_s=clock_s
            )
            moves.append(move)
        else:
            from_gait = i > 0 and cast[i].goes_on_from(cast[i - 1])
            into_gait = i + 1 < len(spans) and cast[i + 1].goes_on_from(cast[i])
            before = moves[-1] if from_gait else None
            moves += _acted(cast[i], span, path, at, before, into_gait=into_gait)
        at = moves[-1].end
    return tuple(moves)


@dataclass(frozen=True, slots=True, eq=False)
class _Cast:
    """What plays a span: a clip, and how it moves over the ground."""

    clip: Clip
    travels: bool
    steps: bool

    def goes_on_from(self, before: _Cast) -> bool:
        """Return whether this goes on along the path without coming to rest after ``before``."""
        if not (self.travels and before.travels and self.clip.cyclic and before.clip.cyclic):
            return False
        return self.clip is before.clip or (self.steps and before.steps)


def _cast(span: Span, library: Library) -> _Cast:
    """Find who plays a span. The clip is neutral; its expression by Effort belongs here."""
    action = library.action(IDLE if span.phrase is None else span.phrase.action)
    clip = library.clip(action.name)
    travels = span.phrase is not None and action.travels
    return _Cast(clip, travels, travels and clip.cyclic and bool(gait_of(clip).passings))


def _acted(
    cast: _Cast,
    span: Span,
    path: GroundPath,
    at: Placement,
    before: Move | None,
    *,
    into_gait: bool,
) -> list[Move]:
    """Return the moves that act out a phrase: one, but for a turn that takes several passes.

    Parameters
    ----------
    before
        The move that this one goes on from along the path, if it does.
    """
    assert span.phrase is not None
    clip, end_s = cast.clip, span.end_s
    # A phrase that goes on from a gait fills the short gap between them, any other waits.
    start_s = span.start_s if before else max(span.start_s, span.phrase.start_s)
    if cast.travels and clip.cyclic:
        phase = None
        if before is not None and cast.steps:
            phase = phase_after(before.clip, float(before.frame[-1]), clip)
        return [
            along_path(
                clip,
                path,
                start_s,
                end_s,
                at,
                phase=phase,
                from_gait=before is not None,
                into_gait=into_gait,
            )
        ]
    if cast.travels:
        return [leap(clip, path, start_s, end_s, at)]
    facing_rad = nearest_turn(float(path.heading_at(start_s)), at.heading_rad)
    at = Placement(at.position_m, facing_rad)
    if not turns(clip):
        return [gesture(clip, start_s, end_s, at)]
    prop_turn_rad = float(path.heading_at(end_s) - path.heading_at(start_s))
    passes = turn_passes(clip, prop_turn_rad)
    moves: list[Move] = []
    for i, turn_rad in enumerate(passes):
        first_s = start_s + (end_s - start_s) * i / len(passes)
        last_s = start_s + (end_s - start_s) * (i + 1) / len(passes)
        moves.append(turn(clip, first_s, last_s, at, turn_rad))
        at = moves[-1].end
    return moves
