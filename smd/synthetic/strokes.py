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
    swing_limit_rad : how much the arm's swing turns the prop at most.
    swing_spread : of that turn from gesture to gesture, standard deviation, in radians a metre.
    stroke_spread : of the strokes of one gesture, standard deviation of the logarithm of size.
    stroke_aim_rad : error of each stroke's direction, standard deviation about each axis.
    stroke_turn_rad : how far the prop is turned aside between two strokes, or halfway through a
        single one: standard deviation about each axis.
    skew : how much earlier or later than halfway a stroke is fastest: standard deviation of the
        logarithm of the power that its time is raised to.
    roundness_spread : from stroke to stroke, standard deviation of the logarithm of roundness.
    swings : how many times more than twice a waving, clapping or dancing hand goes to and fro.
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
    swing_limit_rad: float = 0.3
    swing_spread: float = 0.0
    stroke_spread: float = 0.0
    stroke_aim_rad: float = 0.0
    stroke_turn_rad: float = 0.0
    skew: float = 0.0
    roundness_spread: float = 0.0
    swings: int = 0


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


def chained(overlap: float, *strokes: Stroke) -> tuple[Stroke, ...]:
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


def gliding(move_m: Vector, speed_m_s: float, *, at_s: float = 0.0) -> Stroke:
    """Return a stroke that cruises for six tenths of its time at about ``speed_m_s``."""
    distance_m = float(np.linalg.norm(move_m))
    return Stroke(at_s, 1.25 * distance_m / speed_m_s, move_m, cruise=0.6)


def bobbing(glide: Stroke, rise_m: float, period_s: float) -> tuple[Stroke, ...]:
    """Return a glide with ups and downs on the way: a whole number of hops."""
    hops = max(round(glide.duration_s / period_s), 1)
    half_s = glide.duration_s / (2 * hops)
    up, down = (0.0, rise_m, 0.0), (0.0, -rise_m, 0.0)
    beats = [Stroke(i * half_s, half_s, down if i % 2 else up) for i in range(2 * hops)]
    return (glide, *beats)


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


def leaning(
    overlap: float, tilt_deg: float, *middle: Stroke, tilting_s: float = 0.4
) -> tuple[Stroke, ...]:
    """Return a tilt forward about the left axis, strokes, and the tilt back."""
    angle = np.radians(tilt_deg)
    tip = Stroke(0.0, tilting_s, turn_rad=(angle, 0.0, 0.0))
    return chained(overlap, tip, *middle, replace(tip, turn_rad=(-angle, 0.0, 0.0)))


def rocking(axis: int, tilt_deg: float, count: int, each_s: float) -> tuple[Stroke, ...]:
    """Return turns to and fro about an axis of the prop, which end where they began."""
    tilt = np.radians(tilt_deg)
    turns = [tilt, *(2.0 * tilt * (-1.0) ** i for i in range(1, count)), tilt * (-1.0) ** count]
    vectors = [tuple(turn if i == axis else 0.0 for i in range(3)) for turn in turns]
    return tuple(
        Stroke(i * each_s, each_s, turn_rad=(v[0], v[1], v[2])) for i, v in enumerate(vectors)
    )


def later(strokes: tuple[Stroke, ...], by_s: float) -> tuple[Stroke, ...]:
    """Return strokes that begin later."""
    return tuple(replace(stroke, start_s=stroke.start_s + by_s) for stroke in strokes)


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


def to_and_fro(move_m: Vector, count: int, each_s: float) -> tuple[Stroke, ...]:
    """Return strokes there and back, one after the other."""
    back = (-move_m[0], -move_m[1], -move_m[2])
    return tuple(Stroke(i * each_s, each_s, back if i % 2 else move_m) for i in range(count))


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
