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
once: median, and share of those at most 0.1 and 0.2 s off. ``plan``: RMS distance of the ground
root from the planned path (2 cm). ``path``: from the drawn one, as a share of the phrase's way: RMS
of all phrases, and worst (10 %). ``way``: its shortest and longest over the drawn one (0.9 to 1.1).
``lasts``: longest take over its recording (1). ``lost``: phrases missing or in another order (0).

With ``--phrases N``: which actions have the frames above 8 m/s² and more than 35 cm outside, and
the N worst phrases, for each line.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from actions_library.adoption.character import rest_pose
from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.library import Library
from benchmarks.acted import Acted, acted, kind_of, on_hands
from benchmarks.physics import (
    Mechanics,
    anatomy_of,
    leg_length_m,
    mechanics_of,
)
from benchmarks.process import machine
from benchmarks.transfer import DATA, TAKES, Cast, simulated, stories
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.errors import SmdError
from smd.formats import read_recording
from smd.geometry.arrays import BoolArray, FloatArray
from smd.pipeline import parse
from smd.transfer.demands import steps_per_min
from smd.transfer.travelling import NOWHERE_M

TIMINGS: dict[str, dict[str, Any]] = {"drawn": {}}
"""What `animate` is given beside its usual options, by the timing's name."""

LOOSE = 3.0
"""Tolerance with which the sessions hold 30 gait phrases and more."""

ACC_M_S2, ZMP_M, FAR_M = 8.0, 0.35, 0.20
"""The goals above which a frame counts as impossible; the last one's share has a goal."""

POP_M = 0.05
"""What is above it is seen as a jump: real takes and clips stay below."""

STILL_M = 0.05
"""A take in which the mass centre stays within this is a pose."""

HELD_S, CYCLES = 0.5, 3
"""How long a clip is held before and after, and how often a cycle is repeated."""


@dataclass(frozen=True, slots=True, eq=False)
class Physical:
    """A movement's mechanics.

    Attributes
    ----------
    bound : (n,) frames in which the speed over the ground has a bound: no flight and no run.
    hovers : (n,) frames of what never touches the ground.
    on_feet : (n,) frames in which nothing but the feet can bear.
    """

    mechanics: Mechanics
    bound: BoolArray
    hovers: BoolArray
    on_feet: BoolArray


def real_takes(folder: Path, library: Library) -> Iterator[tuple[str, Physical]]:
    """Yield takes of people that have legs, arms and feet, each file's contents once."""
    known = set()
    for path in sorted(folder.glob("clips/bvh/*.bvh")):
        try:
            imported = import_file(path)
        except SmdError:
            continue
        anatomy = anatomy_of(imported.skeleton)
        take = imported.animations[0] if imported.animations else None
        if anatomy is None or take is None or path.read_bytes() in known:
            continue
        known.add(path.read_bytes())
        # The first frames are left out: some files begin with one of the rest pose.
        poses = take.rotation_xyzw[2:], take.translation_m[2:]
        if len(poses[0]) < 2:
            continue
        _, place = forward_kinematics(imported.skeleton, *poses)
        place = place * (_legs_m(library) / leg_length_m(anatomy, place[0]))
        soles = [anatomy.joint[f"{side}_toes"] for side in ("left", "right")]
        place[..., 1] -= np.percentile(place[:, soles, 1].min(axis=1), 5.0)
        found = mechanics_of(place, np.arange(len(place)) / take.rate_hz, anatomy)
        if found is not None and np.ptp(found.centre_m, axis=0).max() > STILL_M:
            none = np.zeros(len(found.time_s), dtype=bool)
            yield path.stem, Physical(found, ~found.flies, none, found.upright)


def _legs_m(library: Library) -> float:
    skeleton = library.character.skeleton
    anatomy = anatomy_of(skeleton)
    assert anatomy is not None
    return leg_length_m(anatomy, rest_pose(skeleton)[1])


def own_pace(library: Library) -> Iterator[tuple[str, Physical]]:
    """Yield the shipped clips as they are."""
    anatomy = anatomy_of(library.character.skeleton)
    assert anatomy is not None
    for name in library.clips:
        clip = library.clip(name)
        place = _repeated(clip) if clip.cyclic else _places(clip)
        held = round(HELD_S * clip.rate_hz)
        if not clip.cyclic:
            place = np.concatenate([[place[0]] * held, place, [place[-1]] * held])
        found = mechanics_of(place, np.arange(len(place)) / clip.rate_hz, anatomy)
        if found is not None:
            hovers = np.full(len(found.time_s), not clip.contacts.any())
            bound = ~(found.flies | hovers | (clip.cyclic and found.flies.any()))
            on_feet = found.upright & ~hovers & (not on_hands(clip))
            yield name, Physical(found, bound, hovers, on_feet)


def _places(clip: Clip) -> FloatArray:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def _repeated(clip: Clip) -> FloatArray:
    """Return where the joints of a cycle are, several times over; it goes straight on."""
    place = _places(clip)
    way = place[-1, 0] - place[0, 0]
    return np.concatenate([place[:-1] + k * way for k in range(CYCLES)])


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


def print_culprits(performers: Sequence[Acted], most: int) -> None:
    """Print which actions have the impossible frames, and the worst phrases."""
    frames: dict[tuple[str, str, str], list[tuple[FloatArray, FloatArray]]] = defaultdict(list)
    phrases = []
    for one in performers:
        level, outside = one.mechanics.level_m_s2, one.mechanics.outside_m
        for i, move in enumerate(one.moves):
            rows = one.at == i
            if not rows.any():
                continue
            kind, name = kind_of(move), move.piece.clip.name
            for part, those in (("joins", rows & one.joins), ("inside", rows & ~one.joins)):
                frames[kind, name, part].append((level[those], outside[those]))
            at = int(np.argmax(np.where(rows, level, -1.0)))
            worst = float(np.max(outside[rows], where=~np.isnan(outside[rows]), initial=0.0))
            at_s = one.start_s + float(one.mechanics.time_s[at])
            phrases.append((float(level[at]), worst, f"{one.name}: {kind} {name} at {at_s:.2f} s"))
    joined = {
        key: tuple(np.concatenate(part) for part in zip(*of, strict=True))
        for key, of in frames.items()
    }
    for title, pick in (
        ("by kind", lambda key: f"{key[0]}, {key[2]}"),
        ("by action", lambda key: f"{key[0]} {key[1]}, {key[2]}"),
    ):
        _print_shares(title, joined, pick, most)
    print("  worst phrases: acceleration, zero moment point outside")
    for acc, worst, where in sorted(phrases, reverse=True)[:most]:
        print(f"    {acc:6.1f} m/s2 {100.0 * worst:5.0f} cm  {where}")


def _print_shares(
    title: str,
    frames: dict[tuple[str, str, str], tuple[FloatArray, ...]],
    pick: Any,
    most: int,
) -> None:
    """Print shares of all frames above the goals, of groups of frames, the largest first."""
    groups: dict[str, list[tuple[FloatArray, ...]]] = defaultdict(list)
    for key, of in frames.items():
        groups[pick(key)].append(of)
    level, outside = (
        {name: np.concatenate([of[i] for of in all_of]) for name, all_of in groups.items()}
        for i in (0, 1)
    )
    fast = {name: int(np.count_nonzero(of > ACC_M_S2)) for name, of in level.items()}
    tips = {name: int(np.count_nonzero(of > ZMP_M)) for name, of in outside.items()}
    frames_of_all = sum(len(of) for of in level.values())
    print(f"  {title}: share of frames; of those above 8 m/s2, p99; of those above 35 cm, p95")
    for name in sorted(fast, key=lambda n: fast[n] + tips[n], reverse=True)[:most]:
        has = outside[name][~np.isnan(outside[name])]
        print(
            f"    {name:32s} {100.0 * len(level[name]) / frames_of_all:5.1f} %"
            f" {100.0 * fast[name] / max(sum(fast.values()), 1):6.1f} %"
            f" {_quantile(level[name], 0.99):6.1f} m/s2"
            f" {100.0 * tips[name] / max(sum(tips.values()), 1):6.1f} %"
            f" {100.0 * _quantile(has, 0.95):5.0f} cm"
        )


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
