"""What compensating a lever arm gains: ``python -m benchmarks.lever_arm [DATA]``.

First on simulated people who turn the prop about their grip: how far the estimate is from the
truth. Then on the kettle recordings (A. Verduyn, MIT) in ``DATA/controllers/kettle``: three
pourings with the tracker's frame at the centre of mass, and three *other* performances of them
with it at the top. The lever between the two points, and the turn between the two frames, are
estimated from the other trials than the one they are tried on.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np

from benchmarks.process import machine
from smd.doodle import Doodle
from smd.formats import SourceFrame, read_recording
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    normalized,
    quaternion_from_rotvec,
    rotate,
)
from smd.recognition.alignment import align
from smd.recognition.lever import estimate_lever
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import Token
from smd.smoothing import smooth
from smd.synthetic.person import simulated_person
from smd.synthetic.tracker import tracker_times

TRIALS = (1, 2, 3)
PEOPLE = 100


def turned_prop(lever_m: FloatArray, drift_m: float, rng: np.random.Generator) -> Doodle:
    """Return 15 s of a prop turned about a centre that strays by ``drift_m``, up to 1.5 Hz."""
    t = tracker_times(0.0, 15.0, 90.0, rng)

    def waves(most_hz: float, amplitude: float) -> FloatArray:
        hz, phase = rng.uniform(0.1, most_hz, (2, 4, 3)) * [[[1.0]], [[2 * np.pi / most_hz]]]
        return 0.5 * amplitude * np.sin(2 * np.pi * hz * t[:, None, None] + phase).sum(axis=1)

    orientation = quaternion_from_rotvec(waves(0.8, 1.0))
    centre = waves(1.5, drift_m) + rng.normal(0.0, 3e-4, (len(t), 3))
    return Doodle(t, centre - rotate(orientation, lever_m), orientation)


def simulated() -> None:
    print(f"\nsimulated, {PEOPLE} people, 15 s each, noise 0.3 mm")
    for name, drift_m in (("a steady hand (0.5–1.5 mm)", None), ("5 mm", 5e-3), ("20 mm", 20e-3)):
        errors, inside = [], []
        for seed in range(PEOPLE):
            rng = np.random.default_rng(seed)
            person = simulated_person(rng)
            lever = np.array(person.grip_m)
            doodle = turned_prop(lever, person.drift_m if drift_m is None else drift_m, rng)
            found = estimate_lever([smooth(doodle)])
            errors.append(float(np.linalg.norm(found.lever_m - lever)))
            inside.extend(np.abs(found.lever_m - lever) < 2.0 * found.error_m)
        print(
            f"centre strays by {name:27} error: median {1000 * np.median(errors):4.1f} mm, "
            f"largest {1000 * max(errors):4.1f} mm; "
            f"within two standard errors {np.mean(inside):.2f}"
        )


@dataclass(frozen=True, slots=True)
class Relation:
    """Where and how the one frame sits in the other."""

    lever_m: FloatArray
    top_from_com_xyzw: FloatArray

    def turned(self, top: Doodle) -> Doodle:
        """Return the doodle with its frame turned, at the place where it is."""
        return replace(top, orientation_xyzw=multiply(top.orientation_xyzw, self.top_from_com_xyzw))

    def compensated(self, top: Doodle) -> Doodle:
        """Return the doodle as seen from the other point."""
        place = top.position_m + rotate(top.orientation_xyzw, self.lever_m)
        return self.turned(replace(top, position_m=place))


def pairs(a: Doodle, b: Doodle) -> IntArray:
    """Return which samples belong together, by angular speed alone: no frame enters it."""
    speed = [
        np.linalg.norm(smooth(d).angular_velocity_rad_s, axis=-1, keepdims=True) for d in (a, b)
    ]
    return align(*speed).path


def relation(takes: list[tuple[Doodle, Doodle]]) -> Relation:
    """Return the relation of the frames that takes in both of them show.

    The takes are other performances, each standing somewhere else, and no prop is turned about
    either point: this is not `estimate_lever`, but the same equation, of place instead of speed.
    """
    columns, target, turns = [], [], []
    for com, top in takes:
        at_com, at_top = smooth(com), smooth(top)
        i, j = pairs(com, top).T
        orientation = at_top.orientation_xyzw[j]
        matrix = matrix_from_quaternion(orientation)
        apart = at_com.position_m[i] - at_top.position_m[j]
        columns.append((matrix - matrix.mean(axis=0)).reshape(-1, 3))
        target.append((apart - apart.mean(axis=0)).ravel())
        turn = multiply(inverse(orientation), at_com.orientation_xyzw[i])
        turns.append(turn * np.sign(turn @ [1.0, 1.0, 1.0, 1.0])[:, None])
    lever = np.linalg.lstsq(np.concatenate(columns), np.concatenate(target), rcond=None)[0]
    return Relation(lever, normalized(np.concatenate(turns).mean(axis=0)))


def agreement(a: Doodle, b: Doodle) -> float:
    """Return the share of aligned time at which both have the same token."""
    ours, theirs = tokens(a), tokens(b)
    return float(np.mean([ours[i] == theirs[j] for i, j in pairs(a, b)]))


def tokens(doodle: Doodle) -> list[Token]:
    """Return the token of each sample."""
    return [run.token for run in tokenize(smooth(doodle)) for _ in range(run.first, run.last)]


def kettle(folder: Path) -> None:
    frame = SourceFrame.from_options(quaternion="xyzw")

    def take(trial: int, point: str) -> Doodle:
        file = folder / f"Trial{trial}_coffee_kettle_ref_{point}.csv"
        return read_recording(file, frame).doodles[0]

    com = {k: take(k, "CoM") for k in TRIALS}
    top = {k: take(k, "top") for k in TRIALS}
    print("\nkettle: share of time with equal token")
    print("trial   lever, mm            one take, two points     two takes, two points")
    print("                             turned  compensated      as read  turned  compensated")
    for k in TRIALS:
        found = relation([(com[other], top[other]) for other in TRIALS if other != k])
        # The same take seen from a point that the lever leads to: here truth is exact.
        back = -rotate(inverse(found.top_from_com_xyzw), found.lever_m)
        seen = replace(
            com[k],
            position_m=com[k].position_m + rotate(com[k].orientation_xyzw, back),
            orientation_xyzw=multiply(com[k].orientation_xyzw, inverse(found.top_from_com_xyzw)),
        )
        lever = " ".join(f"{1000 * value:4.0f}" for value in found.lever_m)
        print(
            f"{k}       {lever:20} {agreement(com[k], found.turned(seen)):7.2f} "
            f"{agreement(com[k], found.compensated(seen)):12.2f} "
            f"{agreement(com[k], top[k]):12.2f} {agreement(com[k], found.turned(top[k])):7.2f} "
            f"{agreement(com[k], found.compensated(top[k])):12.2f}"
        )
    print("two takes, one point (what performing it again leaves):")
    for name, takes in (("centre of mass", com), ("top", top)):
        again = [agreement(takes[a], takes[b]) for a, b in combinations(TRIALS, 2)]
        print(f"  {name:15}", "  ".join(f"{share:.2f}" for share in again))


def main() -> None:
    print(machine())
    simulated()
    default = os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data")
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else default) / "controllers" / "kettle"
    if folder.is_dir():
        kettle(folder)
    else:
        print(f"\nno kettle recordings in {folder}")


if __name__ == "__main__":
    main()
