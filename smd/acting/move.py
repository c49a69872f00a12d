"""Move: something that is played for a while, where it goes, and how much of it is seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from smd.character.poses import Poses
from smd.geometry.arrays import BoolArray, FloatArray

KNOT_RATE_HZ = 120.0
"""How densely a move is described; twice as dense as any clip or doodle of ours."""


class Placement(NamedTuple):
    """Where a ground root stands, ``(2,)`` x and z in the scene, and which way it faces."""

    position_m: FloatArray
    heading_rad: float


class Footwork(NamedTuple):
    """What feet do: when each should stand, and how it turns of its own will.

    Attributes
    ----------
    stands : (n, legs).
    pivot_rad : (n, legs) which way each points over the ground, from wherever it began; only
        differences count.
    """

    stands: BoolArray
    pivot_rad: FloatArray


class Playable(Protocol):
    """What a move can play: a clip, or a blend of clips."""

    def sampled(self, frame: FloatArray) -> Poses:
        """Return local poses at fractional frames ``(n,)``, the ground root at its origin."""

    def stands_at(self, frame: FloatArray) -> Footwork:
        """Return what the character's legs do at fractional frames ``(n,)``; cycles add up."""


PlayedT = TypeVar("PlayedT", bound=Playable, covariant=True)


@dataclass(frozen=True, slots=True, eq=False)
class Airborne:
    """The part of what is played in which nothing touches the ground.

    Attributes
    ----------
    first, last : the frames before and after it.
    body_m : (k,) height of the joint that holds the legs, in each frame of what is played.
    """

    first: int
    last: int
    body_m: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Move(Generic[PlayedT]):
    """What a character does from ``start_s`` to ``end_s``, described at knots.

    Attributes
    ----------
    piece : what is played.
    start_s, end_s : on the recording's clock.
    time_s : (k,) increasing; before the first and after the last knot, the move holds still.
    root_m : (k, 2) x and z of the ground root in the scene.
    heading_rad : (k,) of the ground root.
    frame : (k,) of what is played, fractional, not decreasing; beyond the last frame of a cycle.
    presence : (k,) in [0, 1], how much of it is seen; the rest is idling.
    idles : whether nothing is performed.
    airborne : the part of its frames that flies, if one does.
    """

    piece: PlayedT
    start_s: float
    end_s: float
    time_s: FloatArray
    root_m: FloatArray
    heading_rad: FloatArray
    frame: FloatArray
    presence: FloatArray
    idles: bool = False
    airborne: Airborne | None = None

    @property
    def room_s(self) -> float:
        """How long a transition into or out of the move may take: a third of a phrase."""
        duration_s = self.end_s - self.start_s
        return duration_s if self.idles else duration_s / 3.0

    @property
    def end(self) -> Placement:
        """Where the move leaves the ground root."""
        return Placement(self.root_m[-1], float(self.heading_rad[-1]))

    def root_at(self, time_s: FloatArray) -> FloatArray:
        """Return x and z of the ground root ``(m, 2)`` at some times."""
        return np.stack([np.interp(time_s, self.time_s, axis) for axis in self.root_m.T], axis=-1)

    def heading_at(self, time_s: FloatArray) -> FloatArray:
        """Return the ground root's heading at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.heading_rad))

    def frame_at(self, time_s: FloatArray) -> FloatArray:
        """Return the fractional frame of what is played at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.frame))

    def presence_at(self, time_s: FloatArray) -> FloatArray:
        """Return how much of it is seen at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.presence))


def knots(start_s: float, end_s: float) -> FloatArray:
    """Return the times at which a move is described, both ends among them."""
    count = max(round((end_s - start_s) * KNOT_RATE_HZ), 1) + 1
    return np.linspace(start_s, end_s, count)


def nearest_turn(heading_rad: float, to_rad: float) -> float:
    """Return the heading plus whole turns that is nearest to another."""
    return heading_rad + 2.0 * np.pi * float(np.round((to_rad - heading_rad) / (2.0 * np.pi)))
