"""What a performer's own examples add to others': ``python -m benchmarks.own_examples``.

Hands before a camera (SHREC'17, 14 gestures). An action is learned from five examples of five
other people; to them come 0 to 3 of the performer's own (`add_examples`). The rest of the
performer's takes is tested, the same ones however many own examples there are. How much an own
example counts for (`smd.recognition.exemplar`: ``STRANGERS``, ``FARTHER``) was chosen on people 1
to 7; people 8 to 14 are to report. Goals: accuracy and F1 rise with each own example, and one goes
at least half the way of three.

F1 is that of single takes, of which a library knows all gestures but three: a take is right where
it passes and is named as what it is, and wrong where it passes as anything else. The last row is
of performers who rehearsed half of the gestures, tested with all. ``--sessions`` prints instead
F1 in composed sessions (`benchmarks.composed`), which nothing says what is meant in, and
``--shipped`` what own taps add to the shipped `push`, and own shakes to `wave`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from actions_library.folder import load_library
from benchmarks.composed import FRAME, Teaching, idle_files, read_idle, session_of
from benchmarks.gestures import DATA, REPORTED, Gestures, read_gestures
from benchmarks.tally import Tally, tally
from smd.doodle import Doodle
from smd.errors import LearningError
from smd.geometry.arrays import FloatArray
from smd.recognition import Recognizer, add_examples, learn_action
from smd.recognition.action import Action
from smd.recognition.exemplar import exemplar_of
from smd.recognition.rehearsal import Likeness, likeness

CHOSEN_ON = tuple(range(1, 8))
OTHERS, MOST_OWN, UNKNOWN = 5, 3, 3
SPLITS, SEED = 3, 31
NEIGHBOURS = {"push": 2, "wave": 14}
"""Shipped actions, and the gestures that are most like them: tap and shake."""

ROWS = ("accuracy", "F1, three gestures unknown", "accuracy, half rehearsed")


@dataclass(frozen=True)
class Split:
    """A performer, and whose takes are shown and tested, by gesture and number.

    Attributes
    ----------
    others, own : ``OTHERS`` and ``MOST_OWN`` of each gesture.
    tested : of the same gestures, the rest of the performer's.
    shuffled : the gestures; F1 leaves the first out, and half of them are rehearsed.
    """

    others: Mapping[int, list[int]]
    own: Mapping[int, list[int]]
    tested: list[int]
    shuffled: list[int]


def splits_of(data: Gestures) -> Iterator[Split]:
    """Yield each person as a performer, with the gestures that they have enough takes of."""
    for number in range(SPLITS):
        rng = np.random.default_rng([SEED, number])
        for person in np.unique(data.person):
            others, own, tested = {}, {}, []
            for label in np.unique(data.label).tolist():
                takes = rng.permutation(np.flatnonzero(data.label == label))
                theirs = takes[data.person[takes] != person]
                _, of_each = np.unique(data.person[theirs], return_index=True)
                mine = takes[data.person[takes] == person].tolist()
                if len(of_each) >= OTHERS and len(mine) > MOST_OWN:
                    others[label] = theirs[np.sort(of_each)[:OTHERS]].tolist()
                    own[label] = mine[:MOST_OWN]
                    tested += mine[MOST_OWN:]
            if len(own) > UNKNOWN:
                yield Split(others, own, tested, rng.permutation(list(own)).tolist())


def looked_at(data: Gestures, actions: Iterable[Action], tested: Iterable[int]) -> list[Likeness]:
    """Return what takes look like; each is asked for as what it is."""
    recognizer = Recognizer(actions)
    return [likeness(recognizer, str(data.label[i]), data.doodles[i]) for i in tested]


@dataclass(frozen=True)
class Figures:
    """What came out.

    Attributes
    ----------
    rows : (3, 4), percent, in the order of ``ROWS``, with 0 to ``MOST_OWN`` own examples.
    refused : (2,), percent of takes that are taken for another action than the one asked for,
        with no own examples: of takes of that one, and of takes of all others.
    tested : how many takes.
    """

    rows: FloatArray
    refused: FloatArray
    tested: int


def figures(data: Gestures) -> Figures:
    """Return what own examples add for the people of some gestures."""
    right, right_of_half, hits, passed = np.zeros((4, MOST_OWN + 1))
    refused, asked = np.zeros((2, 2))
    tested = known = 0
    for split in splits_of(data):
        of_others = {
            label: _learned(str(label), [data.doodles[i] for i in ids])
            for label, ids in split.others.items()
        }
        held = split.shuffled[UNKNOWN:]
        half = split.shuffled[: len(split.shuffled) // 2]
        tested += len(split.tested)
        known += int(np.isin(data.label[split.tested], held).sum())
        for count in range(MOST_OWN + 1):
            own = {
                label: add_examples(action, [data.doodles[i] for i in split.own[label][:count]])
                for label, action in of_others.items()
            }
            mixed = {**of_others, **{label: own[label] for label in half}}
            looks = looked_at(data, own.values(), split.tested)
            right[count] += sum(one.place == 1 for one in looks)
            looks_of_half = looked_at(data, mixed.values(), split.tested) if count else looks
            right_of_half[count] += sum(one.place == 1 for one in looks_of_half)
            for one in looked_at(data, [own[label] for label in held], split.tested):
                named = one.matches[0].action
                passed[count] += named is not None
                hits[count] += named == one.action
            if count == 0:
                for one, label in product(looks, of_others):
                    other = int(str(label) != one.action)
                    refused[other] += Likeness(str(label), one.matches).is_another
                    asked[other] += 1
    f1 = 2.0 * hits / (passed + known)
    rows = 100.0 * np.array([right / tested, f1, right_of_half / tested])
    return Figures(rows, 100.0 * refused / asked, tested)


def f1_of_sessions(people: Sequence[int], idle: Sequence[Doodle]) -> tuple[FloatArray, Tally]:
    """Return F1 in sessions, in percent, with 0 to ``MOST_OWN`` own examples; and what with most.

    Each person plays some sessions to a full library; they are the same for all counts.
    """
    data = read_gestures(people, FRAME)
    counts = [Tally() for _ in range(MOST_OWN + 1)]
    for person, number in product(people, range(SPLITS)):
        of_others: dict[str, Action] = {}
        for own in range(MOST_OWN + 1):
            rng = np.random.default_rng([SEED, number, person])
            teaching = Teaching(own=own, others=OTHERS, set_aside=MOST_OWN)
            session = session_of(data, person, teaching, idle, rng)
            if session is None:
                break
            if not own:
                of_others = {name: _learned(name, each) for name, each in session.examples.items()}
            actions = [
                add_examples(action, session.examples[name][:own])
                for name, action in of_others.items()
            ]
            counts[own] += tally(Recognizer(actions).spot(session.free), session)
    return 100.0 * np.array([one.f1 for one in counts]), counts[-1]


def print_shipped(data: Gestures) -> None:
    """Print how takes of a neighbour of a shipped action fare with some of them added to it."""
    shipped = load_library()
    for name, label in NEIGHBOURS.items():
        first, passes = np.zeros((2, MOST_OWN + 1))
        tested = 0
        for person in np.unique(data.person):
            takes = np.flatnonzero((data.person == person) & (data.label == label))
            takes = np.random.default_rng([SEED, person]).permutation(takes)
            own, rest = takes[:MOST_OWN], takes[MOST_OWN:]
            tested += len(rest)
            for count in range(MOST_OWN + 1 if len(rest) else 0):
                taught = add_examples(shipped.action(name), [data.doodles[i] for i in own[:count]])
                known = [taught if one.name == name else one for one in shipped.actions]
                recognizer = Recognizer(known)
                looks = [likeness(recognizer, name, data.doodles[i]) for i in rest]
                first[count] += sum(one.place == 1 for one in looks)
                passes[count] += sum(one.place == 1 and one.share() <= 1.0 for one in looks)
        print_row(f"{tested} as {name}: first", 100.0 * first / tested)
        print_row(f"{tested} as {name}: first, and passes", 100.0 * passes / tested)


def _learned(name: str, doodles: Sequence[Doodle]) -> Action:
    """Return an action that is learned from other people's takes."""
    try:
        return learn_action(name, doodles, own=False)
    except LearningError:  # they have nothing in common: the pattern of one, all as examples
        one = learn_action(name, doodles[:1], own=False)
        exemplar = add_examples(one, doodles[1:]).exemplar
        assert exemplar is not None
        return replace(one, exemplar=exemplar_of(exemplar.examples()))


def print_row(name: str, row: FloatArray) -> None:
    """Print figures with 0 to ``MOST_OWN`` own examples, and what one of them does."""
    gain = row[-1] - row[0]
    way = f"   one goes {100.0 * (row[1] - row[0]) / gain:.0f} % of the way" if gain else ""
    print(f"  {name:36}" + "".join(f"{value:8.1f}" for value in row) + way, flush=True)


def main() -> None:
    """Print a table for the people to choose on, and one for those to report."""
    if not (DATA / "gestures").is_dir():
        print(f"data absent ({DATA / 'gestures'})")
        return
    for people, purpose, files in zip(
        (CHOSEN_ON, REPORTED), ("to choose on", "to report"), idle_files(), strict=True
    ):
        if "--sessions" in sys.argv:
            f1, most = f1_of_sessions(people, read_idle(files))
            print(
                f"people {people[0]} to {people[-1]}, {purpose}: {most.known} known gestures and "
                f"{most.others} others in {most.minutes:.1f} min, {OTHERS} examples of others"
            )
            print_row("F1 in sessions", f1)
            continue
        if "--shipped" in sys.argv:
            print(f"people {people[0]} to {people[-1]}, {purpose}: by the shipped library")
            print_shipped(read_gestures(people))
            continue
        found = figures(read_gestures(people))
        print(
            f"people {people[0]} to {people[-1]}, {purpose}: {found.tested} takes tested, "
            f"{OTHERS} examples of others, {SPLITS} splits"
        )
        print(f"  {'own examples':36}" + "".join(f"{i:8}" for i in range(MOST_OWN + 1)))
        for name, row in zip(ROWS, found.rows, strict=True):
            print_row(name, row)
        of_it, of_others = found.refused
        print(
            f"  taken for another action than was asked for: {of_it:.1f} % of its own takes, "
            f"{of_others:.1f} % of others'",
            flush=True,
        )


if __name__ == "__main__":
    main()
