"""Three short stories played by simulated people, and the Scores they should give.

``python -m smd.synthetic.stories FOLDER`` writes ``<story>.csv`` and ``<story>.score.json`` for
each. The table is 1 m x 1 m with its middle at the origin; the figurines are 17.5 cm tall.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from smd.doodle import Doodle, Recording
from smd.errors import SmdError
from smd.formats import write_recording
from smd.score import Part, Score
from smd.score_file import write_score
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

CENTRE_M = 0.84
"""Height of a standing figurine's centre: its half height above a table of 0.75 m."""


@dataclass(frozen=True, slots=True, eq=False)
class Story:
    """What was recorded, and what should be understood.

    Attributes
    ----------
    name : of its files.
    recording : what the trackers reported.
    score : the actions as they were played.
    """

    name: str
    recording: Recording
    score: Score


def duel() -> Story:
    """Return the duel: knight and rival bow, close in, strike and dodge, until one yields."""
    knight = _take(101, x_m=0.08, z_m=-0.42, heading_rad=0.0)
    knight.until(0.8).play("bow")
    knight.until(3.4).play("walk", size=0.9)
    knight.until(6.6).play("punch", size=0.9)
    knight.until(8.4).play("turn_right")
    knight.until(10.7).play("jump", size=1.1)
    knight.until(12.6).play("punch").pause(0.6).play("punch")
    knight.until(16.4).play("bow").until(18.8)

    rival = _take(102, x_m=0.0, z_m=0.42, heading_rad=np.pi)
    rival.until(1.2).play("bow")
    rival.until(3.8).play("walk", size=0.65)
    rival.until(6.5).play("side_step_left", size=0.9)
    rival.until(8.6).play("turn_right", size=0.9)
    rival.until(10.4).play("throw", size=0.7)
    rival.until(12.3).play("side_step_right", size=0.9)
    rival.until(15.0).play("bow", size=0.9).until(18.8)
    return _story("duel", knight=knight, rival=rival)


def postman() -> Story:
    """Return the postman: he delivers a letter, bows, and flees from the dog over the fence."""
    postman = _take(201, x_m=0.1, z_m=-0.42, heading_rad=0.0)
    postman.pause(0.7).play("walk").pause(0.6)
    postman.play("side_step_right", size=0.8).pause(0.6)
    postman.play("walk", size=0.8).pause(0.6)
    postman.play("bow").pause(0.6)
    postman.play("turn_left", size=1.8, pace=0.8).pause(0.5)
    postman.play("run", size=0.8).pause(0.5)
    postman.play("jump").pause(0.9)
    return _story("postman", postman=postman)


def fledgling() -> Story:
    """Return the fledgling: it shuffles on its branch, hops off, takes a run, and flies."""
    bird = _take(301, x_m=-0.34, z_m=-0.38, heading_rad=0.25 * np.pi)
    bird.pause(0.6).play("side_step_left").pause(0.6)
    bird.play("side_step_right").pause(0.6)
    bird.play("jump").pause(0.6)
    bird.play("run", size=0.7).pause(0.6)
    bird.play("fly", size=0.6).pause(0.6)
    bird.play("turn_right").pause(0.6)
    bird.play("fly", size=0.6).pause(0.6)
    bird.play("bow").pause(0.8)
    return _story("fledgling", bird=bird)


STORIES: Mapping[str, Callable[[], Story]] = MappingProxyType(
    {"duel": duel, "postman": postman, "fledgling": fledgling}
)
"""The stories by name; each call gives the same."""


def _take(seed: int, *, x_m: float, z_m: float, heading_rad: float) -> Take:
    """Return the beginning of a performance by a person of their own."""
    rng = np.random.default_rng(seed)
    person = simulated_person(rng)
    return Take(person, rng, start_m=(x_m, CENTRE_M, z_m), heading_rad=heading_rad)


def _story(name: str, **takes: Take) -> Story:
    """Return a story of takes by device."""
    doodles = tuple(_rounded(take.doodle(device)) for device, take in takes.items())
    parts = tuple(Part(device, take.phrases) for device, take in takes.items())
    source = f"{name}.csv"
    metadata = {"story": name, "made_by": "python -m smd.synthetic.stories"}
    return Story(name, Recording(doodles, source, metadata=metadata), Score(parts, source))


def _rounded(doodle: Doodle) -> Doodle:
    """Return a doodle to a tenth of a millisecond and a hundredth of a millimetre."""
    return Doodle(
        doodle.time_s.round(4), doodle.position_m.round(5), doodle.orientation_xyzw, doodle.device
    )


def main(arguments: list[str]) -> int:
    """Write every story into the folder named."""
    if len(arguments) != 1:
        print("usage: python -m smd.synthetic.stories FOLDER", file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    try:
        for make in STORIES.values():
            story = make()
            write_recording(story.recording, folder / f"{story.name}.csv")
            write_score(story.score, folder / f"{story.name}.score.json")
            seconds = max(float(doodle.time_s[-1]) for doodle in story.recording.doodles)
            print(f"{folder / story.name}.csv: {seconds:.1f} s")
    except SmdError as error:
        print(error, file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
