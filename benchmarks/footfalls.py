"""When each foot of a dog, a horse and two foxes is down: ``python -m benchmarks.footfalls``.

For each gait, as Hildebrand (1965, 1977) describes it: the phase at which each foot lands, from the
left hind foot's landing on, and its duty factor, the share of the cycle that it is down. All are
read the same way from where the feet are, by `smd.character.contacts`, and of the dog not from its
clips' labels. The imported clips run on the spot, with feet that slide: there, and so here for all,
a foot stands while it is low and goes back. Goals: a walk lands in lateral sequence, a trot in
diagonal pairs, a gallop flies.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from actions_library.adoption.carrying import stature_m
from actions_library.adoption.character import plan_of
from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.importers.imported import Animation
from smd.character.clip import Clip
from smd.character.contacts import contacts
from smd.character.kinematics import forward_kinematics
from smd.character.roles import BodyPlan, body_plan
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.runs import runs_of_true

DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))
CLIPS = DATA / "clips" / "gltf"

FEET = ("left hind", "left fore", "right hind", "right fore")

AHEAD = (0.0, 0.0, 1.0)
"""Where the shipped characters face."""

FRAMES = 240
"""Of a cycle, between which the files' 14 to 67 are interpolated."""


@dataclass(frozen=True, slots=True)
class Animal:
    """Whose feet are read.

    Attributes
    ----------
    name : for people.
    source : a file in `CLIPS`, or a shipped library.
    gaits : the clip of each.
    toes : the joint nearest to the ground of each of `FEET`.
    """

    name: str
    source: str
    gaits: dict[str, str]
    toes: tuple[str, str, str, str]


ANIMALS = (
    Animal(
        "dog",
        "dog",
        {"walk": "walk", "trot": "trot", "gallop": "run"},
        ("left_hind_toes", "left_fore_toes", "right_hind_toes", "right_fore_toes"),
    ),
    Animal(
        "mesh2motion horse",
        "horse-animations.glb",
        {"walk": "Walk", "trot": "Trot", "gallop": "Run"},
        ("back_leg_leaf_l", "front_leg_leaf_l", "back_leg_leaf_r", "front_leg_leaf_r"),
    ),
    Animal(
        "Khronos fox",
        "Fox.glb",
        {"walk": "Walk", "gallop": "Run"},
        ("b_LeftFoot02_018", "b_LeftHand_011", "b_RightFoot02_022", "b_RightHand_08"),
    ),
    Animal(
        "Quaternius fox",
        "quaternius_Fox.glb",
        {"walk": "Walk", "gallop": "Gallop"},
        ("FFB.L", "FF.L", "FFB.R", "FF.R"),
    ),
)


@dataclass(frozen=True, slots=True, eq=False)
class Footfalls:
    """When feet are down in a cycle, from the left hind foot's landing on.

    Attributes
    ----------
    animal, gait : whose, and which.
    period_s : of the cycle.
    down : (FRAMES, 4) of `FEET`.
    """

    animal: str
    gait: str
    period_s: float
    down: BoolArray

    def landing(self, foot: int) -> float:
        """Return the phase at which a foot lands; NaN if it never does."""
        on = self.down[:, foot]
        found = np.flatnonzero(on & ~np.roll(on, 1))
        return float(found[0]) / FRAMES if len(found) else float("nan")

    @property
    def duty(self) -> FloatArray:
        """The duty factor of each foot."""
        return np.asarray(self.down.mean(axis=0))

    @property
    def order(self) -> str:
        """The feet's initials in the order of their landings."""
        at = [self.landing(foot) for foot in range(4)]
        landed = sorted((a, FEET[f]) for f, a in enumerate(at) if np.isfinite(a))
        return " ".join("".join(word[0] for word in name.split()).upper() for _, name in landed)

    @property
    def flights(self) -> list[float]:
        """The share of the cycle of each flight."""
        air = ~self.down.any(axis=1)
        if air.all():
            return [1.0]
        air = np.roll(air, -int(np.flatnonzero(~air)[0]))
        return [(end - start) / FRAMES for start, end in runs_of_true(air)]


def found_falls(animals: tuple[Animal, ...] = ANIMALS) -> Iterator[Footfalls]:
    """Yield what is read of each animal's gaits; those whose file is absent are left out."""
    for animal in animals:
        if animal.source.endswith(".glb"):
            path = CLIPS / animal.source
            if not path.is_file():
                continue
            imported = import_file(path)
            plan = plan_of(imported)
            for gait, name in animal.gaits.items():
                yield footfalls(animal, gait, imported.skeleton, imported.animation(name), plan)
        else:
            library = load_library(animal.source)
            skeleton = library.character.skeleton
            rest = forward_kinematics(
                skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
            )[1]
            plan = body_plan(skeleton.joints, skeleton.parents.tolist(), rest, front=AHEAD)
            for gait, name in animal.gaits.items():
                yield footfalls(animal, gait, skeleton, library.clip(name), plan)


def footfalls(
    animal: Animal, gait: str, skeleton: Skeleton, clip: Clip | Animation, plan: BodyPlan
) -> Footfalls:
    """Return when feet are down in a cyclic clip, seen from the body that they carry."""
    from scipy.interpolate import CubicSpline

    place = forward_kinematics(skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    rest = forward_kinematics(skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)[1]
    toes = [skeleton.index(name) for name in animal.toes]
    frames = len(place)
    travel = (place[-1, plan.pelvis] - place[0, plan.pelvis]) * [1.0, 0.0, 1.0]
    own = place[:, toes] - np.linspace(0.0, 1.0, frames)[:, None, None] * travel
    duration_s = (frames - 1) / clip.rate_hz
    if np.abs(own[-1] - own[0]).max() > 0.05 * stature_m(plan, rest):
        own = np.concatenate([own, own[:1]])  # a file that leaves out the last frame
        duration_s = frames / clip.rate_hz
    own[-1] = own[0]
    at = np.linspace(0.0, 1.0, FRAMES, endpoint=False)
    path = CubicSpline(np.linspace(0.0, 1.0, len(own)), own, axis=0, bc_type="periodic")
    ahead = path(at, 1) @ np.array(plan.front) / FRAMES
    gone = np.cumsum(np.tile(np.maximum(ahead, 0.0), (3, 1)), axis=0)
    height = np.tile(path(at)[..., 1], (3, 1))
    position = np.stack([gone, height, np.zeros_like(gone)], axis=-1)
    lowest = height.min(axis=0).tolist()
    down = contacts(position, lowest, FRAMES / duration_s, stature_m(plan, rest))
    down = down[FRAMES : 2 * FRAMES]
    landed = np.flatnonzero(down[:, 0] & ~np.roll(down[:, 0], 1))
    first = int(landed[0]) if len(landed) else 0
    return Footfalls(animal.name, gait, duration_s, np.roll(down, -first, axis=0))


def print_falls(found: list[Footfalls]) -> None:
    """Print a line for each animal's gait, those of a gait together."""
    heads = " ".join(f"{foot:>10}" for foot in FEET)
    print(f"{'gait':7} {'':18} {'cycle':>7} {heads}  {'duty factors':19} {'flights':13} order")
    for gait in dict.fromkeys(one.gait for one in found):
        for one in found:
            if one.gait != gait:
                continue
            lands = " ".join(f"{one.landing(foot):10.2f}" for foot in range(4))
            duty = " ".join(f"{share:.2f}" for share in one.duty)
            flights = " ".join(f"{share:.2f}" for share in one.flights) or "none"
            print(
                f"{gait:7} {one.animal:18} {one.period_s:5.2f} s {lands}  {duty} {flights:13} "
                f"{one.order}"
            )


def main() -> None:
    """Read and print all."""
    print_falls(list(found_falls()))
    absent = [one.source for one in ANIMALS if one.source.endswith(".glb")]
    absent = [name for name in absent if not (CLIPS / name).is_file()]
    if absent:
        print(f"absent, and left out: {', '.join(absent)} in {CLIPS}")


if __name__ == "__main__":
    main()
