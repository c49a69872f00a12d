"""Move: one span of the timeline, fitted to the doodle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.transfer.repertoire import Piece

KNOT_RATE_HZ = 120.0
"""How densely a move is described; twice as dense as any clip or doodle of ours."""


class Placement(NamedTuple):
    """Where a ground root stands, ``(2,)`` x and z on the stage, and which way it faces."""

    position_m: FloatArray
    heading_rad: float


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """What a character does from ``start_s`` to ``end_s``, described at knots.

    Attributes
    ----------
    piece : what is seen.
    start_s, end_s : on the recording's clock.
    time_s : (k,) increasing; before the first and after the last knot, the move holds still.
    root_m : (k, 2) x and z of the ground root on the stage.
    heading_rad : (k,) of the ground root.
    frame : (k,) of the clip, fractional, not decreasing; beyond the last frame of a cyclic one.
    presence : (k,) in [0, 1], how much of the clip is seen; the rest is idling.
    idles : whether nothing is performed.
    """

    piece: Piece
    start_s: float
    end_s: float
    time_s: FloatArray
    root_m: FloatArray
    heading_rad: FloatArray
    frame: FloatArray
    presence: FloatArray
    idles: bool = False

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
        """Return the clip's fractional frame at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.frame))

    def presence_at(self, time_s: FloatArray) -> FloatArray:
        """Return how much of the clip is seen at some times."""
        return np.asarray(np.interp(time_s, self.time_s, self.presence))


def knots(start_s: float, end_s: float) -> FloatArray:
    """Return the times at which a move is described, both ends among them."""
    count = max(round((end_s - start_s) * KNOT_RATE_HZ), 1) + 1
    return np.linspace(start_s, end_s, count)


def nearest_turn(heading_rad: float, to_rad: float) -> float:
    """Return the heading plus whole turns that is nearest to another."""
    return heading_rad + 2.0 * np.pi * float(np.round((to_rad - heading_rad) / (2.0 * np.pi)))
