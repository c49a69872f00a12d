"""What learned patterns accept, and what learning costs: ``python -m benchmarks.learning``.

Budget: a hundred examples within five seconds. Simulated people by default seeds; where real
gestures are at hand (``SMD_TEST_DATA``), they are told apart by the least edit distance to the
patterns of three examples per person, ours beside those paired by index as in the paper.
"""

from __future__ import annotations

import os
import re
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.process import machine
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.errors import LearningError
from smd.formats import read_recording
from smd.recognition.automaton import compile_automaton, edit_distance
from smd.recognition.generalization import MANDATORY_SHARE
from smd.recognition.learning import LearnedPattern, doodle_runs, learn_pattern, without_rest
from smd.recognition.pattern import Pattern
from smd.recognition.tokens import Token
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take
from tests.naive.learning_by_index import learned_by_index

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
TAUGHT, TRIED = 1, 99
"""Seeds of the people who teach and of those who try."""


def played(action: str, count: int, seed: int) -> list[Doodle]:
    """Return an action's gesture as played by so many people, each facing elsewhere."""
    rng = np.random.default_rng(seed)
    takes = []
    for _ in range(count):
        take = Take(simulated_person(rng), rng, heading_rad=rng.uniform(-3.0, 3.0))
        takes.append(take.pause(0.2).play(action).pause(0.3).doodle())
    return takes


def tokens_of(doodle: Doodle) -> tuple[Token, ...]:
    """Return the tokens of a gesture without the rest around it."""
    return tuple(run.token for run in without_rest(doodle_runs(doodle, DEFAULT_FIGURE_HEIGHT_M)))


def edits(pattern: Pattern, words: Sequence[tuple[Token, ...]]) -> list[int]:
    """Return the distance of each string to a pattern."""
    automaton = compile_automaton(pattern)
    return [edit_distance(automaton, word) for word in words]


def accepted_by_chance(pattern: Pattern, rng: np.random.Generator) -> float:
    """Return the share of random strings of 4 to 11 of a pattern's own tokens it accepts."""
    tokens = pattern.tokens()
    lengths = rng.integers(4, 12, 200)
    words = [tuple(tokens[i] for i in rng.integers(0, len(tokens), n)) for n in lengths]
    return float(np.mean([distance == 0 for distance in edits(pattern, words)]))


def by_simulated_people() -> None:
    """Print what patterns learned from 1, 3, 10 people accept of 20 others."""
    tried = {action: [tokens_of(d) for d in played(action, 20, TRIED)] for action in GESTURES}
    print("\nsimulated people: learned from n, tried on 20 others, eleven actions")
    print(" n  new gestures accepted  mean edits  other gestures  random strings   s a pattern")
    for count in (1, 3, 10):
        rng = np.random.default_rng(7)
        own, strangers, chance, started = [], [], [], time.process_time()
        learned = {a: learn_pattern(played(a, count, TAUGHT)).pattern for a in GESTURES}
        each_s = (time.process_time() - started) / len(learned)
        for action, pattern in learned.items():
            for other, words in tried.items():
                (own if other == action else strangers).extend(edits(pattern, words))
            if len(pattern.tokens()) > 2:
                chance.append(accepted_by_chance(pattern, rng))
        print(
            f"{count:2}  {np.mean(np.array(own) == 0):21.1%}  {np.mean(own):10.2f}"
            f"  {np.mean(np.array(strangers) == 0):14.2%}  {np.mean(chance):14.2%}  {each_s:12.2f}"
        )
    doodles = played("throw", 100, TAUGHT)
    started = time.process_time()
    learn_pattern(doodles)
    print(f"a hundred examples of a throw: {time.process_time() - started:.1f} s")


def by_index(doodles: Sequence[Doodle], learned: LearnedPattern) -> Pattern:
    """Return what pairing by index makes of the same examples and their average."""
    sequences, mandatory = [], []
    for doodle in (*doodles, learned.average):
        runs = without_rest(doodle_runs(doodle, DEFAULT_FIGURE_HEIGHT_M))
        extent = np.array([run.travel_heights + run.turn_rad for run in runs])
        sequences.append([run.token for run in runs])
        mandatory.append((extent >= MANDATORY_SHARE * extent.max()).tolist())
    return learned_by_index(sequences, mandatory)


def by_real_people() -> None:
    """Print how often the least edit distance finds the gesture, per person."""
    files: dict[int, dict[int, list[Path]]] = defaultdict(lambda: defaultdict(list))
    for path in sorted((DATA / "gestures").glob("*.csv")):
        name = re.match(r"g(\d+)_f\d_s(\d+)_e\d+", path.name)
        if name:
            files[int(name[2])][int(name[1])].append(path)
    if not files:
        print(f"\nno real gestures in {DATA}")
        return
    right: dict[str, list[bool]] = {"laid side by side": [], "paired by index": []}
    refused = patterns = 0
    for gestures in files.values():
        ours: dict[int, Pattern] = {}
        theirs: dict[int, Pattern] = {}
        rest: list[tuple[int, tuple[Token, ...]]] = []
        for gesture, paths in gestures.items():
            doodles = [read_recording(path).doodles[0] for path in paths]
            if len(doodles) < 4:
                continue
            patterns += 1
            try:
                learned = learn_pattern(doodles[:3])
            except LearningError:
                refused += 1
                continue
            ours[gesture] = learned.pattern
            theirs[gesture] = by_index(doodles[:3], learned)
            rest += [(gesture, tokens_of(doodle)) for doodle in doodles[3:]]
        for way, found in zip(right, (ours, theirs), strict=True):
            automata = {gesture: compile_automaton(pattern) for gesture, pattern in found.items()}
            for gesture, word in rest:
                nearest = min(automata, key=lambda g: edit_distance(automata[g], word))
                right[way].append(nearest == gesture)
    print(f"\nreal people ({len(files)}), 14 gestures, 3 examples each, the rest by least edits")
    print(f"refused: {refused} of {patterns}")
    for way, hits in right.items():
        print(f"{way:18} {np.mean(hits):.1%} of {len(hits)} right")


def main() -> None:
    print(machine())
    by_simulated_people()
    by_real_people()


if __name__ == "__main__":
    main()
