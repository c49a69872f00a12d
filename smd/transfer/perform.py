"""From a Score to a Performance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from smd.acting.act import Frames, act
from smd.acting.company import encounters
from smd.acting.gaze import with_gaze
from smd.acting.grip import with_props_held
from smd.acting.performance import Actor, Performance
from smd.acting.terrain import Terrain
from smd.cast import ActionLibrary, Cast, cast_of
from smd.doodle import Recording
from smd.errors import ScoreError, TransferError
from smd.score import Part, Score
from smd.score_file import score_to_json
from smd.transfer.demands import demands
from smd.transfer.facing import HEADINGS
from smd.transfer.lacking import without_lacking
from smd.transfer.limits import Limits
from smd.transfer.plan import DRAWN, TIMINGS
from smd.transfer.plan_report import hurried, plan_to_json, unmet
from smd.transfer.staging import Staged, entrances, heights_m, kept_apart
from smd.transfer.stretch import AUTO, factors, stretched

RATE_HZ = 24.0
"""Frames per second: film's, and what Blender's importer leaves its scene at."""

MOST_HURRIED = 0.05
"""Share of phrases without enough time up to which a take is not stretched any further."""

EMPTY_HANDED = (
    "{}: its character has no hand with fingers and a thumb, so that it cannot hold its prop; "
    "leave --hold out, or give it another character with --library"
)
"""What is said of a performer that should hold its prop, and cannot."""

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
    timing: str = "feasible",
    stretch: float | str = 1.0,
    limits: Limits | None = None,
    hold: bool = False,
) -> Performance:
    """Act out a Score.

    Parameters
    ----------
    score
        Its devices are the recording's. What its library has no action for is idled through.
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
    timing
        When phrases are played: "drawn", as in the Score and to the letter of the paper, or
        "feasible", as a body can, with heads that look where it goes.
    stretch
        How many times as long as the recording the performance lasts; "auto" for as long as most
        phrases need.
    limits
        What a body can, where that is asked for; by default a person's.
    hold
        Whether characters hold their props in a hand.

    Returns
    -------
    Performance
        Its warnings are the Score's, what its characters lack, and what the doodles ask too much
        of; its source is the Score with these warnings.

    Raises
    ------
    ScoreError
        If a device or a time is not there.
    LibraryError
        If a cast has a library for a device that is not in the recording.
    TransferError
        If ``rate_hz`` is not positive and finite, ``expressiveness`` is not within 0 and 2,
        ``heading`` or ``timing`` is neither, ``stretch`` is no number from 0.1 to 20, the Score has
        no performers, or there is no ground or more than one below a performer's way.
    """
    if not 0.0 <= expressiveness <= 2.0:
        raise TransferError(f"expressiveness: expected 0 to 2, got {expressiveness!r}")
    if not (np.isfinite(rate_hz) and rate_hz > 0):
        raise TransferError(f"rate_hz: expected a positive number, got {rate_hz!r}")
    if heading not in HEADINGS:
        raise TransferError(f"heading: expected {' or '.join(HEADINGS)}, got {heading!r}")
    if timing not in TIMINGS:
        raise TransferError(f"timing: expected {' or '.join(TIMINGS)}, got {timing!r}")
    if stretch == AUTO and timing == DRAWN:
        raise TransferError("stretch: expected a number with the timing 'drawn', got 'auto'")
    if not score.performers:
        raise TransferError("score: expected at least one performer, got none")
    cast = cast_of(library)
    cast.check(recording.devices)
    for part in score.performers:
        check_part(part, recording)
    known, lacking = without_lacking(score, cast)
    for factor in factors(stretch):
        take = stretched(known, recording, factor)
        frames = frames_of(take[1], rate_hz)
        alone = entrances(
            *take,
            cast,
            frames.time_s,
            expressiveness=expressiveness,
            heading=heading,
            timing=timing,
            limits=limits,
        )
        if hurried([one.plan for one in alone]) <= MOST_HURRIED:
            break
    staged = kept_apart(alone, cast)
    actors = tuple(acted(one, cast, frames, terrain) for one in staged)
    if timing != DRAWN:
        actors = with_gaze(actors, rate_hz)
    if hold:
        actors = with_props_held(actors)
    asked = lacking + [line for one in staged for line in demands(one.part.device, one.moves)]
    asked += [line for one in staged for line in unmet(one.part.device, one.plan)]
    if hold:
        asked += [EMPTY_HANDED.format(one.name) for one in actors if one.held is None]
    devices = [part.device for part in score.performers]
    before, after = ([one.moves for one in performers] for performers in (alone, staged))
    asked += encounters(devices, before, after, heights_m(devices, cast))
    # A Score may come from an earlier performance, and have its warnings already.
    warnings = tuple(dict.fromkeys([*score.warnings, *asked]))
    plans = {one.part.device: one.plan for one in alone}
    source = {
        "score": score_to_json(replace(score, warnings=warnings)),
        "plan": plan_to_json(plans, timing=timing, stretch=factor),
    }
    return Performance(rate_hz, frames.start_s, actors, terrain, warnings, source)


def frames_of(recording: Recording, rate_hz: float) -> Frames:
    """Return the frames from a recording's first sample to its last."""
    start_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)
    end_s = max(float(doodle.time_s[-1]) for doodle in recording.doodles)
    # + 1e-6: a duration of whole frames may come out a hair short.
    return Frames(start_s, rate_hz, int(np.floor((end_s - start_s) * rate_hz + 1e-6)) + 1)


def acted(one: Staged, cast: Cast, frames: Frames, terrain: Terrain | None) -> Actor:
    """Return a performer as an actor."""
    character = cast.of(one.part.device).character
    return act(
        one.part.device,
        character,
        one.moves,
        one.idling,
        one.pieces.legs,
        frames,
        phrases=[planned.phrase for planned in one.plan.phrases],
        doodles=one.doodles,
        terrain=terrain,
        mass=one.pieces.mass,
    )


def check_part(part: Part, recording: Recording) -> None:
    """Raise ScoreError unless a part's device and times are there."""
    if part.device not in recording.devices:
        raise ScoreError(
            f"performers: expected a device of the recording ({', '.join(recording.devices)}), "
            f"found {part.device!r}"
        )
    doodles = recording.of(part.device)
    first_s, last_s = float(doodles[0].time_s[0]), float(doodles[-1].time_s[-1])
    for i, phrase in enumerate(part.phrases):
        if phrase.start_s < first_s - BEYOND_S or phrase.end_s > last_s + BEYOND_S:
            raise ScoreError(
                f"device {part.device!r}: phrases[{i}]: expected times within the device's "
                f"{first_s:.3f} to {last_s:.3f} s, found {phrase.action!r} from "
                f"{phrase.start_s:.3f} to {phrase.end_s:.3f} s"
            )
