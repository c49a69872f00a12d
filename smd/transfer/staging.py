"""Staging: the moves of every performer of a Score."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from smd.acting.company import apart
from smd.acting.flight import height_of
from smd.acting.move import Move
from smd.acting.moving import Idling
from smd.cast import ActionLibrary, Cast
from smd.character.mass import mass_of
from smd.doodle import Doodle, Recording
from smd.geometry.arrays import FloatArray
from smd.score import Part, Phrase, Score
from smd.transfer.course import course
from smd.transfer.facing import HEADINGS
from smd.transfer.limits import Limits
from smd.transfer.path import ground_path
from smd.transfer.plan import DRAWN, FEASIBLE, TIMINGS, Plan, Planning
from smd.transfer.repertoire import Piece, Repertoire, repertoire, with_efforts, with_faster
from smd.transfer.scene import SceneScale, scene_scale


@dataclass(frozen=True, slots=True, eq=False)
class Staged:
    """A performer with its moves.

    Attributes
    ----------
    part : what it performs, as drawn.
    plan : when and how it is played.
    doodles : at the scene's scale.
    pieces : what it can do.
    moves : one after the other, from the first frame to the last.
    idling : what it does in between.
    """

    part: Part
    plan: Plan
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
    timing: str = FEASIBLE,
    limits: Limits | None = None,
) -> list[Staged]:
    """Return the moves of each performer, as if alone, from the first of some times to the last.

    Parameters are those of `perform`.
    """
    scene = scene_scale(recording, cast.shared.character.height_m, score.figure_height_m)
    pieces = repertoires(score, cast, expressiveness, drawn=timing == DRAWN)
    make = partial(
        enter,
        recording=recording,
        scene=scene,
        time_s=time_s,
        heading=heading,
        planning=TIMINGS[timing],
        limits=limits or Limits(),
    )
    return [
        make(part, pieces=pieces[cast.of(part.device)], idling_ahead=ahead)
        for part, ahead in zip(score.performers, _idling_ahead(), strict=False)
    ]


def kept_apart(alone: Sequence[Staged], cast: Cast) -> list[Staged]:
    """Return performers whose paths keep a least distance from each other."""
    together = apart(
        [one.moves for one in alone], heights_m([one.part.device for one in alone], cast)
    )
    return [replace(one, moves=moves) for one, moves in zip(alone, together, strict=True)]


def heights_m(devices: Sequence[str], cast: Cast) -> list[float]:
    """Return how tall the characters of some devices are."""
    return [cast.of(device).character.height_m for device in devices]


def enter(
    part: Part,
    recording: Recording,
    scene: SceneScale,
    pieces: Repertoire,
    time_s: FloatArray,
    idling_ahead: float,
    heading: str,
    planning: Planning,
    limits: Limits,
) -> Staged:
    """Return the moves of a performer, ``idling_ahead`` of a cycle ahead in its idle clip."""
    clock_s = float(time_s[0]) - idling_ahead * pieces.idle.clip.duration_s
    drawn = ground_path(recording.of(part.device), scene)
    doodles = [scene.placed_doodle(doodle) for doodle in recording.of(part.device)]
    ends_s = float(time_s[0]), float(time_s[-1])
    plan = planning(part, drawn, height_of(doodles), pieces, *ends_s, limits)
    pieces = with_efforts(pieces, [span.phrase for span in plan.spans if span.phrase])
    path = HEADINGS[heading](plan.path, plan.spans, pieces)
    moves = course(plan.spans, path, pieces, clock_s=clock_s)
    idling = Idling(pieces.idle, pieces.idle.clip.rate_hz, clock_s)
    played = tuple(plan.played(doodle) for doodle in doodles)
    return Staged(part, plan, played, pieces, moves, idling)


def _idling_ahead() -> Iterator[float]:
    """Return how far ahead each performer is in its idle clip, so that no two move in step."""
    golden = 0.5 * (5.0**0.5 - 1.0)  # multiples of it never come near each other
    return (golden * i % 1.0 for i in itertools.count())


def repertoires(
    score: Score, cast: Cast, expressiveness: float, *, drawn: bool
) -> dict[ActionLibrary, Repertoire]:
    """Return what can be performed with each library of a cast, in this Score.

    Parameters
    ----------
    drawn
        Whether all is played as drawn, so that neither weight nor faster gaits count.
    """
    phrases: dict[ActionLibrary, list[Phrase]] = {}
    for part in score.performers:
        phrases.setdefault(cast.of(part.device), []).extend(part.phrases)
    found = {}
    for library, spoken in phrases.items():
        mass = None if drawn else mass_of(library.character.skeleton)
        known = repertoire(library, spoken, expressiveness=expressiveness, mass=mass)
        found[library] = known if drawn else with_faster(known, library)
    return found
