"""Move: a clip, or a blend of clips, with its path, its timing and its blend weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from smd.character.poses import Poses
from smd.character.tracks import Tracks
from smd.geometry.arrays import BoolArray, FloatArray

KNOT_RATE_HZ = 120.0
"""Rate at which a move is sampled; twice that of any clip or doodle of ours."""


class Placement(NamedTuple):
    """Where a ground root stands, ``(2,)`` x and z in the scene, and which way it faces."""

    position_m: FloatArray
    heading_rad: float


class Footwork(NamedTuple):
    """Foot contacts: when each foot should stand, and how the clip itself pivots it.

    Attributes
    ----------
    stands : (n, legs).
    pivot_rad : (n, legs) heading of each foot over the ground, from any start; only differences
        count.
    """

    stands: BoolArray
    pivot_rad: FloatArray


class Playable(Protocol):
    """What a move can play: a clip, or a blend of clips."""

    def sampled(self, frame: FloatArray) -> Poses:
        """Return local poses at fractional frames ``(n,)``, the ground root at its origin."""

    def tracks_at(self, frame: FloatArray) -> Tracks:
        """Return the tracks at fractional frames ``(n,)``."""

    def stands_at(self, frame: FloatArray) -> Footwork:
        """Return the foot contacts at fractional frames ``(n,)``; pivots of cycles add up."""


PlayedT = TypeVar("PlayedT", bound=Playable, covariant=True)


@dataclass(frozen=True, slots=True, eq=False)
class Airborne:
    """The part of a clip in which nothing touches the ground.

    Attributes
    ----------
    first, last : the frames before and after it.
    body_m : (k,) height of the joint that holds the legs, in each frame of the clip.
    """

    first: int
    last: int
    body_m: FloatArray

    @property
    def over_line_m(self) -> FloatArray:
        """How high the body is over the line from take-off to landing, in each frame between."""
        flown = self.body_m[self.first : self.last + 1]
        return np.asarray(flown - np.linspace(flown[0], flown[-1], len(flown)))

    @property
    def apex_m(self) -> float:
        """How far the body rises over that line."""
        return float(self.over_line_m.max())


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
    presence : (k,) in [0, 1], its blend weight; the rest is the idle clip's.
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
        """How long a transition into or out of the move may take: a third of a phrase, or as
        long as it waits in its first pose.
        """
        duration_s = self.end_s - self.start_s
        if self.idles:
            return duration_s
        return max(duration_s / 3.0, self.waits_s)

    @property
    def waits_s(self) -> float:
        """How long it stays in its first pose."""
        first = int(np.searchsorted(self.frame, self.frame[0], side="right")) - 1
        return float(self.time_s[first] - self.time_s[0])

    @property
    def end(self) -> Placement:
        """Position and heading of the ground root at the end."""
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
        """Return its blend weight at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.presence))


def knots(start_s: float, end_s: float) -> FloatArray:
    """Return the times at which a move is sampled, both ends among them."""
    count = max(round((end_s - start_s) * KNOT_RATE_HZ), 1) + 1
    return np.linspace(start_s, end_s, count)


def nearest_turn(heading_rad: float, to_rad: float) -> float:
    """Return the heading plus whole turns that is nearest to another."""
    return heading_rad + 2.0 * np.pi * float(np.round((to_rad - heading_rad) / (2.0 * np.pi)))
