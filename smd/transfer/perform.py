"""From a Score to a Performance."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from smd.acting.act import Frames, act
from smd.acting.company import apart, encounters
from smd.acting.move import Move
from smd.acting.moving import Idling
from smd.acting.performance import Performance
from smd.acting.terrain import Terrain
from smd.cast import ActionLibrary, Cast, cast_of
from smd.doodle import Doodle, Recording
from smd.errors import ScoreError, TransferError
from smd.geometry.arrays import FloatArray
from smd.score import Part, Phrase, Score
from smd.score_file import score_to_json
from smd.transfer.course import course
from smd.transfer.demands import demands
from smd.transfer.facing import HEADINGS
from smd.transfer.path import ground_path
from smd.transfer.repertoire import Piece, Repertoire, repertoire
from smd.transfer.scene import SceneScale, scene_scale
from smd.transfer.timeline import timeline

RATE_HZ = 24.0
"""Frames per second: film's, and what Blender's importer leaves its scene at."""

BEYOND_S = 0.05
"""How far a phrase may reach beyond its device's samples: hand-written times are rounded."""


def perform(
    score: Score,
    recording: Recording,
    library: ActionLibrary | Cast,
    *,
    rate_hz: float = RATE_HZ,
    expressiveness: float = 1.0,
    heading: str = "prop",
    terrain: Terrain | None = None,
) -> Performance:
    """Act out a Score.

    Parameters
    ----------
    score
        Its actions are the library's, its devices the recording's.
    recording
        What the Score was read from; the performance lasts from its first to its last sample.
    library
        Character and clips; in a `Cast`, each performer's own.
    rate_hz
        Frames per second, positive.
    expressiveness
        How much of the phrases' Effort is played, from 0 (neutral clips) to 2.
    heading
        What performers face by, "prop" or "path".
    terrain
        What they go on; by default the level ground.

    Returns
    -------
    Performance
        Its warnings are the Score's, and what the doodles ask too much of; its source is the
        Score with these warnings.

    Raises
    ------
    ScoreError
        If an action, a device or a time is not there.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    TransferError
        If ``rate_hz`` is not positive and finite, ``expressiveness`` is not within 0 and 2,
        ``heading`` is neither, the Score has no performers, or there is no ground or more than
        one below a performer's way.
    """
    if not 0.0 <= expressiveness <= 2.0:
        raise TransferError(f"expressiveness: expected 0 to 2, got {expressiveness!r}")
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise TransferError(f"rate_hz: expected a positive number, got {rate_hz!r}")
    if heading not in HEADINGS:
        raise TransferError(f"heading: expected {' or '.join(HEADINGS)}, got {heading!r}")
    if not score.performers:
        raise TransferError("score: expected at least one performer, got none")
    cast = cast_of(library)
    cast.check(recording.devices)
    for part in score.performers:
        check_part(part, recording, cast.of(part.device))
    start_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)
    end_s = max(float(doodle.time_s[-1]) for doodle in recording.doodles)
    # + 1e-6: a duration of whole frames may come out a hair short.
    count = int(np.floor((end_s - start_s) * rate_hz + 1e-6)) + 1
    frames = Frames(start_s, rate_hz, count)
    alone = entrances(
        score, recording, cast, frames.time_s, expressiveness=expressiveness, heading=heading
    )
    staged = kept_apart(alone, cast)
    actors = tuple(
        act(
            one.part.device,
            cast.of(one.part.device).character,
            one.moves,
            one.idling,
            one.pieces.legs,
            frames,
            phrases=one.part.phrases,
            doodles=one.doodles,
            terrain=terrain,
        )
        for one in staged
    )
    asked = [line for one in staged for line in demands(one.part.device, one.moves)]
    devices = [part.device for part in score.performers]
    before, after = ([one.moves for one in performers] for performers in (alone, staged))
    asked += encounters(devices, before, after, _heights_m(devices, cast))
    # A Score may come from an earlier performance, and have its warnings already.
    warnings = tuple(dict.fromkeys([*score.warnings, *asked]))
    source = {"score": score_to_json(replace(score, warnings=warnings))}
    return Performance(rate_hz, start_s, actors, terrain, warnings, source)


def repertoires(score: Score, cast: Cast, expressiveness: float) -> dict[ActionLibrary, Repertoire]:
    """Return what can be performed with each library of a cast, in this Score."""
    phrases: dict[ActionLibrary, list[Phrase]] = {}
    for part in score.performers:
        phrases.setdefault(cast.of(part.device), []).extend(part.phrases)
    return {
        library: repertoire(library, spoken, expressiveness=expressiveness)
        for library, spoken in phrases.items()
    }


def check_part(part: Part, recording: Recording, library: ActionLibrary) -> None:
    """Raise ScoreError unless a part's device, actions and times are there."""
    if part.device not in recording.devices:
        raise ScoreError(
            f"performers: expected a device of the recording ({', '.join(recording.devices)}), "
            f"found {part.device!r}"
        )
    known = [action.name for action in library.actions]
    doodles = recording.of(part.device)
    first_s, last_s = float(doodles[0].time_s[0]), float(doodles[-1].time_s[-1])
    for i, phrase in enumerate(part.phrases):
        place = f"device {part.device!r}: phrases[{i}]"
        if phrase.action not in known:
            near = difflib.get_close_matches(phrase.action, known, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise ScoreError(
                f"{place}.action: expected one of {', '.join(known)}, found {phrase.action!r}{hint}"
            )
        if phrase.start_s < first_s - BEYOND_S or phrase.end_s > last_s + BEYOND_S:
            raise ScoreError(
                f"{place}: expected times within the device's {first_s:.3f} to {last_s:.3f} s, "
                f"found {phrase.action!r} from {phrase.start_s:.3f} to {phrase.end_s:.3f} s"
            )


@dataclass(frozen=True, slots=True, eq=False)
class Staged:
    """A performer that knows where it goes and what it does there.

    Attributes
    ----------
    part : what it performs.
    doodles : at the scene's scale.
    pieces : what it can do.
    moves : one after the other, from the first frame to the last.
    idling : what it does in between.
    """

    part: Part
    doodles: tuple[Doodle, ...]
    pieces: Repertoire
    moves: tuple[Move[Piece], ...]
    idling: Idling


def entrances(
    score: Score,
    recording: Recording,
    cast: Cast,
    time_s: FloatArray,
    *,
    expressiveness: float,
    heading: str,
) -> list[Staged]:
    """Lay out what each performer does, as if alone, from the first of some times to the last.

    Parameters are those of `perform`.
    """
    scene = scene_scale(recording, cast.shared.character.height_m, score.figure_height_m)
    pieces = repertoires(score, cast, expressiveness)
    return [
        enter(part, recording, scene, pieces[cast.of(part.device)], time_s, ahead, heading)
        for part, ahead in zip(score.performers, _idling_ahead(), strict=False)
    ]


def kept_apart(alone: Sequence[Staged], cast: Cast) -> list[Staged]:
    """Return performers that do not walk through each other."""
    heights_m = _heights_m([one.part.device for one in alone], cast)
    together = apart([one.moves for one in alone], heights_m)
    return [replace(one, moves=moves) for one, moves in zip(alone, together, strict=True)]


def _heights_m(devices: Sequence[str], cast: Cast) -> list[float]:
    return [cast.of(device).character.height_m for device in devices]


def enter(
    part: Part,
    recording: Recording,
    scene: SceneScale,
    pieces: Repertoire,
    time_s: FloatArray,
    idling_ahead: float,
    heading: str,
) -> Staged:
    """Lay out what a performer does, ``idling_ahead`` of a cycle ahead in its idling."""
    clock_s = float(time_s[0]) - idling_ahead * pieces.idle.clip.duration_s
    spans = timeline(part, float(time_s[0]), float(time_s[-1]))
    path = HEADINGS[heading](ground_path(recording.of(part.device), scene), spans, pieces)
    moves = course(spans, path, pieces, clock_s=clock_s)
    doodles = tuple(scene.placed_doodle(doodle) for doodle in recording.of(part.device))
    idling = Idling(pieces.idle, pieces.idle.clip.rate_hz, clock_s)
    return Staged(part, doodles, pieces, moves, idling)


def _idling_ahead() -> Iterator[float]:
    """Return how far ahead each performer is in its idling, so that no two breathe as one."""
    golden = 0.5 * (5.0**0.5 - 1.0)  # multiples of it never come near each other
    return (golden * i % 1.0 for i in itertools.count())
