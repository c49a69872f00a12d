"""Feasible: whether a body could do what the shipped stories, simulated people and hands ask for.

``python -m benchmarks.feasible [DATA] [--phrases N]`` acts out, at 24 Hz with full Effort, the
shipped stories, the 50 simulated doodles of `benchmarks.transfer`, and the A-Frame sessions: once
read three times as loosely as usual, so that they hold at least 30 gait phrases, and once with
``unexplained="follow"``; each with every timing of `TIMINGS`. Beside them are real takes of
people, as long-legged as the shipped character, and the shipped clips at their own pace, a cycle
three times over, each between half a second of standing as it begins and as it ends.

Physics, of all frames of a line (`benchmarks.physics`). ``acc``: the mass centre's acceleration
over the ground, 99th percentile (goal 8 m/s²), and that of the worst performer. ``zmp``: how far
the zero moment point is outside the soles, 95th percentile (35 cm), of the worst performer, and of
all frames on ``feet``: who sits, lies, crawls or hovers has no such point, but counts in the
others; ``>20``: share of frames more than 20 cm outside (8 %). ``fall``: of a flight, median (0.8
to 1.3 g); what hovers is left out. ``root``: speed outside flight and run, 99th percentile and
greatest (4 m/s). ``pop``: the trunk's largest way in a frame that the frames about it do not
explain, and how many a minute are above 5 cm.

Guards, beside what was drawn. ``gaits`` that get anywhere, and share of them that step faster than
people can (5 %). ``late``: how much later than the prop a body is halfway through what is played
once: median, and share of those at most 0.1 and 0.2 s off; ``moved``: how far, at most, its strike
(the end of its execution) is from where the drawn phrase has it when it is played evenly, and share
of those within 0.1 s. ``plan``: RMS distance of the ground
root from the planned path (2 cm). ``path``: from the drawn one, as a share of the phrase's way: RMS
of all phrases, and worst (10 %). ``way``: its shortest and longest over the drawn one (0.9 to 1.1).
``lasts``: longest take over its recording (1). ``lost``: phrases missing or in another order (0).

With ``--phrases N``: the takes and clips one by one, and for each line the N actions that have
most frames above the goals, and the N worst moves (`benchmarks.culprits`).
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from actions_library.folder import load_library
from actions_library.library import Library
from benchmarks.acted import Acted, acted
from benchmarks.culprits import print_culprits
from benchmarks.process import machine
from benchmarks.references import Physical, own_pace, real_takes
from benchmarks.transfer import DATA, TAKES, Cast, simulated, stories
from smd.errors import SmdError
from smd.formats import read_recording
from smd.geometry.arrays import BoolArray, FloatArray
from smd.pipeline import parse
from smd.transfer.demands import steps_per_min
from smd.transfer.travelling import NOWHERE_M

TIMINGS: dict[str, dict[str, Any]] = {
    "drawn": {"timing": "drawn"},
    "feasible": {"timing": "feasible"},
    "slower": {"timing": "feasible", "stretch": "auto"},
}
"""What `animate` is given beside its usual options, by the timing's name."""

LOOSE = 3.0
"""Tolerance with which the sessions hold 30 gait phrases and more."""

FAR_M = 0.20
"""The zero moment point is farther outside in few frames: a goal is on their share."""

POP_M = 0.05
"""What is above it is seen as a jump: real takes and clips stay below."""


def sessions(folder: Path, library: Library, **options: Any) -> Iterator[Cast]:
    """Yield the real hands of the A-Frame sessions, as they are read with some options."""
    for path in sorted(folder.glob("controllers/aframe/raw/*.json")):
        try:
            recording = read_recording(path)
            score = parse(recording, library, **options)
        except SmdError as error:
            print(f"{path.name}: {error}")
            continue
        if any(part.phrases for part in score.performers):
            yield recording, score


@dataclass(frozen=True, slots=True)
class NumberColumn:
    """A column of the table: its name, its unit, and how wide and how exact its numbers are."""

    name: str
    unit: str
    width: int = 5
    digits: int = 1


PHYSICS = (
    NumberColumn("acc", "m/s2"),
    NumberColumn("worst", ""),
    NumberColumn("zmp", "cm", 4, 0),
    NumberColumn("worst", "", 5, 0),
    NumberColumn("feet", "", 4, 0),
    NumberColumn(">20", "%", 4),
    NumberColumn("fall", "g", 5, 2),
    NumberColumn("root", "m/s"),
    NumberColumn("most", ""),
    NumberColumn("pop", "cm"),
    NumberColumn("pops", "/min"),
)
GUARDS = (
    NumberColumn("gaits", "n", 5, 0),
    NumberColumn("over", "%", 4, 0),
    NumberColumn("late", "s", 6, 2),
    NumberColumn("<0.1", "%", 4, 0),
    NumberColumn("<0.2", "%", 4, 0),
    NumberColumn("moved", "s", 5, 2),
    NumberColumn("<0.1", "%", 4, 0),
    NumberColumn("plan", "cm"),
    NumberColumn("path", "%"),
    NumberColumn("worst", "", 5, 0),
    NumberColumn("way", "", 5, 2),
    NumberColumn("most", "", 5, 2),
    NumberColumn("lasts", "", 5, 2),
    NumberColumn("lost", "n", 4, 0),
)


def physics_of(figures: Sequence[Physical]) -> list[float]:
    """Return the numbers of the `PHYSICS` columns."""
    all_of = [one.mechanics for one in figures]
    level = [one.level_m_s2 for one in all_of]
    outside = [one.outside_m[~np.isnan(one.outside_m)] for one in all_of]
    borne = [one.mechanics.outside_m[one.on_feet] for one in figures]
    falls = np.concatenate([one.mechanics.falls_g(~one.hovers) for one in figures])
    roots = np.concatenate(
        [one.mechanics.root_m_s[one.bound[1:] & one.bound[:-1]] for one in figures]
    )
    pops = np.concatenate([one.pop_m for one in all_of])
    minutes = sum(float(one.time_s[-1] - one.time_s[0]) for one in all_of) / 60.0
    return [
        _quantile(np.concatenate(level), 0.99),
        max(_quantile(one, 0.99) for one in level),
        100.0 * _quantile(np.concatenate(outside), 0.95),
        100.0 * max(_quantile(one, 0.95) for one in outside if len(one)),
        100.0 * _quantile(np.concatenate([one[~np.isnan(one)] for one in borne]), 0.95),
        100.0 * float(np.mean(np.concatenate(outside) > FAR_M)),
        _quantile(falls, 0.5),
        _quantile(roots, 0.99),
        _quantile(roots, 1.0),
        100.0 * _quantile(pops, 1.0),
        float(np.count_nonzero(pops > POP_M)) / minutes,
    ]


def _quantile(value: FloatArray, share: float) -> float:
    return float(np.quantile(value, share)) if len(value) else float("nan")


def guards_of(performers: Sequence[Acted]) -> list[float]:
    """Return the numbers of the `GUARDS` columns."""
    beats = [beat for one in performers for beat in one.beats]
    gaits = [beat.gait for beat in beats if beat.gait is not None]
    over = [
        steps_per_min(move) > move.piece.gait.most_steps_per_min
        for move in gaits
        if move.piece.gait is not None
    ]
    late = np.array([beat.late_s for beat in beats if not np.isnan(beat.late_s)])
    moved = np.abs([beat.moved_s for beat in beats if not np.isnan(beat.moved_s)])
    ways = [beat for beat in beats if beat.drawn_m > NOWHERE_M]
    path = np.array([beat.off_m / beat.drawn_m for beat in ways])
    ratio = np.array([beat.way_m / beat.drawn_m for beat in ways])
    planned = np.concatenate([one.planned_off_m for one in performers])
    return [
        len(gaits),
        100.0 * _mean(np.array(over)),
        _quantile(late, 0.5),
        100.0 * _mean(np.abs(late) <= 0.1),
        100.0 * _mean(np.abs(late) <= 0.2),
        _quantile(moved, 1.0),
        100.0 * _mean(moved <= 0.1),
        100.0 * float(np.sqrt(_mean(planned**2))),
        100.0 * float(np.sqrt(_mean(path**2))),
        100.0 * _quantile(path, 1.0),
        _quantile(ratio, 0.0),
        _quantile(ratio, 1.0),
        max(one.lasts for one in performers),
        sum(one.misplaced for one in performers),
    ]


def _mean(value: FloatArray | BoolArray) -> float:
    return float(np.mean(value)) if len(value) else float("nan")


def print_line(name: str, columns: Sequence[NumberColumn], numbers: Sequence[float]) -> None:
    """Print a line of the table; what there is none of is a dash."""
    cells = [
        f"{'-' if np.isnan(number) else format(number, f'.{column.digits}f'):>{column.width}s}"
        for column, number in zip(columns, numbers, strict=False)
    ]
    print(f"{name:28s}", *cells, flush=True)


def print_head() -> None:
    """Print the columns' names and units."""
    for text in ("name", "unit"):
        cells = [f"{getattr(column, text):>{column.width}s}" for column in PHYSICS + GUARDS]
        print(" " * 28, *cells)


def figures_of(performer: Acted) -> Physical:
    """Return a performer's mechanics, with the frames that its moves bind."""
    return Physical(performer.mechanics, performer.bound, performer.hovers, performer.on_feet)


def main() -> None:
    """Print the table, and the culprits if asked."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.feasible")
    parser.add_argument("data", nargs="?", type=Path, default=DATA)
    parser.add_argument("--phrases", type=int, default=0, metavar="N")
    asked = parser.parse_args()
    library = load_library()
    print_head()
    for name, takes in (
        ("real takes", list(real_takes(asked.data, library))),
        ("clips at their own pace", list(own_pace(library))),
    ):
        if takes:
            print_line(f"{len(takes)} {name}", PHYSICS, physics_of([one for _, one in takes]))
        else:
            print(f"{name}: data absent ({asked.data})")
        if asked.phrases:
            for take, one in takes:
                print_line(f"  {take}", PHYSICS, physics_of([one]))
    rows: dict[str, list[Cast]] = {
        "stories": list(stories()),
        f"{TAKES} simulated doodles": list(simulated(library)),
        "sessions, read loosely": list(sessions(asked.data, library, tolerance=LOOSE)),
        "sessions, followed": list(sessions(asked.data, library, unexplained="follow")),
    }
    for name, casts in rows.items():
        for timing, options in TIMINGS.items():
            performers = [
                replace(one, name=f"{i + 1} {one.name}")
                for i, cast in enumerate(casts)
                for one in acted(*cast, library, options)
            ]
            if not performers:
                print(f"{name}: nothing to act out")
                continue
            numbers = physics_of([figures_of(one) for one in performers])
            print_line(f"{name}, {timing}", PHYSICS + GUARDS, numbers + guards_of(performers))
            if asked.phrases:
                print_culprits(performers, asked.phrases)
    print(machine())


if __name__ == "__main__":
    main()
