"""How a creature's feet stand on the paths of the stories: ``python -m benchmarks.creatures dog``.

Each performer of each story is the creature in turn, the others are people. For each of its
phrases: the mean speed of what touches the ground while its foot is to stand and is within 5 mm of
the ground (at most 0.02 m/s is the goal), and how low anything of it gets (5 mm at most). The
stories are played as recorded, and three times as slowly, so that slow gaits are seen too.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import smd
from smd.acting.legs import Leg, legs_of
from smd.acting.moving import stepped
from smd.cast import ActionLibrary
from smd.character.kinematics import forward_kinematics
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.score import Score
from smd.transfer.lacking import without_lacking
from smd.transfer.perform import acted, frames_of
from smd.transfer.staging import entrances
from smd.transfer.stretch import stretched

RECORDINGS = Path(__file__).parents[1] / "recordings"
ON_GROUND_M, RATE_HZ = 0.005, 60.0
STRETCHES = (1.0, 3.0)


@dataclass(frozen=True, slots=True)
class Footed:
    """How feet stand in a phrase.

    Attributes
    ----------
    story, device, stretch : of which performance.
    action : whose clip is played.
    speed_m_s : of the body, on average.
    slide_m_s : of standing feet, on average; NaN where none stands.
    lowest_m : of any foot, over the ground.
    """

    story: str
    device: str
    stretch: float
    action: str
    speed_m_s: float
    slide_m_s: float
    lowest_m: float


def footed(creature: ActionLibrary, stretches: tuple[float, ...] = STRETCHES) -> Iterator[Footed]:
    """Yield how a creature's feet stand in each phrase of the stories."""
    people = smd.load_library()
    for path in sorted(RECORDINGS.glob("*.csv")):
        recording = smd.read_recording(path)
        for device in recording.devices:
            cast = smd.Cast(people, {device: creature})
            score, _ = without_lacking(smd.parse(recording, cast, devices=[device]), cast)
            for stretch in stretches:
                yield from _footed(path.stem, device, stretch, score, recording, cast)


def _footed(
    story: str,
    device: str,
    stretch: float,
    score: Score,
    recording: smd.Recording,
    cast: smd.Cast,
) -> Iterator[Footed]:
    take = stretched(score, recording, stretch)
    frames = frames_of(take[1], RATE_HZ)
    (one,) = entrances(*take, cast, frames.time_s, expressiveness=1.0, heading="prop")
    actor = acted(one, cast, frames, None)
    skeleton = actor.character.skeleton
    place = forward_kinematics(skeleton, *actor.poses)[1]
    legs = legs_of(skeleton, [leg.foot for leg in one.pieces.legs])
    touching, rest_m = _touching(skeleton, legs)
    stands, _ = stepped(one.moves, frames.time_s, one.idling)
    height = place[:, touching, 1] - rest_m
    on = stands & (height < ON_GROUND_M)
    speed = np.linalg.norm(np.diff(place[:, touching][..., ::2], axis=0), axis=-1) * RATE_HZ
    for span in one.plan.spans:
        if span.phrase is None:
            continue
        i, j = np.round((np.array([span.start_s, span.end_s]) - frames.start_s) * RATE_HZ)
        rows = slice(int(i), max(int(j), int(i) + 2))
        both = on[rows][1:] & on[rows][:-1]
        slid = speed[rows][: len(both)][both]
        way = np.linalg.norm(np.diff(place[rows, 0], axis=0), axis=1).sum()
        yield Footed(
            story,
            device,
            stretch,
            span.phrase.action,
            float(way) / (span.end_s - span.start_s),
            float(slid.mean()) if len(slid) else float("nan"),
            float(height[rows].min()),
        )


def _touching(skeleton: Skeleton, legs: tuple[Leg, ...]) -> tuple[list[int], FloatArray]:
    """Return the joint of each leg that touches the ground, its toes or its foot; and its height.

    The height is that at rest.
    """
    rest = forward_kinematics(skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)[1]
    joints = []
    for leg in legs:
        below = np.flatnonzero(skeleton.parents == leg.foot)
        joints.append(int(below[0]) if len(below) else leg.foot)
    return joints, rest[joints, 1]


def main(arguments: list[str]) -> None:
    """Measure the creature named, and print a line for each phrase."""
    creature = smd.load_library(arguments[0] if arguments else "dog")
    print(
        f"{'story':10} {'device':8} {'stretch':>7} {'action':12} {'speed':>9} {'slide':>11} lowest"
    )
    for one in footed(creature):
        print(
            f"{one.story:10} {one.device:8} {one.stretch:7.0f} {one.action:12} "
            f"{one.speed_m_s:5.2f} m/s {one.slide_m_s:7.4f} m/s {1e3 * one.lowest_m:6.1f} mm"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
