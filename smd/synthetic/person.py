"""A person who plays gestures: habits and errors, all of them none where nothing is said.

A person plays a gesture larger or smaller, slower or faster, aims beside the mark, holds the prop
askew, takes it beside its centre and trembles. All numbers are ours, in figurine scale, and not
measurements of people.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.synthetic.curves import Vector


@dataclass(frozen=True, slots=True)
class Person:
    """How somebody plays. The default is exact and steady: closed-form truth.

    Attributes
    ----------
    size, pace : of gestures, relative to the average person.
    spread : of size and pace from gesture to gesture, standard deviation of the logarithm.
    aim_rad : error of a gesture's heading and elevation, standard deviation.
    askew_rad : standing tilt of the prop in the hand, about (left, front).
    overlap : share of a stroke during which the next one is drawn already, from 0 to 1.
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
