"""Simulated people whose hands differ as much as real ones do.

`person.simulated_person` draws people who mean every turn of the prop; Effort is learned from
them. Real hands are less tidy: they hold the prop askew, turn it along as they move, bow out,
miss where they began. `hand_person` draws people who do so as much as was measured of people 1 to
7 of a collection of gestures before a camera [1]_ and of two sessions with VR controllers.
``python -m benchmarks.hands`` prints both populations beside those hands.

References
----------
.. [1] Q. De Smedt et al., "SHREC'17 Track: 3D Hand Gesture Recognition Using a Depth and Skeletal
   Dataset", Eurographics Workshop on 3D Object Retrieval, 2017.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from smd.synthetic.curves import Vector
from smd.synthetic.person import Person, simulated_person


@dataclass(frozen=True, slots=True)
class Hands:
    """How real hands differ. Standard deviations, unless something else is said.

    Attributes
    ----------
    size, pace : between people, of the logarithm.
    spread : of both from gesture to gesture of one person.
    aim_rad : of a gesture's heading and elevation.
    stroke_spread, stroke_aim_rad : of its strokes' lengths (logarithm) and directions.
    stroke_turn_rad : of how far the prop is turned aside between them.
    askew_rad, misfacing_rad : between people, of how the prop is tilted and turned in the hand.
    swing_rad_per_m : how much hands turn as they move, on average: 3 x 3, turn about (left, up,
        front) per displacement along (left, up, front). Who lifts a hand tips it back, and who
        takes it to the left turns it to the left.
    swing_between, swing_spread : of each of those numbers, between people and from gesture to
        gesture, in radians a metre.
    swing_limit_rad : how much that turns the prop at most.
    roundness : range of how far a person's strokes bow out.
    roundness_spread, skew : from stroke to stroke, as in `strokes.Person`.
    swings : chances that a hand waves no, one and two times more than twice.
    """

    size: float = 0.25
    pace: float = 0.22
    spread: float = 0.2
    aim_rad: float = np.radians(10.0)
    stroke_spread: float = 0.17
    stroke_aim_rad: float = np.radians(8.0)
    stroke_turn_rad: float = np.radians(10.0)
    askew_rad: float = np.radians(12.0)
    misfacing_rad: float = np.radians(12.0)
    swing_rad_per_m: tuple[Vector, Vector, Vector] = (
        (0.0, -1.5, 0.0),
        (1.5, 0.0, 0.5),
        (0.0, 0.0, 0.0),
    )
    swing_between: float = 1.0
    swing_spread: float = 1.0
    swing_limit_rad: float = 0.7
    roundness: tuple[float, float] = (0.03, 0.15)
    roundness_spread: float = 0.5
    skew: float = 0.3
    swings: tuple[float, float, float] = (0.6, 0.3, 0.1)


MEASURED = Hands()
"""What was measured; ``docs/synthetic.md`` shows the figures side by side."""


def hand_person(rng: np.random.Generator, hands: Hands = MEASURED) -> Person:
    """Return a person drawn at random, whose hands differ from others' as ``hands`` says.

    What is not said there, as grip and unrest, is drawn as `person.simulated_person` does.
    """
    usual = simulated_person(rng)
    swing = hands.swing_rad_per_m + rng.normal(0.0, hands.swing_between, (3, 3))
    left, up, front = ((x, y, z) for x, y, z in swing.tolist())
    return replace(
        usual,
        size=float(np.exp(rng.normal(0.0, hands.size))),
        pace=float(np.exp(rng.normal(0.0, hands.pace))),
        spread=hands.spread,
        aim_rad=hands.aim_rad,
        stroke_spread=hands.stroke_spread,
        stroke_aim_rad=hands.stroke_aim_rad,
        stroke_turn_rad=hands.stroke_turn_rad,
        askew_rad=(rng.normal(0.0, hands.askew_rad), rng.normal(0.0, hands.askew_rad)),
        misfacing_rad=rng.normal(0.0, hands.misfacing_rad),
        swing_rad_per_m=(left, up, front),
        swing_spread=hands.swing_spread,
        swing_limit_rad=hands.swing_limit_rad,
        roundness=rng.uniform(*hands.roundness),
        roundness_spread=hands.roundness_spread,
        skew=hands.skew,
        swings=int(rng.choice(len(hands.swings), p=hands.swings)),
    )
