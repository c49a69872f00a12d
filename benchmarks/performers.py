"""How well simulated performers' rows of actions are read: ``python -m benchmarks.performers``.

Each of 20 people teaches all shipped actions by three examples and then plays rows of them.
Nothing was fitted to these people. Goals: 99 % of the actions in rows of 2 to 3, 97 % in rows of 5
to 15, punch against throw 97 %. Beside it stands the paper's form: unit costs, greedy longest
match.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from smd.doodle import Doodle
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition import Recognizer, learn_action
from smd.recognition.greedy import longest_match_segments
from smd.recognition.recognizer import recognize
from smd.smoothing import smooth
from smd.synthetic.strokes import GESTURES, Person, simulated_person
from smd.synthetic.takes import Take

PEOPLE, EXAMPLES, SEED = 20, 3, 20260
ROWS = ((2, 3, 6), (5, 15, 3))
"""Fewest and most actions in a row, and rows a person plays."""

DRIFT_RAD, DRIFT_S = np.radians(15.0), (15.0, 40.0)
"""How far, and in how long a period, a person slowly turns about while playing."""

LEFT_HANDED = 0.3
"""Share of people who hold the prop in their left hand: habits mirrored."""


def performer(index: int) -> tuple[Person, np.random.Generator]:
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
    return person, rng


def drifting(doodle: Doodle, rng: np.random.Generator) -> Doodle:
    """Return a doodle whose player slowly turns to and fro, with the prop in place.

    Every step of the way is turned as the player is then; turning the whole way about a point
    would carry a prop a metre away faster than a resting hand ever moves.
    """
    period_s, phase = rng.uniform(*DRIFT_S), rng.uniform(0.0, 2.0 * np.pi)
    angle = DRIFT_RAD * np.sin(2.0 * np.pi * doodle.time_s / period_s + phase)
    turn = quaternion_about([0.0, 1.0, 0.0], angle)
    way = np.cumsum(rotate(turn[1:], np.diff(doodle.position_m, axis=0)), axis=0)
    return replace(
        doodle,
        position_m=np.concatenate([doodle.position_m[:1], doodle.position_m[0] + way]),
        orientation_xyzw=multiply(turn, doodle.orientation_xyzw),
    )


def row(person: Person, rng: np.random.Generator, actions: Sequence[str]) -> tuple[Take, Doodle]:
    """Return a row of actions with pauses between them."""
    take = Take(person, rng, heading_rad=rng.uniform(-np.pi, np.pi)).pause(0.5)
    for action in actions:
        take.play(action).pause(float(rng.uniform(0.3, 1.0)))
    return take, drifting(take.doodle(), rng)


def edits(meant: Sequence[str], found: Sequence[str]) -> int:
    """Return how many actions are missing, too many or wrong."""
    above = list(range(len(found) + 1))
    for i, a in enumerate(meant, 1):
        here = [i]
        for j, b in enumerate(found, 1):
            here.append(min(above[j] + 1, here[-1] + 1, above[j - 1] + (a != b)))
        above = here
    return above[-1]


def main() -> None:
    """Print the simulator's parameters and the share of actions read right."""
    print(f"{PEOPLE} people, {EXAMPLES} examples an action; parameters of the first three:")
    for index in range(3):
        person, _ = performer(index)
        values = {f.name: np.round(getattr(person, f.name), 4).tolist() for f in fields(person)}
        print(f"  {values}")
    print(f"  and facing drifts by {np.degrees(DRIFT_RAD):.0f} degrees in {DRIFT_S} s")
    played = dict.fromkeys(ROWS, 0)
    wrong = {(kind, form): 0 for kind in ROWS for form in ("ours", "paper")}
    pair = pair_right = 0
    for index in range(PEOPLE):
        person, rng = performer(index)
        examples = {
            action: [row(person, rng, [action])[1] for _ in range(EXAMPLES)] for action in GESTURES
        }
        actions = [learn_action(name, doodles) for name, doodles in examples.items()]
        recognizer = Recognizer(actions)
        patterns = {action.name: action.pattern for action in actions if action.pattern}
        for kind in ROWS:
            for _ in range(kind[2]):
                names = rng.choice(list(GESTURES), int(rng.integers(kind[0], kind[1] + 1)))
                take, doodle = row(person, rng, names.tolist())
                meant = [phrase.action for phrase in take.phrases]
                motion = smooth(doodle)
                runs = recognizer.runs_of(doodle, motion)
                ours = [span.action for span in recognizer.spot_runs(motion, runs)]
                greedy = recognize(runs, patterns, segments=longest_match_segments)
                played[kind] += len(meant)
                wrong[kind, "ours"] += edits(meant, ours)
                wrong[kind, "paper"] += edits(meant, [span.action for span in greedy])
        for name in ("punch", "throw") * 3:
            best = recognizer.rank(row(person, rng, [name])[1])[0].action
            pair += 1
            pair_right += best == name
    for kind in ROWS:
        shares = [1.0 - wrong[kind, form] / played[kind] for form in ("ours", "paper")]
        print(
            f"rows of {kind[0]} to {kind[1]}, {played[kind]} actions: ours {100 * shares[0]:.1f} %,"
            f" greedy longest match with unit costs {100 * shares[1]:.1f} %"
        )
    print(f"punch against throw: {100.0 * pair_right / pair:.1f} % of {pair}")


if __name__ == "__main__":
    main()
