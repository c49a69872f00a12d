"""Parsing on two cores: ``python -m benchmarks.parallel``.

Goal: a pool of two processes parses 40 copies of the stories at least 1.7 times as fast as one
process. Both are timed in turn in one run, wall time, on a machine with nothing else to do. The two
are started anew each time, and that counts: each imports, receives the `Parser` and compiles.

Whether the machine has two cores to spare is told by a loop of bare Python, timed the same way:
where that gains less, so does parsing.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from statistics import median

import smd
from benchmarks.process import machine

RECORDINGS = Path(__file__).parents[1] / "recordings"
COPIES, PROCESSES, TIMES, GOAL = 40, 2, 3, 1.7
LOOP = 20_000_000


def alone(parser: smd.Parser, recordings: Sequence[smd.Recording]) -> list[smd.Score]:
    """Parse recordings one after the other."""
    return [parser.parse(recording) for recording in recordings]


def pooled(parser: smd.Parser, recordings: Sequence[smd.Recording]) -> list[smd.Score]:
    """Parse recordings in a pool, in portions of a quarter of what a process is to do."""
    portion = -(-len(recordings) // (4 * PROCESSES))
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        return list(pool.map(parser.parse, recordings, chunksize=portion))


def loop(count: int) -> int:
    """Keep a processor busy, with nothing but Python."""
    total = 0
    for i in range(count):
        total += i
    return total


def loops_gain() -> float:
    """Return how many times as fast two loops are in two processes as in one."""
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        list(pool.map(loop, PROCESSES * [1000]))  # started
        started = time.perf_counter()
        for _ in range(PROCESSES):
            pool.submit(loop, LOOP).result()
        alone_s = time.perf_counter() - started
        started = time.perf_counter()
        list(pool.map(loop, PROCESSES * [LOOP]))
        return alone_s / (time.perf_counter() - started)


def main() -> None:
    """Print the seconds of each and their ratio."""
    stories = [smd.read_recording(path) for path in sorted(RECORDINGS.glob("*.csv"))]
    recordings = COPIES * stories
    parser = smd.Parser(smd.load_library())
    spent_s: dict[str, list[float]] = {"one": [], "two": []}
    alone(parser, stories)  # to warm up
    for _ in range(TIMES):
        found = {}
        for name, parse in (("one", alone), ("two", pooled)):
            started = time.perf_counter()
            found[name] = parse(parser, recordings)
            spent_s[name].append(time.perf_counter() - started)
        if found["one"] != found["two"]:
            raise SystemExit("two processes found other Scores than one")
    print(machine())
    print(
        f"two loops of bare Python are {loops_gain():.2f} times as fast in two processes as in one"
    )
    print(f"{COPIES} copies of {len(stories)} stories, median of {TIMES} (least to most):")
    for name, took_s in spent_s.items():
        print(f"  {name}: {median(took_s):.2f} s ({min(took_s):.2f} to {max(took_s):.2f})")
    ratio = median(spent_s["one"]) / median(spent_s["two"])
    verdict = "met" if ratio >= GOAL else "missed"
    print(f"two are {ratio:.2f} times as fast as one; goal {GOAL}: {verdict}")


if __name__ == "__main__":
    main()
