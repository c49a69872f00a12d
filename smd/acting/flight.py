"""Flight: how high a jump, a leap or a fall carries the body, along a parabola.

A clip jumps as high as it was made to. Here the doodle decides the height: between take-off and
landing the body follows a parabola. Its duration is that of the flight as it is played; its apex
lies between the height that the prop drew and the one that gravity demands.
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
"""Least rise of a flying body over the line from take-off to landing. A clip whose body sinks as
far below that line does not fly either: in a roll the feet leave the ground as well."""

LOWEST, HIGHEST = 0.5, 2.0
"""Limits of a flight's apex over its clip's: the legs of a clip push, tuck and land for a flight of
its own height."""

FLOATING = 3.0
"""Factor by which a flight may be slower or faster than free fall, within its clip's limits."""

PACE_S = 0.03
"""Time before take-off and after landing over which a clip's pace on the ground is taken."""

YIELDING_S = 0.3
"""Time before take-off in which the difference to the clip's velocity is built up, and time after
landing in which it is absorbed: a higher jump crouches deeper, before and after."""

DEEPEST = 0.2
"""Most that a body sinks so, as a share of its height; a low one takes less time for it."""

_SINKS = 0.198
"""Most that `fading` reaches: how deep a body sinks, over its speed and its time."""


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
        """Return the greatest height over the line from the first to the last position."""
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
    gathering_m_s, yielding_m_s : difference to the clip's velocity at take-off and landing.
    gathering_s, yielding_s : over which it is built up and absorbed.
    move : what it is part of.
    body_m : (n,) height of the body in each frame of the clip.
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
        """Return the share of the flight that has passed: 0 before it, 1 after."""
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
    """Return the apex of a flight.

    It is the geometric mean of the prop's rise and of the apex g t² / 8 of a body thrown up for
    that time, or the latter alone where there is no prop. It is limited to a factor of `FLOATING`
    around the latter, and then to ``LOWEST`` and ``HIGHEST`` times the clip's own apex.
    """
    thrown_m = GRAVITY_M_S2 * duration_s**2 / 8.0
    meant_m = thrown_m if prop_rise_m is None else np.sqrt(max(prop_rise_m, 0.0) * thrown_m)
    meant_m = np.clip(meant_m, thrown_m / FLOATING, thrown_m * FLOATING)
    return float(np.clip(meant_m, LOWEST * own_apex_m, HIGHEST * own_apex_m))


def airborne(body_m: FloatArray, touches: BoolArray) -> Airborne | None:
    """Return the one flight of a clip, if it has exactly one.

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
    flights_ = [Airborne(*pair, body_m) for pair in zip(leaves, lands, strict=False)]
    found = [one for one in flights_ if _flies(one)]
    return found[0] if len(found) == 1 else None


def _flies(one: Airborne) -> bool:
    return bool(one.apex_m > LEAST_APEX_M and one.over_line_m.min() > -LEAST_APEX_M)


def fall_s(prop_rise_m: float, flown: Airborne) -> float:
    """Return how long a body is in free fall that jumps as high as its prop rose.

    The height is limited to `LOWEST` and `HIGHEST` times the clip's own apex.
    """
    apex_m = float(np.clip(prop_rise_m, LOWEST * flown.apex_m, HIGHEST * flown.apex_m))
    return float(np.sqrt(8.0 * apex_m / GRAVITY_M_S2))


def flights(moves: Sequence[Move[Playable]], height: Height | None) -> Iterator[Flight]:
    """Yield the flights in the moves of a performer, as high as its prop was.

    Without a height, they are as high as a body that is thrown up for their time.
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


def _flight(move: Move[Playable], height: Height | None, flown: Airborne) -> Flight:
    first, last, body_m = flown.first, flown.last, flown.body_m
    take_off_s, landing_s = np.interp([first, last], move.frame, move.time_s)
    duration_s = landing_s - take_off_s
    own_apex_m = flown.apex_m
    rise_m = None if height is None else height.rise_m(move.start_s, move.end_s)
    apex_m = apex_for(rise_m, duration_s, own_apex_m)
    # Of the clip on the ground, at the pace there: before take-off and after landing, not across.
    before_s, after_s = take_off_s - PACE_S, landing_s + PACE_S
    before, off, on, after = move.frame_at(np.array([before_s, take_off_s, landing_s, after_s]))
    leaving = (off - before) / PACE_S * _slope(body_m[max(first - 2, 0) : first + 1])
    landing = (on - after) / PACE_S * _slope(body_m[last : last + 3][::-1])
    mean = (body_m[last] - body_m[first]) / duration_s
    gathering_m_s = float(mean + 4.0 * apex_m / duration_s - leaving)
    yielding_m_s = float(mean - 4.0 * apex_m / duration_s - landing)
    return Flight(
        move=move,
        body_m=body_m,
        take_off_s=float(take_off_s),
        landing_s=float(landing_s),
        from_m=float(body_m[first]),
        to_m=float(body_m[last]),
        apex_m=apex_m,
        own_apex_m=own_apex_m,
        gathering_m_s=gathering_m_s,
        yielding_m_s=yielding_m_s,
        gathering_s=_sinking_s(gathering_m_s, take_off_s - move.start_s, float(body_m[first])),
        yielding_s=_sinking_s(yielding_m_s, move.end_s - landing_s, float(body_m[last])),
    )


def _sinking_s(speed_m_s: float, room_s: float, height_m: float) -> float:
    """Return how long a difference in velocity is built up or absorbed on the ground."""
    deepest_s = DEEPEST * height_m / (_SINKS * max(abs(speed_m_s), 1e-9))
    return float(max(min(YIELDING_S, room_s, deepest_s), 1e-3))


def _slope(value: FloatArray) -> float:
    """Return how fast up to three values grow at the last one, per frame."""
    if len(value) < 3:
        return float(value[-1] - value[0]) / max(len(value) - 1, 1)
    return float(0.5 * value[-3] - 2.0 * value[-2] + 1.5 * value[-1])
