"""How spans are held against what was played in a session."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from benchmarks.composed import Session
from smd.geometry.arrays import FloatArray


class Found(Protocol):
    """A stretch that was given a name, whoever gave it."""

    @property
    def action(self) -> str:
        """Its name."""

    @property
    def start_s(self) -> float:
        """Where it begins."""

    @property
    def end_s(self) -> float:
        """Where it ends."""


class Named(NamedTuple):
    """A stretch with a name, and nothing more."""

    action: str
    start_s: float
    end_s: float


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts over one or more sessions; they add up.

    A span belongs to the gesture in whose window its middle lies; windows meet half-way between
    takes. The first one there that has the right name is a hit, every other span is false.

    Attributes
    ----------
    known : gestures of actions that the library holds.
    hits : how many of them were found.
    others : gestures of other classes.
    left : how many of them have no span in their window.
    false : spans that are no hits.
    minutes : length of the sessions.
    off_s : of each hit, how much too late it begins and ends.
    """

    known: int = 0
    hits: int = 0
    others: int = 0
    left: int = 0
    false: int = 0
    minutes: float = 0.0
    off_s: tuple[tuple[float, float], ...] = ()

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            self.known + other.known,
            self.hits + other.hits,
            self.others + other.others,
            self.left + other.left,
            self.false + other.false,
            self.minutes + other.minutes,
            self.off_s + other.off_s,
        )

    @property
    def recall(self) -> float:
        """Share of the known gestures that were found."""
        return self.hits / max(self.known, 1)

    @property
    def precision(self) -> float:
        """Share of the spans that are hits."""
        return self.hits / max(self.hits + self.false, 1)

    @property
    def f1(self) -> float:
        """Harmonic mean of recall and precision."""
        return 2.0 * self.hits / max(self.known + self.hits + self.false, 1)

    @property
    def false_a_minute(self) -> float:
        """False spans a minute."""
        return self.false / max(self.minutes, 1e-9)

    @property
    def left_alone(self) -> float:
        """Share of the gestures of other classes of which nothing was said."""
        return self.left / max(self.others, 1)


def tally(spans: Iterable[Found], session: Session) -> Tally:
    """Hold spans against a session."""
    hit: dict[int, Found] = {}
    touched: set[int] = set()
    false = 0
    for span in sorted(spans, key=lambda each: each.start_s):
        place = session.window_of(0.5 * (span.start_s + span.end_s))
        touched.add(place)
        if span.action == session.gestures[place].action and place not in hit:
            hit[place] = span
        else:
            false += 1
    others = {i for i, one in enumerate(session.gestures) if one.action is None}
    return Tally(
        known=len(session.gestures) - len(others),
        hits=len(hit),
        others=len(others),
        left=len(others - touched),
        false=false,
        minutes=session.free.duration_s / 60.0,
        off_s=tuple(
            (span.start_s - session.gestures[i].start_s, span.end_s - session.gestures[i].end_s)
            for i, span in hit.items()
        ),
    )


def f1_interval(people: Sequence[Tally]) -> tuple[float, float]:
    """Return a 95 % interval of F1 over people (bootstrap)."""
    return _middle_95(_f1_of_draws(people))


def f1_gain_interval(ours: Sequence[Tally], theirs: Sequence[Tally]) -> tuple[float, float]:
    """Return a 95 % interval of how much F1 is higher, over people, the same ones of both."""
    return _middle_95(_f1_of_draws(ours) - _f1_of_draws(theirs))


def _f1_of_draws(people: Sequence[Tally]) -> FloatArray:
    """Return F1 of 2000 draws of as many people, with return; the same draws each time."""
    draws = np.random.default_rng(0).integers(len(people), size=(2000, len(people)))
    counts = np.array([(one.known, one.hits, one.false) for one in people])
    known, hits, false = counts[draws].sum(axis=1).T
    return np.asarray(2.0 * hits / np.maximum(known + hits + false, 1))


def _middle_95(values: FloatArray) -> tuple[float, float]:
    low, high = np.percentile(values, (2.5, 97.5)).tolist()
    return low, high
