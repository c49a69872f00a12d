"""Following: going along with the prop where nothing is recognised."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from laban import RigidMotion
from smd.acting.legs import feet_of
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed
from smd.geometry.rotations import heading_rad
from smd.score import Phrase
from smd.transfer.ground_root import ground_root, turned

if TYPE_CHECKING:
    from smd.cast import ActionLibrary

PREFERRED = ("walk", "run", "walk_backward", "side_step_left", "side_step_right")
"""What somebody does who just goes along; other gaits, such as sneaking, mean something."""

GOES_HEIGHTS_S = 0.15
"""Figure heights a second from which a prop travels: on the stage 0.26 m/s, a fifth of a walk."""

SMOOTHING_S = 0.2
"""Of that speed: a body does not stop where a hand turns back."""

PAUSE_S, SHORTEST_S = 0.6, 0.8
"""A shorter pause is gone through, and shorter travel is not gone along with."""

STEP_S = 1.0
"""How often the gait may change."""

LEAST_HEIGHTS = 1.0
"""Way, in figure heights, that is worth going along with."""

TURN_OUTWEIGHS = 1.0
"""A gait that goes another way by a radian suits as little as one of a pace unlike by the root of
so many powers of e. Who is moved sideways steps sideways, unless nobody could step so fast."""


@dataclass(frozen=True, slots=True)
class Pace:
    """How a gait goes.

    Attributes
    ----------
    action : its name.
    heights_s : its clip's own speed, in heights of the character.
    direction_rad : where it goes, seen from where it faces; to the left is positive.
    """

    action: str
    heights_s: float
    direction_rad: float


def paces(library: ActionLibrary) -> tuple[Pace, ...]:
    """Return the gaits of a library; of those that are preferred where it has any."""
    found = []
    for action in library.actions:
        if not (action.travels and action.cyclic):
            continue
        clip = library.clip(action.name)
        left, ahead = ground_root(clip).position_m[-1]
        speed = float(np.hypot(left, ahead)) / clip.duration_s / library.character.height_m
        if speed > 0.0 and feet_of(clip):
            found.append(Pace(action.name, speed, float(np.arctan2(left, ahead))))
    return tuple(one for one in found if one.action in PREFERRED) or tuple(found)


def going_along(
    phrases: Sequence[Phrase],
    motions: Sequence[RigidMotion],
    library: ActionLibrary,
    *,
    figure_height_m: float,
) -> tuple[Phrase, ...]:
    """Return a performer's phrases with implied ones where its prop travels and none is.

    Parameters
    ----------
    phrases
        In time order.
    motions
        Of the performer's doodles, in time order.
    library
        Has the gaits; their clips are read. Without any, nothing is implied.
    figure_height_m
        Height of the figurine that the prop stands for.
    """
    known = paces(library)
    if not known:
        return tuple(phrases)
    implied = [
        phrase for motion in motions for phrase in _along(phrases, motion, known, figure_height_m)
    ]
    return tuple(sorted([*phrases, *implied], key=lambda phrase: phrase.start_s))


def _along(
    phrases: Sequence[Phrase], motion: RigidMotion, known: Sequence[Pace], figure_height_m: float
) -> Iterator[Phrase]:
    """Yield the implied phrases of one doodle."""
    time_s = motion.time_s
    over_ground = motion.velocity_m_s[:, [0, 2]] / figure_height_m
    step_s = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 1.0
    speed = gaussian_smoothed(np.linalg.norm(over_ground, axis=1), SMOOTHING_S / step_s)
    free = np.ones(len(time_s), dtype=bool)
    for phrase in phrases:
        free &= (time_s < phrase.start_s) | (time_s > phrase.end_s)
    seen = turned(over_ground, -heading_rad(motion.orientation_xyzw))
    for first, last in _travels(time_s, free, speed >= GOES_HEIGHTS_S):
        way = float(np.trapezoid(speed[first : last + 1], time_s[first : last + 1]))
        if time_s[last] - time_s[first] < SHORTEST_S or way < LEAST_HEIGHTS:
            continue
        for start_s, end_s, action in _gaits(
            time_s[first : last + 1], seen[first : last + 1], known
        ):
            yield Phrase(action, round(start_s, 3), round(end_s, 3), confidence=0.0, implied=True)


def _travels(time_s: FloatArray, free: BoolArray, goes: BoolArray) -> Iterator[tuple[int, int]]:
    """Yield the first and the last sample of each travel outside of phrases, short pauses in."""
    first = last = None
    for i in range(len(time_s)):
        over = last is not None and (not free[i] or time_s[i] - time_s[last] > PAUSE_S)
        if over and first is not None and last is not None:
            yield first, last
            first = last = None
        if free[i] and goes[i]:
            first, last = i if first is None else first, i
    if first is not None and last is not None:
        yield first, last


def _gaits(
    time_s: FloatArray, seen: FloatArray, known: Sequence[Pace]
) -> Iterator[tuple[float, float, str]]:
    """Yield the gaits that suit one travel, seen from the prop: to the left and ahead."""
    count = max(round((time_s[-1] - time_s[0]) / STEP_S), 1)
    edges_s = np.linspace(time_s[0], time_s[-1], count + 1)
    begun_s, going = float(edges_s[0]), ""
    for start_s, end_s in zip(edges_s[:-1].tolist(), edges_s[1:].tolist(), strict=True):
        inside = (time_s >= start_s) & (time_s <= end_s)
        action = _suiting(seen[inside], known).action
        if going and action != going:
            yield begun_s, start_s, going
            begun_s = start_s
        going = action
    yield begun_s, float(edges_s[-1]), going


def _suiting(seen: FloatArray, known: Sequence[Pace]) -> Pace:
    """Return the gait that suits some velocities, in heights a second, best."""
    pace = float(np.linalg.norm(seen, axis=1).mean())
    left, ahead = seen.mean(axis=0)

    def unlike(one: Pace) -> float:
        off = np.arctan2(left, ahead) - one.direction_rad
        off = abs(float(np.arctan2(np.sin(off), np.cos(off))))
        return float(np.log(max(pace, 1e-6) / one.heights_s)) ** 2 + TURN_OUTWEIGHS * off

    return min(known, key=unlike)
