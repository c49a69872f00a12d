"""Unit against graded costs, the cheapest cut against the longest match, on tokens alone:
``python -m benchmarks.token_costs``.

Real gestures (SHREC'17, people 1 to 7) are told by the nearest example's token string; simulated
people play the shipped gestures in a row; idle hands mean nothing. Nothing was fitted to these
simulated people.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from actions_library.authoring.actions import HUMANOID_ACTIONS
from benchmarks import gestures
from benchmarks.greedy import longest_match_segments
from benchmarks.performers import edits
from smd.errors import SmdError
from smd.formats import SourceFrame, read_recording
from smd.recognition import pattern as ast
from smd.recognition.bank import compile_library, distances
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segmenter, least_cost_segments
from smd.recognition.token_costs import TokenCosts, graded_costs, unit_costs
from smd.recognition.token_spotter import recognize
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import Token, TokenRun
from smd.smoothing import smooth
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
PATTERNS = {action.name: action.pattern for action in HUMANOID_ACTIONS if action.pattern}
EXAMPLES, SPLITS, PEOPLE, SEED = 3, 5, 20, 77

Runs = tuple[TokenRun, ...]


def as_pattern(word: Sequence[Token]) -> Pattern:
    """Return the pattern of one string."""
    return Pattern(ast.Sequence(tuple(word)) if len(word) > 1 else word[0])


def real_gestures() -> dict[int, dict[int, list[tuple[Token, ...]]]]:
    """Return token strings by person and gesture."""
    found: dict[int, dict[int, list[tuple[Token, ...]]]] = {}
    for path in sorted((DATA / "gestures").glob("*.csv")):
        gesture, person = map(int, re.findall(r"g(\d+)_f\d_s(\d+)_", path.stem)[0])
        if person <= 7:
            runs = tokenize(smooth(read_recording(path).doodles[0]))
            word = tuple(run.token for run in runs)
            found.setdefault(person, {}).setdefault(gesture, []).append(word)
    return found


def told_right(people: dict[int, dict[int, list[tuple[Token, ...]]]], costs: TokenCosts) -> float:
    """Return the share of gestures whose nearest example, of the same person, is of their kind."""
    rng = np.random.default_rng(SEED)
    right = []
    for classes in people.values():
        for _ in range(SPLITS):
            examples, rest = {}, []
            for gesture, words in classes.items():
                order = rng.permutation(len(words))
                for i in order[:EXAMPLES]:
                    examples[f"{gesture} {i}"] = words[i]
                rest += [(gesture, words[i]) for i in order[EXAMPLES:]]
            bank = compile_library({n: as_pattern(w) for n, w in examples.items()}, costs)
            length = np.array([len(word) for word in examples.values()])
            for gesture, word in rest:
                far = distances(bank, word) / np.maximum(length, len(word))
                right.append(int(bank.names[int(far.argmin())].split()[0]) == gesture)
    return float(np.mean(right))


def rows(fewest: int, most: int) -> list[tuple[list[str], Runs]]:
    """Return actions that simulated people play in a row, and the tokens of it."""
    played = []
    for index in range(PEOPLE):
        rng = np.random.default_rng([SEED, index, most])
        person = simulated_person(rng)
        for _ in range(3):
            take = Take(person, rng).pause(0.6)
            count = rng.integers(fewest, most + 1)
            names = [str(name) for name in rng.choice(list(GESTURES), count)]
            for name in names:
                take.play(name).pause(float(rng.uniform(0.4, 1.2)))
            played.append((names, tokenize(smooth(take.doodle()))))
    return played


def idle_runs() -> tuple[list[Runs], float]:
    """Return tokens of hands that mean nothing, and how many minutes they last."""
    found, all_s = [], 0.0
    for path in sorted((DATA / "idle").glob("*.csv")):
        for doodle in read_recording(path, SourceFrame(handedness="left")).doodles:
            try:
                found.append(tokenize(smooth(doodle)))
            except SmdError:  # too short to smooth
                continue
            all_s += doodle.duration_s
    return found, all_s / 60.0


def main() -> None:
    """Print every figure."""
    kinds = (unit_costs(), graded_costs())
    if (DATA / "gestures").is_dir():
        people = real_gestures()
        for costs in kinds:
            share = 100.0 * told_right(people, costs)
            print(f"SHREC, {len(people)} people, {EXAMPLES} examples: {costs.name} {share:.1f} %")
        data = gestures.read_gestures(gestures.REPORTED)
        every = gestures.within_people(data)
        splits = every[: len(every) // gestures.SPLITS]  # the first of each person
        for costs in kinds:
            share, _ = gestures.accuracy(partial(gestures.ours, token_costs=costs), data, splits)
            print(f"  with verification, people 8 to 14: {costs.name} {100.0 * share:.1f} %")
    short, long = rows(2, 3), rows(5, 15)
    idle, minutes = idle_runs()
    ways: tuple[tuple[TokenCosts, Segmenter], ...] = (
        *((costs, least_cost_segments) for costs in kinds),
        (unit_costs(), longest_match_segments),
    )
    print(f"{PEOPLE} simulated people, shipped patterns: actions right; false on idle hands")
    for costs, segments in ways:
        bank = compile_library(PATTERNS, costs)
        right = []
        for played in (short, long):
            wrong = sum(
                edits([s.action for s in recognize(runs, bank, segments=segments)], names)
                for names, runs in played
            )
            right.append(100.0 - 100.0 * wrong / sum(len(names) for names, _ in played))
        false = sum(len(recognize(runs, bank, segments=segments)) for runs in idle)
        rate = f"{false / minutes:.1f} a minute" if idle else "data absent"
        print(
            f"  {segments.__name__:24} {costs.name:7} 2-3 in a row {right[0]:5.1f} %, "
            f"5-15 {right[1]:5.1f} %, idle {rate}"
        )


if __name__ == "__main__":
    main()
