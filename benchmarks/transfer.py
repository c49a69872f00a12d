"""Transfer: how feet stand, how phrases join, how true the path is, how long it takes.

``python -m benchmarks.transfer`` measures the shipped stories, three minutes of two simulated
hands, and, for comparison, the neutral clips themselves. Budgets: soles within 5 mm of the ground
slide at most 0.02 m/s on average, none is more than 5 mm in it, travelling phrases are at most
2 cm RMS off the smoothed path, and the three minutes take well under 1 s at 24 or 60 frames a
second.

Columns: ``slide``, mean and 95th percentile of the speed of heels and balls within 5 mm of the
ground; ``toes``, their mean speed below 0.05 m and the share of those frames above 0.2 m/s (the
clips' own walks have some: toes roll, and swing low); ``lowest`` point of any sole; ``path``, RMS
distance of the ground root from the smoothed path in travelling phrases; ``turn``, the most a
joint turns from one frame to the next, within 0.1 s of a boundary between phrases and anywhere
else.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from benchmarks.process import machine
from benchmarks.takes import long_recording
from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.doodle import Recording
from smd.formats import read_recording
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import inverse, multiply, rotate, rotvec_from_quaternion
from smd.pipeline import animate, parse
from smd.score import Score, read_score
from smd.transfer.legs import feet_of, legs_of, world_of
from smd.transfer.path import ground_path
from smd.transfer.performance import Actor, Performance
from smd.transfer.poses import Poses
from smd.transfer.stage import stage_for

STORIES = Path(__file__).parents[1] / "recordings"
RATE_HZ = 60.0
NEAR_GROUND_M = 0.005
LOW_TOES_M = 0.05
FAST_TOES_M_S = 0.2
AROUND_S = 0.1


@dataclass(frozen=True, slots=True)
class Feet:
    """Speeds (m/s) of soles near the ground and of low toes, and heights (m) of soles."""

    slide_m_s: FloatArray
    toes_m_s: FloatArray
    lowest_m: float

    def __str__(self) -> str:
        fast = 100.0 * np.mean(self.toes_m_s > FAST_TOES_M_S)
        return (
            f"{self.slide_m_s.mean():7.4f} {np.quantile(self.slide_m_s, 0.95):7.4f}"
            f" {self.toes_m_s.mean():7.3f} {fast:5.1f} {1e3 * self.lowest_m:7.1f}"
        )


def measured_feet(skeleton: Skeleton, poses: Poses, feet: tuple[int, ...], rate_hz: float) -> Feet:
    """Measure the feet of poses in the world."""
    slides, toes, lowest = [], [], np.inf
    for leg in legs_of(skeleton, feet):
        foot_q, ankle = world_of(skeleton, leg.foot, *poses)
        for point, height in ((leg.heel_m, 0.0), (leg.ball_m, leg.ball_height_m)):
            place = ankle + rotate(foot_q, point)
            up = place[:, 1] - height
            lowest = min(lowest, float(up.min()))
            slides.append(_speeds(place, up < NEAR_GROUND_M, rate_hz))
        toes.append(_speeds(place, place[:, 1] < LOW_TOES_M, rate_hz))
    return Feet(np.concatenate(slides), np.concatenate(toes), lowest)


def _speeds(place_m: FloatArray, low: BoolArray, rate_hz: float) -> FloatArray:
    """Return speeds over the ground between two frames that are both low."""
    steps = np.diff(place_m, axis=0)[low[1:] & low[:-1]]
    return np.hypot(steps[:, 0], steps[:, 2]) * rate_hz


def path_error_m(actor: Actor, recording: Recording, library: Library, score: Score) -> FloatArray:
    """Return distances of the ground root from the smoothed path in travelling phrases."""
    stage = stage_for(recording, library.character.height_m, score.figure_height_m)
    path = ground_path(recording.of(actor.device), stage)
    start_s = min(float(doodle.time_s[0]) for doodle in recording.doodles)
    times = start_s + np.arange(len(actor.translation_m)) / RATE_HZ
    errors = [np.zeros(0)]
    for phrase in actor.part.phrases:
        if not library.action(phrase.action).travels:
            continue
        rows = (times >= phrase.start_s) & (times <= phrase.end_s)
        root = actor.translation_m[rows][:, 0, [0, 2]]
        # The character goes on from where it stood: both begin at the origin.
        wanted = path.at(np.arange(phrase.start_s, phrase.end_s, 1e-3))
        began = path.at(float(times[rows][0])) if rows.any() else 0.0
        gaps = (root - root[:1])[:, None] - (wanted - began)[None]
        errors.append(np.linalg.norm(gaps, axis=-1).min(axis=1))
    return np.concatenate(errors)


def turns_deg(actor: Actor, start_s: float) -> tuple[float, float]:
    """Return the most that a joint turns in a frame, around boundaries and elsewhere."""
    q = actor.rotation_xyzw
    steps = np.linalg.norm(rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:])), axis=-1)
    frames = np.arange(len(steps)) + 0.5
    near = np.zeros(len(steps), dtype=bool)
    for phrase in actor.part.phrases:
        for edge_s in (phrase.start_s, phrase.end_s):
            near |= np.abs(frames - (edge_s - start_s) * RATE_HZ) < AROUND_S * RATE_HZ
    steps = np.degrees(steps)
    return float(steps[near].max(initial=0.0)), float(steps[~near].max(initial=0.0))


def print_performance(name: str, score: Score, recording: Recording, library: Library) -> None:
    """Act out a Score and print a line per performer."""
    performance: Performance = animate(score, recording, library, rate_hz=RATE_HZ)
    feet = feet_of(library.clip("walk"))
    for actor in performance.actors:
        poses = Poses(actor.rotation_xyzw, actor.translation_m)
        measured = measured_feet(actor.character.skeleton, poses, feet, RATE_HZ)
        error = path_error_m(actor, recording, library, score)
        rms = 100.0 * np.sqrt(np.mean(error**2)) if len(error) else 0.0
        around, inside = turns_deg(actor, performance.start_s)
        print(f"{name + ' ' + actor.device:24s} {measured} {rms:6.2f} {around:7.1f} {inside:7.1f}")


def print_clip(clip: Clip) -> None:
    """Print a neutral clip's line."""
    feet = feet_of(clip)
    if feet:
        poses = Poses(clip.rotation_xyzw, clip.translation_m)
        print(f"{clip.name:24s} {measured_feet(clip.skeleton, poses, feet, clip.rate_hz)}")


def main() -> None:
    """Print the table and the times."""
    library = load_library()
    columns = ("slide", "95 %", "toes", "fast", "lowest", "path", "turn at", "else")
    units = ("m/s", "m/s", "m/s", "%", "mm", "cm", "deg", "deg")
    widths = (7, 7, 7, 5, 7, 6, 7, 7)
    for row in (columns, units):
        print(" " * 24, *(f"{text:>{width}s}" for text, width in zip(row, widths, strict=True)))
    for clip in library.clips.values():
        print_clip(clip)
    for file in sorted(STORIES.glob("*.csv")):
        score = read_score(file.with_suffix(".score.json"))
        print_performance(file.stem, score, read_recording(file), library)
    take = long_recording(duration_s=180.0, rate_hz=90.0)
    score = parse(take, library)
    print_performance("simulated 180 s", score, take, library)
    print()
    print(machine())
    for rate_hz in (24.0, 60.0):
        times = []
        for _ in range(5):
            began = time.perf_counter()
            animate(score, take, library, rate_hz=rate_hz)
            times.append(time.perf_counter() - began)
        print(f"animate, 180 s, two devices, {rate_hz:g} Hz: {median(times):.2f} s", end="")
        print(f" ({min(times):.2f} to {max(times):.2f})")


if __name__ == "__main__":
    main()
