"""The stand-in OpenVR runtime: built from vrclient.cpp, found by the real loader."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

HMD, CONTROLLER, TRACKER = 1, 2, 3
LEFT, RIGHT = 1, 2
TRIGGER, GRIP = 1 << 33, 1 << 2
OK, OUT_OF_RANGE = 200, 201


@dataclass
class Played:
    """A device of a scene, in our convention: times, positions and orientations of its rows."""

    kind: int
    role: int
    serial: str
    time_s: np.ndarray
    position_m: np.ndarray
    orientation_xyzw: np.ndarray
    battery: float = -1.0
    buttons: Callable[[float], int] = lambda time_s: 0
    lost: tuple[float, float] = (0.0, 0.0)
    """Not seen from … to …"""
    away: tuple[float, float] = (0.0, 0.0)
    """Not connected from … to …"""

    def lines(self, index: int) -> list[str]:
        """Return the scene's lines: OpenVR's device faces -Z, ours is turned half round Y."""
        q = self.orientation_xyzw
        # q * (0, 1, 0, 0), the half turn about Y, written out
        theirs = np.stack([-q[:, 2], q[:, 3], q[:, 0], -q[:, 1]], axis=1)
        lines = [f"device {index} {self.kind} {self.role} {self.serial} stand-in {self.battery}"]
        for time_s, position, quaternion in zip(self.time_s, self.position_m, theirs, strict=True):
            gone = self.away[0] <= time_s < self.away[1]
            unseen = gone or self.lost[0] <= time_s < self.lost[1]
            numbers = " ".join(f"{value:.9f}" for value in (*position, *quaternion))
            result = OUT_OF_RANGE if unseen else OK
            lines.append(
                f"row {time_s:.9f} {index} {numbers} {int(not gone)} {int(not unseen)} {result} "
                f"{self.buttons(float(time_s))}"
            )
        return lines


@dataclass
class Scene:
    """What the stand-in plays."""

    devices: Sequence[Played] = ()
    refuse: int = 0
    quit_s: float | None = None
    extra: list[str] = field(default_factory=list)

    def text(self) -> str:
        lines = [f"refuse {self.refuse}"]
        if self.quit_s is not None:
            lines.append(f"quit {self.quit_s}")
        for index, device in enumerate(self.devices):
            lines += device.lines(index)
        return "\n".join(lines) + "\n"


def compiler() -> str | None:
    """Return a C++ compiler of this machine that can build the stand-in, or None."""
    if not sys.platform.startswith("linux"):
        return None
    return shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")


def build(folder: Path) -> Path:
    """Build the stand-in into ``folder``, and return the folder of its path registry."""
    library = folder / "runtime" / "bin" / "linux64" / "vrclient.so"
    library.parent.mkdir(parents=True)
    source = Path(__file__).with_name("vrclient.cpp")
    command = [compiler(), "-O1", "-std=c++17", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror"]
    subprocess.run([*command, "-o", library, source], check=True, timeout=300)
    registry = folder / "config" / "openvr" / "openvrpaths.vrpath"
    registry.parent.mkdir(parents=True)
    paths = {"runtime": [str(folder / "runtime")], "version": 1}
    paths |= {name: [str(folder / name)] for name in ("config", "log")}
    registry.write_text(json.dumps(paths), encoding="utf-8")
    return folder / "config"


def environment(config: Path, scene: Scene, folder: Path) -> dict[str, str]:
    """Return the variables that make the loader find the stand-in, and it its scene."""
    path = folder / "scene.txt"
    path.write_text(scene.text(), encoding="utf-8")
    return {
        "XDG_CONFIG_HOME": str(config),
        "SMD_STANDIN_SCENE": str(path),
        "SMD_STANDIN_LOG": str(folder / "asked.txt"),
    }


def asked(folder: Path, word: str) -> np.ndarray:
    """Return the numbers that the stand-in logged under a word."""
    lines = (folder / "asked.txt").read_text(encoding="utf-8").splitlines()
    return np.array([float(line.split()[1]) for line in lines if line.startswith(word + " ")])


def answered(
    folder: Path,
    time_s: np.ndarray,
    position_m: np.ndarray,
    played: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Return when each frame of a take was asked for, on the scene's clock.

    Some questions come before the take, for the list of devices, and some are asked again, a
    moment later. Of the questions nearest to a frame it is the one whose answer it holds.

    Parameters
    ----------
    folder
        Of the log.
    time_s, position_m
        Of one device's frames.
    played
        Where it was at some times.
    """
    asked_s = asked(folder, "poses")

    own_s = time_s - time_s[0]

    def nearest(start_s: float) -> np.ndarray:
        after = np.clip(np.searchsorted(asked_s, own_s + start_s), 1, len(asked_s) - 1)
        return after - (2.0 * (own_s + start_s) < asked_s[after - 1] + asked_s[after])

    def misfit_s(start_s: float) -> float:
        return float(np.median(np.abs(asked_s[nearest(start_s)] - own_s - start_s)))

    start_s = min(asked_s[:8], key=misfit_s)
    # A machine that stalls may ask several times before a frame is written.
    beside = np.clip(nearest(start_s)[:, None] + np.arange(-8, 9), 0, len(asked_s) - 1)
    there_m = played(asked_s[beside].ravel()).reshape(*beside.shape, 3)
    off_m = np.linalg.norm(there_m - position_m[:, None], axis=2)
    off_m += 1e-3 * np.abs(asked_s[beside] - (own_s + start_s)[:, None])  # at rest, the nearest
    rows = beside[np.arange(len(beside)), off_m.argmin(axis=1)]
    assert len(set(rows)) == len(rows), "a sample is there twice"
    return asked_s[rows]
