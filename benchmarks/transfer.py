"""Transfer: how feet stand, how phrases join, how true the path is, how long it takes.

``python -m benchmarks.transfer [DATA]`` acts out, at 60 Hz with full Effort, the shipped stories,
50 simulated doodles over all shipped actions and all states of Effort (their Scores are what was
meant), and real hands: the A-Frame sessions, understood with twice the usual tolerance, since
nobody meant our gestures there, and waiting hands; beside the same figures for the neutral clips.
Each is acted as drawn, and as a body can.

Feet: ``contact``, mean speed over the ground of the part of a sole that bears, while its foot is
labelled as standing (goal 0.02 m/s); ``near``, mean speed of heels and balls within 5 mm of the
ground, labelled or not; ``toes``, mean speed of toes below 0.05 m, and ``fast``, the share of
that above 0.2 m/s, as NVIDIA's kimodo defines skating (goal: 0.01 m/s and 1 % beyond the clips'
own); ``lowest`` point of any sole (goal -5 mm). Under each line is what toes the same clips have,
played as fast, over their own ground: a clip that is played twice as fast has toes twice as fast.
``path``: RMS distance of the ground root from the planned path in travelling phrases (2 cm).
``begin`` and ``done``: the latest that a clip begins, or has shown what it is about, beside the
Score, in frames (1); a gait that walks through a gap below 0.3 s begins there.
``pops``: turns of a joint in a frame that exceed the clip's own by more than 8 degrees, per
million, and the largest excess. ``halfway``: when a body that plays a clip once is halfway through
its way, beside the prop. ``bound``: share of accelerations across boundaries above the
99.5th percentile of the same joint inside phrases (0.5 % if boundaries are like anything else).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from statistics import median

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from benchmarks import acting_quality as quality
from benchmarks.acting_quality import RATE_HZ
from benchmarks.process import machine
from benchmarks.takes import long_recording
from laban import Effort
from smd.doodle import Recording
from smd.errors import SmdError
from smd.formats import SourceFrame, read_recording
from smd.geometry.arrays import FloatArray
from smd.pipeline import animate, parse
from smd.score import Part, Score
from smd.score_file import read_score
from smd.synthetic.efforts import SHAPING
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

STORIES = Path(__file__).parents[1] / "recordings"
DATA = Path(__file__).parents[2] / "shared" / "data"
TAKES, PHRASES = 50, 8
TIMINGS = ("drawn", "feasible")

Cast = tuple[Recording, Score]


def stories() -> Iterator[Cast]:
    """Yield the shipped stories and their Scores."""
    for file in sorted(STORIES.glob("*.csv")):
        yield read_recording(file), read_score(file.with_suffix(".score.json"))


def simulated(library: Library) -> Iterator[Cast]:
    """Yield doodles of simulated people who play all actions with all states of Effort."""
    rng = np.random.default_rng(11)
    states = list(product((-1.0, 0.0, 1.0), repeat=4))
    actions = [action.name for action in library.actions if action.pattern is not None]
    deck: list[str] = []
    for _ in range(TAKES):
        take = Take(simulated_person(rng), rng).pause(0.5)
        efforts = []
        for _ in range(PHRASES):
            deck = deck or [str(name) for name in rng.permutation(actions)]
            time_, weight, space, flow = states[rng.integers(len(states))]
            size = float(np.exp(SHAPING.size_per_weight * weight))
            pace = float(np.exp(-SHAPING.duration_per_time * time_))
            take.play(deck.pop(), size=size, pace=pace).pause(float(rng.uniform(0.0, 1.2)))
            efforts.append(Effort(time_, weight, space, flow))
        phrases = [
            replace(
                phrase, start_s=round(phrase.start_s, 3), end_s=round(phrase.end_s, 3), effort=e
            )
            for phrase, e in zip(take.pause(0.5).phrases, efforts, strict=True)
        ]
        yield (
            Recording((take.doodle(),), source="simulated"),
            Score((Part("prop", tuple(phrases)),)),
        )


def real_hands(folder: Path, library: Library, *, sessions: bool) -> Iterator[Cast]:
    """Yield real recordings in which something was recognised."""
    pattern = "controllers/aframe/raw/*.json" if sessions else "idle/*.csv"
    for path in sorted(folder.glob(pattern)):
        try:
            frame = None if sessions else SourceFrame(handedness="left")
            recording = read_recording(path, frame) if frame else read_recording(path)
            score = parse(recording, library, tolerance=2.0 if sessions else 1.0)
        except SmdError as error:
            print(f"{path.name}: {error}")
            continue
        if any(part.phrases for part in score.performers):
            yield recording, score


def row(name: str, feet: list[quality.Feet], more: str = "") -> str:
    """Return the line of a table about feet."""
    contact, near, toes = (
        np.concatenate([getattr(f, field) for f in feet])
        for field in ("labelled_m_s", "near_m_s", "toes_m_s")
    )
    lowest = min(f.lowest_m for f in feet)
    return (
        f"{name:24s} {contact.mean():8.4f} {near.mean():8.4f} {toes_of(toes)}"
        f" {1e3 * lowest:7.1f}{more}"
    )


def toes_of(toes_m_s: FloatArray) -> str:
    """Return the mean speed of low toes, and the share of it that skates, in per cent."""
    fast = 100.0 * np.mean(toes_m_s > quality.FAST_TOES_M_S)
    return f"{toes_m_s.mean():7.3f} {fast:6.2f}"


def print_casts(name: str, casts: list[Cast], library: Library, timing: str) -> None:
    """Act out some Scores and print their line, and that of the clips they play."""
    name = f"{name}, {timing}"
    feet, toes, errors, begins, dones = [], [], [], [], []
    popped, turns, worst = 0, 0, 0.0
    inside, across, late, phrases, seconds = [], [], [], 0, 0.0
    for recording, score in casts:
        performance = animate(score, recording, library, rate_hz=RATE_HZ, timing=timing)
        for seen in quality.played(performance, recording, score, library, timing=timing):
            skeleton = seen.actor.character.skeleton
            feet.append(
                quality.measured_feet(skeleton, seen.poses, seen.feet, seen.stands, RATE_HZ)
            )
            toes.append(quality.toes_of_clips_m_s(seen))
            errors.append(quality.path_errors_m(seen))
            late.append(quality.lateness_s(seen, recording.of(seen.actor.name)))
            begin, done = quality.boundary_gaps_s(seen)
            begins.append(begin)
            dones.append(done)
            count, of, excess = quality.pops(seen)
            popped, turns, worst = popped + count, turns + of, max(worst, excess)
            within, at = quality.accelerations(seen)
            inside.append(within)
            across.append(at)
            phrases += len(seen.actor.phrases)
            seconds += len(seen.time_s) / RATE_HZ
    if not feet:
        print(f"{name:24s} nothing to act out")
        return
    error = np.concatenate(errors)
    begin, done = np.concatenate(begins) * RATE_HZ, np.concatenate(dones) * RATE_HZ
    limit = np.quantile(np.concatenate(inside), 0.995, axis=0)
    above = 100.0 * np.mean(np.concatenate(across) > limit)
    rms = 100.0 * np.sqrt(np.mean(error**2)) if len(error) else 0.0
    more = (
        f" {rms:6.2f} {begin.max(initial=0.0):6.1f} {done.max(initial=0.0):6.1f}"
        f" {1e6 * popped / turns:7.0f} {worst:5.0f} {above:6.2f}"
    )
    print(row(name, feet, more))
    print(f"{'  their clips, as fast':42s} {toes_of(np.concatenate(toes))}")
    if not len(np.concatenate(late)):
        return
    early = np.sum(begin > 1.0) / max(len(begin), 1)
    print(
        f"  {phrases} phrases, {seconds:.0f} s; begun a frame early: {early:.1%}; "
        "halfway later than the prop: 10th, 50th, 90th percentile "
        + ", ".join(f"{x:+.2f}" for x in np.quantile(np.concatenate(late), [0.1, 0.5, 0.9]))
        + " s"
    )


def seconds_of(work: object, repeats: int = 5) -> list[float]:
    """Return how long some work takes, sorted."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()  # type: ignore[operator]
        times.append(time.perf_counter() - began)
    return sorted(times)


def main() -> None:
    """Print the table and the times."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else DATA
    library = load_library()
    names = ("contact", "near", "toes", "fast", "lowest", "path", "begin", "done", "pops", "most")
    units = ("m/s", "m/s", "m/s", "%", "mm", "cm", "frames", "frames", "per M", "deg")
    widths = (8, 8, 7, 6, 7, 6, 6, 6, 7, 5, 6)
    for texts in ((*names, "bound"), (*units, "%")):
        print(" " * 24, *(f"{text:>{width}s}" for text, width in zip(texts, widths, strict=True)))
    every = [feet for clip in library.clips.values() if (feet := quality.feet_of_clip(clip))]
    print(row("all neutral clips", every))
    groups = {"stories": list(stories()), f"{TAKES} simulated": list(simulated(library))}
    for name, sessions in (("sessions", True), ("waiting hands", False)):
        if folder.is_dir():
            groups[name] = list(real_hands(folder, library, sessions=sessions))
        else:
            print(f"{name}: data absent ({folder})")
    for (name, casts), timing in product(groups.items(), TIMINGS):
        print_casts(name, casts, library, timing)
    print()
    print(machine())
    take = long_recording(duration_s=180.0, rate_hz=90.0)
    score = parse(take, library)
    for timing, dial in product(TIMINGS, (0.0, 1.0)):
        times = seconds_of(
            lambda t=timing, e=dial: animate(score, take, library, timing=t, expressiveness=e)
        )
        print(
            f"animate, 180 s, two devices, 24 Hz, {timing}, expressiveness {dial:g}: "
            f"{median(times):.2f} s ({times[0]:.2f} to {times[-1]:.2f})"
        )


if __name__ == "__main__":
    main()
