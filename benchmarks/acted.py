"""Acted: a Score acted out, with the physics of each performer and what became of each phrase.

The Score and the path are the drawn ones, whatever the performance made of their times.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from actions_library.library import Library
from benchmarks import acting_quality as quality
from benchmarks.physics import RATE_HZ, Mechanics, anatomy_of, mechanics
from smd.acting.flight import flights, in_air
from smd.acting.move import Move, knots
from smd.acting.moving import rows_of
from smd.acting.transitions import TRANSITION_S
from smd.character.clip import STAGES, Clip
from smd.character.kinematics import forward_kinematics
from smd.doodle import Recording
from smd.geometry.arrays import BoolArray, FloatArray, IntArray
from smd.pipeline import animate
from smd.score import Part, Phrase, Score
from smd.transfer.demands import way_of
from smd.transfer.repertoire import Piece
from smd.transfer.stretch import stretched
from smd.transfer.timeline import SHORTEST_IDLE_S
from smd.transfer.travelling import NOWHERE_M

FINE_S = 1e-3
"""Step at which a path is compared with a place."""


class Beat(NamedTuple):
    """A phrase as it was drawn, with what became of it.

    Attributes
    ----------
    drawn : of the Score.
    moves : of the performer, in order; none where the phrase is not played.
    drawn_m : length of the drawn path on the stage; 0 of what does not travel.
    way_m : length of the ground root's.
    off_m : RMS distance of the ground root from the drawn path, put where the root begins.
    late_s : how much later than the prop the body is halfway through what is played once; NaN of
        a cycle, or where the prop is lost.
    moved_s : how much later its strike, the end of a clip's execution, is than in the drawn phrase,
        played evenly; NaN of a cycle, and of what takes several moves.
    """

    drawn: Phrase
    moves: tuple[Move[Piece], ...]
    drawn_m: float
    way_m: float
    off_m: float
    late_s: float
    moved_s: float

    @property
    def gait(self) -> Move[Piece] | None:
        """The move that steps along the path, if one does and gets anywhere."""
        steps = (m for m in self.moves if kind_of(m) == "gait" and way_of(m) > NOWHERE_M)
        return next(steps, None)


@dataclass(frozen=True, slots=True, eq=False)
class Acted:
    """A performer's figures.

    Attributes
    ----------
    name : of the recording and the device, or the take's.
    start_s : time of the first frame, on the recording's clock.
    mechanics : of what is seen.
    moves : one after the other; ``at (n,)`` is which of them acts in each frame.
    joins : (n,) whether that move just began, within a transition's time.
    flies : (n,) in the air by a jump, a leap or a fall, as the moves have it.
    beats : its phrases.
    planned_off_m : (m,) distances of the ground root from the moves' path.
    lasts : its duration over the recording's.
    misplaced : phrases that are not played, or not in the drawn order.
    """

    name: str
    start_s: float
    mechanics: Mechanics
    moves: tuple[Move[Piece], ...]
    at: IntArray
    joins: BoolArray
    flies: BoolArray
    beats: tuple[Beat, ...]
    planned_off_m: FloatArray
    lasts: float
    misplaced: int

    @property
    def hovers(self) -> BoolArray:
        """Frames of what never touches the ground ``(n,)``."""
        return np.array([kind_of(move) == "hovers" for move in self.moves])[self.at]

    @property
    def on_feet(self) -> BoolArray:
        """Frames in which nothing but the feet can bear ``(n,)``."""
        crawls = [
            any("hand" in joint for joint in move.piece.clip.contact_joints) for move in self.moves
        ]
        return self.mechanics.upright & ~self.hovers & ~np.array(crawls)[self.at]

    @property
    def bound(self) -> BoolArray:
        """Frames in which the speed over the ground is bounded ``(n,)``: no flight and no run."""
        runs = np.array(
            [move.piece.gait is not None and move.piece.gait.flies for move in self.moves]
        )
        return ~(self.hovers | self.flies | runs[self.at])


def kind_of(move: Move[Piece]) -> str:
    """Return how a move moves: "pause", "in place", "leap", "gait", or "hovers"."""
    if move.idles:
        return "pause"
    if not move.piece.clip.contacts.any():
        return "hovers"
    if move.piece.gait is not None and move.piece.gait.passings:
        return "gait"
    return "leap" if move.piece.travels else "in place"


def on_hands(clip: Clip) -> bool:
    """Return whether hands touch the ground in a clip."""
    return any("hand" in joint for joint in clip.contact_joints)


def acted(
    recording: Recording, score: Score, library: Library, options: dict[str, Any]
) -> Iterator[Acted]:
    """Act out a Score, `animate` being given some options, and yield its performers' figures.

    Where the take is stretched, what was drawn is taken to have been drawn as slowly.
    """
    first_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)
    last_s = max(float(doodle.time_s[-1]) for doodle in recording.doodles)
    performance = animate(score, recording, library, rate_hz=RATE_HZ, **options)
    if "stretch" in options:
        factor = json.loads(performance.source["plan"])["stretch"]
        score, recording = stretched(score, recording, factor)
        options = {name: value for name, value in options.items() if name != "stretch"}
    parts = {part.device: part for part in score.performers}
    for seen in quality.played(performance, recording, score, library, **options):
        skeleton = seen.actor.character.skeleton
        anatomy = anatomy_of(skeleton)
        figures = anatomy and mechanics(skeleton, seen.poses, performance.rate_hz, anatomy)
        if figures is None:
            continue
        now_s = performance.start_s + figures.time_s
        at, joins = _acting(seen.moves, now_s)
        part = parts[seen.actor.name]
        beats = tuple(_beats(seen, part, recording))
        played = [phrase.action for phrase in seen.actor.phrases]
        ordered = in_order([phrase.action for phrase in part.phrases], played)
        yield Acted(
            name=f"{Path(recording.source).stem} {seen.actor.name}",
            start_s=performance.start_s,
            mechanics=figures,
            moves=seen.moves,
            at=at,
            joins=joins,
            flies=in_air(list(flights(seen.moves, None)), now_s),
            beats=beats,
            planned_off_m=_planned_off_m(seen),
            lasts=float(seen.time_s[-1] - seen.time_s[0]) / (last_s - first_s),
            misplaced=len(part.phrases) - min(ordered, sum(bool(beat.moves) for beat in beats)),
        )


def _acting(moves: Sequence[Move[Piece]], time_s: FloatArray) -> tuple[IntArray, BoolArray]:
    """Return which move acts at each time ``(n,)``, and whether it just began."""
    at, joins = np.zeros(len(time_s), dtype=np.int64), np.zeros(len(time_s), dtype=bool)
    for i, (move, rows) in enumerate(zip(moves, rows_of(moves, time_s), strict=True)):
        at[rows] = i
        joins[rows] = i > 0 and time_s[rows] < move.start_s + min(TRANSITION_S, move.room_s)
    return at, joins


def in_order(drawn: Sequence[str], played: Sequence[str]) -> int:
    """Return how many drawn actions are played in their order."""
    blocks = SequenceMatcher(None, drawn, played, autojunk=False).get_matching_blocks()
    return sum(block.size for block in blocks)


def _beats(seen: quality.Played, part: Part, recording: Recording) -> Iterator[Beat]:
    """Yield the drawn phrases of a part, each with the moves of the phrase played in its place."""
    played = _moves_of(seen)
    over_s = float(seen.time_s[0])
    before: Move[Piece] | None = None
    for i, phrase in enumerate(part.phrases):
        moves = played[i] if i < len(played) else ()
        drawn_m = way_m = off_m = 0.0
        if moves and moves[0].piece.travels:
            # A gait that goes on from another fills the short gap between them.
            goes_on = before is not None and kind_of(before) == kind_of(moves[0]) == "gait"
            goes_on &= phrase.start_s - over_s < SHORTEST_IDLE_S
            start_s = over_s if goes_on else max(over_s, phrase.start_s)
            over_ground = seen.path.at(knots(start_s, phrase.end_s))
            drawn_m = _length_m(over_ground)
            way_m = sum(way_of(move) for move in moves)
            fine = seen.path.at(np.arange(start_s, phrase.end_s, FINE_S))
            off_m = _rms(_distances_m(_root(seen, moves), fine - fine[0] + moves[0].root_m[0]))
        late_s = _late_s(seen, moves, phrase, recording)
        yield Beat(phrase, moves, drawn_m, way_m, off_m, late_s, _moved_s(moves, phrase))
        before, over_s = moves[-1] if moves else None, phrase.end_s


def _moves_of(seen: quality.Played) -> list[tuple[Move[Piece], ...]]:
    """Return the moves of each phrase of an actor: those that begin with it, and go on in it."""
    acting = [move for move in seen.moves if not move.idles]
    found: list[tuple[Move[Piece], ...]] = []
    over_s = -np.inf
    for phrase in seen.actor.phrases:
        within = [
            move
            for move in acting
            if move.start_s >= over_s - 1e-6
            and move.start_s < phrase.end_s - 1e-6
            and move.end_s > phrase.start_s + 1e-6
        ]
        found.append(tuple(within))
        over_s = phrase.end_s
    return found


def _late_s(
    seen: quality.Played, moves: Sequence[Move[Piece]], phrase: Phrase, recording: Recording
) -> float:
    """Return how much later than the prop a body is halfway, as `acting_quality.lateness_s`."""
    if not moves or moves[0].piece.clip.cyclic:
        return np.nan
    drawn = quality.drawn_between(recording.of(seen.actor.name), phrase.start_s, phrase.end_s)
    rows = (seen.time_s >= moves[0].start_s) & (seen.time_s <= moves[-1].end_s)
    if drawn is None or np.count_nonzero(rows) < 3:
        return np.nan
    local = (part[rows] for part in seen.poses)
    _, place = forward_kinematics(seen.actor.character.skeleton, *local)
    steps = np.linalg.norm(np.diff(place - place[:, :1], axis=0), axis=-1).mean(axis=-1)
    return quality.halfway_s(seen.time_s[rows][1:], steps) - quality.halfway_s(*drawn)


def _moved_s(moves: Sequence[Move[Piece]], phrase: Phrase) -> float:
    """Return how much later a clip's execution ends than in the phrase, played evenly."""
    if len(moves) != 1 or moves[0].piece.clip.cyclic:
        return np.nan
    move, clip = moves[0], moves[0].piece.clip
    struck = float(clip.stage_end_frames[STAGES.index("execution")])
    struck_s = float(np.interp(struck, move.frame, move.time_s))
    return struck_s - phrase.start_s - struck / (len(clip) - 1) * (phrase.end_s - phrase.start_s)


def _planned_off_m(seen: quality.Played) -> FloatArray:
    """Return distances of the ground root from the path of the moves that travel."""
    off = [np.zeros(0)]
    for move in seen.moves:
        if move.piece.travels and not move.idles:
            fine = move.root_at(np.arange(move.start_s, move.end_s, FINE_S))
            off.append(_distances_m(_root(seen, [move]), fine))
    return np.concatenate(off)


def _root(seen: quality.Played, moves: Sequence[Move[Piece]]) -> FloatArray:
    """Return x and z of the ground root in the frames of some moves."""
    rows = (seen.time_s >= moves[0].start_s) & (seen.time_s <= moves[-1].end_s)
    return np.asarray(seen.poses.translation_m[rows][:, 0, [0, 2]])


def _distances_m(place_m: FloatArray, way_m: FloatArray) -> FloatArray:
    """Return how far places ``(n, 2)`` are from the nearest of a way ``(m, 2)``."""
    gaps = np.linalg.norm(place_m[:, None] - way_m[None], axis=-1)
    return np.asarray(gaps.min(axis=1, initial=np.inf))


def _length_m(way_m: FloatArray) -> float:
    return float(np.linalg.norm(np.diff(way_m, axis=0), axis=-1).sum())


def _rms(value: FloatArray) -> float:
    return float(np.sqrt(np.mean(value**2))) if len(value) else 0.0
