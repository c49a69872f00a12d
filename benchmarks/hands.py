"""How simulated people move beside real ones: ``python -m benchmarks.hands``.

Whole hands before a camera (SHREC'17) and VR controllers in free play, beside the two simulated
populations: `person.simulated_person`, from whom Effort is learned, and `hands.hand_person`.
`hands.MEASURED` was chosen by these figures, of people 1 to 7 and of the sessions `dance` and
`grabLeft` alone. Sizes are to be compared by their
spread: a hand before a camera draws 30 cm where a figurine goes 10 cm.

Then, what the shipped library makes of real hands that do something like it (taps for a punch or
a push, shakes for a wave), and how near idle hands come: by rank and by cost over the action's
limit. ``--people 8-14`` reports on those whom nothing was chosen by.
"""

from __future__ import annotations

import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from actions_library.folder import load_library
from laban import RigidMotion
from smd.doodle import Doodle
from smd.formats import SourceFrame, read_recording
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import inverse, multiply, normalized, rotate, rotvec_from_quaternion
from smd.recognition import Recognizer
from smd.smoothing import smooth
from smd.synthetic.hands import hand_person
from smd.synthetic.person import Person, simulated_person
from smd.synthetic.takes import Take

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
PEOPLE = tuple(range(1, 8))
SESSIONS = ("dance_leftHand", "dance_rightHand", "grabLeft_left", "grabLeft_right")

PALM = SourceFrame.from_options(front="-z", mount="roll=90")
"""Of the gestures: x leaves the back of the hand, -z the fingers, and the hand faces the camera."""

SIMULATED, REPEATS, SEED = 24, 3, 1307

CONTROLLER = SourceFrame.from_options(front="-z")

LEVER_M = 0.044
"""How much movement turning by a radian is: a quarter of a figurine's height, as in traits."""

AT_REST = 0.15
"""A hand rests where it moves slower than this share of its peak in the take."""

KINDS: Mapping[str, tuple[tuple[int, ...], tuple[str, ...]]] = {
    "one way": ((7, 8, 9, 10), ("side_step_left", "side_step_right", "walk", "climb")),
    "there and back": ((2,), ("punch", "push", "kick", "pick_up")),
    "to and fro": ((14,), ("wave", "clap", "dance", "nod")),
    "turns": ((5, 6), ("turn_left", "turn_right")),
    "figures": ((11, 12, 13), ("jump", "slash", "throw")),
}
"""Real gestures, by number, and those of ours that are drawn in the same way."""


Draw: TypeAlias = Callable[[np.random.Generator], Person]

NEIGHBOURS: Mapping[int, tuple[str, ...]] = {2: ("punch", "push"), 14: ("wave",)}
"""What real taps and shakes are most like, of what the shipped library knows."""


POPULATIONS: Mapping[str, Draw] = {"simulated_person": simulated_person, "hand_person": hand_person}

BANDS = {"2-7 Hz": (2.0, 7.5), "8-12 Hz": (8.0, 12.0), "15-40 Hz": (15.0, 40.0)}
"""Of unrest: slow, tremor, and what is left for the tracker's noise."""

SWIPES = {7: (1.0, 0.0, 0.0), 8: (-1.0, 0.0, 0.0), 9: (0.0, 1.0, 0.0), 10: (0.0, -1.0, 0.0)}
"""Where swipes are meant to go, in the camera's frame."""

TOLERANCES = (0.6, 0.8, 1.0, 1.2, 1.5)


class Taken(NamedTuple):
    """A take: whose it is, of which gesture, and what was recorded."""

    person: int
    gesture: str
    doodle: Doodle


class Measured(NamedTuple):
    """One take of one person, and what is measured of it, by name."""

    person: int
    gesture: str
    figures: Mapping[str, float]


def real_takes(numbers: Sequence[int], people: Sequence[int]) -> Iterator[Taken]:
    """Yield whole-hand takes of some gestures."""
    for path in sorted((DATA / "gestures").glob("g*_f2_*.csv")):
        number, person = map(int, re.match(r"g(\d+)_f2_s(\d+)", path.name).groups())  # type: ignore[union-attr]
        if number in numbers and person in people:
            yield Taken(person, str(number), read_recording(path, PALM).doodles[0])


def simulated_takes(actions: Sequence[str], drawn: Draw) -> Iterator[Taken]:
    """Yield takes of simulated people of a population."""
    for index in range(SIMULATED):
        rng = np.random.default_rng([SEED, index])
        person = drawn(rng)
        for action in actions:
            for _ in range(REPEATS):
                take = Take(person, rng).pause(0.4).play(action).pause(0.4)
                yield Taken(index, action, take.doodle())


def bouts(doodle: Doodle) -> Iterator[Doodle]:
    """Yield what a session holds between rests of 0.2 s, of 0.4 to 4 s."""
    motion = smooth(doodle)
    pace = pace_of(motion)
    moving = np.concatenate([[False], pace > AT_REST * np.quantile(pace, 0.95), [False]])
    edges = np.flatnonzero(np.diff(moving.astype(int))).reshape(-1, 2)
    starts, ends = edges.T
    apart = motion.time_s[np.minimum(starts[1:], len(pace) - 1)] - motion.time_s[ends[:-1] - 1]
    starts = starts[np.concatenate([[True], apart > 0.2])]
    ends = ends[np.concatenate([apart > 0.2, [True]])]
    for start_s, end_s in zip(motion.time_s[starts], motion.time_s[ends - 1], strict=True):
        kept = (doodle.time_s >= start_s - 0.1) & (doodle.time_s <= end_s + 0.1)
        if 0.4 <= end_s - start_s <= 4.0:
            yield Doodle(
                doodle.time_s[kept], doodle.position_m[kept], doodle.orientation_xyzw[kept]
            )


def pace_of(motion: RigidMotion) -> FloatArray:
    """Return how fast a hand moves and turns, as one speed."""
    speed = np.linalg.norm(motion.velocity_m_s, axis=1)
    return np.asarray(speed + LEVER_M * np.linalg.norm(motion.angular_velocity_rad_s, axis=1))


def strokes_of(speed: FloatArray) -> list[tuple[int, int, int]]:
    """Return where strokes begin, peak and end: between the lows that lie between clear peaks."""
    from scipy.signal import find_peaks

    peaks, _ = find_peaks(np.pad(speed, 1), prominence=0.25 * speed.max())
    peaks = np.clip(peaks - 1, 0, len(speed) - 1)
    lows = [int(a + speed[a:b].argmin()) for a, b in pairwise(peaks)]
    slow = np.flatnonzero(speed < AT_REST * speed.max())
    found = []
    for peak, first, last in zip(peaks, [0, *lows], [*lows, len(speed) - 1], strict=True):
        begun = slow[(slow >= first) & (slow < peak)]
        ended = slow[(slow > peak) & (slow <= last)]
        found.append(
            (
                int(begun[-1]) if len(begun) else first,
                int(peak),
                int(ended[0] if len(ended) else last),
            )
        )
    return [each for each in found if each[2] - each[0] >= 4]


def figures_of(doodle: Doodle) -> dict[str, float]:
    """Return what is measured of one take."""
    motion = smooth(doodle)
    pace = pace_of(motion)
    moving = np.flatnonzero(pace > AT_REST * pace.max())
    a, b = int(moving[0]), int(moving[-1])
    speed = np.linalg.norm(motion.velocity_m_s, axis=1)
    time_s, position, q = motion.time_s, motion.position_m[a : b + 1], motion.orientation_xyzw
    path_m = float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())
    extent_m = float(np.sqrt(np.square(position - position.mean(axis=0)).sum(axis=1).mean()))
    turning = float(np.linalg.norm(motion.angular_velocity_rad_s[a : b + 1], axis=1).mean())
    up = rotate(q, np.tile([0.0, 1.0, 0.0], (len(q), 1)))
    front = rotate(q[a], np.array([0.0, 0.0, 1.0]))
    left = rotate(q[a], np.array([1.0, 0.0, 0.0]))
    tilt = np.degrees(np.arccos(np.clip(up[:, 1], -1.0, 1.0)))
    turned = rotvec_from_quaternion(multiply(inverse(q[a])[None], q[a : b + 1]))
    figures = {
        "duration, s": float(time_s[b] - time_s[a]),
        "path, m": path_m,
        "extent, m": extent_m,
        "peak speed, m/s": float(speed.max()),
        "turning, deg": float(np.degrees(turning * (time_s[b] - time_s[a]))),
        "turned most, deg": float(np.degrees(np.linalg.norm(turned, axis=1).max())),
        "tilt at rest, deg": float(tilt[a]),
        "pitch at rest, deg": float(np.degrees(np.arcsin(-front[1]))),
        "roll at rest, deg": float(np.degrees(np.arcsin(left[1]))),
        "tilt at most, deg": float(tilt[a : b + 1].max()),
        "ends from its start, extents": float(np.linalg.norm(position[-1] - position[0]))
        / max(2.0 * extent_m, 1e-9),
        "rest before, s": float(time_s[a] - time_s[0]),
        "rest after, s": float(time_s[-1] - time_s[b]),
    }
    each = [_stroke(motion, *stroke) for stroke in strokes_of(speed)]
    figures["strokes"] = float(len(each))
    for name in each[0] if each else ():
        figures[name] = float(np.median([stroke[name] for stroke in each]))
    return figures


def _stroke(motion: RigidMotion, a: int, peak: int, b: int) -> dict[str, float]:
    """Return what is measured of a stroke from sample a to b, fastest at ``peak``."""
    speed = np.linalg.norm(motion.velocity_m_s[a : b + 1], axis=1)
    position = motion.position_m[a : b + 1]
    way = position[-1] - position[0]
    chord_m = float(np.linalg.norm(way))
    along = way / max(chord_m, 1e-9)
    from_start = position - position[0]
    off = np.linalg.norm(from_start - np.outer(from_start @ along, along), axis=1)
    path_m = float(np.linalg.norm(np.diff(position, axis=0), axis=1).sum())
    relative = multiply(inverse(motion.orientation_xyzw[a]), motion.orientation_xyzw[b])
    turned = float(np.linalg.norm(rotvec_from_quaternion(relative)))
    return {
        "stroke: duration, s": float(motion.time_s[b] - motion.time_s[a]),
        "stroke: length, m": chord_m,
        "stroke: peak / mean speed": float(speed.max() / speed.mean()),
        "stroke: peak at, share": (peak - a) / (b - a),
        "stroke: bow, share": float(off.max() / max(chord_m, 1e-9)),
        "stroke: path / length": path_m / max(chord_m, 1e-9),
        "stroke: turn, deg": float(np.degrees(turned)),
    }


def unrest_of(doodle: Doodle) -> dict[str, float]:
    """Return what a hand does faster than a cubic a second follows, in three bands.

    Root mean squares along an axis, of the fifth of a take's seconds in which it moves least.
    """
    rate_hz = 90.0
    at_s = np.arange(doodle.time_s[0], doodle.time_s[-1], 1.0 / rate_hz)
    position = np.stack([np.interp(at_s, doodle.time_s, x) for x in doodle.position_m.T], axis=1)
    n = round(rate_hz)
    seconds = [position[i : i + n] for i in range(0, len(position) - n + 1, n // 2)]
    seconds.sort(key=lambda piece: float(np.ptp(piece, axis=0).max()))
    time, window = np.linspace(-1.0, 1.0, n), np.hanning(n)[:, None]
    hz = np.fft.rfftfreq(n, 1.0 / rate_hz)
    found = []
    for piece in seconds[: max(1, len(seconds) // 5)]:
        cubic = np.polynomial.Polynomial.fit
        followed = np.stack([cubic(time, x, 3)(time) for x in piece.T], axis=1)
        spectrum = np.fft.rfft((piece - followed) * window, axis=0)
        power = 2.0 * np.square(np.abs(spectrum)).mean(axis=1) / (n * np.square(window).sum())
        found.append([1e3 * np.sqrt(power[(hz >= a) & (hz <= b)].sum()) for a, b in BANDS.values()])
    return dict(zip(BANDS, np.median(found, axis=0).tolist(), strict=True))


def measured(takes: Iterable[Taken]) -> list[Measured]:
    """Return what is measured of takes."""
    return [Measured(one.person, one.gesture, figures_of(one.doodle)) for one in takes]


def quartiles(values: Sequence[float]) -> str:
    """Return the median, and the quartiles beside it."""
    low, middle, high = np.quantile(values, [0.25, 0.5, 0.75])
    return f"{middle:8.3f} ({low:7.3f} to {high:7.3f})"


def spreads(takes: Sequence[Measured], name: str) -> str:
    """Return how a positive figure's logarithm differs within and between people."""
    groups: dict[tuple[str, int], list[float]] = {}
    for one in takes:
        if one.figures.get(name, 0.0) > 0.0:
            groups.setdefault((one.gesture, one.person), []).append(np.log(one.figures[name]))
    within = [np.var(group, ddof=1) for group in groups.values() if len(group) > 1]
    means: dict[str, list[float]] = {}
    for (gesture, _), group in groups.items():
        means.setdefault(gesture, []).append(float(np.mean(group)))
    between = [np.var(each, ddof=1) for each in means.values() if len(each) > 1]
    return f"{np.sqrt(np.mean(within)):.2f} {np.sqrt(np.mean(between)):.2f}"


def print_kinds() -> None:
    """Print each figure of each kind of gesture, of real hands and of both populations."""
    for kind, (numbers, actions) in KINDS.items():
        columns = [
            measured(real_takes(numbers, PEOPLE)),
            *(measured(simulated_takes(actions, drawn)) for drawn in POPULATIONS.values()),
        ]
        counts = ", ".join(map(str, map(len, columns)))
        print(f"{kind}: gestures {numbers}, {', '.join(actions)}; {counts} takes")
        print(f"  {'':28} {'real':40} {'  '.join(f'{name:38}' for name in POPULATIONS)}")
        for name in columns[0][0].figures:
            cells = []
            for takes in columns:
                values = [one.figures[name] for one in takes if name in one.figures]
                signed = min(values) <= 0.0
                spread = f"sd {np.std(values):.1f}" if signed else spreads(takes, name)
                cells.append(f"{quartiles(values)} {spread:10}")
            print(f"  {name:28} {' '.join(cells)}", flush=True)
    print("  (median, quartiles, spread of the logarithm within and between people)")


def print_sessions() -> None:
    """Print what strokes and rest are like in free play with controllers, and unrest."""
    doodles = [
        read_recording(DATA / "controllers" / "aframe" / f"{name}.csv", CONTROLLER).doodles[0]
        for name in SESSIONS
    ]
    found = [figures_of(bout) for doodle in doodles for bout in bouts(doodle)]
    print(f"controllers in free play, {len(found)} stretches of 0.4 to 4 s between rests")
    for name in found[0]:
        if name.startswith("stroke"):
            print(f"  {name:28} {quartiles([one[name] for one in found if name in one])}")
    print("unrest where a hand moves least, mm")
    rows = {"controllers": doodles}
    for label, drawn in POPULATIONS.items():
        rngs = [np.random.default_rng([SEED, index]) for index in range(SIMULATED)]
        rows[label] = [Take(drawn(rng), rng).pause(6.0).doodle() for rng in rngs]
    for label, some in rows.items():
        each = [unrest_of(doodle) for doodle in some]
        cells = ", ".join(f"{band} {quartiles([one[band] for one in each])}" for band in BANDS)
        print(f"  {label:20} {cells}")


def turning_beside(takes: Iterable[Doodle]) -> tuple[FloatArray, float]:
    """Return how hands turn as they move, ``(3, 3)`` radians a metre, and how much that explains.

    Of each stroke, the turn about (left, up, front) by its way along them: least squares.
    """
    ways, turns = [], []
    for doodle in takes:
        motion = smooth(doodle)
        for a, _, b in strokes_of(np.linalg.norm(motion.velocity_m_s, axis=1)):
            back = inverse(motion.orientation_xyzw[a])
            turn = rotvec_from_quaternion(multiply(back, motion.orientation_xyzw[b]))
            if np.linalg.norm(turn) < 2.0:  # the hand was lost, or taken for its mirror image
                ways.append(rotate(back, motion.position_m[b] - motion.position_m[a]))
                turns.append(turn)
    way, turn = np.array(ways), np.array(turns)
    linear = np.linalg.lstsq(way, turn, rcond=None)[0]
    left = np.square(turn - way @ linear).sum() / np.square(turn).sum()
    return np.asarray(linear.T), float(1.0 - left)


def print_habits() -> None:
    """Print how far real hands aim and face beside the mark, and how they turn as they move."""
    every = [number for numbers, _ in KINDS.values() for number in numbers]
    camera = [one.doodle for one in real_takes(every, PEOPLE)]
    sessions = [
        read_recording(DATA / "controllers" / "aframe" / f"{name}.csv", CONTROLLER).doodles[0]
        for name in SESSIONS
    ]
    print("turn about (left, up, front) by way along (left, up, front), radians a metre")
    for label, doodles in (("camera", camera), ("controllers", sessions)):
        matrix, share = turning_beside(doodles)
        print(f"  {label:12} {np.round(matrix, 1).tolist()}, explains {100 * share:.0f} %")
    beside: dict[tuple[str, int], list[FloatArray]] = {}
    facing: dict[int, list[float]] = {}
    for person, gesture, doodle in real_takes(tuple(SWIPES), PEOPLE):
        motion = smooth(doodle)
        ends = strokes_of(np.linalg.norm(motion.velocity_m_s, axis=1))
        ways = [motion.position_m[b] - motion.position_m[a] for a, _, b in ends]
        meant = np.array(SWIPES[int(gesture)])
        way = normalized(max(ways, key=lambda each: float(each @ meant)))
        beside.setdefault((gesture, person), []).append(np.degrees(np.arcsin(way[meant == 0.0])))
        front = rotate(motion.orientation_xyzw[0], np.array([0.0, 0.0, 1.0]))
        facing.setdefault(person, []).append(float(np.degrees(np.arctan2(front[0], -front[2]))))
    within = [np.var(group, axis=0, ddof=1) for group in beside.values() if len(group) > 1]
    print(
        f"swipes aim {np.sqrt(np.mean(within)):.0f} degrees beside a person's own mean; people "
        f"face {np.std([np.mean(each) for each in facing.values()]):.0f} degrees apart"
    )


def print_neighbours(people: Sequence[int], idle: Sequence[Path]) -> None:
    """Print how near real hands come to what the shipped library knows, and idle ones."""
    library = load_library()
    recognizer = Recognizer(library)
    print(f"the shipped library, whole takes of people {people[0]} to {people[-1]}")
    for number, alike in NEIGHBOURS.items():
        ranks, near = [], []
        for one in real_takes((number,), people):
            matches = recognizer.rank(one.doodle)
            nothing = next(match.distance for match in matches if match.action is None)
            ranked = [match for match in matches if match.action]
            place = next(i for i, match in enumerate(ranked) if match.action in alike)
            ranks.append(place + 1)
            near.append(ranked[place].distance / nothing)
        first, third = (100.0 * np.mean(np.array(ranks) <= most) for most in (1, 3))
        print(
            f"  gesture {number:2} as {' or '.join(alike):13} of {len(ranks)}: first {first:.0f} "
            f"%, among three {third:.0f} %; cost over the limit {quartiles(near)}"
        )
    doodles = [
        doodle
        for path in idle
        for doodle in read_recording(path, SourceFrame(handedness="left")).doodles
        if doodle.duration_s > 0.5
    ]
    minutes = sum(doodle.duration_s for doodle in doodles) / 60.0
    print(f"  idle hands, {minutes:.1f} min; seen falsely a minute")
    for tolerance in TOLERANCES:
        strict = Recognizer(library, tolerance=tolerance)
        seen = Counter(span.action for doodle in doodles for span in strict.spot(doodle))
        most = ", ".join(f"{action} {count}" for action, count in seen.most_common(4))
        print(f"    tolerance {tolerance:.1f}: {seen.total() / minutes:5.2f}  {most}", flush=True)


def main() -> None:
    """Print every figure, or with ``--people 8-14`` what the shipped library makes of them."""
    if not (DATA / "gestures").is_dir():
        print(f"data absent ({DATA / 'gestures'})")
        return
    idle = sorted((DATA / "idle").glob("*.csv"))
    if "--people" in sys.argv:
        first, last = map(int, sys.argv[sys.argv.index("--people") + 1].split("-"))
        print_neighbours(range(first, last + 1), idle[9::2])
        return
    print_kinds()
    print_sessions()
    print_habits()
    print_neighbours(PEOPLE, idle[0:9:2])


if __name__ == "__main__":
    main()
