from __future__ import annotations

import numpy as np
import pytest

from benchmarks.greedy import MOST_EDITS, MOST_WRONG, longest_match_segments
from smd.recognition.automaton import compile_automaton, edit_distance
from smd.recognition.bank import compile_library
from smd.recognition.costs import DEFAULT_COSTS
from smd.recognition.pattern import Pattern
from smd.recognition.segmentation import Segment
from smd.recognition.token_spotter import recognize
from smd.recognition.tokens import Token, TokenRun

PATTERNS = {
    "walk": Pattern.parse("T_Z"),
    "punch": Pattern.parse("T_Z T_N_Z"),
    "wave": Pattern.parse("T_X (T_N_X T_X)+"),
}
BANK = compile_library(PATTERNS)
NAMES = ("T_Z", "T_N_Z", "T_X", "T_N_X", "R_Y")


def runs_of(names):
    return tuple(
        TokenRun(Token.parse(name), 18 * i, 18 * i + 18, 0.3 * i, 0.3 * i + 0.3, 1.0)
        for i, name in enumerate(names)
    )


def segments(text):
    return longest_match_segments(BANK, runs_of(text.split()), DEFAULT_COSTS)


def every_match(names):
    """The same choice, by measuring every action on every part."""
    found, at = [], 0
    while at < len(names):
        ways = []
        for last in range(at + 1, len(names) + 1):
            word = tuple(map(Token.parse, names[at:last]))
            for index, pattern in enumerate(PATTERNS.values()):
                d = edit_distance(compile_automaton(pattern), word)
                if d <= min(MOST_WRONG * len(word), MOST_EDITS) and d < len(word):
                    ways.append((d - len(word), d, len(word), index))
        if not ways:
            at += 1
            continue
        _, _, length, index = min(ways)
        found.append(Segment(index, at, at + length))
        at += length
    return tuple(found)


@pytest.mark.parametrize("seed", range(60))
def test_it_takes_what_measuring_every_part_takes(seed):
    rng = np.random.default_rng(seed)
    names = [NAMES[i] for i in rng.integers(len(NAMES), size=rng.integers(1, 20))]
    assert longest_match_segments(BANK, runs_of(names), DEFAULT_COSTS) == every_match(names)


def test_the_largest_token_sequence_has_priority():
    assert segments("T_Z T_N_Z") == (Segment(1, 0, 2),)
    assert segments("T_X T_N_X T_X T_N_X T_X T_Z") == (Segment(2, 0, 5), Segment(0, 5, 6))


def test_what_matches_nothing_is_passed_over():
    assert segments("R_Y T_Z R_Y") == (Segment(0, 1, 2),)
    assert segments("") == ()
    assert longest_match_segments(compile_library({}), runs_of(["T_Z"]), DEFAULT_COSTS) == ()


def test_it_sees_actions_in_the_least_movement_as_the_paper_does():
    twitch = (TokenRun(Token.parse("T_Z"), 0, 3, 0.0, 0.05, 0.01),)
    assert recognize(twitch, PATTERNS) == ()
    (span,) = recognize(twitch, PATTERNS, segments=longest_match_segments)
    assert span.action == "walk"
