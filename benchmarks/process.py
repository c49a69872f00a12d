"""Whole-process measurements, and the machine they were taken on."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from dataclasses import dataclass
from importlib.metadata import version
from statistics import median


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
    peaks: list[list[float]] = [[] for _ in commands]
    for turn in range(times + 1):
        for index, command in enumerate(commands):
            started = time.perf_counter()
            child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
            peak_mib = _wait(child)
            wall_s = time.perf_counter() - started
            if child.returncode:
                raise SystemExit(f"exit code {child.returncode}: {' '.join(command)}")
            if turn:
                walls[index].append(wall_s)
                peaks[index].append(peak_mib)
    return [
        Runs(tuple(wall), max(peak) if all(peak) else None)
        for wall, peak in zip(walls, peaks, strict=True)
    ]


def _wait(child: subprocess.Popen[bytes]) -> float:
    """Wait for a child and return its peak memory in MiB; 0 where the system does not say."""
    if not hasattr(os, "wait4"):  # Windows
        child.wait()
        return 0.0
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_maxrss / (1024.0 if sys.platform != "darwin" else 1024.0**2)


def machine() -> str:
    """Return the machine and the versions in one line."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("numpy", "scipy", "usd-core"))
    return (
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores, "
        f"Python {platform.python_version()}, {packages}"
    )
