"""Doodles of simulated people who play with a chosen Effort: what the shipped reader learns from.

A take is one gesture of `smd.synthetic.gestures`, the same that asks for an action, whose strokes
are shaped by Effort as the transfer of Effort to animation shapes clips [1]_ (section 6.4), so
that what is read from the hand and what is written to the character mean the same:

- **Time**: a sudden stroke is short and has its attack early; a sustained one takes long and has
  its peak in the middle. How far it goes stays.
- **Weight**: a strong stroke goes further in the same time, its force in a short burst, and is
  stopped dead, so that the braced limb rings; the tense muscle trembles more. A light stroke goes
  less far at a more even speed, without recoil.

- **Space**: an indirect stroke wanders: it bows out to a side and weaves on its way, within the
  same time. A direct one is straight, and one that is neither half as wandering.
- **Flow**: a bound stroke is held back, and could stop at any moment: it is a chain of small
  submovements that hardly run into each other [2]_. A free one runs on: the hand swings through
  beyond the end and comes back at its ease, and the prop turns with it.

At 0 on Time, Weight and Flow, and where no Space is meant, a stroke is the minimum-jerk one that
the gesture has anyway.

People differ in what `smd.synthetic.person.Person` says, and in size of stage, in how far they
go in acting out an Effort and in how they lean when they mean nothing. All numbers are in
`SHAPING` and `SPREAD`, in the open; they are our reading and not measurements of people.

References
----------
.. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019.
.. [2] T. Flash, E. Henis, "Arm Trajectory Modifications During Reaching Towards Visual Targets",
   Journal of Cognitive Neuroscience 3(3), 1991 (submovements superposed).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from laban import Effort
from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
)
from smd.synthetic import strokes
from smd.synthetic.curves import RATE_HZ
from smd.synthetic.gestures import gesture
from smd.synthetic.person import Person, simulated_person
from smd.synthetic.strokes import Stroke
from smd.synthetic.tracker import tracker_times

ACTIONS = (
    *("walk", "run", "side_step_left", "side_step_right", "jump", "turn_left", "turn_right"),
    *("punch", "throw", "fly", "bow"),
)
"""Whose gestures a labelled corpus plays: kinds enough to generalise over, and a corpus that stays
what it is when more gestures are added."""


@dataclass(frozen=True, slots=True)
class Shaping:
    """What Effort does to a stroke, per unit of Time or Weight.

    Attributes
    ----------
    duration_per_time : a stroke lasts ``exp(duration_per_time * time)`` times as long.
    attack_per_sudden : time runs as ``1 - (1 - u)^(1 + attack_per_sudden * time)`` of itself.
    size_per_weight : a stroke goes ``exp(size_per_weight * weight)`` times as far.
    turn_per_weight : and turns ``exp(turn_per_weight * weight)`` times as far.
    burst_per_strong : time runs as a beta distribution of parameters 1 plus this times weight.
    cruise_per_light : share of a light stroke that is added to its part of even speed.
    recoil_per_strong : first swing of the ringing after a stroke, as a share of its size.
    recoil_hz, recoil_decay_s : of that ringing.
    tremor_per_weight : tremor is ``exp(tremor_per_weight * weight)`` times as large.
    bow_per_indirect : how far an indirect stroke bows out, as a share of its length.
    weave_per_indirect, weaves : and how far it weaves about that bow, how many times.
    hold_per_bound : how nearly a bound stroke comes to rest between its submovements.
    holds_per_s : submovements a second.
    swing_per_free, swing_s : how far a free stroke swings through, and how long that takes.
    turn_per_free : how far the prop turns with it, in radians per stroke length of 0.1 m.
    """

    duration_per_time: float = -0.6
    attack_per_sudden: float = 0.6
    size_per_weight: float = 0.5
    turn_per_weight: float = 0.25
    burst_per_strong: float = 0.6
    cruise_per_light: float = 0.2
    recoil_per_strong: float = 0.08
    recoil_hz: float = 5.0
    recoil_decay_s: float = 0.12
    tremor_per_weight: float = 0.4
    bow_per_indirect: float = 0.18
    weave_per_indirect: float = 0.07
    weaves: float = 2.0
    hold_per_bound: float = 0.75
    holds_per_s: float = 3.5
    swing_per_free: float = 0.14
    swing_s: float = 0.5
    turn_per_free: float = 0.25


SHAPING = Shaping()
"""The shaping from which the shipped model learns."""


@dataclass(frozen=True, slots=True)
class Spread:
    """How people and takes differ beyond `person.Person`: standard deviations and ranges.

    Attributes
    ----------
    stage : between people, of the logarithm of size: some play on a larger table.
    acting : range of how far a person goes in acting out an Effort.
    leaning : between people, of the Effort played where none is meant, per axis.
    take_effort : between takes of one person, per axis.
    take_size, take_pace : between takes of one person, of the logarithm.
    rest_s : range of the stillness before and after.
    sensor_m, sensor_rad : noise of a sample of the tracker.
    """

    stage: float = 0.2
    acting: tuple[float, float] = (0.7, 1.1)
    leaning: float = 0.12
    take_effort: float = 0.12
    take_size: float = 0.12
    take_pace: float = 0.12
    rest_s: tuple[float, float] = (0.03, 0.15)
    sensor_m: float = 2e-4
    sensor_rad: float = 2e-3


TRACKER_NOISE, TRACKER_HZ = (0.3, 6.0), (60.0, 120.0)
"""From the finest to the coarsest tracker: 0.06 mm and 0.03 degrees to 1.2 mm and 0.7 degrees."""

SPREAD = Spread()
"""The differences from which the shipped model learns."""


@dataclass(frozen=True, slots=True)
class Player:
    """Somebody who can play with Effort.

    Attributes
    ----------
    name : of the player.
    habits : how the player moves anyway.
    acting : how far the player goes in acting out an Effort; 1 is all the way.
    time_leaning, weight_leaning : the Effort played where none is meant.
    tracker_noise : of the tracker in use, relative to `Spread.sensor_m` and `sensor_rad`.
    tracker_hz : how often it reports.
    """

    name: str
    habits: Person
    acting: float = 1.0
    time_leaning: float = 0.0
    weight_leaning: float = 0.0
    tracker_noise: float = 1.0
    tracker_hz: float = RATE_HZ


@dataclass(frozen=True, slots=True, eq=False)
class LabelledTake:
    """One take: which gesture was played, the Effort that was meant, by whom, and the doodle."""

    action: str
    effort: Effort
    player: str
    doodle: Doodle


def simulated_player(name: str, rng: np.random.Generator, spread: Spread = SPREAD) -> Player:
    """Return a player drawn at random."""
    habits = simulated_person(rng)
    return Player(
        name=name,
        habits=replace(habits, size=habits.size * float(np.exp(rng.normal(0.0, spread.stage)))),
        acting=float(rng.uniform(*spread.acting)),
        time_leaning=float(rng.normal(0.0, spread.leaning)),
        weight_leaning=float(rng.normal(0.0, spread.leaning)),
    )


def simulated_take(
    action: str,
    effort: Effort,
    player: Player,
    rng: np.random.Generator,
    spread: Spread | None = None,
) -> Doodle:
    """Return the doodle of a player who plays the gesture of one action with the given Effort.

    Parameters
    ----------
    action
        A name in `gestures.GESTURES`.
    effort
        As meant. Time or Weight that is None is played as 0; without Space the strokes are
        straight, and without Flow nothing is held back or let go.
    player
        Who plays.
    rng
        Source of everything that differs between takes, and of where the player stands.
    spread
        How takes differ; `SPREAD` if absent.

    Raises
    ------
    DoodleError
        If there is no such action.
    """
    spread = spread or SPREAD
    time, weight = (
        player.acting * (meant or 0.0) + leaning + float(rng.normal(0.0, spread.take_effort))
        for meant, leaning in (
            (effort.time, player.time_leaning),
            (effort.weight, player.weight_leaning),
        )
    )
    space, flow = (
        0.0 if meant is None else player.acting * meant + float(rng.normal(0.0, spread.take_effort))
        for meant in (effort.space, effort.flow)
    )
    size = player.habits.size * float(np.exp(rng.normal(0.0, spread.take_size)))
    pace = player.habits.pace * float(np.exp(rng.normal(0.0, spread.take_pace)))
    played = gesture(action, size=size, pace=pace, person=player.habits)
    slower = float(np.exp(SHAPING.duration_per_time * time))
    before_s, after_s = rng.uniform(*spread.rest_s, 2)
    end_s = before_s + slower * played.duration_s + after_s
    end_s += SHAPING.swing_s if flow < 0.0 else 0.0
    time_s = tracker_times(0.0, end_s, player.tracker_hz, rng)

    moved, orientation = np.zeros((len(time_s), 3)), np.tile(IDENTITY_XYZW, (len(time_s), 1))
    for stroke in played.strokes:
        since_s = time_s - before_s - slower * stroke.start_s
        done = _course(since_s, slower * stroke.duration_s, stroke, time, weight, flow)[:, None]
        move = np.exp(SHAPING.size_per_weight * weight) * np.asarray(stroke.move_m)
        moved += done * move
        turn = done * np.exp(SHAPING.turn_per_weight * weight) * np.asarray(stroke.turn_rad)
        if effort.space is not None and np.any(move):
            moved += _wandering(done, move, max(0.5 - 0.5 * space, 0.0), rng)
        if effort.flow is not None:
            turn = turn + _following(done, move, max(-flow, 0.0), rng)
        orientation = multiply(orientation, quaternion_from_rotvec(turn))
    return _tracked(time_s, moved, orientation, player, weight, rng, spread)


def labelled_takes(*, people: int, repeats: int, seed: int) -> Iterator[LabelledTake]:
    """Yield takes of simulated players over every pairing of Time and Weight.

    Both axes take the values -1, 0 and 1: both poles and neutral, in all nine pairs.

    Parameters
    ----------
    people
        How many players there are.
    repeats
        Takes per player and pair; their actions are drawn, none again before all were played.
    seed
        The same seed yields the same takes.
    """
    rng = np.random.default_rng(seed)
    actions = ACTIONS
    for i in range(people):
        player = simulated_player(f"player{i + 1:02d}", rng)
        for time in (-1.0, 0.0, 1.0):
            for weight in (-1.0, 0.0, 1.0):
                order = rng.permutation(len(actions))
                for k in range(repeats):
                    action = actions[order[k % len(actions)]]
                    effort = Effort(time=time, weight=weight)
                    doodle = simulated_take(action, effort, player, rng)
                    yield LabelledTake(action, effort, player.name, doodle)


def fourfold_takes(
    *, people: int, repeats: int, seed: int, spread: Spread = SPREAD
) -> Iterator[LabelledTake]:
    """Yield takes of simulated players over every pairing of Time and Weight, Space and Flow too.

    Space and Flow take the values -1, 0 and 1 as well, each as often as the others for every
    player, in an order that has nothing to do with the pairs or the actions. Every take is reported
    by another tracker, finer or coarser, so that what a sensor's noise decides tells nothing.

    Parameters
    ----------
    people, repeats, seed
        As in `labelled_takes`.
    spread
        How people and takes differ.
    """
    rng = np.random.default_rng([seed, 4])
    actions = ACTIONS
    values = (-1.0, 0.0, 1.0)
    pairs = [(time, weight) for time in values for weight in values]
    count = len(pairs) * repeats
    for i in range(people):
        player = simulated_player(f"player{i + 1:02d}", rng, spread)
        space, flow, played = (
            rng.permutation(np.resize(choice, count))
            for choice in (values, values, np.arange(len(actions)))
        )
        for k, (time, weight) in enumerate(pairs * repeats):
            effort = Effort(time, weight, float(space[k]), float(flow[k]))
            player = replace(
                player,
                tracker_noise=float(np.exp(rng.uniform(*np.log(TRACKER_NOISE)))),
                tracker_hz=float(rng.uniform(*TRACKER_HZ)),
            )
            action = actions[played[k]]
            doodle = simulated_take(action, effort, player, rng, spread)
            meant = effort if _goes_somewhere(action) else replace(effort, space=None)
            yield LabelledTake(action, meant, player.name, doodle)


def coarsely_tracked(doodle: Doodle, rng: np.random.Generator) -> Doodle:
    """Return what the coarsest tracker of `TRACKER_NOISE` makes of what another reported."""
    noise_m, noise_rad = (TRACKER_NOISE[1] * n for n in (SPREAD.sensor_m, SPREAD.sensor_rad))
    return with_noise(doodle, noise_m, noise_rad, rng)


def with_noise(
    doodle: Doodle, noise_m: float, noise_rad: float, rng: np.random.Generator
) -> Doodle:
    """Return a doodle with Gaussian noise on every sample: standard deviations along each axis."""
    shape = doodle.position_m.shape
    turn = quaternion_from_rotvec(rng.normal(0.0, noise_rad, shape))
    return replace(
        doodle,
        position_m=doodle.position_m + rng.normal(0.0, noise_m, shape),
        orientation_xyzw=multiply(doodle.orientation_xyzw, turn),
    )


def _goes_somewhere(action: str) -> bool:
    """Return whether a gesture has a way, where Space could show: a turn on the spot has none."""
    return any(np.any(stroke.move_m) for stroke in gesture(action).strokes)


def _wandering(
    done: FloatArray, move: FloatArray, indirect: float, rng: np.random.Generator
) -> FloatArray:
    """Return how far a stroke is off its straight way, ``(n, 3)``, from and to nothing."""
    side = rng.normal(size=3)
    side = normalized(side - (side @ move) / (move @ move) * move)
    weave = normalized(np.cross(move, side))
    phase = np.clip(done, 0.0, 1.0)
    weaving = SHAPING.weave_per_indirect * np.sin(2.0 * np.pi * SHAPING.weaves * phase)
    way = 4.0 * phase * (1.0 - phase) * (SHAPING.bow_per_indirect * side + weaving * weave)
    return np.asarray(indirect * float(np.linalg.norm(move)) * way)


def _following(
    done: FloatArray, move: FloatArray, free: float, rng: np.random.Generator
) -> FloatArray:
    """Return how the prop turns with a free stroke, rotation vectors ``(n, 3)``."""
    axis = normalized(rng.normal(size=3))
    size = free * SHAPING.turn_per_free * float(np.linalg.norm(move)) / 0.1
    return np.asarray(size * np.sin(np.pi * np.clip(done, 0.0, 1.2)) * axis)


def _course(
    since_s: FloatArray, duration_s: float, stroke: Stroke, time: float, weight: float, flow: float
) -> FloatArray:
    """Return how much of a stroke is done, 0 to 1 and, where it rings, about 1, ``(n,)``."""
    from scipy.special import betainc

    sudden, strong, light = max(time, 0.0), max(weight, 0.0), max(-weight, 0.0)
    bound, free = max(flow, 0.0), max(-flow, 0.0)
    u = np.clip(since_s / duration_s, 0.0, 1.0)
    if bound:
        beats = max(round(SHAPING.holds_per_s * duration_s), 2)
        hold = min(SHAPING.hold_per_bound * bound, 0.95)
        u = np.clip(u - hold * np.sin(2.0 * np.pi * beats * u) / (2.0 * np.pi * beats), 0.0, 1.0)
    u = 1.0 - (1.0 - u) ** (1.0 + SHAPING.attack_per_sudden * sudden)
    burst = 1.0 + SHAPING.burst_per_strong * strong
    cruise = stroke.cruise + SHAPING.cruise_per_light * light * (1.0 - stroke.cruise)
    t = np.maximum(since_s - duration_s, 0.0)
    ringing = np.sin(2.0 * np.pi * SHAPING.recoil_hz * t) * np.exp(-t / SHAPING.recoil_decay_s)
    return (
        strokes.progress(betainc(burst, burst, u), cruise)
        + SHAPING.recoil_per_strong * strong * ringing
        + SHAPING.swing_per_free * free * _swing(since_s - 0.8 * duration_s)
    )


def _swing(since_s: FloatArray) -> FloatArray:
    """Return a swing out and back, at its ease: 0 to 1 to 0 in `Shaping.swing_s`."""
    u = np.clip(since_s / SHAPING.swing_s, 0.0, 1.0)
    return np.asarray(np.sin(np.pi * u) ** 2)


def _tracked(
    time_s: FloatArray,
    moved: FloatArray,
    orientation: FloatArray,
    player: Player,
    weight: float,
    rng: np.random.Generator,
    spread: Spread,
) -> Doodle:
    """Return what a tracker reports of a movement in the player's hand, somewhere in the room.

    The hand holds the prop askew and beside its centre, and trembles, as in `takes.Take`.
    """
    habits = player.habits
    tremor = float(np.exp(SHAPING.tremor_per_weight * weight))
    unrest = _waves(time_s, habits.wobble_rad, 0.3, 1.5, rng)
    unrest = unrest + _waves(time_s, tremor * habits.tremor_rad, 8.0, 12.0, rng)
    unrest = unrest + rng.normal(0.0, player.tracker_noise * spread.sensor_rad, moved.shape)
    swing = 0.3 * np.tanh(moved @ np.asarray(habits.swing_rad_per_m).T / 0.3)
    askew = quaternion_from_rotvec([habits.askew_rad[0], 0.0, habits.askew_rad[1]])
    held = multiply(multiply(orientation, askew), quaternion_from_rotvec(swing + unrest))
    position = moved + rotate(held, np.broadcast_to(np.asarray(habits.grip_m), moved.shape))
    position = position + _waves(time_s, habits.drift_m, 0.1, 0.6, rng)
    position = position + _waves(time_s, tremor * habits.tremor_m, 8.0, 12.0, rng)
    position = position + rng.normal(0.0, player.tracker_noise * spread.sensor_m, moved.shape)
    facing = quaternion_about([0.0, 1.0, 0.0], rng.uniform(-np.pi, np.pi))
    return Doodle(
        time_s,
        rotate(facing, position) + rng.normal(0.0, 0.3, 3),
        multiply(facing, held),
        device=player.name,
    )


def _waves(
    time_s: FloatArray, amplitude: float, low_hz: float, high_hz: float, rng: np.random.Generator
) -> FloatArray:
    """Return unrest of an amplitude between two rates, ``(n, 3)``."""
    rates_hz = rng.uniform(low_hz, high_hz, (3, 5))
    phases = rng.uniform(0.0, 2.0 * np.pi, (3, 5))
    waves = np.sin(2.0 * np.pi * rates_hz * time_s[:, None, None] + phases)
    return np.asarray(amplitude / np.sqrt(5.0) * waves.sum(axis=-1))
