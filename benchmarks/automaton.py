"""What finding every shipped action in token strings costs: ``python -m benchmarks.automaton``.

Budgets: time linear in the string's length, its 99th percentile at most 3 times its median; at 100
tokens at least 10 times as fast as the fuzzy BESTMATCH of the ``regex`` package (``pip install
.[bench]``) on the same patterns and strings; a streaming step within 0.3 ms, 99 times in 100. Times
are processor time of one thread.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping

import numpy as np

from actions_library.authoring.actions import HUMANOID_ACTIONS
from benchmarks.process import machine
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.recognition import pattern as ast
from smd.recognition.bank import Bank, compile_library, occurrences
from smd.recognition.streaming import BLOCK_S, RecognitionStream
from smd.recognition.token_spotter import TokenSpotter
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import Token, TokenRun
from smd.smoothing import smooth
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

PATTERNS = {action.name: action.pattern for action in HUMANOID_ACTIONS if action.pattern}
LENGTHS = (30, 100, 300, 1000)
STRINGS = 120
"""Per length."""
REGEX_STRINGS = 5
TIMEOUT_S = 1.0
"""For one pattern on one string."""
PEOPLE = 12


def milliseconds(job: Callable[[], object]) -> float:
    """Return the processor time of one call."""
    started = time.thread_time()
    job()
    return 1e3 * (time.thread_time() - started)


def doodles() -> list[Doodle]:
    """Return a row of all gestures by each of several simulated people."""
    rows = []
    for index in range(PEOPLE):
        rng = np.random.default_rng([31, index])
        take = Take(simulated_person(rng), rng).pause(0.6)
        for action in rng.permutation(list(GESTURES)):
            take.play(str(action)).pause(float(rng.uniform(0.2, 1.0)))
        rows.append(take.doodle())
    return rows


def strings(runs: list[TokenRun], length: int, count: int) -> list[tuple[Token, ...]]:
    """Return strings cut from what people drew, each from a place of its own, end to end."""
    tokens = [run.token for run in runs]
    tokens = tokens * (1 + length // len(tokens)) * 2
    rng = np.random.default_rng(length)
    begin = rng.integers(len(tokens) - length, size=count)
    return [tuple(tokens[i : i + length]) for i in begin]


def percentiles(times: Iterable[float]) -> tuple[float, float]:
    """Return the median and the 99th percentile."""
    median, most = np.percentile(list(times), [50.0, 99.0])
    return float(median), float(most)


def print_lengths(bank: Bank, runs: list[TokenRun]) -> None:
    """Print time by length, the line through it, and its spread."""
    occurrences(bank, [run.token for run in runs[:100]])
    lengths: list[int] = []
    times: list[float] = []
    print(f"all {len(bank)} actions, every end of a string; ms of {STRINGS} strings each")
    for length in LENGTHS:
        spent = [
            milliseconds(lambda w=w: occurrences(bank, w)) for w in strings(runs, length, STRINGS)
        ]  # type: ignore[misc]
        median, most = percentiles(spent)
        print(
            f"  {length:5d} tokens: median {median:7.2f}, 99th percentile {most:7.2f} "
            f"({most / median:.2f} times)"
        )
        lengths += [length] * len(spent)
        times += spent
    slope, offset = np.polyfit(lengths, times, 1)
    left = np.array(times) - (slope * np.array(lengths) + offset)
    r2 = 1.0 - left.var() / np.var(times)
    print(f"  line: {offset:.3f} ms + {1e3 * slope:.1f} us a token, R^2 = {r2:.4f}")


def in_letters(node: ast.Node, letters: Mapping[Token, str]) -> str:
    """Return an expression over tokens as one over letters, for ``regex``."""
    match node:
        case Token():
            return letters[node]
        case ast.Sequence(parts):
            return "".join(in_letters(part, letters) for part in parts)
        case ast.Choice(options):
            return "(?:" + "|".join(in_letters(option, letters) for option in options) + ")"
        case ast.Repeat(body, optional):
            return f"(?:{in_letters(body, letters)})" + ("*" if optional else "+")


def print_regex(bank: Bank, runs: list[TokenRun]) -> None:
    """Print the time that ``regex`` takes for the best fuzzy match of each pattern, beside ours."""
    try:
        import regex
    except ImportError:
        print("regex is not installed: nothing to compare with (pip install .[bench])")
        return
    known = {run.token for run in runs}.union(*(p.tokens() for p in PATTERNS.values()))
    letters = {token: chr(0x4E00 + i) for i, token in enumerate(sorted(known))}
    print(
        f"regex {regex.__version__}, BESTMATCH, all patterns in turn, {REGEX_STRINGS} strings of "
        f"a length, {TIMEOUT_S:g} s at most for a pattern; ms a string"
    )
    for errors in ("{e}", "{e<=2}"):
        compiled = [
            regex.compile(f"(?:{in_letters(p.root, letters)}){errors}", regex.BESTMATCH)
            for p in PATTERNS.values()
        ]
        for length in (30, 100):
            ours, theirs, late = [], [], 0
            for word in strings(runs, length, REGEX_STRINGS):
                text = "".join(letters[token] for token in word)
                ours.append(milliseconds(lambda w=word: occurrences(bank, w)))  # type: ignore[misc]
                started = time.thread_time()
                for one in compiled:
                    try:
                        one.search(text, timeout=TIMEOUT_S)
                    except TimeoutError:
                        late += 1
                theirs.append(1e3 * (time.thread_time() - started))
            a, b = float(np.median(ours)), float(np.median(theirs))
            print(
                f"  {errors:7} {length:5d} tokens: ours {a:7.2f}, theirs {b:9.2f} "
                f"({b / a:.1f} times), {late} of {len(compiled) * REGEX_STRINGS} timed out"
            )


def print_streaming(bank: Bank, rows: list[Doodle]) -> None:
    """Print what a token costs a bank, and what a sample costs a stream."""
    runs = [run for row in rows for run in tokenize(smooth(row))]
    front = bank.nowhere()
    steps = []
    for j, read in enumerate(bank.reading(run.token for run in runs)):
        started = time.thread_time()
        front = bank.after(front, entering=0.0, at=j, read=read, skip=1.0)
        bank.leaving(front)
        steps.append(1e3 * (time.thread_time() - started))
    print(
        "streaming, ms: median {:.3f}, 99th percentile {:.3f} a token of a bank".format(
            *percentiles(steps)
        )
    )
    pushes: list[float] = []
    seconds: list[float] = []
    for row in rows:
        stream = RecognitionStream(TokenSpotter(bank))
        spent = []
        for sample in zip(row.time_s, row.position_m, row.orientation_xyzw, strict=True):
            started = time.thread_time()
            stream.push(*sample)
            spent.append(1e3 * (time.thread_time() - started))
        pushes += spent
        rate = int((len(row) - 1) / row.duration_s)
        seconds += _means(spent, rate)
    print(
        "  a sample of a stream, smoothing and all, averaged over a second: "
        "median {:.3f}, 99th percentile {:.3f}".format(*percentiles(seconds))
    )
    print(
        "  a single push: median {:.3f}, 99th percentile {:.3f} ".format(*percentiles(pushes))
        + f"(one in {round(BLOCK_S * rate)} does the work of all)"
    )


def _means(values: list[float], count: int) -> list[float]:
    """Return the means of ``count`` values each, a last part left out."""
    whole: FloatArray = np.array(values[: len(values) // count * count])
    return [float(mean) for mean in whole.reshape(-1, count).mean(axis=1)]


def main() -> None:
    """Print every figure."""
    print(machine())
    bank = compile_library(PATTERNS)
    rows = doodles()
    runs = [run for row in rows for run in tokenize(smooth(row))]
    print_lengths(bank, runs)
    print_regex(bank, runs)
    print_streaming(bank, rows)


if __name__ == "__main__":
    main()
