"""References for `benchmarks.feasible`: how people move, and clips at their own pace."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from actions_library.adoption.character import rest_pose
from actions_library.importers import import_file
from actions_library.library import Library
from benchmarks.acted import on_hands
from benchmarks.physics import Mechanics, anatomy_of, leg_length_m, mechanics_of
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.errors import SmdError
from smd.geometry.arrays import BoolArray, FloatArray

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
