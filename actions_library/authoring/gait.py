"""Gaits by phase: when each of any number of feet stands, and so where.

Hildebrand's diagrams [1]_ describe a gait that repeats by two things: the part of the cycle that
each foot is down (its duty factor), and when in the cycle it lands. Walks have a duty factor above
one half, runs below [3]_. The orders of footfalls here are those of dogs [2]_.

References
----------
.. [1] M. Hildebrand, "Symmetrical gaits of horses", Science 150, 1965.
.. [2] M. Hildebrand, "Analysis of asymmetrical gaits", J. Mammalogy 58, 1977.
.. [3] R. McN. Alexander, "The gaits of bipedal and quadrupedal animals", Int. J. Robotics
   Research 3, 1984.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from actions_library.authoring.feet import ALWAYS_S, Plant, Via, repeated
from actions_library.authoring.rig import Rig
from actions_library.authoring.rigging import place_of

LATERAL_WALK = {"left_hind": 0.0, "left_fore": 0.25, "right_hind": 0.5, "right_fore": 0.75}
"""Each hind foot lands before the fore foot of its own side, evenly spaced."""

TROT = {"left_hind": 0.0, "right_fore": 0.0, "right_hind": 0.5, "left_fore": 0.5}
"""Diagonal pairs."""

ROTARY_GALLOP = {"left_hind": 0.0, "right_hind": 0.11, "right_fore": 0.44, "left_fore": 0.56}
"""Hind feet, a flight stretched out, fore feet in a circle with them, a flight gathered."""


@dataclass(frozen=True, slots=True)
class Step:
    """How one foot steps.

    Attributes
    ----------
    duty : part of the cycle that it is down.
    lift : of the ankle over where it stands (m).
    land_pitch, leave_pitch : of the foot when it lands and when it leaves, toes down (°).
    flat, roll : parts of the stand in which it comes down and rolls off.
    fold : of the foot early on its way through the air, toes down (°).
    toes : bends the toes up then (°).
    ahead : where it stands in the middle of its stand, ahead of where it is at rest (m).
    inward : how much nearer to the middle than at rest it stands (m).
    out : how far it swings out on its way (m).
    """

    duty: float = 0.6
    lift: float = 0.05
    land_pitch: float = 0.0
    leave_pitch: float = 0.0
    flat: float = 0.3
    roll: float = 0.5
    fold: float = 0.0
    toes: float = 0.0
    ahead: float = 0.0
    inward: float = 0.0
    out: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class GaitDiagram:
    """A gait that repeats.

    Attributes
    ----------
    period_s : of the cycle.
    stride_m : the way in one cycle.
    phase : when each leg's foot lands, in cycles, by the leg's name.
    step : of all feet but those that have their own.
    own : steps of some legs, by the leg's name.
    """

    period_s: float
    stride_m: float
    phase: Mapping[str, float]
    step: Step
    own: Mapping[str, Step] = field(default_factory=dict)

    def step_of(self, leg: str) -> Step:
        """Return how a leg's foot steps."""
        return self.own.get(leg, self.step)


def metachronal(
    pairs: Sequence[tuple[str, str]], lag: float, across: float = 0.5
) -> dict[str, float]:
    """Return the phases of many legs: a wave of steps from the first pair to the last [1]_.

    Parameters
    ----------
    pairs
        Names of the left and the right leg of each pair; from hind to fore in insects, and in
        caterpillars, whose wave runs ahead.
    lag
        How much later each pair steps than the one before it, in cycles.
    across
        How much later the right foot steps than the left one: 0.5 in turn, 0 together.

    References
    ----------
    .. [1] D. M. Wilson, "Insect walking", Annual Review of Entomology 11, 1966.
    """
    return {
        name: (k * lag + side * across) % 1.0
        for k, pair in enumerate(pairs)
        for side, name in enumerate(pair)
    }


def gait_plants(rig: Rig, gait: GaitDiagram) -> dict[str, list[Plant]]:
    """Return each leg's plants, for a body that travels ahead from the origin at constant speed.

    In the middle of its stand a foot is below where it is at rest, moved by its step's ``ahead``.
    """
    return {leg: _plants_of(rig, leg, gait) for leg in gait.phase}


def standing_plants(rig: Rig) -> dict[str, list[Plant]]:
    """Return plants of every leg, which stands where it is at rest for as long as anybody looks."""
    plants = {}
    for leg in rig.legs:
        left, _, ahead = place_of(rig.skeleton, leg.foot)
        plants[leg.name] = [Plant(-ALWAYS_S, ALWAYS_S, left=left, ahead=ahead)]
    return plants


def _plants_of(rig: Rig, name: str, gait: GaitDiagram) -> list[Plant]:
    leg, step = rig.leg(name), gait.step_of(name)
    left, _, ahead = place_of(rig.skeleton, leg.foot)
    land = gait.phase[name] * gait.period_s
    stand_s = step.duty * gait.period_s
    middle = (land + 0.5 * stand_s) / gait.period_s
    plant = Plant(
        land=land,
        leave=land + stand_s,
        left=left - leg.out * step.inward,
        ahead=ahead + step.ahead + middle * gait.stride_m,
        land_pitch=step.land_pitch,
        flat=step.flat * stand_s,
        leave_pitch=step.leave_pitch,
        roll=step.roll * stand_s,
        swing=(
            _via(step, 0.25, 0.15, lift=0.75, pitch=step.fold, toes=step.toes),
            _via(step, 0.55, 0.63, lift=1.0, pitch=0.6 * step.fold, toes=0.5 * step.toes),
            _via(step, 0.85, 1.03, lift=0.4, pitch=step.land_pitch, toes=step.land_pitch),
        ),
    )
    return repeated([plant], gait.period_s, left=0.0, ahead=gait.stride_m)


def _via(step: Step, at: float, swung: float, *, lift: float, pitch: float, toes: float) -> Via:
    """Return a place on a foot's way through the air.

    ``swung`` is the part of its way from back to front as its body sees it, while that travels on.
    """
    along = at * (1.0 - step.duty) + swung * step.duty
    up, out = lift * step.lift, step.out if at < 0.8 else 0.0
    return Via(at, up, along=along, out=out, pitch=pitch, toes=toes)
