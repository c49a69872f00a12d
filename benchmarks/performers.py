"""How well simulated performers' rows of actions are read: ``python -m benchmarks.performers``.

Each of 20 people teaches all shipped actions by three examples and then plays rows of them.
Nothing was fitted to these people. Goals: 99 % of the actions in rows of 2 to 3, 97 % in rows of 5
to 15, punch against throw 97 %. Beside it stands the paper's form, from the same examples: its
learned patterns, unit costs, greedy longest match; its users reached 94 % and 90 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from benchmarks.greedy import longest_match_segments
from smd.doodle import Doodle
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition import Recognizer, learn_action
from smd.recognition.token_spotter import recognize
from smd.smoothing import smooth
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import STEADY, Person, simulated_person
from smd.synthetic.takes import Take

PEOPLE, EXAMPLES, SEED = 20, 3, 20260
ROWS = ((2, 3, 6), (5, 15, 3))
"""Fewest and most actions in a row, and rows a person plays."""

DRIFT_RAD, DRIFT_S = np.radians(15.0), (15.0, 40.0)
"""How far, and in how long a period, a person slowly turns about while playing."""

DIFFICULTIES = (0.0, 0.25, 0.5, 1.0)
"""How far people are from nobody in particular, who makes no errors, to as various as `PEOPLE`."""

LEFT_HANDED = 0.3
"""Share of people who hold the prop in their left hand: habits mirrored."""


def performer(index: int, difficulty: float) -> tuple[Person, np.random.Generator]:
    """Return one of the people, and the source of all that differs in what they do."""
    rng = np.random.default_rng([SEED, index])
    person = simulated_person(rng)
    if rng.random() < LEFT_HANDED:
        x, y, z = person.grip_m
        left, front = person.askew_rad
        person = replace(
            person,
            grip_m=(-x, y, z),
            askew_rad=(left, -front),
            misfacing_rad=-person.misfacing_rad,
        )
    return eased(person, difficulty), rng


def eased(person: Person, difficulty: float) -> Person:
    """Return a person whose habits and errors are a share of another one's."""
    shares = {}
    for field in fields(person):
        none, all_ = (np.asarray(getattr(one, field.name)) for one in (STEADY, person))
        if field.name in ("size", "pace"):
            shares[field.name] = (all_**difficulty).tolist()
        else:
            share = none + difficulty * (all_ - none)
            counted = isinstance(getattr(person, field.name), int)
            shares[field.name] = round(float(share)) if counted else share.tolist()
    return replace(person, **shares)


def drifting(doodle: Doodle, rng: np.random.Generator, most_rad: float) -> Doodle:
    """Return a doodle whose player slowly turns to and fro, with the prop in place.

    Every step of the way is turned as the player is then; turning the whole way about a point
    would carry a prop a metre away faster than a resting hand ever moves.
    """
    period_s, phase = rng.uniform(*DRIFT_S), rng.uniform(0.0, 2.0 * np.pi)
    angle = most_rad * np.sin(2.0 * np.pi * doodle.time_s / period_s + phase)
    turn = quaternion_about([0.0, 1.0, 0.0], angle)
    way = np.cumsum(rotate(turn[1:], np.diff(doodle.position_m, axis=0)), axis=0)
    return replace(
        doodle,
        position_m=np.concatenate([doodle.position_m[:1], doodle.position_m[0] + way]),
        orientation_xyzw=multiply(turn, doodle.orientation_xyzw),
    )


def row(
    person: Person, rng: np.random.Generator, actions: Sequence[str], difficulty: float
) -> tuple[Take, Doodle]:
    """Return a row of actions with pauses between them."""
    take = Take(person, rng, heading_rad=rng.uniform(-np.pi, np.pi)).pause(0.5)
    for action in actions:
        take.play(action).pause(float(rng.uniform(0.3, 1.0)))
    return take, drifting(take.doodle(), rng, difficulty * DRIFT_RAD)


def edits(meant: Sequence[str], found: Sequence[str]) -> int:
    """Return how many actions are missing, too many or wrong."""
    above = list(range(len(found) + 1))
    for i, a in enumerate(meant, 1):
        here = [i]
        for j, b in enumerate(found, 1):
            here.append(min(above[j] + 1, here[-1] + 1, above[j - 1] + (a != b)))
        above = here
    return above[-1]


@dataclass
class EditCounts:
    """How many actions were played, and how many edits from them each form is."""

    played: int = 0
    ours: int = 0
    paper: int = 0


def played_at(difficulty: float) -> tuple[dict[tuple[int, int, int], EditCounts], tuple[int, int]]:
    """Return what was read of rows of each kind, and how often punch and throw were right."""
    tallies = {kind: EditCounts() for kind in ROWS}
    pair = right = 0
    for index in range(PEOPLE):
        person, rng = performer(index, difficulty)
        examples = {
            action: [row(person, rng, [action], difficulty)[1] for _ in range(EXAMPLES)]
            for action in GESTURES
        }
        actions = [learn_action(name, doodles) for name, doodles in examples.items()]
        recognizer = Recognizer(actions)
        patterns = {action.name: action.pattern for action in actions if action.pattern}
        for kind, tally in tallies.items():
            for _ in range(kind[2]):
                names = rng.choice(list(GESTURES), int(rng.integers(kind[0], kind[1] + 1)))
                take, doodle = row(person, rng, names.tolist(), difficulty)
                meant = [phrase.action for phrase in take.phrases]
                motion = smooth(doodle)
                runs = recognizer.runs_of(doodle, motion)
                ours = [span.action for span in recognizer.spot_runs(motion, runs)]
                greedy = recognize(runs, patterns, segments=longest_match_segments)
                tally.played += len(meant)
                tally.ours += edits(meant, ours)
                tally.paper += edits(meant, [span.action for span in greedy])
        for name in ("punch", "throw") * 3:
            best = recognizer.rank(row(person, rng, [name], difficulty)[1])[0].action
            pair += 1
            right += best == name
    return tallies, (right, pair)


def main() -> None:
    """Print the simulator's parameters and the share of actions read right."""
    print(f"{PEOPLE} people, {EXAMPLES} examples an action; parameters of the first three:")
    for index in range(3):
        person, _ = performer(index, 1.0)
        values = {f.name: np.round(getattr(person, f.name), 4).tolist() for f in fields(person)}
        print(f"  {values}")
    print(f"  and facing drifts by {np.degrees(DRIFT_RAD):.0f} degrees in {DRIFT_S} s")
    print("difficulty: what is left of all that; actions right, ours and the paper's form")
    for difficulty in DIFFICULTIES:
        tallies, (right, pair) = played_at(difficulty)
        shares = ", ".join(
            f"rows of {kind[0]} to {kind[1]}: {100 * (1 - tally.ours / tally.played):5.1f} % and "
            f"{100 * (1 - tally.paper / tally.played):5.1f} % of {tally.played}"
            for kind, tally in tallies.items()
        )
        print(
            f"  {difficulty:4.2f}  {shares}; punch against throw {100.0 * right / pair:.1f} % "
            f"of {pair}",
            flush=True,
        )


if __name__ == "__main__":
    main()
