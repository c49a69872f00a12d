"""How well gestures are found among all else that hands do: ``python -m benchmarks.sessions``.

Composed sessions (`benchmarks.composed`) of people 8 to 14 with the pauses of nine idle hands;
``--develop`` takes people 1 to 7 and nine others, and is the one to choose by. Beside ours stand a
plain spotter by warping (`benchmarks.plain_spotter`) and the form with limits
(`benchmarks.limits`), on the same sessions in the same run. Goals: F1 0.05 above the plain spotter
and twice that with limits; with the trigger held 92 % of the known takes found, and at tolerance
0.8 half of the others left alone; 0.3 false a minute in idle hands where 70 % of drawn takes are
found.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.folder import load_library
from benchmarks.composed import (
    FEW_CLASSES,
    FRAME,
    Session,
    Teaching,
    idle_files,
    minutes_of,
    read_idle,
    sessions_of,
    tremble,
)
from benchmarks.gestures import DATA, REPORTED, learned_action, read_gestures
from benchmarks.guards import (
    Make,
    Spots,
    free_play,
    print_guard,
    print_neighbours,
    spans_in,
)
from benchmarks.limits import LimitRecognizer
from benchmarks.plain_spotter import PlainSpotter
from benchmarks.tally import Tally, f1_gain_interval, f1_interval, tally
from benchmarks.variants import VARIANTS
from smd.doodle import Doodle
from smd.recognition import Recognizer

DEVELOPED = tuple(range(1, 8))
TEACHINGS = (Teaching(own=2), Teaching(own=3), Teaching(others=10))
SEED = 2029
IDLE_PARTS = 3
"""Each library looks at one of so many parts of the idle hands, in turn: all would take as long as
the sessions, and tell little more."""

STRICT = 0.8
"""A tolerance at which more is left alone."""

OURS, LIMITS, PLAIN = "ours", "with limits", "plain spotter"

FORMS: Mapping[str, Make] = {OURS: Recognizer, LIMITS: LimitRecognizer}
"""Those that take actions; the plain spotter takes examples."""

FREE, DRAWN, DRAWN_STRICT = "free", "drawn", f"drawn, tolerance {STRICT:g}"
"""What is said of drawing: nothing, or when the trigger is held."""


@dataclass(frozen=True, slots=True)
class Trial:
    """What one form found in one session.

    Attributes
    ----------
    form, said : which form, and what it was told of drawing.
    teaching, small, person : how its library was taught, whether it is a small one, and who plays.
    counts : against the truth.
    making_s, spotting_s : processor time, to learn and make it ready, and for the session.
    idle, idle_minutes : spans in idle hands, and how long those are that were looked at.
    """

    form: str
    said: str
    teaching: Teaching
    small: bool
    person: int
    counts: Tally
    making_s: float
    spotting_s: float
    idle: int = 0
    idle_minutes: float = 0.0


@dataclass(frozen=True, slots=True)
class TrialSet:
    """All trials, to choose from."""

    every: tuple[Trial, ...]

    def of(self, form: str, said: str, teaching: Teaching, small: bool | None = None) -> TrialSet:
        """Return those of a form, what is said, a teaching and, if asked for, a size."""
        return TrialSet(
            tuple(
                one
                for one in self.every
                if (one.form, one.said, one.teaching) == (form, said, teaching)
                and small in (None, one.small)
            )
        )

    @property
    def counts(self) -> Tally:
        """All counts together."""
        return sum((one.counts for one in self.every), Tally())

    @property
    def by_person(self) -> list[Tally]:
        """The counts of each person, in their order."""
        people: dict[int, Tally] = defaultdict(Tally)
        for one in self.every:
            people[one.person] += one.counts
        return [people[person] for person in sorted(people)]


def trials(sessions: Sequence[Session], idle: Sequence[Doodle]) -> TrialSet:
    """Let every form find what it can in every session, and in idle hands."""
    found: list[Trial] = []
    for number, session in enumerate(sessions, 1):
        for form, spots, making_s, said in _forms(session):
            for what in said:
                started = time.process_time()
                spans = spots.spot(session.free if what == FREE else session.drawn)
                spotting_s = time.process_time() - started
                looks = what == FREE and form not in VARIANTS
                looked_at = idle[number % IDLE_PARTS :: IDLE_PARTS] if looks else ()
                trial = Trial(
                    form=form,
                    said=what,
                    teaching=session.teaching,
                    small=len(session.examples) == FEW_CLASSES,
                    person=session.person,
                    counts=tally(spans, session),
                    making_s=making_s,
                    spotting_s=spotting_s,
                    idle=sum(spans_in(looked_at, spots).values()),
                    idle_minutes=minutes_of(looked_at),
                )
                found.append(trial)
        print(
            f"session {number} of {len(sessions)}: person {session.person}, {session.teaching}, "
            f"{len(session.examples)} classes, {session.free.duration_s:.0f} s",
            file=sys.stderr,
            flush=True,
        )
    return TrialSet(tuple(found))


def _forms(session: Session) -> Iterator[tuple[str, Spots, float, Sequence[str]]]:
    """Yield each form of a session's library, its making, and what it is to be told of drawing."""
    started = time.process_time()
    actions = [learned_action(name, list(own)) for name, own in session.examples.items()]
    learning_s = time.process_time() - started
    for form, make in {**FORMS, **VARIANTS}.items():
        started = time.process_time()
        made = make(actions)
        making_s = learning_s + time.process_time() - started
        yield form, made, making_s, (FREE, DRAWN)
    started = time.process_time()
    plain = PlainSpotter(session.examples)
    yield PLAIN, plain, time.process_time() - started, (FREE, DRAWN)
    yield OURS, Recognizer(actions, tolerance=STRICT), 0.0, (DRAWN_STRICT,)
    yield LIMITS, LimitRecognizer(actions, tolerance=STRICT), 0.0, (DRAWN_STRICT,)


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
    told = [f"{1e3 * m:.2f} mm and {np.degrees(rad):.2f} degrees" for m, rad in tremble(sessions)]
    print(f"at rest, hands tremble by {told[0]} within takes, by {told[1]} between", flush=True)


def print_found(found: TrialSet, said: str) -> None:
    """Print what is found in the sessions, and what ours gains over the others."""
    print(
        "  taught       form           F1 (95 % over people)  of 6, of all  recall  precision  "
        "false/min  begin, end off: median, 90 %"
    )
    for teaching in TEACHINGS:
        for form in (*FORMS, PLAIN, *VARIANTS):
            some = found.of(form, said, teaching)
            if not some.every:
                continue
            whole = some.counts
            low, high = f1_interval(some.by_person)
            small, full = (found.of(form, said, teaching, size).counts.f1 for size in (True, False))
            print(
                f"  {teaching!s:12} {form:14} {whole.f1:4.2f} ({low:.2f} to {high:.2f})     "
                f"{small:.2f}, {full:.2f}    {whole.recall:5.2f}  {whole.precision:9.2f}  "
                f"{whole.false_a_minute:9.1f}  {_off(whole)}"
            )
        ours = found.of(OURS, said, teaching)
        for form in (LIMITS, PLAIN):
            theirs = found.of(form, said, teaching)
            gain = ours.counts.f1 - theirs.counts.f1
            low, high = f1_gain_interval(ours.by_person, theirs.by_person)
            print(
                f"  {teaching!s:12} ours above {form}: {gain:+.2f} ({low:+.2f} to {high:+.2f}), "
                f"{ours.counts.f1 / max(theirs.counts.f1, 1e-9):.2f} times"
            )


def _off(whole: Tally) -> str:
    """Return how far from the truth the hits begin and end."""
    if not whole.off_s:
        return "no hits"
    middle, most = np.percentile(np.abs(whole.off_s), (50, 90), axis=0)
    return f"{middle[0]:.2f}, {middle[1]:.2f} s; {most[0]:.2f}, {most[1]:.2f} s"


def print_drawn(found: TrialSet) -> None:
    """Print what is said of takes with the trigger held, known and of other classes."""
    print("with the trigger held: known takes found, and others of which nothing is said")
    for teaching in TEACHINGS:
        for form in FORMS:
            for said, tolerance in ((DRAWN, 1.0), (DRAWN_STRICT, STRICT)):
                whole = found.of(form, said, teaching).counts
                print(
                    f"  {teaching!s:12} {form:12} tolerance {tolerance:3.1f}: "
                    f"{100.0 * whole.recall:5.1f} % of {whole.known}, "
                    f"{100.0 * whole.left_alone:5.1f} % of {whole.others} left alone"
                )


def print_idle(found: TrialSet) -> None:
    """Print what the sessions' libraries find in idle hands, beside their recall of takes."""
    print(
        "idle hands with every session's library: how long, false a minute, and in the worst "
        "library; known takes found, free and with the trigger held"
    )
    for teaching in TEACHINGS:
        for form in (*FORMS, PLAIN):
            free = found.of(form, FREE, teaching)
            drawn = found.of(form, DRAWN, teaching)
            seen, minutes = np.array([(one.idle, one.idle_minutes) for one in free.every]).T
            print(
                f"  {teaching!s:12} {form:14} {minutes.sum():5.1f} min, "
                f"{seen.sum() / minutes.sum():5.2f}, {(seen / minutes).max():5.2f}; "
                f"{100.0 * free.counts.recall:5.1f} %, {100.0 * drawn.counts.recall:5.1f} %"
            )


def print_times(found: TrialSet) -> None:
    """Print what each form took, with small libraries and with full ones."""
    print(
        "processor time a minute of session without a trigger, of 6 classes and of all; to learn "
        "and make ready a library of each"
    )
    for teaching in TEACHINGS:
        for form in (*FORMS, PLAIN, *VARIANTS):
            told = []
            for small in (True, False):
                some = found.of(form, FREE, teaching, small)
                spotting_s = sum(one.spotting_s for one in some.every)
                making_s = np.mean([one.making_s for one in some.every])
                told.append((spotting_s / some.counts.minutes, making_s))
            (few, few_made), (full, full_made) = told
            print(
                f"  {teaching!s:12} {form:14} {1e3 * few:6.0f}, {1e3 * full:6.0f} ms; "
                f"{few_made:5.2f}, {full_made:5.2f} s"
            )


def main() -> None:
    """Print every figure, of the people to report on or to choose by."""
    if not (DATA / "gestures").is_dir():
        print(f"data absent ({DATA / 'gestures'})")
        return
    develop = "--develop" in sys.argv
    people = DEVELOPED if develop else REPORTED
    idle = read_idle(idle_files()[0 if develop else 1])
    sessions = list(sessions_of(read_gestures(people, FRAME), idle, TEACHINGS, seed=SEED))
    print_sizes(sessions, people)
    actions = load_library().actions
    print_guard(FORMS, actions, idle, free_play(develop=develop))
    print_neighbours(FORMS, actions, people)
    found = trials(sessions, idle)
    print("sessions of which nothing says what is meant")
    print_found(found, FREE)
    print("the same with the trigger held")
    print_found(found, DRAWN)
    print_drawn(found)
    print_idle(found)
    print_times(found)


if __name__ == "__main__":
    main()
