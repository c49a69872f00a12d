"""Gait: how many cycles of a walk (run, side-step …) take a character over a distance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from smd.character.clip import Clip
from smd.geometry.arrays import BoolArray
from smd.geometry.runs import runs_of_true

SHORTEST_STRIDE, LONGEST_STRIDE = 0.75, 1.25
"""Limits of a stride over its clip's: what human legs can do."""

MOST_WALKING_PER_MIN = 140.0
"""Steps a minute from which people run rather than walk [1]_.

References
----------
.. [1] "Cadence (steps/min) as an indicator of the walk-to-run transition", Human Movement
   Science 90, 2023: 135 to 140 steps a minute in young and middle-aged adults.
"""

MOST_RUNNING_PER_MIN = 270.0
"""Steps a minute that no runner exceeds by much: the fastest took 262 at 12.1 m/s [1]_.

References
----------
.. [1] M. Čoh et al., "Kinematics of Usain Bolt's Maximal Sprint Velocity", Kinesiology 50, 2018.
"""

SPARE = 0.85
"""Share of a gait's greatest speed that is planned for: its steps are whole."""

HALF_CYCLE_TOLERANCE = 0.05
"""How far from half a cycle apart two passings may be and still halve it."""


@dataclass(frozen=True, slots=True, order=True)
class Passing:
    """The middle of a foot's swing, where it passes the standing one.

    Attributes
    ----------
    phase : in the cycle, in [0, 1).
    foot : index of the joint.
    """

    phase: float
    foot: int


@dataclass(frozen=True, slots=True)
class Gait:
    """What a travelling cyclic clip does per cycle.

    Attributes
    ----------
    stride_m : distance over the ground.
    duration_s : of a cycle.
    passings : by phase; a gait begins and ends there, since it is nearest to standing. Empty for
        what never touches the ground.
    flies : whether there are moments when no foot stands, as in a run.
    """

    stride_m: float
    duration_s: float
    passings: tuple[Passing, ...]
    flies: bool = False

    @property
    def speed_m_s(self) -> float:
        """The clip's own speed."""
        return self.stride_m / self.duration_s

    @property
    def halves(self) -> bool:
        """Whether the feet pass each other twice a cycle, half a cycle apart."""
        return (
            len(self.passings) == 2
            and abs(self.passings[1].phase - self.passings[0].phase - 0.5) < HALF_CYCLE_TOLERANCE
        )

    @property
    def most_steps_per_min(self) -> float:
        """Limit of steps a minute: a human's, or the clip's own cadence if that is higher."""
        human = MOST_RUNNING_PER_MIN if self.flies else MOST_WALKING_PER_MIN
        return max(human, 60.0 * len(self.passings) / self.duration_s)

    def cycles_for(self, distance_m: float, duration_s: float) -> float:
        """Return how many cycles, whole or half, cover a distance in a time.

        People who walk slower take shorter and fewer steps alike: the ratio of step length to
        step rate hardly changes with speed [1]_, so that the stride grows with its root. No
        stride is shorter or longer than `SHORTEST_STRIDE` and `LONGEST_STRIDE` times the clip's
        while there is a number of cycles for that; within them, steps come no faster than people
        take them. A gait that goes nowhere keeps its own time.

        References
        ----------
        .. [1] N. Sekiya, H. Nagasaki, "Reproducibility of the walking patterns of normal young
           adults", Gait & Posture 7, 1998.
        """
        unit = 0.5 if self.halves else 1.0
        speed_ratio = distance_m / duration_s / self.speed_m_s
        if speed_ratio < 0.05:
            return float(max(round(duration_s / self.duration_s / unit), 1) * unit)
        own = distance_m / self.stride_m
        fewest, most = own / LONGEST_STRIDE, own / SHORTEST_STRIDE
        wanted = own / np.sqrt(speed_ratio)
        if self.passings:
            quickest = self.most_steps_per_min / 60.0 * duration_s / len(self.passings)
            wanted = min(wanted, quickest)
        cycles = round(float(np.clip(wanted, fewest, most)) / unit) * unit
        # Rounding may have left the bounds; the other side may keep them. 1e-9: of rounding alone.
        if cycles < fewest - 1e-9 and cycles + unit <= most + 1e-9:
            cycles += unit
        elif cycles > most + 1e-9 and cycles - unit >= fewest - 1e-9:
            cycles -= unit
        return float(max(cycles, unit))


def gait_of(clip: Clip, stands: Mapping[int, BoolArray]) -> Gait:
    """Read a travelling cyclic clip's gait from when each foot stands, by its joint."""
    passings = [Passing(phase, foot) for foot, on in stands.items() for phase in _middles(~on[:-1])]
    flies = bool(passings) and not np.any(list(stands.values()), axis=0).all()
    return Gait(clip.travel_m, clip.duration_s, tuple(sorted(passings)), flies)


def fastest_m_s(gait: Gait) -> float:
    """Return the greatest speed of a gait: its most steps a minute, its longest stride."""
    if not gait.passings:
        return np.inf
    steps_hz = gait.most_steps_per_min / 60.0
    return steps_hz / len(gait.passings) * LONGEST_STRIDE * gait.stride_m


def planned_m_s(gait: Gait, walking_m_s: float) -> float:
    """Return the speed of a gait that is planned for; of one that does not run, up to another."""
    most = SPARE * fastest_m_s(gait)
    return most if gait.flies or not gait.passings else min(most, walking_m_s)


def phase_after(before: Gait, phase: float, after: Gait) -> float | None:
    """Return the phase at which a gait continues another: the same foot passes; None without one.

    Parameters
    ----------
    phase
        Where ``before`` ended; at one of its own passings, perhaps cycles later.
    """
    ended = min(before.passings, key=lambda p: abs((p.phase - phase + 0.5) % 1.0 - 0.5))
    return next((p.phase for p in after.passings if p.foot == ended.foot), None)


def _middles(signal: BoolArray) -> list[float]:
    """Return the phases of the middles of a cyclic signal's stretches of true."""
    if signal.all() or not signal.any():
        return []
    n = len(signal)
    first_off = int(np.argmin(signal))
    runs = runs_of_true(np.roll(signal, -first_off))
    return [float(((first + end - 1) / 2 + first_off) % n / n) for first, end in runs]
