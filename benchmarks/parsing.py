"""What parsing saves by what is made once: ``python -m benchmarks.parsing``.

Goal: `smd.parse` in a loop over the stories takes at most 0.6 of the processor time of the same
loop that makes the `Recognizer` and reads the Effort model anew for each, as was done before
`smd.Parser`. Both are timed in turn in one run.
"""

from __future__ import annotations

import time
from pathlib import Path
from statistics import median

import smd
from actions_library.library import Library
from benchmarks.process import machine
from laban.model_file import load_effort_model
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M
from smd.recognition import Recognizer

ROOT = Path(__file__).parents[1]
MODEL = ROOT / "laban" / "models" / "default.json"
TIMES, GOAL = 10, 0.6


def kept(library: Library, recording: smd.Recording) -> None:
    """Parse a recording, as a program does that parses many."""
    smd.parse(recording, library)


def anew(library: Library, recording: smd.Recording) -> None:
    """Parse a recording, and make for it what the one before had already."""
    Recognizer(library.actions, figure_height_m=DEFAULT_FIGURE_HEIGHT_M)
    load_effort_model(MODEL)
    smd.parse(recording, library)


def main() -> None:
    """Print what each story takes either way, and the ratio over all of them."""
    library = smd.load_library()
    total_s = {"kept": 0.0, "anew": 0.0}
    print(machine())
    print(f"processor time of parsing, median of {TIMES} in turn:")
    for path in sorted((ROOT / "recordings").glob("*.csv")):
        recording = smd.read_recording(path)
        spent_s: dict[str, list[float]] = {"kept": [], "anew": []}
        for turn in range(TIMES + 1):
            for name, parse in (("kept", kept), ("anew", anew)):
                started = time.process_time()
                parse(library, recording)
                if turn:  # after one round to warm up
                    spent_s[name].append(time.process_time() - started)
        took_s = {name: median(each) for name, each in spent_s.items()}
        total_s = {name: total_s[name] + took_s[name] for name in took_s}
        print(f"  {path.name}: {_compared(took_s)}")
    met = total_s["kept"] <= GOAL * total_s["anew"]
    print(f"  all: {_compared(total_s)}; goal {GOAL}: {'met' if met else 'missed'}")


def _compared(took_s: dict[str, float]) -> str:
    kept_ms, anew_ms = 1e3 * took_s["kept"], 1e3 * took_s["anew"]
    return f"{kept_ms:.0f} ms kept, {anew_ms:.0f} ms anew, ratio {kept_ms / anew_ms:.2f}"


if __name__ == "__main__":
    main()
