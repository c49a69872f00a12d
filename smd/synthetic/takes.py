"""Takes: gestures and pauses of one simulated person, as a tracker would report them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from smd.doodle import Doodle
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
)
from smd.score import Phrase
from smd.synthetic.curves import RATE_HZ, Vector, even_times
from smd.synthetic.gestures import Gesture, gesture
from smd.synthetic.person import Person
from smd.synthetic.strokes import progress
from smd.synthetic.tracker import tracker_times

REBOUND_S = 0.3
"""How long a hand takes to spring back after a gesture."""


@dataclass(frozen=True, slots=True)
class _Manner:
    """How the strokes of one gesture differ from what their person usually does.

    Attributes
    ----------
    roundness : how far each bows out, as a share of its length.
    power : of the share of time that is gone, for each: below 1 it is fastest early.
    swing : what is added to the turn of the arm's swing, 3 x 3, rotation per displacement.
    aside_rad : how far the prop is turned aside at the end of each stroke but the last.
    """

    roundness: FloatArray
    power: FloatArray
    swing: FloatArray
    aside_rad: FloatArray

    def turn_aside(self, done: FloatArray) -> FloatArray:
        """Return how far the prop is turned aside, ``(n, 3)``, once ``(strokes, n)`` is done."""
        if len(done) == 1:
            return np.asarray(4.0 * (done * (1.0 - done)).T @ self.aside_rad)
        reached = np.concatenate([self.aside_rad[:-1], np.zeros((1, 3))])
        return np.asarray(done.T @ np.diff(reached, axis=0, prepend=0.0))


@dataclass(frozen=True, slots=True)
class _Played:
    """A gesture on a take's clock, the upright frame it is drawn in (with the aim's error), a
    unit vector for each of its strokes, across it, to which it bows out, and their manner.
    """

    gesture: Gesture
    start_s: float
    facing_xyzw: FloatArray
    side: FloatArray
    manner: _Manner


class Take:
    """One device's performance, built gesture by gesture.

    Parameters
    ----------
    person
        Who plays.
    rng
        Source of all that differs from take to take.
    start_m, heading_rad
        Where the prop is at first, and where it faces (0 is +Z, positive to the left).
    start_s
        Time of the first sample.
    """

    def __init__(
        self,
        person: Person,
        rng: np.random.Generator,
        *,
        start_m: Vector = (0.0, 0.0, 0.0),
        heading_rad: float = 0.0,
        start_s: float = 0.0,
    ) -> None:
        self._person = person
        self._rng = rng
        self._start_m = np.asarray(start_m, dtype=np.float64)
        self._first_heading_rad = self._heading_rad = heading_rad
        self._first_s = self.now_s = start_s
        self._played: list[_Played] = []

    @property
    def phrases(self) -> tuple[Phrase, ...]:
        """What was played, and when: from the first stroke's beginning to the last one's end."""
        return tuple(
            Phrase(p.gesture.action, p.start_s, p.start_s + p.gesture.duration_s)
            for p in self._played
        )

    def pause(self, duration_s: float) -> Take:
        """Hold still."""
        self.now_s += duration_s
        return self

    def until(self, time_s: float) -> Take:
        """Hold still until a time; at once if it has passed."""
        self.now_s = max(self.now_s, time_s)
        return self

    def play(self, action: str, *, size: float = 1.0, pace: float = 1.0) -> Take:
        """Play an action's gesture as this person does; ``size`` and ``pace`` as in `gesture`."""
        person, rng = self._person, self._rng
        size *= person.size * float(np.exp(rng.normal(0.0, person.spread)))
        pace *= person.pace * float(np.exp(rng.normal(0.0, person.spread)))
        aim = rng.normal(0.0, person.aim_rad, 2)
        played, manner = self._in_a_manner(gesture(action, size=size, pace=pace, person=person))
        facing = multiply(
            quaternion_about([0.0, 1.0, 0.0], self._heading_rad + aim[0]),
            quaternion_about([1.0, 0.0, 0.0], aim[1]),
        )
        moves = np.array([stroke.move_m for stroke in played.strokes])
        side = normalized(np.cross(moves, rng.normal(size=moves.shape)))
        self._played.append(_Played(played, self.now_s, facing, side, manner))
        self._heading_rad += sum(stroke.turn_rad[1] for stroke in played.strokes)
        self.now_s += played.duration_s
        return self

    def _in_a_manner(self, played: Gesture) -> tuple[Gesture, _Manner]:
        """Return a gesture with the errors of its strokes, and what else is theirs alone.

        They have a source of their own: who makes no such errors draws from the take's as ever.
        """
        person, rng = self._person, self._rng.spawn(1)[0]
        n = len(played.strokes)
        longer = np.exp(rng.normal(0.0, person.stroke_spread, n))
        astray = quaternion_from_rotvec(rng.normal(0.0, person.stroke_aim_rad, (n, 3)))
        strokes = played.strokes
        if person.stroke_spread or person.stroke_aim_rad:
            moves = longer[:, None] * rotate(astray, np.array([s.move_m for s in strokes]))
            turns = longer[:, None] * np.array([s.turn_rad for s in strokes])
            strokes = tuple(
                replace(stroke, move_m=tuple(move), turn_rad=tuple(turn))
                for stroke, move, turn in zip(strokes, moves.tolist(), turns.tolist(), strict=True)
            )
        manner = _Manner(
            roundness=person.roundness * np.exp(rng.normal(0.0, person.roundness_spread, n)),
            power=np.exp(rng.normal(0.0, person.skew, n)),
            swing=rng.normal(0.0, person.swing_spread, (3, 3)),
            aside_rad=rng.normal(0.0, person.stroke_turn_rad, (n, 3)),
        )
        return replace(played, strokes=strokes), manner

    def doodle(self, device: str = "prop", *, rate_hz: float = RATE_HZ) -> Doodle:
        """Return what a tracker reports of the take: uneven times, 1 % of the frames lost.

        Draws from the generator: a second call gives another reading of the same play.
        """
        time_s = tracker_times(self._first_s, self.now_s, rate_hz, self._rng)
        position, orientation = self._pose(time_s)
        return Doodle(time_s, position, orientation, device=device)

    def exact_doodle(self, device: str = "prop", *, rate_hz: float = RATE_HZ) -> Doodle:
        """Return the take at even times, with this person's unrest but no fault of a tracker."""
        time_s = self._first_s + even_times(self.now_s - self._first_s, rate_hz)
        position, orientation = self._pose(time_s)
        return Doodle(time_s, position, orientation, device=device)

    def _pose(self, time_s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the prop's position and orientation at given times."""
        person, rng = self._person, self._rng
        moved = np.zeros((len(time_s), 3))
        orientation = quaternion_about(
            [0.0, 1.0, 0.0], np.full(len(time_s), self._first_heading_rad)
        )
        local = np.zeros_like(moved)
        swung = np.zeros_like(moved)
        aside = np.zeros_like(moved)
        for played in self._played:
            last_s = played.gesture.duration_s
            manner = played.manner
            shares = []
            for stroke, side, roundness, power in zip(
                played.gesture.strokes, played.side, manner.roundness, manner.power, strict=True
            ):
                begun_s = time_s - played.start_s - stroke.start_s
                gone = np.clip(begun_s / stroke.duration_s, 0.0, 1.0) ** power
                done = progress(gone, stroke.cruise)[:, None]
                move = np.asarray(stroke.move_m)
                bow = 4.0 * roundness * float(np.linalg.norm(move)) * side
                path = done * move + done * (1.0 - done) * bow
                if stroke.end_s > last_s - 1e-9:
                    back = progress((begun_s - stroke.duration_s) / REBOUND_S)[:, None]
                    path -= person.rebound_m * back * normalized(move)
                moved += rotate(played.facing_xyzw, path)
                shares.append(done[:, 0])
                local += path
                swung += path @ manner.swing.T
                turn = quaternion_from_rotvec(done * np.asarray(stroke.turn_rad))
                orientation = multiply(orientation, turn)
            aside += manner.turn_aside(np.array(shares))
        tilt = [person.askew_rad[0], person.misfacing_rad, person.askew_rad[1]]
        askew = quaternion_from_rotvec(tilt)
        most_rad = person.swing_limit_rad
        swung += local @ np.asarray(person.swing_rad_per_m).T
        swing = most_rad * np.tanh(swung / most_rad)
        unrest = _waves(time_s, person.wobble_rad, 0.3, 1.5, rng)
        unrest = unrest + _waves(time_s, person.tremor_rad, 8.0, 12.0, rng)
        held = multiply(
            multiply(orientation, askew), quaternion_from_rotvec(swing + aside + unrest)
        )
        grip = np.broadcast_to(np.asarray(person.grip_m), moved.shape)
        # The hand is where the pivot is; at rest, upright, the pivot is below the centre by grip.
        lever = rotate(held, grip) - rotate(orientation[0], grip[0])
        position = self._start_m + moved + lever
        position += _waves(time_s, person.drift_m, 0.1, 0.6, rng)
        position += _waves(time_s, person.tremor_m, 8.0, 12.0, rng)
        return position, held


def _waves(
    time_s: FloatArray, amplitude: float, low_hz: float, high_hz: float, rng: np.random.Generator
) -> FloatArray:
    """Return unrest of an amplitude between two rates, ``(n, 3)``: five sine waves an axis."""
    rates = rng.uniform(low_hz, high_hz, (3, 5))
    phases = rng.uniform(0.0, 2.0 * np.pi, (3, 5))
    waves = np.sin(2.0 * np.pi * rates * time_s[:, None, None] + phases).sum(axis=-1)
    return np.asarray(amplitude / np.sqrt(5.0) * waves)
