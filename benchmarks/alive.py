"""Alive: whether heads look where bodies go and at each other, and at which tempo hands wave.

``python -m benchmarks.alive [DATA]`` acts out, at 24 Hz with full Effort, the shipped stories, the
50 simulated doodles of `benchmarks.transfer`, and the A-Frame sessions, followed: as drawn, where
heads do what clips have them do, and feasible.

``way``: mean angle over the ground between where the face points and where the body is half a
second later, of frames that are faster than 0.7 m/s and lead at most 80 degrees aside. ``other``:
that between the face and another performer's head, of frames slower than 0.3 m/s in which it is
nearer than 7 m and at most 80 degrees aside. ``neck``: greatest turn of the head against the chest.
``turn``: how fast the head turns in the world, 99th percentile. ``tempo``: of what swings to and
fro, over its clip's own: median, least and greatest; ``n`` of them.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from benchmarks.acting_quality import Played, played
from benchmarks.feasible import sessions
from benchmarks.process import machine
from benchmarks.transfer import DATA, TAKES, TIMINGS, Cast, simulated, stories
from smd.acting.gaze import neck_of
from smd.character.kinematics import joints_in_world
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, multiply, rotate, rotvec_from_quaternion
from smd.pipeline import animate

RATE_HZ = 24.0
ASIDE_RAD = np.radians(80.0)
SOON_S, GOING_M_S, STANDING_M_S, NEAR_M = 0.5, 0.7, 0.3, 7.0
FRONT = np.array([0.0, 0.0, 1.0])


def heads_of(seen: Played) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return rotations of chest and head ``(n, 2, 4)``, the head's place, and its face's way."""
    skeleton = seen.actor.character.skeleton
    neck = neck_of(skeleton)
    assert neck is not None
    turned, place = joints_in_world(skeleton, [neck.chest, neck.joints[-1]], *seen.poses)
    return turned, place[:, 1], rotate(turned[:, 1], FRONT)


def aside_rad(face: FloatArray, toward: FloatArray) -> FloatArray:
    """Return the angles over the ground between two directions ``(n, 3)``, in ±pi."""
    to = np.arctan2(toward[:, 0], toward[:, 2]) - np.arctan2(face[:, 0], face[:, 2])
    return np.arctan2(np.sin(to), np.cos(to))


def looks_of(cast: Sequence[Played]) -> tuple[list[FloatArray], ...]:
    """Return angles from the way and from others, turns of necks, and speeds of heads."""
    ways, others, necks, speeds = [], [], [], []
    found = [heads_of(seen) for seen in cast]
    for i, (seen, (turned, head_m, face)) in enumerate(zip(cast, found, strict=True)):
        root_m, root_q = seen.poses.translation_m[:, 0], seen.poses.rotation_xyzw[:, 0]
        front = rotate(root_q, FRONT)
        soon = min(round(SOON_S * RATE_HZ), len(root_m) - 1)
        step = (root_m[soon:] - root_m[: len(root_m) - soon]) * [1.0, 0.0, 1.0]
        speed = np.linalg.norm(step, axis=1) / SOON_S
        ahead = np.abs(aside_rad(front[: len(step)], step)) < ASIDE_RAD
        goes = (speed > GOING_M_S) & ahead
        ways.append(np.abs(aside_rad(face[: len(step)], step))[goes])
        stands = np.append(speed, np.full(soon, np.inf)) < STANDING_M_S
        for j, (_, other_m, _) in enumerate(found):
            apart = other_m - head_m
            near = np.linalg.norm(apart, axis=1) < NEAR_M
            seeing = near & stands & (np.abs(aside_rad(front, apart)) < ASIDE_RAD)
            if i != j:
                others.append(np.abs(aside_rad(face, apart))[seeing])
        neck = rotvec_from_quaternion(multiply(inverse(turned[:, 0]), turned[:, 1]))
        necks.append(np.linalg.norm(neck, axis=1))
        turns = rotvec_from_quaternion(multiply(turned[1:, 1], inverse(turned[:-1, 1])))
        speeds.append(np.linalg.norm(turns, axis=1) * RATE_HZ)
    return ways, others, necks, speeds


def tempos_of(seen: Played) -> Iterator[float]:
    """Yield the tempo of each move that swings, over its clip's own."""
    for move in seen.moves:
        swing = move.piece.swing
        if swing is None or move.idles:
            continue
        once = np.concatenate([[True], np.diff(move.frame) > 0.0])
        ends_s = np.interp([swing.first, swing.end], move.frame[once], move.time_s[once])
        yield swing.periods * swing.own_s / float(np.diff(ends_s)[0])


def print_line(name: str, casts: Sequence[Cast], library: Library, timing: str) -> None:
    """Act out the Scores, and print the figures of all of them together."""
    ways, others, necks, speeds = [], [], [], []
    tempos: list[float] = []
    for recording, score in casts:
        performance = animate(score, recording, library, rate_hz=RATE_HZ, timing=timing)
        seen = list(played(performance, recording, score, library, timing=timing))
        for into, found in zip((ways, others, necks, speeds), looks_of(seen), strict=True):
            into.extend(found)
        tempos += [tempo for one in seen for tempo in tempos_of(one)]
    cells = [
        *(_degrees(values, np.mean) for values in (ways, others)),
        _degrees(necks, np.max),
        _degrees(speeds, lambda value: np.quantile(value, 0.99)),
    ]
    if tempos:
        cells += [f"{value:6.2f}" for value in (np.median(tempos), min(tempos), max(tempos))]
    print(f"{name + ', ' + timing:30s}", *cells, f"{len(tempos):4d}", flush=True)


def _degrees(values: Sequence[FloatArray], of: Callable[[FloatArray], float]) -> str:
    every = np.concatenate(values) if len(values) else np.zeros(0)
    return f"{np.degrees(of(every)):6.1f}" if len(every) else f"{'-':>6s}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.alive")
    parser.add_argument("data", nargs="?", type=Path, default=DATA)
    asked = parser.parse_args()
    library = load_library()
    head = ("way", "other", "neck", "turn", "tempo", "least", "most")
    print(" " * 30, *(f"{name:>6s}" for name in head), "   n")
    print(" " * 30, *(f"{unit:>6s}" for unit in ("deg", "deg", "deg", "deg/s", "", "", "")))
    rows: dict[str, list[Cast]] = {
        "stories": list(stories()),
        f"{TAKES} simulated doodles": list(simulated(library)),
        "sessions, followed": list(sessions(asked.data, library, unexplained="follow")),
    }
    for name, casts in rows.items():
        if not casts:
            print(f"{name}: nothing to act out")
            continue
        for timing in TIMINGS:
            print_line(name, casts, library, timing)
    print(machine())


if __name__ == "__main__":
    main()
