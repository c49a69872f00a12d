"""Plan: what a body does of what was drawn, and when.

A hand at 1 : 10 asks a body to be several times as fast as it is. A plan changes when phrases begin
and end, which gait they are done with, and how fast and how sharply their path is gone, each as
little as is enough. Phrases, their order, the places that they lead to and the length of the take
stay.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from smd.acting.flight import Height
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.score import Part, Phrase
from smd.transfer.allotment import Share, allotted
from smd.transfer.limits import Limits
from smd.transfer.path import GroundPath
from smd.transfer.planned_path import planned_path
from smd.transfer.repertoire import Repertoire
from smd.transfer.task import Task, tasks_of, way_of_phrase
from smd.transfer.timeline import Span, timeline


@dataclass(frozen=True, slots=True)
class Planned:
    """What became of a phrase.

    Attributes
    ----------
    drawn : the phrase of the Score.
    start_s, end_s : when it is played.
    strike_moved_s : how much later its execution ends than drawn; None where nothing strikes.
    action : whose clip is played.
    hurry : the time that it asks for over the time it has; 1 where that is enough.
    """

    drawn: Phrase
    start_s: float
    end_s: float
    strike_moved_s: float | None
    action: str
    hurry: float

    @property
    def phrase(self) -> Phrase:
        """The phrase of the Score, when it is played."""
        return replace(self.drawn, start_s=self.start_s, end_s=self.end_s)


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """What one performer does.

    Attributes
    ----------
    phrases : of the Score, and what became of them.
    spans : the performer's time, with the actions whose clips are played.
    path : where it goes, at the times at which it does.
    drawn_s, played_s : (k,) increasing: when each moment of the recording is played.
    """

    phrases: tuple[Planned, ...]
    spans: tuple[Span, ...]
    path: GroundPath
    drawn_s: FloatArray
    played_s: FloatArray

    def played(self, doodle: Doodle) -> Doodle:
        """Return a doodle at the times at which it is played."""
        if np.array_equal(self.drawn_s, self.played_s):
            return doodle
        time_s = np.interp(doodle.time_s, self.drawn_s, self.played_s)
        # A hair apart, also on a clock whose seconds began in 1970.
        hair_s = max(1e-9, 2.0 * float(np.spacing(np.abs(time_s).max())))
        time_s = np.maximum.accumulate(time_s + hair_s * np.arange(len(time_s)))
        return replace(doodle, time_s=time_s)


class Planning(Protocol):
    """How a performer's time is planned."""

    def __call__(
        self,
        part: Part,
        path: GroundPath,
        height: Height,
        pieces: Repertoire,
        start_s: float,
        end_s: float,
        limits: Limits,
    ) -> Plan:
        """Return the plan of a performer.

        Parameters
        ----------
        part
            What it performs, as drawn.
        path, height
            Of its prop, as drawn.
        pieces
            What it can do.
        start_s, end_s
            Of the take.
        limits
            What a body can.
        """


def as_drawn(
    part: Part,
    path: GroundPath,
    height: Height,
    pieces: Repertoire,
    start_s: float,
    end_s: float,
    limits: Limits,
) -> Plan:
    """Play everything when it was drawn, as the paper does."""
    ends = np.array([start_s, end_s])
    phrases = tuple(
        Planned(
            one,
            one.start_s,
            one.end_s,
            None if pieces.like(one).clip.cyclic else 0.0,
            one.action,
            1.0,
        )
        for one in part.phrases
    )
    return Plan(phrases, timeline(part.phrases, start_s, end_s), path, ends, ends)


def feasible(
    part: Part,
    path: GroundPath,
    height: Height,
    pieces: Repertoire,
    start_s: float,
    end_s: float,
    limits: Limits,
) -> Plan:
    """Change as little as makes it possible for a body."""
    tasks, shares = _shared_out(part.phrases, path, height, pieces, start_s, end_s, limits)
    both = list(zip(tasks, shares, strict=True))
    timed = [task.phrase(share) for task, share in both]
    spans = timeline(
        timed, start_s, end_s, [task.cue(share, pieces, limits) for task, share in both]
    )
    clock = _clock(part.phrases, timed, start_s, end_s)
    planned, spans, drawn_s, played_s = planned_path(path, spans, pieces, *clock, limits)
    played = [span.phrase for span in spans if span.phrase is not None]
    phrases = tuple(_planned(*one, then) for one, then in zip(both, played, strict=True))
    return Plan(phrases, spans, planned, drawn_s, played_s)


DRAWN, FEASIBLE = "drawn", "feasible"

TIMINGS: Mapping[str, Planning] = {DRAWN: as_drawn, FEASIBLE: feasible}
"""How a performer's time is planned, by its name."""


def _shared_out(
    phrases: Sequence[Phrase],
    path: GroundPath,
    height: Height,
    pieces: Repertoire,
    start_s: float,
    end_s: float,
    limits: Limits,
) -> tuple[list[Task], list[Share]]:
    """Return what is planned of each phrase, with gaits that are fast enough, and its time."""
    actions = [phrase.action for phrase in phrases]
    ways = [
        way_of_phrase(phrase, path, limits) if pieces.like(phrase).travels else None
        for phrase in phrases
    ]
    for _ in range(1 + len(pieces.faster)):
        tasks = tasks_of(phrases, actions, ways, path, height, pieces, limits)
        shares = allotted([task.wish for task in tasks], start_s, end_s)
        faster = [
            task.quick_enough(share, pieces, limits)
            for task, share in zip(tasks, shares, strict=True)
        ]
        if faster == actions:
            break
        actions = faster
    return tasks, shares


def _planned(task: Task, share: Share, played: Phrase) -> Planned:
    wished_s = task.wish.strike_s
    moved_s = None
    if share.strike_s is not None and wished_s is not None:
        moved_s = share.strike_s - wished_s
    return Planned(
        task.drawn, played.start_s, played.end_s, moved_s, task.action, task.hurry(share)
    )


def _clock(
    drawn: Sequence[Phrase], played: Sequence[Phrase], start_s: float, end_s: float
) -> tuple[FloatArray, FloatArray]:
    """Return when each moment of the recording is played ``(k,)``, from the ends of its phrases."""
    knots = [(start_s, start_s)]
    for one, other in zip(drawn, played, strict=True):
        knots += [(one.start_s, other.start_s), (one.end_s, other.end_s)]
    knots.append((end_s, end_s))
    drawn_s, played_s = np.maximum.accumulate(np.array(knots), axis=0).T
    keep = np.concatenate([[True], (np.diff(drawn_s) > 1e-9) & (np.diff(played_s) > 1e-9)])
    return drawn_s[keep], played_s[keep]
