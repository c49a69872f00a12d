"""How well Effort is read, and how fast: ``python -m benchmarks.laban``.

Accuracy is always on people that nothing was learned from. Goals on real people: 0.87 over the
axes, 0.91 with their own takes; on simulated ones 0.95 for Time and Weight and 0.85 for both
together where the paper's method reaches about 0.80, 0.80 and 0.50. Budgets: 5 ms for a reading of
10 s, 0.2 ms a sample for a stream.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.papers_effort import fit_papers_method
from benchmarks.process import picture_folder, run
from laban import AXES, EffortModel, EffortStream, RigidMotion, load_effort_model, read_effort
from laban.committee import folds
from laban.description import describe
from laban.effort import POLES
from laban.features import effort_features
from laban.model import effort_of
from laban.own import OwnMeasure, measure_of
from laban.training import AxisReport, Training
from smd.doodle import Doodle, Recording
from smd.effort import (
    SIMULATED_SEED,
    TrainingSet,
    accuracy_interval,
    read_manifest,
    recording_efforts,
)
from smd.effort import simulated_examples as simulated
from smd.formats import SourceFrame, read_recording, write_recording
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.smoothing import smooth
from smd.synthetic.efforts import SPREAD, Spread, fourfold_takes, with_noise

SHARED = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
DATA = SHARED / "laban"
PEOPLE, REPEATS, SEED = 48, 4, SIMULATED_SEED + 1
"""Of the simulated people of each difficulty; not those of the shipped model."""

DIFFICULTIES = (0.5, 0.75, 1.0)
"""How far simulated people and takes differ, as a share of `SPREAD`."""

NOISE, DRAWS = "noise of 1 mm and 0.5 degrees", 10
"""What takes are measured worse by, and how often: one draw says little about 72 takes."""

SCALES = (2.0, 6.0, 0.5)
"""How many times as large movements are made."""

SURE = 0.9
"""A reading beyond this is saturated, where nothing was learned."""

HISTORY = (3, 7, 15, 31)
"""How many phrases somebody has played before the one that is read."""

Classify = Callable[[FloatArray, NDArray[np.bool_], NDArray[np.int64], FloatArray], FloatArray]
"""Learns from rows, which are of the high pole and whose they are; returns log odds of others."""


def paper(
    rows: FloatArray, high: NDArray[np.bool_], whose: NDArray[np.int64], asked: FloatArray
) -> FloatArray:
    """Classify as the paper does."""
    return fit_papers_method(rows, high, folds(whose)).log_odds(asked)


def discriminant(
    rows: FloatArray, high: NDArray[np.bool_], _: NDArray[np.int64], asked: FloatArray
) -> FloatArray:
    """Classify by Fisher's linear discriminant."""
    from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

    return np.asarray(LinearDiscriminantAnalysis().fit(rows, high).decision_function(asked))


def simple_statistics(motion: RigidMotion) -> list[float]:
    """Return seven statistics of speed, acceleration and jerk."""
    speed, acceleration, jerk = (
        np.linalg.norm(x, axis=-1)
        for x in (motion.velocity_m_s, motion.acceleration_m_s2, motion.jerk_m_s3)
    )
    both = [f(x) for x in (speed, acceleration, jerk) for f in (np.mean, np.max)]
    return [float(value) for value in (*both, np.std(speed))]


def left_out(
    classify: Classify, rows: FloatArray, meant: FloatArray, whose: NDArray[np.int64]
) -> AxisReport:
    """Return the log odds of every take of a pole, its performer left out."""
    at_pole = np.isfinite(meant) & (meant != 0)
    odds = np.zeros(len(meant))
    for out in folds(whose):
        inside, asked = at_pole & ~out, at_pole & out
        if asked.any():
            odds[asked] = classify(rows[inside], meant[inside] > 0, whose[inside], rows[asked])
    return AxisReport(odds[at_pole], meant[at_pole])


def auc(report: AxisReport) -> float:
    """Return how often a take of the high pole reads higher than one of the low pole."""
    high = report.reading[report.meant > 0][:, None]
    low = report.reading[report.meant < 0][None, :]
    return float(np.mean((high > low) + 0.5 * (high == low)))


def print_reports(title: str, reports: dict[str, AxisReport], *, chances: bool) -> None:
    """Print each axis's accuracy, interval, area under the curve and Brier score."""
    print(f"  {title}")
    for axis, report in reports.items():
        count = int(np.sum(report.meant != 0))
        low, high = accuracy_interval(round(report.accuracy * count), count)
        brier = f"  Brier {report.brier_score:.3f}" if chances else ""
        print(
            f"    {axis:7} {report.accuracy:.3f} [{low:.2f}, {high:.2f}] of {count:4d}  "
            f"AUC {auc(report):.2f}{brier}"
        )
    mean = np.mean([report.accuracy for report in reports.values()])
    print(f"    {'mean':7} {mean:.3f}", flush=True)


def real_people() -> tuple[list[RigidMotion], list[Doodle], TrainingSet]:
    """Return the real takes: as motions, as doodles, and described."""
    rows = read_manifest(DATA / "manifest.csv")
    doodles = [read_recording(row.path, SourceFrame(up="z")).doodles[0] for row in rows]
    motions = [smooth(doodle) for doodle in doodles]
    described = np.array([describe(motion) for motion in motions])
    meant = np.array([row.meant for row in rows])
    return motions, doodles, TrainingSet(described, meant, tuple(row.performer for row in rows))


def by_axis(examples: TrainingSet) -> dict[str, FloatArray]:
    """Return what was meant, by axis."""
    return dict(zip(AXES, examples.meant.T, strict=True))


def print_real(motions: Sequence[RigidMotion], examples: TrainingSet) -> None:
    """Print how real people are told, everything chosen without the one who is judged."""
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    fifty = np.array([effort_features(motion) for motion in motions])
    seven = np.array([simple_statistics(motion) for motion in motions])
    print(f"{len(motions)} takes of {whose.max() + 1} real people, one pole a take, each left out")
    for title, classify, rows in (
        ("the paper: 50 features, best M, naive Bayes", paper, fifty),
        ("linear discriminant of 7 simple statistics", discriminant, seven),
    ):
        reports = {a: left_out(classify, rows, m, whose) for a, m in by_axis(examples).items()}
        print_reports(title, reports, chances=False)
    training = examples.train(trained_on="benchmark")
    print_reports("ours", dict(training.alone), chances=True)
    print_reports("ours, with the performer's unlabelled takes", dict(training.own), chances=True)
    print_transfer(load_effort_model(), examples, whose)


def print_transfer(model: EffortModel, examples: TrainingSet, whose: NDArray[np.int64]) -> None:
    """Print how the shipped model, which learned from simulated people, does on real ones."""
    alone, own = judged(model, examples, whose)
    print_reports("transfer: the shipped model", alone, chances=True)
    print_reports("transfer, with the performer's unlabelled takes", own, chances=True)


def judged(
    model: EffortModel, examples: TrainingSet, whose: NDArray[np.int64]
) -> tuple[dict[str, AxisReport], dict[str, AxisReport]]:
    """Return how a model does on takes it has not seen, alone and with the performers' takes."""
    measures = {int(p): measure_of(examples.descriptions[whose == p]) for p in np.unique(whose)}
    both: tuple[dict[str, AxisReport], dict[str, AxisReport]] = {}, {}
    for reports, known in zip(both, (False, True), strict=True):
        for axis, meant in by_axis(examples).items():
            labelled = np.flatnonzero(np.isfinite(meant))
            if axis not in model.axes or not len(labelled):
                continue
            reading = [
                getattr(
                    effort_of(
                        examples.descriptions[i],
                        model,
                        measures[int(whose[i])] if known else None,
                    ),
                    axis,
                )
                for i in labelled
            ]
            reports[axis] = AxisReport(np.array(reading), meant[labelled])
    return both


def spread_at(difficulty: float) -> Spread:
    """Return a share of what simulated people and takes differ by."""
    low, high = SPREAD.acting
    scaled = {
        name: difficulty * getattr(SPREAD, name)
        for name in ("stage", "leaning", "take_effort", "take_size", "take_pace")
    }
    acting = (1.0 + difficulty * (low - 1.0), 1.0 + difficulty * (high - 1.0))
    return replace(SPREAD, acting=acting, **scaled)


def print_simulated() -> None:
    """Print how simulated people are told, at several difficulties."""
    print(
        f"{PEOPLE} simulated people, {9 * REPEATS} takes each, all axes at once, left out in turn"
    )
    for difficulty in DIFFICULTIES:
        examples = simulated(
            people=PEOPLE, repeats=REPEATS, seed=SEED, spread=spread_at(difficulty)
        )
        whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
        meant = by_axis(examples)
        poles = np.all(examples.meant[:, :2] != 0, axis=1)
        right, shares = [], []
        for axis in ("time", "weight"):
            report = left_out(paper, examples.descriptions[:, :50], meant[axis], whose)
            told = np.zeros(len(poles), bool)
            told[meant[axis] != 0] = (report.reading > 0) == (report.meant > 0)
            right.append(told)
            shares.append(report.accuracy)
        both = float(np.mean((right[0] & right[1])[poles]))
        print(f"  difficulty {difficulty:g}: the paper's method")
        print(f"    time {shares[0]:.3f}  weight {shares[1]:.3f}  joint states {both:.3f}")
        print_joint(examples.train(trained_on="benchmark"), poles, meant)


def print_joint(training: Training, poles: NDArray[np.bool_], meant: dict[str, FloatArray]) -> None:
    """Print what training came to on people left out, joint states as one decision and as two."""
    for title, reports, reader in (
        ("ours", training.alone, training.model.alone),
        ("ours, with the performer's takes", training.own, training.model.own),
    ):
        assert reader.states is not None
        right = [
            (reports[axis].reading > 0) == (reports[axis].meant > 0) for axis in ("time", "weight")
        ]
        two = float(np.mean((right[0] & right[1])[poles]))
        shares = "  ".join(f"{axis} {report.accuracy:.3f}" for axis, report in reports.items())
        print(
            f"    {title}: {shares}  joint states {reader.states.held_out_accuracy:.3f} "
            f"(two decisions {two:.3f})",
            flush=True,
        )


def changed(doodle: Doodle, how: str, rng: np.random.Generator) -> Doodle:
    """Return a take that was moved and turned, or measured worse."""
    position, orientation = doodle.position_m, doodle.orientation_xyzw
    if how == "moved and turned":
        turn = quaternion_about([0.0, 1.0, 0.0], rng.uniform(-np.pi, np.pi))
        position = rotate(turn, position) + rng.normal(0.0, 2.0, 3)
        return replace(doodle, position_m=position, orientation_xyzw=multiply(turn, orientation))
    if how == NOISE:
        return with_noise(doodle, 1e-3, np.radians(0.5), rng)
    kept = np.unique(
        np.searchsorted(doodle.time_s, np.arange(doodle.time_s[0], doodle.time_s[-1], 1 / 60.0))
    )
    return doodle.selected(kept)


def flips(before: FloatArray, after: FloatArray, meant: FloatArray) -> str:
    """Return the shares of decisions that differ: of those for a pole that was meant, and of all.

    ``before (n, a)``, ``after (draws, n, a)`` and ``meant (n, a)``, which is as in `TrainingSet`.
    """
    differ = (before > 0) != (after > 0)
    of_poles = 100.0 * differ[:, np.abs(meant) == 1.0].mean(axis=1)
    spread = f" ({of_poles.min():.1f} – {of_poles.max():.1f})" if len(of_poles) > 1 else ""
    return (
        f"flips {of_poles.mean():.1f} %{spread} where a pole was meant, "
        f"{100.0 * differ.mean():.1f} % of all"
    )


def print_robustness(title: str, doodles: Sequence[Doodle], meant: FloatArray) -> None:
    """Print by how much the shipped model's readings change, and how many decisions flip.

    ``meant (n, 4)`` is as in `TrainingSet`.
    """
    model, rng = load_effort_model(), np.random.default_rng(SEED)
    before = np.array([values(doodle, model) for doodle in doodles])
    print(f"{title}: {len(doodles)} takes, the shipped model")
    for how, draws in (("moved and turned", DRAWS), (NOISE, DRAWS), ("at 60 Hz", 1)):
        after = np.array(
            [[values(changed(d, how, rng), model) for d in doodles] for _ in range(draws)]
        )
        largest = np.abs(after - before).max()
        print(f"  {how:30} largest change {largest:.4f}, {flips(before, after, meant)}")


def print_left_out_robustness(doodles: Sequence[Doodle], examples: TrainingSet) -> None:
    """Print how many decisions flip, by models that the others' takes taught."""
    rng = np.random.default_rng(SEED)
    noisy = [[describe(smooth(changed(d, NOISE, rng))) for d in doodles] for _ in range(DRAWS)]
    large = [[describe(smooth(larger(d, scale))) for d in doodles] for scale in SCALES]
    described = np.array([examples.descriptions, *noisy, *large])
    readings = np.zeros((2, *described.shape[:2], len(AXES)))  # unknown, known; clean, then changed
    performers = np.asarray(examples.performers)
    for person in np.unique(performers):
        out = performers == person
        others = TrainingSet(described[0, ~out], examples.meant[~out], tuple(performers[~out]))
        model = others.train(trained_on="benchmark").model
        for i, takes in enumerate(described[:, out]):
            readings[:, i, out] = [
                _readings(takes, model, own) for own in (None, measure_of(takes))
            ]
    print("real people, each read by a model of the others")
    for title, (before, *after) in zip(
        ("performer unknown", "with the performer's takes"), readings, strict=True
    ):
        print(f"  {title}")
        print(f"    {NOISE:30} {flips(before, np.array(after[:DRAWS]), examples.meant)}")
        for scale, at_scale in zip(SCALES, after[DRAWS:], strict=True):
            print_scale(scale, before, at_scale, examples.meant)


def larger(doodle: Doodle, scale: float) -> Doodle:
    """Return a take whose way is so many times as large, its noise with it."""
    return replace(doodle, position_m=scale * doodle.position_m)


def print_scale(scale: float, before: FloatArray, after: FloatArray, meant: FloatArray) -> None:
    """Print how many decisions flip at a scale, by axis too, and how far takes keep their order.

    ``before``, ``after`` and ``meant`` ``(n, a)``; NaN where not labelled. The order is the area
    under the curve, before and after.
    """
    each = []
    for axis, was, is_now, label in zip(AXES, before.T, after.T, meant.T, strict=True):
        poles = np.abs(label) == 1.0
        differ = 100.0 * np.mean((was > 0)[poles] != (is_now > 0)[poles])
        order = [auc(AxisReport(reading[poles], label[poles])) for reading in (was, is_now)]
        each.append(f"{axis} {differ:.1f} % ({order[0]:.2f} to {order[1]:.2f})")
    print(f"    {f'{scale:g} times as large':30} {flips(before, after[None], meant)}")
    print(f"      {', '.join(each)}", flush=True)


def print_scales(title: str, doodles: Sequence[Doodle], examples: TrainingSet) -> None:
    """Print how many decisions of the shipped model flip when takes are larger or smaller."""
    model = load_effort_model()
    performers = np.asarray(examples.performers)
    print(f"{title}: {len(doodles)} takes, the shipped model")
    at = [[describe(smooth(larger(d, scale))) for d in doodles] for scale in SCALES]
    described = np.array([examples.descriptions, *at])
    for own in (False, True):
        readings = np.zeros((*described.shape[:2], len(AXES)))
        for person in np.unique(performers):
            mine = performers == person
            for i, takes in enumerate(described[:, mine]):
                readings[i, mine] = _readings(takes, model, measure_of(takes) if own else None)
        print("  with the performer's takes" if own else "  performer unknown")
        for scale, after in zip(SCALES, readings[1:], strict=True):
            print_scale(scale, readings[0], after, examples.meant)


def print_free_play() -> None:
    """Print how sure the shipped model is of movement of a kind that it has not learned."""
    model = load_effort_model()
    for title, files, frame in (
        ("A-Frame sessions", sorted(SHARED.glob("controllers/aframe/raw/*.json")), SourceFrame()),
        ("idle hands", sorted(SHARED.glob("idle/*.csv")), SourceFrame(handedness="left")),
    ):
        recordings = [read_recording(path, frame) for path in files]
        whole = [
            values(doodle, model)
            for recording in recordings
            for doodle in recording.doodles
            if len(doodle.time_s) > 9
        ]
        found = [read for recording in recordings for read in recording_efforts(recording, model)]
        parts = [[getattr(read.effort, a) for a in AXES] for read in found if read.state]
        chances = [read.state[2] for read in found if read.state]
        print(f"{title}: {len(files)} files")
        for what, readings in (("whole doodles", whole), ("movements between rests", parts)):
            sure = np.abs(np.array(readings))
            print(
                f"  {what:24} {len(sure):4d}: {int(np.sum(sure > SURE))} of {sure.size} axes above "
                f"{SURE:g}, median {np.median(sure):.2f}, most {sure.max():.2f}"
            )
        print(f"  chance of the joint state: median {np.median(chances):.2f}")


def print_histories() -> None:
    """Print how phrases are told alone, and against others that the same person played before.

    Simulated people of the middle difficulty; what they played before is various, or all of it in
    the same Effort of Time and Weight as the phrase, as in a scene of one mood.
    """
    examples = simulated(people=12, repeats=REPEATS, seed=SEED + 1, spread=spread_at(0.75))
    model, rng = load_effort_model(), np.random.default_rng(SEED)
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    described, meant = examples.descriptions, examples.meant
    print("simulated people: phrases after others of the same person")
    for title, one_mood in (("various", False), ("of one mood", True)):
        for count in HISTORY:
            right: list[list[bool]] = []
            for i in range(len(described)):
                others = np.flatnonzero((whose == whose[i]) & (np.arange(len(whose)) != i))
                if one_mood:
                    others = others[(meant[others, :2] == meant[i, :2]).all(axis=1)]
                before = rng.choice(others, min(count, len(others)), replace=False)
                own = measure_of(described[before])
                each = [effort_of(described[i], model, known) for known in (None, own)]
                right += [
                    [getattr(effort, axis) * label > 0 for effort in each]
                    for axis, label in zip(AXES, meant[i], strict=True)
                    if abs(label) == 1.0
                ]
            alone, against = np.mean(right, axis=0)
            print(f"  {title}, {count} before: alone {alone:.3f}, against them {against:.3f}")
            if one_mood:
                break  # a person has played no more than three others in one mood


def _readings(
    descriptions: FloatArray, model: EffortModel, own: OwnMeasure | None
) -> list[list[float]]:
    """Return the readings of descriptions ``(n, 132)``, on all axes."""
    efforts = [effort_of(description, model, own) for description in descriptions]
    return [[getattr(effort, axis) for axis in AXES] for effort in efforts]


def values(doodle: Doodle, model: EffortModel) -> list[float]:
    """Return the readings of a take; 0 where an axis is not read."""
    effort = read_effort(smooth(doodle), model)
    return [getattr(effort, axis) or 0.0 for axis in AXES if axis in model.axes]


def print_times(motion: RigidMotion, own: OwnMeasure | None) -> None:
    """Print processor time of a reading and of a stream, in ms."""
    model = load_effort_model()
    ten = motion.between(motion.time_s[0], motion.time_s[0] + 10.0)
    spent = []
    for _ in range(100):
        started = time.thread_time()
        read_effort(ten, model, own)
        spent.append(1e3 * (time.thread_time() - started))
    lasts_s = ten.time_s[-1] - ten.time_s[0]
    print(f"one reading of {lasts_s:.1f} s: median {np.median(spent):.2f} ms")
    stream, spent = EffortStream(model, own), []
    for i in range(len(ten)):
        piece = ten.between(ten.time_s[i], ten.time_s[i])
        started = time.thread_time()
        stream.push(piece)
        spent.append(1e3 * (time.thread_time() - started))
    print(
        f"a sample of a stream: mean {np.mean(spent):.2f} ms, median {np.median(spent):.2f} ms, "
        f"99th percentile {np.percentile(spent, 99):.2f} ms (one in 15 reads a window)"
    )


def print_whole_process() -> None:
    """Print what classifying 100 files takes, from the start of the program to its end."""
    with tempfile.TemporaryDirectory() as folder:
        takes = fourfold_takes(people=6, repeats=2, seed=SEED)
        for i, take in enumerate(islice(takes, 100)):
            write_recording(Recording((take.doodle,)), Path(folder, f"{i:03d}.csv"))
        (runs,) = run([sys.executable, "-m", "smd.cli", "laban", "classify", folder])
    print(f"smd laban classify of 100 files: {runs}")


def draw_reliability(path: Path) -> None:
    """Draw how often the shipped model's chances are right on new simulated people."""
    from matplotlib.figure import Figure

    examples = simulated(people=PEOPLE, repeats=REPEATS, seed=SEED)
    whose = np.unique(np.asarray(examples.performers), return_inverse=True)[1]
    figure = Figure(figsize=(7.0, 3.8), dpi=100, layout="constrained")
    for axes, title, reports in zip(
        figure.subplots(1, 2),
        ("performer unknown", "performer's takes known"),
        judged(load_effort_model(), examples, whose),
        strict=True,
    ):
        axes.plot([0, 1], [0, 1], color="0.7", linewidth=1.0)
        for axis, report in reports.items():
            poles = report.meant != 0
            chance, high = 0.5 * (1 + report.reading[poles]), report.meant[poles] > 0
            groups = np.array_split(np.argsort(chance), 8)
            axes.plot(
                [chance[g].mean() for g in groups],
                [high[g].mean() for g in groups],
                "o-",
                markersize=3,
                label=POLES[axis][1],
            )
        axes.set(xlabel="chance of the pole, as read", ylabel="share", title=title)
        axes.legend()
    figure.savefig(path)


def main() -> None:
    """Print every figure."""
    if DATA.is_dir():
        motions, doodles, examples = real_people()
        print_real(motions, examples)
        print_robustness("real people", doodles, examples.meant)
        print_scales("real people", doodles, examples)
        print_left_out_robustness(doodles, examples)
        print_times(max(motions, key=len), measure_of(examples.descriptions[:8]))
    else:
        print(f"data absent ({DATA})")
    takes = list(fourfold_takes(people=8, repeats=2, seed=SEED))
    efforts = [[getattr(take.effort, axis) for axis in AXES] for take in takes]
    meant = np.array(efforts, dtype=np.float64)  # None, not labelled, becomes NaN
    print_robustness("simulated people", [take.doodle for take in takes], meant)
    described = np.array([describe(smooth(take.doodle)) for take in takes])
    players = tuple(take.player for take in takes)
    print_scales(
        "simulated people", [take.doodle for take in takes], TrainingSet(described, meant, players)
    )
    print_free_play()
    print_histories()
    print_whole_process()
    print_simulated()
    if folder := picture_folder():
        draw_reliability(folder / "effort-chances.png")


if __name__ == "__main__":
    main()
