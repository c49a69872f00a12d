"""Reading recordings: how fast, and what is found in files that others made.

``python -m benchmarks.reading``. Budgets: three minutes of two devices at 90 Hz within 0.3 s, a
million rows within a few seconds, on one core.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from itertools import combinations
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks.process import machine
from smd.doodle import Doodle, Recording
from smd.formats import SourceFrame, read_recording, write_recording
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import quaternion_from_euler, rotate
from smd.smoothing import smooth

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))


def recording(rows: int, devices: int) -> Recording:
    """Return hands that move and turn all along, at 90 Hz."""
    t = np.arange(rows // devices) / 90.0
    position = np.stack([np.sin(t), np.cos(2 * t), np.sin(0.1 * t)], axis=1)
    q = quaternion_from_euler("YXZ", np.stack([t, np.sin(t), np.cos(1.3 * t)], axis=1))
    return Recording(tuple(Doodle(t, position, q, f"prop{i + 1}") for i in range(devices)))


def seconds(work: Callable[[], object], times: int) -> float:
    """Return the median processor time of a call; other work on the machine does not count."""
    measured = []
    for _ in range(times):
        started = time.process_time()
        work()
        measured.append(time.process_time() - started)
    return median(measured)


def speed(folder: Path) -> None:
    """Print times of writing and reading."""
    for rows, devices, times in ((32_400, 2, 7), (1_000_000, 1, 3)):
        path = folder / f"{rows}.csv"
        whole = recording(rows, devices)
        wrote = seconds(lambda path=path, whole=whole: write_recording(whole, path), 1)
        read = seconds(lambda path=path: read_recording(path), times)
        size = path.stat().st_size / 1e6
        print(f"{rows:9,} rows, {size:5.1f} MB: read in {read:.3f} s, written in {wrote:.3f} s")


def spin_axis(path: Path, order: str) -> FloatArray:
    """Return the axis of the world about which a kettle turns most."""
    motion = smooth(read_recording(path, SourceFrame(quaternion=order)).doodles[0])
    spin = rotate(motion.orientation_xyzw, motion.angular_velocity_rad_s)
    return np.asarray(np.linalg.svd(spin, full_matrices=False)[2][0])


def kettle(folder: Path) -> None:
    """Print how far apart the axes of the six pourings are, by order of the quaternion."""
    files = sorted(folder.glob("*_ref_*.csv"))
    for order in ("xyzw", "wxyz"):
        axes = [spin_axis(path, order) for path in files]
        apart = [np.degrees(np.arccos(min(1.0, abs(a @ b)))) for a, b in combinations(axes, 2)]
        print(
            f"kettle, {len(files)} pourings read as {order}: axes of turning "
            f"{np.median(apart):.0f} degrees apart (median), {max(apart):.0f} at most"
        )


def idle(folder: Path) -> None:
    """Print what was lost in hands that wait, and the fastest step before and after."""
    frame = SourceFrame.from_options(handedness="left")
    raw, kept, lost_s, kinds = 0.0, 0.0, 0.0, {"gap": 0, "frozen": 0, "invalid": 0}
    for path in sorted(folder.glob("*.csv")):
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        steps = np.linalg.norm(np.diff(rows[:, 1:4], axis=0), axis=1) / np.diff(rows[:, 0])
        raw = max(raw, float(steps.max()))
        found = read_recording(path, frame)
        for doodle in found.doodles:
            step_m = np.linalg.norm(np.diff(doodle.position_m, axis=0), axis=1)
            kept = max(kept, float((step_m / np.diff(doodle.time_s)).max()))
        for dropout in found.dropouts:
            kinds[dropout.kind] += 1
            lost_s += dropout.end_s - dropout.start_s
    counts = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
    print(f"idle hands: {counts}; {lost_s:.0f} s lost")
    print(f"fastest step {raw:.0f} m/s in the files, {kept:.0f} m/s in the doodles")


def main() -> None:
    print(machine())
    with tempfile.TemporaryDirectory() as folder:
        speed(Path(folder))
    if DATA.is_dir():
        kettle(DATA / "controllers" / "kettle")
        idle(DATA / "idle")
    else:
        print(f"real recordings absent: {DATA}")


if __name__ == "__main__":
    main()
