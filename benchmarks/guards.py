"""What the shipped library finds where nothing is meant, and in gestures that are near its own.

Printed by ``python -m benchmarks.sessions``. Goals: in idle hands and in free play at most 0.3
phrases a minute; at least 60 % of drawn taps taken for a punch or a push, and of shakes for a wave.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol, TypeAlias

import numpy as np

from benchmarks.composed import FRAME, minutes_of
from benchmarks.gestures import DATA
from benchmarks.recognition import poisson_interval
from benchmarks.tally import Found
from smd.doodle import HEADSETS, Doodle
from smd.errors import DoodleError
from smd.formats import read_recording
from smd.recognition.action import Action

DEVELOPED_PLAY = ("dance", "grabLeft")
"""Sessions of free play to choose by; the others are reported on."""

NEIGHBOURS = (
    ("taps of the whole hand", "g02_f2_s{person:02d}_*.csv", ("punch", "push")),
    ("shakes", "g14_*_s{person:02d}_*.csv", ("wave",)),
)
"""Gestures before a camera that are near some of the shipped ones, and to which."""


class Spots(Protocol):
    """Finds actions in doodles."""

    def spot(self, doodle: Doodle) -> Sequence[Found]:
        """Return what was found, in time order."""


Make: TypeAlias = Callable[[Sequence[Action]], Spots]
"""What is made of a library."""


def spans_in(doodles: Iterable[Doodle], spots: Spots) -> Counter[str]:
    """Return what is found in doodles, by name."""
    seen: Counter[str] = Counter()
    for doodle in doodles:
        try:
            seen.update(span.action for span in spots.spot(doodle))
        except DoodleError:  # too short to smooth
            continue
    return seen


def free_play(*, develop: bool) -> list[Doodle]:
    """Return the controllers of A-Frame sessions, not the headset."""
    folder = DATA / "controllers" / "aframe" / "raw"
    paths = [
        path for path in sorted(folder.glob("*.json")) if (path.stem in DEVELOPED_PLAY) == develop
    ]
    doodles = [doodle for path in paths for doodle in read_recording(path).doodles]
    return [doodle for doodle in doodles if doodle.device.lower() not in HEADSETS]


def print_guard(
    forms: Mapping[str, Make],
    actions: Sequence[Action],
    idle: Sequence[Doodle],
    play: Sequence[Doodle],
) -> None:
    """Print what a library finds where nothing is meant."""
    print("the shipped library at its default, where nothing is meant: phrases a minute (95 %)")
    for title, doodles in (("idle hands", idle), ("free play of controllers", play)):
        minutes = minutes_of(doodles)
        for form, make in forms.items():
            seen = spans_in(doodles, make(actions))
            count = sum(seen.values())
            low, high = (bound / minutes for bound in poisson_interval(count))
            what = f"{title}, {minutes:.1f} min, {form}"
            print(f"  {what:46} {count / minutes:.2f} ({low:.2f} to {high:.2f})  {_told(seen)}")


def print_neighbours(
    forms: Mapping[str, Make], actions: Sequence[Action], people: Sequence[int]
) -> None:
    """Print how often gestures before a camera are taken for actions that they resemble.

    A test of neighbours: nobody was asked for a punch or a wave, and a hand is no figurine.
    """
    print("a neighbour's test: drawn, and taken for a shipped action that they resemble")
    for title, pattern, names in NEIGHBOURS:
        paths = [
            path
            for person in people
            for path in sorted((DATA / "gestures").glob(pattern.format(person=person)))
        ]
        takes = [read_recording(path, FRAME).doodles[0] for path in paths]
        drawn = [replace(take, drawing=np.ones(len(take), bool)) for take in takes]
        for form, make in forms.items():
            spots = make(actions)
            seen = [{span.action for span in spots.spot(take)} for take in drawn]
            share = sum(bool(each & set(names)) for each in seen) / max(len(seen), 1)
            which = Counter(action for each in seen for action in (each or {"nothing"}))
            what = f"{title} as {' or '.join(names)}, {form}"
            print(f"  {what:46} {100.0 * share:.0f} % of {len(seen)}  {_told(which)}")


def _told(seen: Counter[str]) -> str:
    """Return what was seen most."""
    return ", ".join(f"{action} {n}" for action, n in seen.most_common(6))
