"""Flight: how high a jump, a leap or a fall carries the body, along a parabola.

A clip jumps as high as it was made to. Here the height is the doodle's: between take-off and
landing the body goes along a parabola whose duration is that of the flight as it is played, and
whose apex lies between what the prop drew and what gravity asks for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from smd.acting.move import Airborne, Move, Playable
from smd.doodle import Doodle
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import fading

GRAVITY_M_S2 = 9.81

LEAST_APEX_M = 0.03
"""Rise of the body over the line from take-off to landing below which a clip does not fly; nor
does it where the body sinks as far below that line, as in a roll, which leaves its feet as well."""

LOWEST, HIGHEST = 0.5, 2.0
"""How much lower or higher than its clip a flight goes: a clip's legs push, tuck and land for a
flight of its own height."""

FLOATING = 3.0
"""How much more slowly or faster than things fall a body may, as far as its clip's bounds allow."""

YIELDING_S = 0.3
"""Time in which the body gathers the speed that a flight begins with beyond the clip's, and gives
in to the speed that it ends with: a higher jump crouches deeper, before and after."""


@dataclass(frozen=True, slots=True, eq=False)
class Height:
    """How high a prop was, in the scene.

    Attributes
    ----------
    time_s : (n,) increasing, on the recording's clock.
    height_m : (n,).
    """

    time_s: FloatArray
    height_m: FloatArray

    def rise_m(self, start_s: float, end_s: float) -> float:
        """Return how far the prop rose at most over the line from its first to its last place."""
        inside = (self.time_s > start_s) & (self.time_s < end_s)
        time_s, ends_s = self.time_s[inside], [start_s, end_s]
        line = np.interp(time_s, ends_s, np.interp(ends_s, self.time_s, self.height_m))
        return float(np.max(self.height_m[inside] - line, initial=0.0))


def height_of(doodles: Sequence[Doodle]) -> Height:
    """Return how high a device's prop was, given its doodles at the scene's scale."""
    return Height(
        np.concatenate([doodle.time_s for doodle in doodles]),
        np.concatenate([doodle.position_m[:, 1] for doodle in doodles]),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Flight:
    """One flight, as it is played.

    Attributes
    ----------
    take_off_s, landing_s : on the recording's clock; in between nothing touches the ground.
    from_m, to_m : heights of the body there.
    apex_m : how far it rises over the line between them; own_apex_m : how far in the clip.
    gathering_m_s, yielding_m_s : how much faster than the clip it rises at take-off and landing.
    gathering_s, yielding_s : over which that is gained and lost again.
    move : what it is part of.
    body_m : (n,) height of the body in each frame of what is played.
    """

    move: Move[Playable]
    body_m: FloatArray
    take_off_s: float
    landing_s: float
    from_m: float
    to_m: float
    apex_m: float
    own_apex_m: float
    gathering_m_s: float
    yielding_m_s: float
    gathering_s: float
    yielding_s: float

    def share(self, time_s: FloatArray) -> FloatArray:
        """Return how much of the flight has passed: 0 before it, 1 after."""
        return np.clip((time_s - self.take_off_s) / (self.landing_s - self.take_off_s), 0.0, 1.0)

    def height_at(self, time_s: FloatArray) -> FloatArray:
        """Return the body's height at some times of the flight: a parabola."""
        s = self.share(time_s)
        return self.from_m + s * (self.to_m - self.from_m) + 4.0 * self.apex_m * s * (1.0 - s)

    def raised_m(self, time_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how much higher than in the clip the body and the feet are at some times.

        Outside the flight the feet stay where they are.
        """
        own = np.interp(self.move.frame_at(time_s), np.arange(len(self.body_m)), self.body_m)
        flies = (time_s > self.take_off_s) & (time_s < self.landing_s)
        feet_m = np.where(flies, self.height_at(time_s) - own, 0.0)
        before = fading((self.take_off_s - time_s) / self.gathering_s) * self.gathering_s
        after = fading((time_s - self.landing_s) / self.yielding_s) * self.yielding_s
        body_m = np.where(
            flies,
            feet_m,
            np.where(
                time_s <= self.take_off_s, -self.gathering_m_s * before, self.yielding_m_s * after
            ),
        )
        return body_m, feet_m


def apex_for(prop_rise_m: float | None, duration_s: float, own_apex_m: float) -> float:
    """Return how high a flight goes.

    It is the geometric mean of what the prop rose and of what a body thrown up for that time
    does, g t² / 8, or the latter alone where there is no prop; within `FLOATING` of the latter,
    and above all within ``LOWEST`` and ``HIGHEST`` times the clip's own.
    """
    thrown_m = GRAVITY_M_S2 * duration_s**2 / 8.0
    meant_m = thrown_m if prop_rise_m is None else np.sqrt(max(prop_rise_m, 0.0) * thrown_m)
    meant_m = np.clip(meant_m, thrown_m / FLOATING, thrown_m * FLOATING)
    return float(np.clip(meant_m, LOWEST * own_apex_m, HIGHEST * own_apex_m))


def airborne(body_m: FloatArray, touches: BoolArray) -> Airborne | None:
    """Return the one flight of what is played, if it has one.

    Parameters
    ----------
    body_m
        ``(k,)`` height of the joint that holds the legs.
    touches
        ``(k,)`` when anything touches the ground.
    """
    change = np.diff(touches.astype(np.int8))
    leaves, lands = np.flatnonzero(change < 0).tolist(), (np.flatnonzero(change > 0) + 1).tolist()
    lands = [frame for frame in lands if leaves and frame > leaves[0]]
    found = [pair for pair in zip(leaves, lands, strict=False) if _flies(body_m, *pair)]
    return Airborne(*found[0], body_m) if len(found) == 1 else None


def _flies(body_m: FloatArray, first: int, last: int) -> bool:
    over_m = _over_line_m(body_m, first, last)
    return bool(over_m.max() > LEAST_APEX_M and over_m.min() > -LEAST_APEX_M)


def flights(moves: Sequence[Move[Playable]], height: Height | None) -> Iterator[Flight]:
    """Yield the flights in the moves of a performer, as high as its prop was.

    Where nothing says how high that was, they are as high as a body is thrown in their time.
    """
    for move in moves:
        flown = move.airborne
        if move.idles or flown is None or flown.last > move.frame[-1]:
            continue
        yield _flight(move, height, flown)


def raised(all_flights: Sequence[Flight], time_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how much higher than in their clips body and feet are at each time ``(n,)``."""
    body_m, feet_m = np.zeros(len(time_s)), np.zeros(len(time_s))
    for flight in all_flights:
        rows = (time_s >= flight.move.start_s) & (time_s < flight.move.end_s)
        body_m[rows], feet_m[rows] = flight.raised_m(time_s[rows])
    return body_m, feet_m


def in_air(all_flights: Sequence[Flight], time_s: FloatArray) -> BoolArray:
    """Return when a performer flies ``(n,)``."""
    flies = np.zeros(len(time_s), dtype=bool)
    for flight in all_flights:
        flies |= (time_s > flight.take_off_s) & (time_s < flight.landing_s)
    return flies


def _over_line_m(body_m: FloatArray, first: int, last: int) -> FloatArray:
    """Return how high a body is over the line from one frame to another, in those frames."""
    return body_m[first : last + 1] - np.linspace(body_m[first], body_m[last], last - first + 1)


def _flight(move: Move[Playable], height: Height | None, flown: Airborne) -> Flight:
    first, last, body_m = flown.first, flown.last, flown.body_m
    take_off_s, landing_s = np.interp([first, last], move.frame, move.time_s)
    duration_s = landing_s - take_off_s
    own_apex_m = float(_over_line_m(body_m, first, last).max())
    rise_m = None if height is None else height.rise_m(move.start_s, move.end_s)
    apex_m = apex_for(rise_m, duration_s, own_apex_m)
    pace_hz = (last - first) / duration_s
    # Of the clip on the ground: before take-off and after landing, not across.
    leaving = pace_hz * _slope(body_m[max(first - 2, 0) : first + 1])
    landing = -pace_hz * _slope(body_m[last : last + 3][::-1])
    mean = (body_m[last] - body_m[first]) / duration_s
    return Flight(
        move=move,
        body_m=body_m,
        take_off_s=float(take_off_s),
        landing_s=float(landing_s),
        from_m=float(body_m[first]),
        to_m=float(body_m[last]),
        apex_m=apex_m,
        own_apex_m=own_apex_m,
        gathering_m_s=float(mean + 4.0 * apex_m / duration_s - leaving),
        yielding_m_s=float(mean - 4.0 * apex_m / duration_s - landing),
        gathering_s=float(max(min(YIELDING_S, take_off_s - move.start_s), 1e-3)),
        yielding_s=float(max(min(YIELDING_S, move.end_s - landing_s), 1e-3)),
    )


def _slope(value: FloatArray) -> float:
    """Return how fast up to three values grow at the last one, per frame."""
    if len(value) < 3:
        return float(value[-1] - value[0]) / max(len(value) - 1, 1)
    return float(0.5 * value[-3] - 2.0 * value[-2] + 1.5 * value[-1])
