"""Strokes: the gestures of simulated people.

A gesture is a few strokes, each a displacement and a turn that follow the minimum-jerk course
[1]_, begun before the one before has ended, so that corners are round [2]_. A `Person` plays a
gesture larger or smaller, slower or faster, aims beside the mark, holds the prop askew, takes it
beside its centre and trembles. All numbers are ours, in figurine scale, and not measurements of
people.

References
----------
.. [1] T. Flash, N. Hogan, "The Coordination of Arm Movements: An Experimentally Confirmed
   Mathematical Model", Journal of Neuroscience 5(7), 1985.
.. [2] T. Flash, E. Henis, "Arm Trajectory Modifications During Reaching Towards Visual Targets",
   Journal of Cognitive Neuroscience 3(3), 1991: superposed strokes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray
from smd.synthetic.curves import Vector, even_times


@dataclass(frozen=True, slots=True)
class Stroke:
    """A displacement and a turn from rest to rest.

    Attributes
    ----------
    start_s : after the gesture's beginning.
    duration_s : positive.
    move_m : displacement along (left, up, front) of the upright frame faced at the beginning.
    turn_rad : rotation vector in the prop's own frame.
    cruise : share of the duration, in [0, 1), spent at full speed in the middle.
    """

    start_s: float
    duration_s: float
    move_m: Vector = (0.0, 0.0, 0.0)
    turn_rad: Vector = (0.0, 0.0, 0.0)
    cruise: float = 0.0

    @property
    def end_s(self) -> float:
        """When it comes to rest, after the gesture's beginning."""
        return self.start_s + self.duration_s


@dataclass(frozen=True, slots=True)
class Gesture:
    """What a hand does with the prop to ask for an action."""

    action: str
    strokes: tuple[Stroke, ...]

    @property
    def duration_s(self) -> float:
        """From the beginning of the first stroke to the end of the last."""
        return max(stroke.end_s for stroke in self.strokes)


@dataclass(frozen=True, slots=True)
class Person:
    """How somebody plays. The default is exact and steady: closed-form truth.

    Attributes
    ----------
    size, pace : of gestures, relative to the average person.
    spread : of size and pace from gesture to gesture, standard deviation of the logarithm.
    aim_rad : error of a gesture's heading and elevation, standard deviation.
    askew_rad : standing tilt of the prop in the hand, about (left, front).
    overlap : share of a stroke that is gone when the next one begins is one less this.
    bob_m : how far a walking hand rises and falls.
    grip_m : from the point about which the hand turns the prop to its centre, in its frame.
    swing_rad_per_m : how much the arm's swing turns the prop: 3 x 3, rotation per displacement.
    wobble_rad, drift_m : slow unrest of the hand, below 1.5 Hz, amplitude.
    tremor_m, tremor_rad : of the hand, 8 to 12 Hz, amplitude.
    misfacing_rad : standing turn of the prop in the hand, about up.
    roundness : how far a stroke bows out sideways, as a share of its length.
    rebound_m : how far the hand springs back after a gesture.
    """

    size: float = 1.0
    pace: float = 1.0
    spread: float = 0.0
    aim_rad: float = 0.0
    askew_rad: tuple[float, float] = (0.0, 0.0)
    overlap: float = 0.3
    bob_m: float = 0.0
    grip_m: Vector = (0.0, 0.0, 0.0)
    swing_rad_per_m: tuple[Vector, Vector, Vector] = ((0.0,) * 3,) * 3
    wobble_rad: float = 0.0
    drift_m: float = 0.0
    tremor_m: float = 0.0
    tremor_rad: float = 0.0
    misfacing_rad: float = 0.0
    roundness: float = 0.0
    rebound_m: float = 0.0


STEADY = Person()
"""Nobody in particular: no errors at all."""


def simulated_person(rng: np.random.Generator) -> Person:
    """Return a person drawn at random."""
    swing = rng.normal(0.0, 0.4, (3, 3))
    further = rng.spawn(1)[0]
    return Person(
        size=float(np.exp(rng.normal(0.0, 0.15))),
        pace=float(np.exp(rng.normal(0.0, 0.15))),
        spread=0.1,
        aim_rad=np.radians(5.0),
        askew_rad=(rng.normal(0.0, np.radians(4.0)), rng.normal(0.0, np.radians(4.0))),
        overlap=rng.uniform(0.2, 0.45),
        bob_m=rng.uniform(0.0, 3e-3),
        grip_m=(rng.normal(0.0, 0.01), rng.uniform(0.0, 0.08), rng.normal(0.0, 0.015)),
        swing_rad_per_m=(tuple(swing[0]), tuple(swing[1]), tuple(swing[2])),
        wobble_rad=rng.uniform(0.5, 1.5) * np.radians(1.0),
        drift_m=rng.uniform(0.5e-3, 1.5e-3),
        tremor_m=rng.uniform(0.1e-3, 0.4e-3),
        tremor_rad=rng.uniform(0.1, 0.25) * np.radians(1.0),
        misfacing_rad=further.normal(0.0, np.radians(6.0)),
        roundness=further.uniform(0.0, 0.08),
        rebound_m=further.uniform(0.0, 5e-3),
    )


def progress(u: FloatArray, cruise: float = 0.0) -> FloatArray:
    """Return how much of a stroke is done at the share ``u`` of its duration: 0 to 1.

    The minimum-jerk course, cut in the middle, with a share ``cruise`` of constant speed between.
    """
    bell = 1.0 - cruise
    peak = 1.875 / bell  # speed at which the two halves meet, before the whole is scaled to 1
    u = np.clip(u, 0.0, 1.0)
    s = np.where(u < 0.5, np.minimum(u / bell, 0.5), np.maximum((u - cruise) / bell, 0.5))
    curved = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    straight = peak * np.clip(u - 0.5 * bell, 0.0, cruise)
    return (curved + straight) / (1.0 + peak * cruise)


def _chain(overlap: float, *strokes: Stroke) -> tuple[Stroke, ...]:
    """Return strokes one after another, each beginning before the end of the one before it.

    They overlap by a share of the shorter one; the start that a stroke carries is added.
    """
    placed: list[Stroke] = []
    for stroke in strokes:
        if placed:
            before = placed[-1]
            shared_s = overlap * min(before.duration_s, stroke.duration_s)
            stroke = replace(stroke, start_s=stroke.start_s + before.end_s - shared_s)
        placed.append(stroke)
    return tuple(placed)


def _glide(move_m: Vector, speed_m_s: float, *, at_s: float = 0.0) -> Stroke:
    """Return a stroke that cruises for six tenths of its time at about ``speed_m_s``."""
    distance_m = float(np.linalg.norm(move_m))
    return Stroke(at_s, 1.25 * distance_m / speed_m_s, move_m, cruise=0.6)


def _bobbing(glide: Stroke, rise_m: float, period_s: float) -> tuple[Stroke, ...]:
    """Return a glide with ups and downs on the way: a whole number of hops."""
    hops = max(round(glide.duration_s / period_s), 1)
    half_s = glide.duration_s / (2 * hops)
    up, down = (0.0, rise_m, 0.0), (0.0, -rise_m, 0.0)
    beats = [Stroke(i * half_s, half_s, down if i % 2 else up) for i in range(2 * hops)]
    return (glide, *beats)


def _walk(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide straight ahead."""
    glide = _glide((0.0, 0.0, 0.35 * size), 0.18 * size**0.5)
    return _bobbing(glide, person.bob_m, 0.45) if person.bob_m else (glide,)


def _run(size: float, person: Person) -> tuple[Stroke, ...]:
    """Hop ahead in low, quick bounds."""
    return _bobbing(_glide((0.0, 0.0, 0.55 * size), 0.36 * size**0.5), 0.036, 0.28)


def _side_step(left: float) -> Callable[[float, Person], tuple[Stroke, ...]]:
    """Glide straight to a side."""
    return lambda size, person: (_glide((left * 0.25 * size, 0.0, 0.0), 0.18 * size**0.5),)


def _jump(size: float, person: Person) -> tuple[Stroke, ...]:
    """Go straight up, over, and straight down."""
    return _chain(
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
    return _chain(
        0.3 * person.overlap,
        Stroke(0.0, 0.32, (0.0, 0.0, 0.15 * size)),
        Stroke(0.0, 0.42, (0.0, 0.0, -0.15 * size)),
    )


def _throw(size: float, person: Person) -> tuple[Stroke, ...]:
    """Draw back, then fling ahead in an arc over the top."""
    return _chain(
        person.overlap,
        Stroke(0.0, 0.45, (0.0, 0.0, -0.10 * size)),
        Stroke(0.0, 0.30, (0.0, 0.08 * size, 0.10 * size)),
        Stroke(0.0, 0.30, (0.0, -0.08 * size, 0.10 * size)),
    )


def _fly(size: float, person: Person) -> tuple[Stroke, ...]:
    """Glide ahead while rocking from wing to wing."""
    glide = _glide((0.0, 0.0, 0.6 * size), 0.25 * size**0.5)
    rocks = max(round(glide.duration_s / 0.55), 2)
    each_s = glide.duration_s / (rocks + 1)
    bank = np.radians(28.0)
    rolls = [bank, *(2.0 * bank * (-1.0) ** i for i in range(1, rocks)), bank * (-1.0) ** rocks]
    strokes = [Stroke(i * each_s, each_s, turn_rad=(0.0, 0.0, r)) for i, r in enumerate(rolls)]
    return (glide, *strokes)


def _bow(size: float, person: Person) -> tuple[Stroke, ...]:
    """Tip forward and come back up."""
    angle = np.radians(55.0) * size
    return (
        Stroke(0.0, 0.7, turn_rad=(angle, 0.0, 0.0)),
        Stroke(0.85, 0.7, turn_rad=(-angle, 0.0, 0.0)),
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


def tracker_times(
    start_s: float, end_s: float, rate_hz: float, rng: np.random.Generator
) -> FloatArray:
    """Return the uneven times at which a tracker reports: 0.5 ms of jitter, 1 % frames lost."""
    time_s = start_s + even_times(end_s - start_s, rate_hz)
    n = len(time_s)
    # A third of a period at most: times must increase.
    jitter_s = np.clip(rng.normal(0.0, 5e-4, n), -1.0 / (3.0 * rate_hz), 1.0 / (3.0 * rate_hz))
    kept = rng.random(n) > 0.01
    kept[[0, -1]] = True
    jitter_s[[0, -1]] = 0.0
    return (time_s + jitter_s)[kept]
