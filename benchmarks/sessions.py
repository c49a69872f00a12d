"""How well gestures are found among all else that hands do: ``python -m benchmarks.sessions``.

Composed sessions (`benchmarks.composed`) of people 8 to 14 with the pauses of nine idle hands;
``--develop`` takes people 1 to 7 and nine others, and is the one to choose by. Beside ours stand a
plain spotter by warping (`benchmarks.spotter`) and the form with limits (`benchmarks.limits`), on
the same sessions in the same run. Goals: F1 0.05 above the plain spotter and twice that with
limits; with the trigger held 92 % of the known takes found, and at tolerance 0.8 half of the others
left alone; 0.3 false a minute in idle hands and in free play.
"""

from __future__ import annotations

import sys
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeAlias

import numpy as np

from actions_library.folder import load_library
from benchmarks.composed import (
    FEW_CLASSES,
    FRAME,
    Session,
    Teaching,
    idle_files,
    read_idle,
    sessions_of,
)
from benchmarks.gestures import DATA, REPORTED, learned_action, read_gestures
from benchmarks.limits import LimitRecognizer
from benchmarks.recognition import poisson_interval
from benchmarks.spotter import Spotter
from benchmarks.tally import Found, Tally, f1_interval, tally
from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.formats import read_recording
from smd.pipeline import HEADSETS
from smd.recognition import Recognizer
from smd.recognition.action import Action

DEVELOPED = tuple(range(1, 8))
TEACHINGS = (Teaching(own=2), Teaching(own=3), Teaching(others=10))
SEED = 2029
STRICT = 0.8
"""A tolerance at which more is left alone."""

DEVELOPED_PLAY = ("dance", "grabLeft")
"""Sessions of free play to choose by; the others are reported on."""

NEIGHBOURS = (
    ("taps of the whole hand", "g02_f2_s{person:02d}_*.csv", ("punch", "push")),
    ("shakes", "g14_*_s{person:02d}_*.csv", ("wave",)),
)
"""Gestures of the camera that are near some of the shipped ones, and to which."""


class Spots(Protocol):
    """Finds actions in doodles."""

    def spot(self, doodle: Doodle) -> Sequence[Found]:
        """Return what was found, in time order."""


Make: TypeAlias = Callable[[Sequence[Action]], Spots]
"""What is made of a library."""

OURS, LIMITS, PLAIN = "ours", "with limits", "plain spotter"

FORMS: Mapping[str, Make] = {OURS: Recognizer, LIMITS: LimitRecognizer}
"""Those that take actions; the plain spotter takes examples."""

VARIANTS: Mapping[str, Make] = {}
"""Ours with a part taken away, to tell what each part is worth."""

FREE, DRAWN, DRAWN_STRICT = "free", "drawn", f"drawn, tolerance {STRICT:g}"


@dataclass(frozen=True, slots=True)
class Key:
    """Which tally: who found, what was said of drawing, how and how much was taught, and whose."""

    form: str
    said: str
    teaching: Teaching
    small: bool
    person: int


@dataclass(slots=True)
class Measured:
    """What was counted over sessions.

    Attributes
    ----------
    tallies : by form, what was said of drawing, teaching, size of the library and person.
    idle : by form and teaching, the false spans in idle hands of each library.
    idle_minutes : length of the idle hands.
    processor_s : by form, for making it and for the sessions without a trigger.
    """

    tallies: dict[Key, Tally] = field(default_factory=lambda: defaultdict(Tally))
    idle: dict[tuple[str, Teaching], list[int]] = field(default_factory=lambda: defaultdict(list))
    idle_minutes: float = 0.0
    processor_s: dict[str, float] = field(default_factory=lambda: defaultdict(float))

    def of(self, form: str, said: str, teaching: Teaching, small: bool | None = None) -> Tally:
        """Return the sum over people, and over both sizes of library by default."""
        parts = (
            one
            for key, one in self.tallies.items()
            if (key.form, key.said, key.teaching) == (form, said, teaching)
            and small in (None, key.small)
        )
        return sum(parts, Tally())

    def by_person(self, form: str, said: str, teaching: Teaching) -> list[Tally]:
        """Return the tally of each person."""
        people: dict[int, Tally] = defaultdict(Tally)
        for key, one in self.tallies.items():
            if (key.form, key.said, key.teaching) == (form, said, teaching):
                people[key.person] += one
        return list(people.values())


def measured(sessions: Sequence[Session], idle: Sequence[Doodle]) -> Measured:
    """Let every form find what it can in every session, and in idle hands."""
    found = Measured(idle_minutes=minutes_of(idle))
    for number, session in enumerate(sessions, 1):
        for form, spots, said in _forms(session, found.processor_s):
            small = len(session.examples) == FEW_CLASSES
            for what in said:
                doodle = session.free if what == FREE else session.drawn
                started = time.process_time()
                counts = tally(spots.spot(doodle), session)
                if what == FREE:
                    found.processor_s[form] += time.process_time() - started
                found.tallies[Key(form, what, session.teaching, small, session.person)] += counts
            if FREE in said and form not in VARIANTS:
                seen = sum(spans_in(idle, spots).values())
                found.idle[form, session.teaching].append(seen)
        _progress(
            f"session {number} of {len(sessions)}: person {session.person}, {session.teaching}, "
            f"{len(session.examples)} classes, {session.free.duration_s:.0f} s"
        )
    return found


def _forms(
    session: Session, processor_s: dict[str, float]
) -> Iterator[tuple[str, Spots, Sequence[str]]]:
    """Yield each form of a session's library, and what is to be said of drawing."""
    started = time.process_time()
    actions = [learned_action(name, list(own)) for name, own in session.examples.items()]
    learning_s = time.process_time() - started
    for form, make in {**FORMS, **VARIANTS}.items():
        started = time.process_time()
        made = make(actions)
        processor_s[f"{form}, made"] += learning_s + time.process_time() - started
        yield form, made, (FREE,) if form in VARIANTS else (FREE, DRAWN)
    started = time.process_time()
    plain = Spotter(session.examples)
    processor_s[f"{PLAIN}, made"] += time.process_time() - started
    yield PLAIN, plain, (FREE, DRAWN)
    yield OURS, Recognizer(actions, tolerance=STRICT), (DRAWN_STRICT,)
    yield LIMITS, LimitRecognizer(actions, tolerance=STRICT), (DRAWN_STRICT,)


def spans_in(doodles: Iterable[Doodle], spots: Spots) -> Counter[str]:
    """Return what is found in doodles, by name."""
    seen: Counter[str] = Counter()
    for doodle in doodles:
        try:
            seen.update(span.action for span in spots.spot(doodle))
        except DoodleError:  # too short to smooth
            continue
    return seen


def minutes_of(doodles: Iterable[Doodle]) -> float:
    """Return how long doodles are together, min."""
    return sum(doodle.duration_s for doodle in doodles) / 60.0


def print_sizes(sessions: Sequence[Session], people: Sequence[int]) -> None:
    """Print how much there is of what."""
    gestures = [one for session in sessions for one in session.gestures]
    classes = [len(session.examples) for session in sessions]
    foreign = sum(one.action is None for one in gestures)
    print(
        f"people {people[0]} to {people[-1]}: {len(sessions)} sessions of "
        f"{len({session.person for session in sessions})} people, "
        f"{minutes_of(session.free for session in sessions):.1f} min, {len(gestures)} gestures, "
        f"{foreign} of them of classes that the library does not hold; libraries of "
        f"{min(classes)} to {max(classes)} classes"
    )


def print_sessions(found: Measured) -> None:
    """Print what is found in the sessions, without a trigger and with it."""
    for said, title in ((FREE, "nothing says what is meant"), (DRAWN, "with the trigger held")):
        print(f"sessions, {title}")
        print(
            "  taught       form             F1 (95 % over people)  of 6, of all classes  recall  "
            "precision  false a minute  begins, ends off (median, 90 %)"
        )
        for teaching in TEACHINGS:
            for form in (*FORMS, PLAIN, *VARIANTS):
                if not (people := found.by_person(form, said, teaching)):
                    continue
                whole = found.of(form, said, teaching)
                low, high = f1_interval(people)
                small, full = (found.of(form, said, teaching, size).f1 for size in (True, False))
                print(
                    f"  {teaching!s:12} {form:16} {whole.f1:4.2f} ({low:.2f} to {high:.2f})     "
                    f"{small:11.2f}, {full:.2f}        {whole.recall:6.2f}  "
                    f"{whole.precision:9.2f}  {whole.false_a_minute:14.1f}  {_off(whole)}"
                )


def _off(whole: Tally) -> str:
    """Return how far from the truth the hits begin and end."""
    if not whole.off_s:
        return "no hits"
    middle, most = np.percentile(np.abs(whole.off_s), (50, 90), axis=0)
    return f"{middle[0]:.2f}, {middle[1]:.2f} s ({most[0]:.2f}, {most[1]:.2f} s)"


def print_drawn(found: Measured) -> None:
    """Print what is said of takes with the trigger held, known and of other classes."""
    print("with the trigger held: known takes found, and others of which nothing is said")
    for teaching in TEACHINGS:
        for form in FORMS:
            for said, tolerance in ((DRAWN, 1.0), (DRAWN_STRICT, STRICT)):
                whole = found.of(form, said, teaching)
                print(
                    f"  {teaching!s:12} {form:12} tolerance {tolerance:3.1f}: "
                    f"{100.0 * whole.recall:5.1f} % of {whole.known}, "
                    f"{100.0 * whole.left_alone:5.1f} % of {whole.others} left alone"
                )


def print_idle(found: Measured) -> None:
    """Print what the sessions' libraries find in idle hands, beside their recall of takes."""
    print(
        f"idle hands, {found.idle_minutes:.1f} min, with every session's library: false a minute, "
        "and in the worst library; known takes found, free and with the trigger held"
    )
    for teaching in TEACHINGS:
        for form in (*FORMS, PLAIN):
            rate = np.array(found.idle[form, teaching]) / found.idle_minutes
            free, drawn = (found.of(form, said, teaching).recall for said in (FREE, DRAWN))
            print(
                f"  {teaching!s:12} {form:16} {rate.mean():5.2f}, {rate.max():5.2f}; "
                f"{100.0 * free:5.1f} %, {100.0 * drawn:5.1f} %"
            )


def print_guard(idle: Sequence[Doodle], play: Sequence[Doodle]) -> None:
    """Print what the shipped library finds where nothing is meant."""
    library = load_library()
    print("the shipped library at its default, where nothing is meant: phrases a minute (95 %)")
    for title, doodles in (("idle hands", idle), ("free play of controllers", play)):
        minutes = minutes_of(doodles)
        for form, make in FORMS.items():
            seen = spans_in(doodles, make(library.actions))
            count = sum(seen.values())
            low, high = (bound / minutes for bound in poisson_interval(count))
            which = ", ".join(f"{action} {n}" for action, n in seen.most_common())
            print(
                f"  {title}, {minutes:.1f} min, {form}: {count / minutes:.2f} ({low:.2f} to "
                f"{high:.2f})  {which}"
            )


def print_neighbours(people: Sequence[int]) -> None:
    """Print how often gestures of a camera are taken for shipped ones that they resemble.

    A test of neighbours: nobody was asked for a punch or a wave, and a hand is no figurine.
    """
    library = load_library()
    print("a neighbour's test: drawn, taken for a shipped action that they resemble")
    for title, pattern, names in NEIGHBOURS:
        paths = [
            path
            for person in people
            for path in sorted((DATA / "gestures").glob(pattern.format(person=person)))
        ]
        takes = [read_recording(path, FRAME).doodles[0] for path in paths]
        drawn = [replace(take, drawing=np.ones(len(take), bool)) for take in takes]
        for form, make in FORMS.items():
            spots = make(library.actions)
            seen = [{span.action for span in spots.spot(take)} for take in drawn]
            share = sum(bool(each & set(names)) for each in seen) / len(seen)
            which = Counter(action for each in seen for action in (each or {"nothing"}))
            told = ", ".join(f"{action} {n}" for action, n in which.most_common(5))
            print(
                f"  {title} as {' or '.join(names)}, {form}: {100.0 * share:.0f} % of {len(seen)}"
                f"  ({told})"
            )


def print_times(found: Measured) -> None:
    """Print what each form took on the sessions."""
    print("processor time on the sessions without a trigger, and to learn and make it ready")
    for form in (*FORMS, PLAIN, *VARIANTS):
        taken_s, made_s = found.processor_s[form], found.processor_s[f"{form}, made"]
        print(f"  {form:16} {taken_s:6.1f} s, {made_s:5.1f} s")


def free_play(names: Callable[[str], bool]) -> list[Doodle]:
    """Return the controllers of A-Frame sessions whose names are wanted, not the headset."""
    folder = DATA / "controllers" / "aframe" / "raw"
    paths = [path for path in sorted(folder.glob("*.json")) if names(path.stem)]
    doodles = [doodle for path in paths for doodle in read_recording(path).doodles]
    return [doodle for doodle in doodles if doodle.device.lower() not in HEADSETS]


def _progress(line: str) -> None:
    """Tell how far it is."""
    print(line, file=sys.stderr, flush=True)


def main() -> None:
    """Print every figure, of the people to report on or to choose by."""
    if not (DATA / "gestures").is_dir():
        print(f"data absent ({DATA / 'gestures'})")
        return
    develop = "--develop" in sys.argv
    people = DEVELOPED if develop else REPORTED
    idle = read_idle(idle_files()[0 if develop else 1])
    play = free_play(lambda name: (name in DEVELOPED_PLAY) == develop)
    sessions = list(sessions_of(read_gestures(people, FRAME), idle, TEACHINGS, seed=SEED))
    print_sizes(sessions, people)
    found = measured(sessions, idle)
    print_sessions(found)
    print_drawn(found)
    print_idle(found)
    print_times(found)
    print_guard(idle, play)
    print_neighbours(people)


if __name__ == "__main__":
    main()
