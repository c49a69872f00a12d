"""Gestures: the strokes that ask for each of the humanoid's actions.

All numbers are ours, in figurine scale, and not measurements of people.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from smd.errors import DoodleError
from smd.synthetic.person import STEADY, Person
from smd.synthetic.strokes import (
    Stroke,
    bobbing,
    chained,
    gliding,
    later,
    leaning,
    rocking,
    to_and_fro,
)


@dataclass(frozen=True, slots=True)
class Gesture:
    """What a hand does with the prop to ask for an action."""

    action: str
    strokes: tuple[Stroke, ...]

    @property
    def duration_s(self) -> float:
        """From the beginning of the first stroke to the end of the last."""
        return max(stroke.end_s for stroke in self.strokes)


def _walk(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide straight ahead."""
    glide = gliding((0.0, 0.0, 0.35 * size), 0.18 * size**0.5)
    return bobbing(glide, person.bob_m, 0.45) if person.bob_m else (glide,)


def _run(size: float, person: Person) -> tuple[Stroke, ...]:
    """Hop ahead in low, quick bounds."""
    return bobbing(gliding((0.0, 0.0, 0.55 * size), 0.36 * size**0.5), 0.036, 0.28)


def _side_step(left: float) -> Callable[[float, Person], tuple[Stroke, ...]]:
    """Glide straight to a side."""
    return lambda size, person: (gliding((left * 0.25 * size, 0.0, 0.0), 0.18 * size**0.5),)


def _jump(size: float, person: Person) -> tuple[Stroke, ...]:
    """Go straight up, over, and straight down."""
    return chained(
        person.overlap,
        Stroke(0.0, 0.32, (0.0, 0.08 * size, 0.0)),
        Stroke(0.0, 0.36, (0.0, 0.0, 0.13 * size)),
        Stroke(0.0, 0.32, (0.0, -0.08 * size, 0.0)),
    )


def _turn(left: float) -> Callable[[float, Person], tuple[Stroke, ...]]:
    """Turn on the spot, a quarter turn at size 1."""
    return lambda size, person: (Stroke(0.0, 1.0, turn_rad=(0.0, left * 0.5 * np.pi * size, 0.0)),)


def _punch(size: float, person: Person) -> tuple[Stroke, ...]:
    """Thrust ahead and straight back."""
    return chained(
        0.3 * person.overlap,
        Stroke(0.0, 0.32, (0.0, 0.0, 0.15 * size)),
        Stroke(0.0, 0.42, (0.0, 0.0, -0.15 * size)),
    )


def _throw(size: float, person: Person) -> tuple[Stroke, ...]:
    """Draw back, then fling ahead in an arc over the top."""
    return chained(
        person.overlap,
        Stroke(0.0, 0.45, (0.0, 0.0, -0.10 * size)),
        Stroke(0.0, 0.30, (0.0, 0.08 * size, 0.10 * size)),
        Stroke(0.0, 0.30, (0.0, -0.08 * size, 0.10 * size)),
    )


def _fly(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide ahead while rocking from wing to wing."""
    glide = gliding((0.0, 0.0, 0.6 * size), 0.25 * size**0.5)
    rocks = max(round(glide.duration_s / 0.55), 2)
    each_s = glide.duration_s / (rocks + 1)
    return (glide, *rocking(2, 28.0, rocks, each_s))


def _bow(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip forward and come back up."""
    angle = np.radians(55.0) * size
    return (
        Stroke(0.0, 0.7, turn_rad=(angle, 0.0, 0.0)),
        Stroke(0.85, 0.7, turn_rad=(-angle, 0.0, 0.0)),
    )


def _walk_backward(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide straight back."""
    return (gliding((0.0, 0.0, -0.28 * size), 0.16 * size**0.5),)


def _sneak(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lean it forward, glide ahead, straighten it."""
    return leaning(person.overlap, 32.0, gliding((0.0, 0.0, 0.26 * size), 0.15 * size**0.5))


def _crawl(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lay it on its face, glide ahead head first, set it up again."""
    glide = gliding((0.0, 0.0, 0.24 * size), 0.15 * size**0.5)
    return leaning(person.overlap, 85.0, glide, tilting_s=0.55)


def _swim(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lay it on its face, glide ahead rolling from side to side, set it up again."""
    glide = gliding((0.0, 0.0, 0.36 * size), 0.20 * size**0.5)
    first, middle, last = leaning(person.overlap, 85.0, glide, tilting_s=0.55)
    rocks = rocking(1, 26.0, 3, middle.duration_s / 4)
    return (first, middle, *later(rocks, middle.start_s), last)


def _climb(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lift it slowly while rocking it from side to side."""
    rise = gliding((0.0, 0.20 * size, 0.0), 0.14 * size**0.5)
    return (rise, *rocking(2, 22.0, 3, rise.duration_s / 4))


def _spin(size: float, person: Person) -> tuple[Stroke, ...]:
    """Turn it once about itself while it rises and sinks."""
    rise_m, half_s = 0.07 * size, 0.6
    return (
        Stroke(0.0, 2.0 * half_s, turn_rad=(0.0, 2.0 * np.pi, 0.0)),
        Stroke(0.0, half_s, (0.0, rise_m, 0.0)),
        Stroke(half_s, half_s, (0.0, -rise_m, 0.0)),
    )


def _leap(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip it back, then let it follow its nose over an arc and level out."""
    tip, over = np.radians(35.0), 0.64
    nose_up = Stroke(0.0, 0.34, turn_rad=(-tip, 0.0, 0.0))
    start_s = nose_up.duration_s * (1.0 - 0.5 * person.overlap)
    return (
        nose_up,
        Stroke(start_s, over, (0.0, 0.0, 0.26 * size), (2.0 * tip, 0.0, 0.0)),
        Stroke(start_s, 0.5 * over, (0.0, 0.08 * size, 0.0)),
        Stroke(start_s + 0.5 * over, 0.5 * over, (0.0, -0.08 * size, 0.0)),
        Stroke(start_s + 0.9 * over, 0.34, turn_rad=(-tip, 0.0, 0.0)),
    )


def _hop(size: float, person: Person) -> tuple[Stroke, ...]:
    """Hop on the spot, three times."""
    return to_and_fro((0.0, 0.045 * size, 0.0), 6, 0.17)


def _roll(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide it ahead, tumble it over its front once round, glide on."""
    glide = Stroke(0.0, 0.45, (0.0, 0.0, 0.12 * size))
    tumble = Stroke(0.0, 1.1, (0.0, 0.0, 0.16 * size), (2.0 * np.pi, 0.0, 0.0))
    return chained(0.5 * person.overlap, glide, tumble, glide)


def _fall(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip it over onto its back, and set it up again."""
    angle = np.radians(85.0)
    down = (0.0, -0.05 * size, -0.08 * size)
    up = (0.0, 0.05 * size, 0.08 * size)
    return (
        Stroke(0.0, 0.5, down, (-angle, 0.0, 0.0)),
        Stroke(0.65, 0.7, up, (angle, 0.0, 0.0)),
    )


def _kick(size: float, person: Person) -> tuple[Stroke, ...]:
    """Swing its feet ahead and back."""
    angle = np.radians(30.0)
    return chained(
        0.3 * person.overlap,
        Stroke(0.0, 0.32, (0.0, 0.0, 0.16 * size), (-angle, 0.0, 0.0)),
        Stroke(0.0, 0.42, (0.0, 0.0, -0.16 * size), (angle, 0.0, 0.0)),
    )


def _push(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lean it forward, shove ahead, come back, straighten it."""
    shove = Stroke(0.0, 0.42, (0.0, 0.0, 0.12 * size))
    back = replace(shove, move_m=(0.0, 0.0, -0.12 * size))
    return leaning(0.5 * person.overlap, 32.0, shove, back, tilting_s=0.34)


def _slash(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lift it to its right, cut down across to its left, bring it back."""
    return chained(
        0.5 * person.overlap,
        Stroke(0.0, 0.36, (-0.07 * size, 0.07 * size, 0.0)),
        Stroke(0.0, 0.26, (0.14 * size, -0.14 * size, 0.0)),
        Stroke(0.0, 0.40, (-0.07 * size, 0.07 * size, 0.0)),
    )


def _pick_up(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip it forward, dip it, lift it, set it straight."""
    dip = Stroke(0.0, 0.32, (0.0, -0.06 * size, 0.0))
    lift = Stroke(0.0, 0.36, (0.0, 0.06 * size, 0.0))
    return leaning(0.5 * person.overlap, 50.0, dip, lift)


def _nod(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip it forward and back, twice, by a little."""
    angle, each_s = np.radians(24.0) * size, 0.24
    return tuple(
        Stroke(i * each_s, each_s, turn_rad=((-1.0) ** i * angle, 0.0, 0.0)) for i in range(4)
    )


def _wave(size: float, person: Person) -> tuple[Stroke, ...]:
    """Rock it from side to side on the spot."""
    return rocking(2, 26.0 * size, 4 + 2 * person.swings, 0.3)


def _clap(size: float, person: Person) -> tuple[Stroke, ...]:
    """Shake it to the left and the right, twice and more."""
    return to_and_fro((0.055 * size, 0.0, 0.0), 6 + 2 * person.swings, 0.2)


def _cheer(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lift it, twist it to and fro, lower it."""
    twists = rocking(1, 28.0, 3, 0.22)
    rise, fall = Stroke(0.0, 0.34, (0.0, 0.09 * size, 0.0)), (0.0, -0.09 * size, 0.0)
    begun_s = rise.duration_s * (1.0 - 0.5 * person.overlap)
    ended_s = begun_s + twists[-1].end_s - 0.5 * person.overlap * twists[-1].duration_s
    return (rise, *later(twists, begun_s), Stroke(ended_s, 0.34, fall))


def _dance(size: float, person: Person) -> tuple[Stroke, ...]:
    """Twist it to and fro on the spot."""
    return rocking(1, 32.0 * size, 4 + 2 * person.swings, 0.32)


def _crouch(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lower it, and lift it again."""
    return (
        Stroke(0.0, 0.42, (0.0, -0.07 * size, 0.0)),
        Stroke(0.5, 0.46, (0.0, 0.07 * size, 0.0)),
    )


def _sit_down(size: float, person: Person) -> tuple[Stroke, ...]:
    """Lower it, rock it back and upright."""
    angle = np.radians(30.0)
    return chained(
        0.5 * person.overlap,
        Stroke(0.0, 0.42, (0.0, -0.07 * size, 0.0)),
        Stroke(0.0, 0.34, turn_rad=(-angle, 0.0, 0.0)),
        Stroke(0.0, 0.40, turn_rad=(angle, 0.0, 0.0)),
    )


def _stand_up(size: float, person: Person) -> tuple[Stroke, ...]:
    """Rock it forward and upright, lift it."""
    angle = np.radians(30.0)
    return chained(
        0.5 * person.overlap,
        Stroke(0.0, 0.36, turn_rad=(angle, 0.0, 0.0)),
        Stroke(0.0, 0.36, turn_rad=(-angle, 0.0, 0.0)),
        Stroke(0.0, 0.42, (0.0, 0.07 * size, 0.0)),
    )


GESTURES: Mapping[str, Callable[[float, Person], tuple[Stroke, ...]]] = MappingProxyType(
    {
        "walk": _walk,
        "run": _run,
        "side_step_left": _side_step(1.0),
        "side_step_right": _side_step(-1.0),
        "jump": _jump,
        "turn_left": _turn(1.0),
        "turn_right": _turn(-1.0),
        "punch": _punch,
        "throw": _throw,
        "fly": _fly,
        "bow": _bow,
        "sneak": _sneak,
        "walk_backward": _walk_backward,
        "spin": _spin,
        "leap": _leap,
        "hop": _hop,
        "crawl": _crawl,
        "roll": _roll,
        "fall": _fall,
        "swim": _swim,
        "climb": _climb,
        "kick": _kick,
        "push": _push,
        "slash": _slash,
        "pick_up": _pick_up,
        "nod": _nod,
        "wave": _wave,
        "clap": _clap,
        "cheer": _cheer,
        "dance": _dance,
        "crouch": _crouch,
        "sit_down": _sit_down,
        "stand_up": _stand_up,
    }
)
"""The strokes of each action's gesture, given its size (1 is average) and who plays it."""


def gesture(
    action: str, *, size: float = 1.0, pace: float = 1.0, person: Person = STEADY
) -> Gesture:
    """Return the gesture of an action, exactly as asked.

    Parameters
    ----------
    action
        A name in `GESTURES`.
    size, pace
        How large and how fast, relative to the average; positive.
    person
        Whose habits (overlap, bobbing) shape it; size and pace are not taken from there.

    Raises
    ------
    DoodleError
        If there is no such action.
    """
    if action not in GESTURES:
        raise DoodleError(f"gesture: expected one of {', '.join(GESTURES)}, got {action!r}")
    strokes = (
        replace(stroke, start_s=stroke.start_s / pace, duration_s=stroke.duration_s / pace)
        for stroke in GESTURES[action](size, person)
    )
    return Gesture(action, tuple(strokes))
