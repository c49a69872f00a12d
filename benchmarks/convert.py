"""Whole conversions: a 3-minute, two-device recording at 90 Hz, and what length costs.

Budgets on 2 cores: ``smd convert`` to .usdc at most 3 s as a whole process, 3 times the floor, and
1 GiB at its peak; its cost linear in length, and 30 minutes within 1.5 GiB; ``smd --help`` at most
0.4 s; ``import smd`` at most 0.1 s. The floor is a bare script that reads the same CSV with NumPy
and authors arrays of the same size through pxr.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.process import machine, run

FLOOR = """
import sys
import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

recording, output, frames, joints, actors, points = *sys.argv[1:3], *map(int, sys.argv[3:])
with open(recording) as lines:
    header = next(i for i, line in enumerate(lines) if line[0].isdigit())
rows = np.loadtxt(recording, delimiter=",", skiprows=header, usecols=(0, 2, 3, 4, 5, 6, 7, 8))
stage = Usd.Stage.CreateNew(output)
for actor in range(actors):
    UsdSkel.Root.Define(stage, f"/stage/actor{actor}")
    animation = UsdSkel.Animation.Define(stage, f"/stage/actor{actor}/animation")
    animation.CreateJointsAttr([f"joint{j}" for j in range(joints)])
    rotations, translations = animation.CreateRotationsAttr(), animation.CreateTranslationsAttr()
    animation.CreateScalesAttr(Vt.Vec3hArray(joints, Gf.Vec3h(1, 1, 1)))
    mesh = UsdGeom.Mesh.Define(stage, f"/stage/actor{actor}/mesh")
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.zeros((points, 3), np.float32)))
    quaternions = np.tile(np.float32([0, 0, 0, 1]), (frames, joints, 1))
    offsets = np.zeros((frames, joints, 3), np.float32)
    with Sdf.ChangeBlock():
        for frame in range(frames):
            rotations.Set(Vt.QuatfArray.FromNumpy(quaternions[frame]), frame)
            translations.Set(Vt.Vec3fArray.FromNumpy(offsets[frame]), frame)
curve = UsdGeom.BasisCurves.Define(stage, "/stage/doodle")
curve.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(rows[:, 1:4].astype(np.float32)))
curve.CreateCurveVertexCountsAttr([len(rows)])
stage.GetRootLayer().Save()
"""


LENGTHS_MIN = (1, 3, 10, 30)


def timed(name: str, work: Callable[[], Any]) -> Any:
    """Run one stage of the pipeline and print its time."""
    started = time.perf_counter()
    result = work()
    print(f"  {name:<10} {time.perf_counter() - started:6.3f} s")
    return result


def processor_s(work: Callable[[], Any]) -> float:
    """Return the processor time of some work."""
    started = time.process_time()
    work()
    return time.process_time() - started


def print_ratios(parse: Callable[[], Any], animate: Callable[..., Any]) -> None:
    """Print what animate takes in parts of what parse takes, one after the other, again and again.

    A ratio in one run says the same on a busy machine as on a free one, and on a fast as on a slow.
    """
    rounds = [
        (
            processor_s(parse),
            processor_s(animate),
            processor_s(lambda: animate(expressiveness=0.0)),
            processor_s(lambda: animate(timing="drawn")),
        )
        for _ in range(5)
    ]
    parsed, *others = np.array(rounds).T
    for name, taken in zip(("animate", "without Effort", "as drawn"), others, strict=True):
        ratios = taken / parsed
        print(
            f"  {name:<14} {np.median(ratios):.2f} of parse's processor time "
            f"({ratios.min():.2f} – {ratios.max():.2f})"
        )


def print_lengths() -> None:
    """Print what conversions of other lengths cost, one run each after another."""
    from benchmarks.takes import long_recording
    from smd.formats import write_recording

    with tempfile.TemporaryDirectory() as folder:
        take, output = Path(folder, "take.csv"), Path(folder, "take.usdc")
        for minutes in LENGTHS_MIN:
            write_recording(long_recording(duration_s=60.0 * minutes, rate_hz=90.0), take)
            command = [sys.executable, "-m", "smd.cli", "convert", str(take), "-o", str(output)]
            (once,) = run(command, times=1)
            peak = "" if once.peak_mib is None else f", peak {once.peak_mib:.0f} MiB"
            print(
                f"smd convert, {minutes:2d} min: {once.wall_s[0]:6.2f} s, "
                f"{once.wall_s[0] / minutes:.2f} s a minute{peak}"
            )


def main() -> None:
    import smd
    from benchmarks.takes import long_recording
    from smd.formats import write_recording

    print(machine())
    with tempfile.TemporaryDirectory() as folder:
        take, output = Path(folder, "take.csv"), Path(folder, "take.usdc")
        write_recording(long_recording(duration_s=180.0, rate_hz=90.0), take)
        print("stages, in one warm process:")
        recording = timed("read", lambda: smd.read_recording(take))
        library = timed("library", smd.load_library)
        score = timed("parse", lambda: smd.parse(recording, library))
        performance = timed("animate", lambda: smd.animate(score, recording, library))
        timed("write", lambda: smd.write(performance, output))
        print_ratios(
            lambda: smd.parse(recording, library),
            lambda **options: smd.animate(score, recording, library, **options),
        )
        character = library.character
        print(
            f"  {sum(len(d) for d in recording.doodles)} rows, "
            f"{sum(len(part.phrases) for part in score.performers)} phrases, "
            f"{len(performance)} frames, {output.stat().st_size / 2**20:.1f} MiB"
        )

        python = sys.executable
        floor = Path(folder, "floor.py")
        floor.write_text(FLOOR, encoding="utf-8")
        sizes = [
            len(performance),
            len(character.skeleton),
            len(performance.actors),
            sum(len(mesh.points_m) for mesh in character.meshes),
        ]
        command = [python, "-m", "smd.cli", "convert", str(take), "-o"]
        both = Path(folder, "both.usdc")
        whole, varied, bare = run(
            [*command, str(output)],
            [*command, str(both), "--variants"],
            [python, str(floor), str(take), str(Path(folder, "floor.usdc")), *map(str, sizes)],
        )
        print(f"smd convert      {whole}   (budget 3 s, 1024 MiB)")
        print(f"with --variants  {varied}")
        large, small = (path.stat().st_size / 2**20 for path in (both, output))
        print(f"its file         {large:.1f} MiB, without {small:.1f} MiB")
        print(f"floor            {bare}")
        print(f"ratio            {median(whole.wall_s) / median(bare.wall_s):.2f}")

    print_lengths()
    help_, empty, import_smd = run(
        [python, "-m", "smd.cli", "--help"], [python, "-c", ""], [python, "-c", "import smd"]
    )
    print(f"smd --help       {help_}   (budget 0.4 s)")
    print(f"import smd       {import_smd}   (budget 0.1 s; an empty Python: {empty})")


if __name__ == "__main__":
    main()
