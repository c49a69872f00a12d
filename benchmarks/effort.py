"""How well Effort is read, and how fast: ``python -m benchmarks.effort``.

Accuracy is always on people that the model has not seen. Budget: one reading within 1 ms.
"""

from __future__ import annotations

import os
import time
from pathlib import Path

import numpy as np

from laban import AXES, Effort, EffortModel, effort_features, load_effort_model, read_effort
from laban.model import POLES
from laban.training import AxisReport
from smd.doodle import Doodle
from smd.effort import SIMULATED_SEED, Examples, read_manifest, simulated_examples
from smd.formats import SourceFrame, read_recording
from smd.geometry.arrays import FloatArray
from smd.smoothing import smooth
from smd.synthetic.efforts import simulated_player, simulated_take
from smd.synthetic.strokes import GESTURES, simulated_person
from smd.synthetic.takes import Take

DATA = (
    Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data")) / "laban"
)


PEOPLE = 12
"""New people for each figure of the shipped model."""


def auc(reading: FloatArray, meant: FloatArray) -> float:
    """Return how often a take of the high pole reads higher than one of the low pole."""
    high, low = reading[meant > 0][:, None], reading[meant < 0][None, :]
    return float(np.mean((high > low) + 0.5 * (high == low)))


def interval(right: int, count: int) -> str:
    """Return Wilson's 95 % interval of a share."""
    z, p = 1.96, right / count
    middle = (p + z * z / (2 * count)) / (1 + z * z / count)
    half = z * np.sqrt(p * (1 - p) / count + z * z / (4 * count**2)) / (1 + z * z / count)
    return f"[{middle - half:.2f}, {middle + half:.2f}]"


def line(axis: str, report: AxisReport, features: str) -> str:
    """Return an axis's figures as one line."""
    poles = report.meant != 0
    count, right = int(poles.sum()), round(report.accuracy * poles.sum())
    return (
        f"  {axis:7} accuracy {report.accuracy:.2f} {interval(right, count):13} of {count:4d}  "
        f"AUC {auc(report.reading, report.meant):.2f}  Brier {report.brier_score:.3f}  {features}"
    )


def judged(model: EffortModel, examples: Examples) -> dict[str, AxisReport]:
    """Return how a model does on takes that it has not seen."""
    reports = {}
    for axis, part in model.axes.items():
        meant = examples.meant[:, AXES.index(axis)]
        known = np.isfinite(meant)
        if known.any():
            reading = np.array([part.value(row) for row in examples.features[known]])
            reports[axis] = AxisReport(reading, meant[known], np.zeros(0))
    return reports


def print_cross_validated(examples: Examples) -> None:
    """Print each axis's accuracy with every performer left out in turn."""
    training = examples.train(trained_on="benchmark")
    for axis, report in training.reports.items():
        part = training.model.axes[axis]
        print(line(axis, report, f"{len(part.columns)} features"))


def simulated() -> None:
    """Print figures on simulated people."""
    print("simulated people of the shipped model, each left out in turn (nested)")
    print_cross_validated(simulated_examples())
    print(f"shipped model, {PEOPLE} new simulated people")
    examples = simulated_examples(people=PEOPLE, seed=SIMULATED_SEED + 1)
    reports = judged(load_effort_model(), examples)
    for axis, report in reports.items():
        print(line(axis, report, ""))
    both = np.all(examples.meant[:, :2] != 0, axis=1)
    right = [(report.reading > 0) == (report.meant > 0) for report in reports.values()]
    print(f"  both    accuracy {np.mean(np.all(right, axis=0)[both]):.2f} of {both.sum():4d}")
    for axis, report in reports.items():
        means = [report.reading[report.meant == pole].mean() for pole in (-1, 0, 1)]
        low, high = POLES[axis]
        print(
            f"  {axis:7} mean reading {low} {means[0]:+.2f}, neutral {means[1]:+.2f}, "
            f"{high} {means[2]:+.2f}"
        )


def by_action() -> None:
    """Print what the shipped model reads in each action's gesture."""
    print(f"shipped model, mean reading of {PEOPLE} people's gestures: time, weight")
    meant = {
        "sudden": Effort(time=1.0),
        "sustained": Effort(time=-1.0),
        "strong": Effort(weight=1.0),
        "light": Effort(weight=-1.0),
    }
    print(f"  {'':16}{'as in stories':>15}" + "".join(f"{word:>15}" for word in meant))
    model, rng = load_effort_model(), np.random.default_rng(SIMULATED_SEED + 2)
    for action in GESTURES:
        told = [Take(simulated_person(rng), rng).play(action).doodle() for _ in range(PEOPLE)]
        cells = [mean_reading(told, model)]
        for effort in meant.values():
            players = [simulated_player("", rng) for _ in range(PEOPLE)]
            played = [simulated_take(action, effort, player, rng) for player in players]
            cells.append(mean_reading(played, model))
        print(f"  {action:16}" + "".join(f"{cell:>15}" for cell in cells))


def mean_reading(doodles: list[Doodle], model: EffortModel) -> str:
    """Return the mean Time and Weight of doodles."""
    efforts = [read_effort(smooth(doodle), model) for doodle in doodles]
    known = [(e.time, e.weight) for e in efforts if e.time is not None]
    return "{:+.2f} {:+.2f}".format(*np.mean(known, axis=0))


def real() -> None:
    """Print figures on real people, where their takes are there."""
    if not DATA.is_dir():
        print(f"real people: no takes in {DATA}")
        return
    rows = read_manifest(DATA / "manifest.csv")
    frame = SourceFrame.from_options(up="z")
    motions = [smooth(read_recording(row.path, frame).doodles[0]) for row in rows]
    examples = Examples(
        np.array([effort_features(motion) for motion in motions]),
        np.array([row.meant for row in rows]),
        tuple(row.performer for row in rows),
    )
    print("real people who guide a robot arm, each left out in turn (nested)")
    print_cross_validated(examples)
    print("shipped model (simulated people) on these real people")
    for axis, report in judged(load_effort_model(), examples).items():
        print(line(axis, report, ""))


def speed() -> None:
    """Print the time of one reading."""
    rng = np.random.default_rng(0)
    motion = smooth(simulated_take("throw", Effort(), simulated_player("", rng), rng))
    start_s, end_s = motion.time_s[0] + 0.1, motion.time_s[-1] - 0.1
    model = load_effort_model()
    spent_ms = []
    for _ in range(300):
        begin = time.perf_counter()
        read_effort(motion.between(start_s, end_s), model)
        spent_ms.append(1e3 * (time.perf_counter() - begin))
    print(
        f"one reading of {end_s - start_s:.1f} s: median {np.median(spent_ms):.2f} ms, "
        f"95th percentile {np.percentile(spent_ms, 95):.2f} ms"
    )


def main() -> None:
    """Print every figure."""
    simulated()
    by_action()
    real()
    speed()


if __name__ == "__main__":
    main()
