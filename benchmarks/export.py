"""How long it takes to write and to draw: `python -m benchmarks.export`.

Budgets: 3 minutes of two devices, at the 60 frames a second of smoothed motion, are written to
.usdc in 1 s (within the 5 s that `smd convert` may take); the library is read in 0.2 s once USD
is loaded; a filmstrip of ten rows is drawn in 12 s (within the 20 s of `smd demo`).
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from actions_library.folder import load_library
from benchmarks.process import machine
from smd.acting.performance import Actor, Performance
from smd.character.poses import Poses
from smd.doodle import Doodle
from smd.score import Phrase

RUNS = 5


def walking(seconds: float, rate_hz: float) -> Performance:
    """Return two of the shipped humanoid that walk on the spot where their clip ends."""
    library = load_library()
    clip = library.clip("walk")
    frames = round(seconds * rate_hz) + 1
    rng = np.random.default_rng(0)
    time_s = np.arange(frames) / rate_hz
    actors = []
    for index, device in enumerate(("left", "right")):
        phase = (np.arange(frames) + 20 * index) % len(clip)
        translation = clip.translation_m[phase].copy()
        translation[:, 0, 0] += index
        # A little noise: no two frames are equal, so that USD cannot store one for both.
        rotation = clip.rotation_xyzw[phase] + rng.normal(0.0, 1e-4, (frames, 27, 4))
        rotation /= np.linalg.norm(rotation, axis=-1, keepdims=True)
        starts = np.arange(1.0, seconds - 2.0, max(seconds / 10.0, 3.0)).tolist()
        phrases = tuple(Phrase("walk", s, s + 2.0) for s in starts)
        doodle = Doodle(
            time_s, rng.normal(0.0, 1.0, (frames, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (frames, 1))
        )
        poses = Poses(rotation, translation)
        actors.append(Actor(device, library.character, poses, phrases, (doodle,)))
    return Performance(rate_hz, 0.0, tuple(actors))


def timed(work: Callable[[], object], runs: int = RUNS) -> str:
    """Return the least, median and greatest time of several runs, in seconds."""
    seconds = []
    for _ in range(runs):
        started = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - started)
    return f"{min(seconds):6.2f} {np.median(seconds):6.2f} {max(seconds):6.2f}"


def main() -> None:
    from exporters import write
    from exporters.filmstrip import write_filmstrip

    print(machine())
    print(f"seconds, of {RUNS} runs                     least median greatest")
    folder = load_library().folder  # named, it is read anew each time
    load_library(folder).clips  # noqa: B018  USD is loaded from here on
    print(f"read the shipped library, clips and all {timed(lambda: load_library(folder).clips)}")
    take = walking(180.0, 60.0)
    with tempfile.TemporaryDirectory() as to_folder:
        for suffix in (".usdc", ".usdz", ".usda"):
            path = Path(to_folder) / f"take{suffix}"
            spent = timed(lambda path=path: write(take, path))
            size = path.stat().st_size / 1e6
            print(f"write 2 x {len(take)} frames, {suffix}, {size:4.0f} MB  {spent}")
        short = Path(to_folder) / "short.usdc"
        write(walking(30.0, 24.0), short)
        for rows in (1, 10):
            picture = short.with_suffix(".png")
            spent = timed(lambda n=rows, to=picture: write_filmstrip(short, to, rows=n), 3)
            print(f"draw a filmstrip of {rows:2d} rows of 8          {spent}")


if __name__ == "__main__":
    main()
