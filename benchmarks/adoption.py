"""Bringing one's own: what loading and importing cost: `python -m benchmarks.adoption`.

What is found out about clips is measured by `benchmarks.stages`.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from actions_library.folder import load_library
from actions_library.importers import import_file

DATA = Path(__file__).parents[2] / "shared" / "data" / "clips"


def seconds(work: Callable[[], object]) -> float:
    """Return the least of three times."""
    times = []
    for _ in range(3):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return min(times)


def print_costs() -> None:
    """Print what loading, importing and skinning cost."""
    print(f"loading the shipped library: {seconds(load_library):.2f} s")
    walk = DATA / "bvh" / "cmu_12_01_walk.bvh"
    if walk.is_file():
        head, _, motion = walk.read_text().partition("MOTION")
        rows = motion.strip().splitlines()[2:]
        rows = (rows * (4500 // len(rows) + 1))[:4500]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "long.bvh")
            text = f"{head}MOTION\nFrames: 4500\nFrame Time: 0.00833333\n" + "\n".join(rows)
            path.write_text(text)
            cost = seconds(lambda: import_file(path))
        print(f"importing a BVH file of 4500 frames and 31 joints: {cost:.2f} s")


def main() -> None:
    """Print every figure."""
    print_costs()


if __name__ == "__main__":
    main()
