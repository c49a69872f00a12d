"""Whole-process measurements, and the machine they were taken on."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from statistics import median

# A child's peak memory counts from what its parent held when it was started, so each command is
# started from a process that holds next to nothing. Windows has no `resource`: no peak there.
_STOPWATCH = """
import json, subprocess, sys, time
started = time.perf_counter()
code = subprocess.call(sys.argv[1:], stdout=subprocess.DEVNULL)
wall_s = time.perf_counter() - started
try:
    import resource
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
except ImportError:
    peak = None
print(json.dumps([code, wall_s, peak]))
"""


@dataclass(frozen=True, slots=True)
class Runs:
    """Wall times of several runs of one command, and the largest memory of any."""

    wall_s: tuple[float, ...]
    peak_mib: float | None

    def __str__(self) -> str:
        memory = "" if self.peak_mib is None else f", peak {self.peak_mib:.0f} MiB"
        return (
            f"median {median(self.wall_s):.2f} s "
            f"({min(self.wall_s):.2f} – {max(self.wall_s):.2f}){memory}"
        )


def run(*commands: list[str], times: int = 5) -> list[Runs]:
    """Run the commands in turn, ``times`` each after one warm-up, and measure each process."""
    walls: list[list[float]] = [[] for _ in commands]
    peaks: list[float | None] = [None for _ in commands]
    for turn in range(times + 1):
        for index, command in enumerate(commands):
            wall_s, peak_mib = _measure(command)
            if turn:
                walls[index].append(wall_s)
                if peak_mib is not None:
                    peaks[index] = max(peak_mib, peaks[index] or 0.0)
    return [Runs(tuple(wall), peak) for wall, peak in zip(walls, peaks, strict=True)]


def _measure(command: list[str]) -> tuple[float, float | None]:
    """Run one command; return its wall time in seconds and its peak memory in MiB."""
    watch = [sys.executable, "-S", "-c", _STOPWATCH, *command]
    said = subprocess.run(watch, stdout=subprocess.PIPE, check=True, text=True).stdout
    code, wall_s, peak = json.loads(said)
    if code:
        raise SystemExit(f"exit code {code}: {' '.join(command)}")
    unit = 1024.0**2 if sys.platform == "darwin" else 1024.0  # bytes there, KiB elsewhere
    return wall_s, None if peak is None else peak / unit


def picture_folder() -> Path | None:
    """Return the folder that ``--picture FOLDER`` names on the command line, if it does."""
    where = sys.argv.index("--picture") + 1 if "--picture" in sys.argv else 0
    return Path(sys.argv[where]) if where else None


def machine() -> str:
    """Return the machine and the versions in one line."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "usd-core"))
    return (
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores, "
        f"Python {platform.python_version()}, {packages}"
    )
