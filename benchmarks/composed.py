"""Composed sessions: one person's takes among pauses of idle hands, with known truth.

Nobody has recorded long sessions of hands with every gesture marked, so sessions are put together:
takes of one person in random order (SHREC'17), between them a movement back and a piece of real
idling (WAIT), joined by movements of least jerk. All parts are brought to the slower sensor's rate
first, and what the camera did not see gets its noise; the whole is then brought to 60 Hz. All stand
in one frame: no sensor gives away what is a gesture. One gesture in five is of a class that the
library was not taught.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from scipy.signal import savgol_filter

from benchmarks.gestures import DATA, Gestures
from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.formats import SourceFrame, read_recording
from smd.geometry.arrays import BoolArray, FloatArray, frozen_array
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
    slerp,
)

RATE_HZ = 60.0
SENSOR_HZ = 30.0
"""Of the camera; the headset's 72 Hz are brought down to it, and both then up to `RATE_HZ`."""

FRAME = SourceFrame(front="-z")
"""Of SHREC'17: people face the camera along -Z, and so does the front of a hand at rest."""

LEAST_CLASSES, FEW_CLASSES = 6, 6
"""A person is asked with so many classes to teach; and what a small library holds."""

OTHERS_SHARE = 0.2
"""Of a session's gestures, and of a full library's classes: what was not taught."""

MOST_TAKES = 3
"""Of one class in a session."""

PAUSE_S = (0.6, 3.0)
MOVE_S, MOVE_S_A_ROOT_M = (0.25, 0.55), 0.6
"""A movement between parts lasts so long, and so much longer by the root of its way."""

REST_M, REST_RAD = 0.02, 0.1
"""Spread of where a hand comes to rest again."""

GUARD_M = 0.1
"""Spread of the place of rest about where takes begin."""

BOW = 0.08
"""Spread of how far a movement bulges, as a share of its way."""

NOISE_M, NOISE_RAD = 0.3e-3, np.radians(0.5)
"""Spread of the camera's noise about each axis, where a hand rests within a take (people 1 to 7):
what a parabola of five samples leaves is 0.4 mm and 0.5 degrees in the median."""

REST_M_S = 0.05
"""A hand that is slower rests, as far as its noise is concerned."""

SLACK_S = 0.2
"""The trigger is pressed at most so long before a take, and let go at most so long after it."""

FASTEST_M_S, FASTEST_RAD_S = 3.0, 20.0
"""Idle hands that are faster have lost their tracking."""


@dataclass(frozen=True, slots=True)
class Teaching:
    """What each class of a library is taught from.

    Attributes
    ----------
    own : examples of the person who plays.
    others : examples of other people.
    set_aside : own takes that are not played, at least ``own``; default ``own``. Sessions of
        teachings that differ in ``own`` alone are the same from the same seed.
    """

    own: int = 0
    others: int = 0
    set_aside: int = -1

    def __post_init__(self) -> None:
        if self.set_aside < 0:
            object.__setattr__(self, "set_aside", self.own)
        if min(self.own, self.others) < 0 or not self.own + self.others:
            raise ValueError(f"teaching: expected examples, got {self.own} and {self.others}")
        if self.set_aside < self.own:
            raise ValueError(f"set_aside: expected at least {self.own}, got {self.set_aside}")

    def __str__(self) -> str:
        parts = [f"own {self.own}"] if self.own or not self.others else []
        return ", ".join([*parts, *([f"others' {self.others}"] if self.others else [])])


@dataclass(frozen=True, slots=True)
class Annotation:
    """A take in a session: the action that it is, None where the library has none, and when."""

    action: str | None
    start_s: float
    end_s: float


@dataclass(frozen=True, slots=True, eq=False)
class Session:
    """What one person plays, and what is known of it.

    Attributes
    ----------
    person : whose takes are played.
    teaching : how the library was taught.
    examples : of each action of the library, at `RATE_HZ`.
    free : what is played, from 0 s at `RATE_HZ`; nothing says when it was meant.
    held : (n,) bool, whether a trigger would be held at each of its samples.
    gestures : in time order, not overlapping.
    """

    person: int
    teaching: Teaching
    examples: Mapping[str, tuple[Doodle, ...]]
    free: Doodle
    held: BoolArray
    gestures: tuple[Annotation, ...]
    edges_s: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        held = frozen_array("held", self.held, (len(self.free),), DoodleError, np.bool_)
        between_s = [
            0.5 * (before.end_s + after.start_s)
            for before, after in zip(self.gestures, self.gestures[1:], strict=False)
        ]
        edges_s = [float(self.free.time_s[0]), *between_s, float(self.free.time_s[-1])]
        object.__setattr__(self, "held", held)
        object.__setattr__(self, "examples", MappingProxyType(dict(self.examples)))
        object.__setattr__(self, "edges_s", frozen_array("edges_s", edges_s, (None,), DoodleError))

    @property
    def drawn(self) -> Doodle:
        """What is played, with the trigger held during the takes."""
        return replace(self.free, drawing=self.held)

    def window_of(self, time_s: float) -> int:
        """Return the gesture to whose window a time belongs; windows meet half-way."""
        place = int(np.searchsorted(self.edges_s, time_s, side="right")) - 1
        return min(max(place, 0), len(self.gestures) - 1)


class _PoseTrack(NamedTuple):
    """Poses at `SENSOR_HZ`: ``(n, 3)`` and ``(n, 4)``."""

    position_m: FloatArray
    orientation_xyzw: FloatArray


def idle_files(folder: Path = DATA / "idle") -> tuple[list[Path], list[Path]]:
    """Return the idle hands to choose on and those to report on: nine files each."""
    paths = sorted(folder.glob("*.csv"))
    return paths[:9], paths[9:18]


def read_idle(paths: Sequence[Path]) -> list[Doodle]:
    """Read idle hands (Unity: left-handed)."""
    recordings = (read_recording(path, SourceFrame(handedness="left")) for path in paths)
    return [doodle for recording in recordings for doodle in recording.doodles]


def minutes_of(doodles: Iterable[Doodle]) -> float:
    """Return how long doodles are together, min."""
    return sum(doodle.duration_s for doodle in doodles) / 60.0


def sessions_of(
    data: Gestures, idle: Sequence[Doodle], teachings: Sequence[Teaching], *, seed: int
) -> Iterator[Session]:
    """Yield the sessions of all people, taught in each way, with a small and a full library.

    People who have fewer than `LEAST_CLASSES` classes with a take more than is set aside are left
    out.
    """
    for number, teaching in enumerate(teachings):
        for person in np.unique(data.person).tolist():
            for size in (FEW_CLASSES, None):
                rng = np.random.default_rng([seed, person, number, size or 0])
                session = session_of(data, person, teaching, idle, rng, classes=size)
                if session is not None:
                    yield session


def session_of(
    data: Gestures,
    person: int,
    teaching: Teaching,
    idle: Sequence[Doodle],
    rng: np.random.Generator,
    *,
    classes: int | None = None,
) -> Session | None:
    """Compose a session of one person, or None where they have too few takes.

    Parameters
    ----------
    data
        Takes of several people, in `FRAME`.
    person
        Who plays.
    teaching
        What the library is taught from.
    idle
        Hands that mean nothing, in our frame, for the pauses.
    rng
        What is random comes from here, in an order that does not depend on ``teaching.own``.
    classes
        How many the library holds; default all but those that are held out.
    """
    own = {
        label: rng.permutation(np.flatnonzero((data.person == person) & (data.label == label)))
        for label in np.unique(data.label).tolist()
    }
    known = [label for label in own if len(own[label]) > teaching.set_aside]
    if len(known) < LEAST_CLASSES:
        return None
    if classes is None:
        classes = max(len(known) - round(OTHERS_SHARE * len(known)), LEAST_CLASSES)
    held = sorted(rng.permutation(known)[:classes].tolist())
    examples: dict[str, tuple[Doodle, ...]] = {}
    takes: list[tuple[str | None, int]] = []
    for label in held:
        theirs = np.flatnonzero((data.person != person) & (data.label == label))
        theirs = rng.permutation(theirs)[: teaching.others]
        ours = own[label]
        taught = [*ours[: teaching.own].tolist(), *theirs.tolist()]
        examples[str(label)] = tuple(resampled(data.doodles[i], RATE_HZ) for i in taught)
        left = ours[teaching.set_aside :][:MOST_TAKES]
        takes += [(str(label), i) for i in left.tolist()]
    foreign = [i for label in own if label not in held for i in own[label].tolist()]
    count = round(OTHERS_SHARE / (1.0 - OTHERS_SHARE) * len(takes))
    takes += [(None, i) for i in rng.permutation(foreign)[:count].tolist()]
    takes = [takes[i] for i in rng.permutation(len(takes)).tolist()]
    played = [(name, data.doodles[i]) for name, i in takes]
    free, held_at, gestures = compose(played, idle, rng)
    return Session(person, teaching, examples, free, held_at, gestures)


def compose(
    takes: Sequence[tuple[str | None, Doodle]],
    idle: Sequence[Doodle],
    rng: np.random.Generator,
) -> tuple[Doodle, BoolArray, tuple[Annotation, ...]]:
    """Put takes and idling together in turn.

    Returns
    -------
    doodle, held, gestures
        As in a `Session`.
    """
    parts = [_part_of(doodle) for _, doodle in takes]
    starts_m = np.array([part.position_m[0] for part in parts])
    guard_m = np.median(starts_m, axis=0) + rng.normal(0.0, GUARD_M, 3)
    guard_xyzw = parts[int(rng.integers(len(parts)))].orientation_xyzw[0]
    stream = [_idling(idle, guard_m, guard_xyzw, rng)]
    spans: list[tuple[int, int]] = []
    for part in parts:
        stream.append(_movement(stream[-1], part, rng))
        first = sum(len(each.position_m) for each in stream)
        spans.append((first, first + len(part.position_m) - 1))
        stream.append(part)
        rest_m = guard_m + rng.normal(0.0, REST_M, 3)
        rest_xyzw = multiply(quaternion_from_rotvec(rng.normal(0.0, REST_RAD, 3)), guard_xyzw)
        pause = _idling(idle, rest_m, rest_xyzw, rng)
        stream += [_movement(part, pause, rng), pause]
    own = {id(part) for part in parts}
    stream = [each if id(each) in own else _seen_by_camera(each, rng) for each in stream]
    position_m, orientation_xyzw = (np.concatenate(each) for each in zip(*stream, strict=True))
    at_s = np.arange(len(position_m)) / SENSOR_HZ
    free = resampled(Doodle(at_s, position_m, orientation_xyzw), RATE_HZ)
    gestures = tuple(
        Annotation(name, first / SENSOR_HZ, last / SENSOR_HZ)
        for (name, _), (first, last) in zip(takes, spans, strict=True)
    )
    held = np.zeros(len(free), bool)
    for one in gestures:
        early_s, late_s = rng.uniform(0.0, SLACK_S, 2)
        held |= (free.time_s >= one.start_s - early_s) & (free.time_s <= one.end_s + late_s)
    return free, held, gestures


def tremble(sessions: Iterable[Session]) -> tuple[FloatArray, FloatArray]:
    """Return by how much hands tremble at rest, in takes and between them.

    Each is the median of what parabolas through five samples of the sensor leave of position and
    of orientation, ``(2,)`` in metres and radians, where a hand is slower than `REST_M_S`.
    """
    left: list[tuple[FloatArray, FloatArray]] = []
    for session in sessions:
        seen = resampled(session.free, SENSOR_HZ)
        rough_m, rough_q = (
            np.linalg.norm(each - savgol_filter(each, 5, 2, axis=0), axis=1)
            for each in (seen.position_m, seen.orientation_xyzw)
        )
        speed_m_s = np.linalg.norm(np.gradient(seen.position_m, axis=0), axis=1) * SENSOR_HZ
        taken = np.zeros(len(seen), bool)
        for one in session.gestures:
            taken |= (seen.time_s >= one.start_s) & (seen.time_s <= one.end_s)
        rough = np.stack([rough_m, 2.0 * rough_q], axis=1)
        rests = speed_m_s < REST_M_S
        left.append((rough[rests & taken], rough[rests & ~taken]))
    own, between = (np.concatenate(each) for each in zip(*left, strict=True))
    return np.median(own, axis=0), np.median(between, axis=0)


def resampled(doodle: Doodle, rate_hz: float) -> Doodle:
    """Return a doodle at even times, from 0 s on; nothing says what of it was meant."""
    # + 1e-9: 0.29 s at 100 Hz is 28.999…96 periods, and must count as 29.
    count = int(doodle.duration_s * rate_hz + 1e-9) + 1
    at_s = doodle.time_s[0] + np.arange(count) / rate_hz
    position_m = interpolate_linear(doodle.time_s, doodle.position_m, at_s)
    orientation_xyzw = interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, at_s)
    return Doodle(np.arange(count) / rate_hz, position_m, orientation_xyzw, doodle.device)


def _part_of(doodle: Doodle) -> _PoseTrack:
    even = resampled(doodle, SENSOR_HZ)
    return _PoseTrack(even.position_m, even.orientation_xyzw)


def _idling(
    idle: Sequence[Doodle], start_m: FloatArray, start_xyzw: FloatArray, rng: np.random.Generator
) -> _PoseTrack:
    """Return a piece of idling that begins at a pose: carried there, and held as there."""
    long = [doodle for doodle in idle if doodle.duration_s > PAUSE_S[1]]
    share = np.array([doodle.duration_s for doodle in long])
    while True:
        whole = long[int(rng.choice(len(long), p=share / share.sum()))]
        length_s = rng.uniform(*PAUSE_S)
        begin_s = whole.time_s[0] + rng.uniform(0.0, whole.duration_s - length_s)
        kept = (whole.time_s >= begin_s) & (whole.time_s <= begin_s + length_s)
        if np.count_nonzero(kept) < 2:
            continue
        piece = _part_of(whole.selected(kept))
        if len(piece.position_m) > 2 and not _is_too_fast(piece):
            break
    turn = multiply(inverse(piece.orientation_xyzw[0]), start_xyzw)
    return _PoseTrack(
        piece.position_m - piece.position_m[0] + start_m, multiply(piece.orientation_xyzw, turn)
    )


def _seen_by_camera(part: _PoseTrack, rng: np.random.Generator) -> _PoseTrack:
    """Return poses with the noise that takes have."""
    n = len(part.position_m)
    turn = quaternion_from_rotvec(rng.normal(0.0, NOISE_RAD, (n, 3)))
    return _PoseTrack(
        part.position_m + rng.normal(0.0, NOISE_M, (n, 3)), multiply(part.orientation_xyzw, turn)
    )


def _is_too_fast(part: _PoseTrack) -> bool:
    """Return whether a hand moves as none does."""
    speed_m_s = SENSOR_HZ * np.linalg.norm(np.diff(part.position_m, axis=0), axis=1)
    steps = multiply(inverse(part.orientation_xyzw[:-1]), part.orientation_xyzw[1:])
    turning_rad_s = SENSOR_HZ * np.linalg.norm(rotvec_from_quaternion(steps), axis=1)
    return bool(speed_m_s.max() > FASTEST_M_S or turning_rad_s.max() > FASTEST_RAD_S)


def _movement(before: _PoseTrack, after: _PoseTrack, rng: np.random.Generator) -> _PoseTrack:
    """Return how a hand goes from the end of one part to the begin of another.

    The way of least jerk (a polynomial of fifth degree [1]_) from the one's velocity to the
    other's, without acceleration at both, slightly bowed; it turns in step.

    References
    ----------
    .. [1] T. Flash, N. Hogan, "The Coordination of Arm Movements", Journal of Neuroscience 5, 1985.
    """
    a_m, b_m = before.position_m[-1], after.position_m[0]
    way_m = float(np.linalg.norm(b_m - a_m))
    count = round((rng.uniform(*MOVE_S) + MOVE_S_A_ROOT_M * np.sqrt(way_m)) * SENSOR_HZ)
    s = np.arange(1, count) / count
    duration_s = count / SENSOR_HZ
    leaving = duration_s * _velocity(before.position_m[-3:])
    arriving = duration_s * _velocity(after.position_m[:3])
    bell = 10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5
    position_m = (
        a_m
        + bell[:, None] * (b_m - a_m)
        + (s - 6.0 * s**3 + 8.0 * s**4 - 3.0 * s**5)[:, None] * leaving
        + (-4.0 * s**3 + 7.0 * s**4 - 3.0 * s**5)[:, None] * arriving
        + 16.0 * np.square(s * (1.0 - s))[:, None] * rng.normal(0.0, BOW * way_m, 3)
    )
    ends_xyzw = (before.orientation_xyzw[-1], after.orientation_xyzw[0])
    from_xyzw, to_xyzw = (np.tile(q, (len(s), 1)) for q in ends_xyzw)
    return _PoseTrack(position_m, slerp(from_xyzw, to_xyzw, bell))


def _velocity(position_m: FloatArray) -> FloatArray:
    """Return the mean velocity of a few samples, m/s."""
    return np.asarray((position_m[-1] - position_m[0]) * SENSOR_HZ / (len(position_m) - 1))
