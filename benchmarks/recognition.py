"""How well actions are recognised, and how fast: ``python -m benchmarks.recognition``.

Simulated people are ones that nothing was fitted to. Budget: the stories exactly, boundaries
within 0.15 s. ``--picture FOLDER`` draws what is missed against what is seen falsely.
"""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from actions_library.folder import load_library
from benchmarks import gestures, performers
from benchmarks.limits import LimitRecognizer
from benchmarks.process import picture_folder
from benchmarks.takes import long_recording
from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.formats import SourceFrame, read_recording
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition import Recognizer
from smd.recognition.detection import Detection
from smd.smoothing import smooth
from smd.synthetic.efforts import labelled_takes
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.stories import STORIES
from smd.synthetic.takes import Take

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
RECOGNIZER = Recognizer(load_library())
TOLERANCES = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4)
HELD_OUT = 2028
"""Seed of people that no threshold, cost or pattern was fitted to."""
PEOPLE = 60


def spans_of(doodle: Doodle, recognizer: Recognizer = RECOGNIZER) -> list[Detection]:
    """Return what is recognised in a doodle."""
    return recognizer.spot(doodle)


def read_as(doodle: Doodle) -> str:
    """Return the actions recognised in a doodle, joined."""
    return "+".join(span.action for span in spans_of(doodle)) or "nothing"


def turned(doodle: Doodle) -> Doodle:
    """Return a doodle with the world turned by a quarter."""
    quarter = quaternion_about([0.0, 1.0, 0.0], np.pi / 2.0)
    position = rotate(quarter, doodle.position_m)
    orientation = multiply(quarter, doodle.orientation_xyzw)
    return Doodle(doodle.time_s, position, orientation, doodle.device)


def scaled(doodle: Doodle, factor: float) -> Doodle:
    """Return a doodle with its positions scaled."""
    return Doodle(doodle.time_s, factor * doodle.position_m, doodle.orientation_xyzw, doodle.device)


def resampled(doodle: Doodle, rate_hz: float) -> Doodle:
    """Return a doodle at even times."""
    at_s = np.arange(doodle.time_s[0], doodle.time_s[-1], 1.0 / rate_hz)
    position = interpolate_linear(doodle.time_s, doodle.position_m, at_s)
    orientation = interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, at_s)
    return Doodle(at_s, position, orientation, doodle.device)


CHANGES: Mapping[str, Callable[[Doodle], Doodle]] = {
    "as it is": lambda doodle: doodle,
    "turned by 90 degrees": turned,
    "positions x 0.5": lambda doodle: scaled(doodle, 0.5),
    "positions x 2": lambda doodle: scaled(doodle, 2.0),
    "at 90 Hz": lambda doodle: resampled(doodle, 90.0),
}


def confusions(takes: Iterator[tuple[str, Doodle]]) -> dict[str, Counter[str]]:
    """Return how often each action was read as what."""
    table: dict[str, Counter[str]] = {}
    for meant, doodle in takes:
        table.setdefault(meant, Counter())[read_as(doodle)] += 1
    return table


def print_confusions(table: Mapping[str, Counter[str]]) -> None:
    """Print the share read right and what the rest was read as."""
    for meant in table:
        count = sum(table[meant].values())
        wrong = [f"{read} {n}" for read, n in table[meant].most_common() if read != meant]
        right = table[meant][meant]
        print(f"  {meant:16} {100.0 * right / count:5.1f} % of {count:4d}  {', '.join(wrong)}")
    every = sum(sum(row.values()) for row in table.values())
    right = sum(row[meant] for meant, row in table.items())
    print(f"  {'all':16} {100.0 * right / every:5.1f} % of {every}")


def single_gestures(people: int, factor: float = 1.0) -> Iterator[tuple[str, Doodle]]:
    """Yield one take per person and action."""
    for index in range(people):
        rng = np.random.default_rng([HELD_OUT, index])
        person = simulated_person(rng)
        for action in GESTURES:
            take = Take(person, rng, heading_rad=rng.uniform(-np.pi, np.pi))
            take.pause(0.6).play(action).pause(0.6)
            yield action, scaled(take.doodle(), factor)


def print_people() -> None:
    """Print accuracy on single gestures, at three sizes, and with every Effort."""
    print(f"{PEOPLE} simulated people, one gesture a take")
    print_confusions(confusions(single_gestures(PEOPLE)))
    for factor in (0.5, 2.0):
        table = confusions(single_gestures(PEOPLE, factor))
        right = sum(row[meant] for meant, row in table.items())
        print(f"  positions x {factor:g}: {100.0 * right / (PEOPLE * len(GESTURES)):.1f} %")
    print("the same gestures with every Effort: sudden, sustained, light, strong, and between")
    takes = labelled_takes(people=12, repeats=11, seed=HELD_OUT)
    print_confusions(confusions((take.action, take.doodle) for take in takes))


def print_rows() -> None:
    """Print how well gestures in a row are read."""
    played = right = extra = 0
    late_s: list[float] = []
    for index in range(PEOPLE):
        rng = np.random.default_rng([HELD_OUT, 1, index])
        take = Take(simulated_person(rng), rng).pause(0.6)
        for action in rng.permutation(list(GESTURES)):
            take.play(str(action)).pause(float(rng.uniform(0.4, 1.2)))
        spans = spans_of(take.doodle())
        taken = set()
        for phrase in take.phrases:
            played += 1
            for i, span in enumerate(spans):
                together = min(span.end_s, phrase.end_s) - max(span.start_s, phrase.start_s)
                if span.action == phrase.action and together > 0.5 * (
                    phrase.end_s - phrase.start_s
                ):
                    right += 1
                    taken.add(i)
                    late_s += [span.start_s - phrase.start_s, span.end_s - phrase.end_s]
                    break
        extra += len(spans) - len(taken)
    within = float(np.mean(np.abs(late_s) <= 0.15))
    print(
        f"all actions in a row, in random order, pauses of 0.4 to 1.2 s: {played} played, "
        f"{100.0 * right / played:.1f} % found, {extra} others seen; boundaries: median "
        f"{np.median(np.abs(late_s)):.3f} s off, {100.0 * within:.1f} % within 0.15 s"
    )


def print_stories() -> None:
    """Print whether each story is understood under each change, and the worst boundary."""
    for name, make in STORIES.items():
        story = make()
        for change, changed in CHANGES.items():
            worst_s, same = 0.0, True
            for doodle, part in zip(story.recording.doodles, story.score.performers, strict=True):
                spans = spans_of(changed(doodle))
                same &= [s.action for s in spans] == [p.action for p in part.phrases]
                for span, phrase in zip(spans, part.phrases, strict=False):
                    ends = (span.start_s - phrase.start_s, span.end_s - phrase.end_s)
                    worst_s = max(worst_s, *map(abs, ends))
            verdict = f"exact, worst boundary {worst_s:.3f} s off" if same else "NOT as played"
            print(f"  {name:10} {change:21} {verdict}")


def idle_doodles() -> list[Doodle]:
    """Return idle hands of every other person; with the others the limits were chosen."""
    paths = sorted((DATA / "idle").glob("*.csv"))[1::2]
    recordings = (read_recording(path, SourceFrame(handedness="left")) for path in paths)
    return [doodle for recording in recordings for doodle in recording.doodles]


def false_detections(doodles: Iterable[Doodle], recognizer: Recognizer) -> Counter[str]:
    """Return what is seen in hands that mean nothing."""
    seen: Counter[str] = Counter()
    for doodle in doodles:
        try:
            seen.update(span.action for span in spans_of(doodle, recognizer))
        except DoodleError:  # too short to smooth
            continue
    return seen


def missed_share(recognizer: Recognizer, people: int = 20) -> float:
    """Return the share of single gestures, played with every Effort, that is read as nothing."""
    takes = list(labelled_takes(people=people // 5, repeats=6, seed=HELD_OUT + 1))
    missed = sum(not spans_of(take.doodle, recognizer) for take in takes)
    return missed / len(takes)


def print_idle() -> None:
    """Print false detections on hands that mean nothing, against gestures missed."""
    doodles = idle_doodles()
    if not doodles:
        print(f"idle hands: data absent ({DATA / 'idle'})")
        return
    minutes = sum(doodle.duration_s for doodle in doodles) / 60.0
    print(f"idle hands of people that no limit was chosen with, {minutes:.1f} min")
    print("  tolerance  false a minute  (95 % interval)  gestures missed")
    curve = []
    for tolerance in TOLERANCES:
        recognizer = Recognizer(load_library(), tolerance=tolerance)
        seen = false_detections(doodles, recognizer)
        count, missed = sum(seen.values()), 100.0 * missed_share(recognizer)
        low, high = (bound / minutes for bound in poisson_interval(count))
        which = ", ".join(f"{action} {n}" for action, n in seen.most_common())
        curve.append((tolerance, count / minutes, missed))
        print(
            f"  {tolerance:9.1f}  {count / minutes:14.2f}  ({low:.2f} to {high:5.2f})  "
            f"{missed:13.1f} %  {which}",
            flush=True,
        )
    if folder := picture_folder():
        draw_trade_off(folder / "trade-off.png", curve)


def poisson_interval(count: int) -> tuple[float, float]:
    """Return the exact 95 % interval of a rate of which ``count`` events were seen [1]_.

    References
    ----------
    .. [1] F. Garwood, "Fiducial Limits for the Poisson Distribution", Biometrika 28, 1936.
    """
    from scipy.stats import chi2

    low = 0.5 * float(chi2.ppf(0.025, 2 * count)) if count else 0.0
    return low, 0.5 * float(chi2.ppf(0.975, 2 * count + 2))


def draw_trade_off(path: Path, curve: Sequence[tuple[float, float, float]]) -> None:
    """Draw gestures missed against false detections, a point for each tolerance."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0, 3.5), dpi=100, layout="constrained")
    axes = figure.subplots()
    axes.plot([c[1] for c in curve], [c[2] for c in curve], "o-", color="#2b6cb0")
    labels: dict[tuple[float, float], list[str]] = {}
    for tolerance, *point in curve:
        labels.setdefault((point[0], point[1]), []).append(f"{tolerance:g}")
    for at, tolerances in labels.items():
        text = ", ".join(tolerances)
        axes.annotate(text, at, xytext=(5, 4), textcoords="offset points", rotation=40)
    axes.set(xlabel="false detections a minute, idle hands", ylabel="gestures missed, %")
    axes.set_title("tolerance of the shipped library", fontsize=10)
    figure.savefig(path)


def print_times() -> None:
    """Print processor time on a long recording, tokens and recognition apart."""
    recording = long_recording(duration_s=180.0, rate_hz=90.0)
    motions = [smooth(doodle) for doodle in recording.doodles]
    started = time.process_time()
    runs = [
        RECOGNIZER.runs_of(doodle, motion)
        for doodle, motion in zip(recording.doodles, motions, strict=True)
    ]
    tokenized = time.process_time()
    for motion, of_device in zip(motions, runs, strict=True):
        RECOGNIZER.spot_runs(motion, of_device)
    ended = time.process_time()
    print(
        f"3 minutes, 2 devices, {sum(map(len, runs))} runs: tokens {tokenized - started:.3f} s, "
        f"recognition {ended - tokenized:.3f} s"
    )
    limited = LimitRecognizer(load_library().actions)
    ratios = []
    for _ in range(5):
        spent = []
        for recognizer in (limited, RECOGNIZER):
            started = time.process_time()
            for doodle in recording.doodles:
                recognizer.spot(doodle)
            spent.append(time.process_time() - started)
        ratios.append(spent[1] / spent[0])
    print(f"times as long as with limits, five turns: {', '.join(f'{r:.2f}' for r in ratios)}")


def main() -> None:
    """Print every figure."""
    print_people()
    print_rows()
    print("the stories")
    print_stories()
    print_idle()
    print_times()
    gestures.main()
    performers.main()


if __name__ == "__main__":
    main()
