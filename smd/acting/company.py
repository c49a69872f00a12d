"""Company: several performers in one scene, kept from walking through each other.

Props pass each other in the hand's width that keeps two hands apart; in a scene that is ten times
the table their characters would go through each other as soon as those widths are misjudged. So
where two come nearer than their bodies allow, their ways bend aside, smoothly, and only there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from smd.acting.move import KNOT_RATE_HZ, Move, Playable, PlayedT
from smd.acting.moving import rows_of
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed
from smd.geometry.runs import runs_of_true

WIDTH_PER_HEIGHT = 0.3
"""Width of a body over its height: shoulders are 0.26 [1]_, and there are arms.

References
----------
.. [1] R. Drillis, R. Contini, "Body Segment Parameters", New York University 1966.
"""

SOFT = 0.25
"""Share of the least distance, to both sides of it, over which paths begin to bend."""

AHEAD_S = 1.6
"""Time before and after a meeting in which two performers move aside."""

THROUGH = 0.5
"""Share of the least distance: nearer, a performer passes on one side; else it goes around."""

SWEEPS = 12
"""Passes over all pairs; two performers need one, a crowd may need them all."""

_STANDING_M_S = 0.05
"""Added to a performer's speed: one that stands makes way only a little."""


def least_distance_m(height_m: float, other_height_m: float) -> float:
    """Return how near two characters' ground roots may come."""
    return 0.5 * WIDTH_PER_HEIGHT * (height_m + other_height_m)


def kept_apart(position_m: FloatArray, height_m: FloatArray, time_s: FloatArray) -> FloatArray:
    """Return how far each performer moves aside ``(p, n, 2)``.

    Parameters
    ----------
    position_m
        ``(p, n, 2)`` where their ground roots are at each time.
    height_m
        ``(p,)`` of their characters.
    time_s
        ``(n,)`` at an even rate.
    """
    now = position_m.copy()
    for _ in range(SWEEPS if len(now) > 2 else 1):
        step = np.zeros_like(now)
        for a, b in combinations(range(len(now)), 2):
            least_m = least_distance_m(height_m[a], height_m[b])
            apart = now[b] - now[a]
            push = parted(apart, least_m, time_s) - apart
            share = _shares(position_m[[a, b]], push, time_s)
            step[a] -= share[0][:, None] * push
            step[b] += share[1][:, None] * push
        now += step
        if not step.any():
            break
    return now - position_m


def parted(apart_m: FloatArray, least_m: float, time_s: FloatArray) -> FloatArray:
    """Return the vector between two performers ``(n, 2)``, never shorter than allowed.

    Farther than ``(1 + SOFT) least_m`` and ``AHEAD_S`` away from any meeting it is as given.
    """
    return _rounded(_past(apart_m, least_m, time_s), least_m)


def _past(apart_m: FloatArray, least_m: float, time_s: FloatArray) -> FloatArray:
    """Move a performer that would go through the other to the side where it is when nearest."""
    done = apart_m.copy()
    far = np.linalg.norm(apart_m, axis=-1)
    ahead = max(round(AHEAD_S * (len(time_s) - 1) / max(time_s[-1] - time_s[0], 1e-9)), 1)
    for start, end in runs_of_true(far < least_m):
        nearest = start + int(np.argmin(far[start:end]))
        if far[nearest] >= THROUGH * least_m:
            continue
        aside = _side(apart_m, nearest)
        along = apart_m[start:end] @ aside
        across = np.linalg.norm(apart_m[start:end] - along[:, None] * aside, axis=-1)
        needed = np.zeros(len(apart_m))
        needed[start:end] = np.sqrt(np.maximum(least_m**2 - across**2, 0.0)) - along
        done += _eased(np.maximum(needed, 0.0), ahead)[:, None] * aside
    return done


def _side(apart_m: FloatArray, nearest: int) -> FloatArray:
    """Return the direction ``(2,)`` from one to the other when they are nearest.

    Where they meet exactly, it is perpendicular to their path; where they do not move either, +X.
    """
    here = apart_m[nearest]
    if np.linalg.norm(here) > 1e-6:
        return here / np.linalg.norm(here)
    before, after = max(nearest - 1, 0), min(nearest + 1, len(apart_m) - 1)
    dx, dz = apart_m[after] - apart_m[before]
    across = np.array([dz, -dx])
    length = np.linalg.norm(across)
    return across / length if length > 1e-9 else np.array([1.0, 0.0])


def _eased(needed_m: FloatArray, ahead: int) -> FloatArray:
    """Return a smooth curve that is nowhere below another, and zero beyond ``ahead`` frames."""
    half = max(ahead // 2, 1)
    padded = np.pad(needed_m, half, mode="edge")
    highest = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1).max(axis=-1)
    return gaussian_smoothed(highest, half / 3.0)


def _rounded(apart_m: FloatArray, least_m: float) -> FloatArray:
    """Keep the distance of two performers above the least one.

    From ``(1 - SOFT) least_m`` to ``(1 + SOFT) least_m`` the distance becomes the parabola that
    leads without a kink from ``least_m``, its value below, to the distance itself beyond.
    """
    far = np.linalg.norm(apart_m, axis=-1)
    soft_m = SOFT * least_m
    over = np.maximum(far - (least_m - soft_m), 0.0)
    wanted = np.where(far < least_m + soft_m, least_m + over**2 / (4.0 * soft_m), far)
    direction = apart_m / np.maximum(far, 1e-12)[:, None]
    direction[far <= 1e-12] = [1.0, 0.0]
    return np.where((wanted == far)[:, None], apart_m, wanted[:, None] * direction)


def _shares(position_m: FloatArray, push_m: FloatArray, time_s: FloatArray) -> FloatArray:
    """Return the share ``(2, n)`` by which each of two performers makes way, by their speeds.

    It is constant from the first moment of making way to the last, so that a performer that stands
    is not moved when the other comes to rest.
    """
    share = np.full((2, len(time_s)), 0.5)
    for start, end in runs_of_true(np.any(push_m != 0.0, axis=-1)):
        way = np.linalg.norm(np.diff(position_m[:, start:end], axis=1), axis=-1).sum(axis=-1)
        speed = way / max(time_s[end - 1] - time_s[start], 1e-9) + _STANDING_M_S
        share[:, start:end] = (speed / speed.sum())[:, None]
    return share


def roots(moves: Sequence[Move[Playable]], time_s: FloatArray) -> FloatArray:
    """Return the position of a performer's ground root ``(n, 2)`` at some times."""
    rows = zip(moves, rows_of(moves, time_s), strict=True)
    return np.concatenate([move.root_at(time_s[part]) for move, part in rows])


def apart(
    all_moves: Sequence[Sequence[Move[PlayedT]]], heights_m: Sequence[float]
) -> list[tuple[Move[PlayedT], ...]]:
    """Return the moves of all performers, bent aside where two of them come too near."""
    if len(all_moves) < 2:
        return [tuple(moves) for moves in all_moves]
    time_s = meeting_times(all_moves)
    places = np.stack([roots(moves, time_s) for moves in all_moves])
    offsets = kept_apart(places, np.asarray(heights_m), time_s)
    return [_displaced(moves, time_s, by) for moves, by in zip(all_moves, offsets, strict=True)]


def meeting_times(all_moves: Sequence[Sequence[Move[Playable]]]) -> FloatArray:
    """Return the times at which the positions of all performers are compared."""
    start_s = min(moves[0].start_s for moves in all_moves)
    end_s = max(moves[-1].end_s for moves in all_moves)
    return np.linspace(start_s, end_s, max(round((end_s - start_s) * KNOT_RATE_HZ), 1) + 1)


def _displaced(
    moves: Sequence[Move[PlayedT]], time_s: FloatArray, offset_m: FloatArray
) -> tuple[Move[PlayedT], ...]:
    if not offset_m.any():
        return tuple(moves)

    def at(times_s: FloatArray) -> FloatArray:
        return np.stack([np.interp(times_s, time_s, axis) for axis in offset_m.T], axis=-1)

    return tuple(replace(move, root_m=move.root_m + at(move.time_s)) for move in moves)


def encounters(
    devices: Sequence[str],
    before: Sequence[Sequence[Move[Playable]]],
    after: Sequence[Sequence[Move[Playable]]],
    heights_m: Sequence[float],
) -> Iterator[str]:
    """Yield a line for each pair that came too near: when, and how far each made way."""
    if len(devices) < 2:
        return
    time_s = meeting_times(before)
    was = [roots(moves, time_s) for moves in before]
    now = [roots(moves, time_s) for moves in after]
    for a, b in combinations(range(len(devices)), 2):
        least_m = least_distance_m(heights_m[a], heights_m[b])
        near = np.linalg.norm(was[b] - was[a], axis=-1)
        times = runs_of_true(near < least_m)
        if len(times) == 0:
            continue
        worst = int(np.argmin(near))
        rows = np.zeros(len(time_s), dtype=bool)
        for start, end in times:
            rows[start:end] = True
        aside = [np.linalg.norm(now[i] - was[i], axis=-1)[rows].max() for i in (a, b)]
        yield (
            f"devices {devices[a]!r} and {devices[b]!r}: at {time_s[worst]:.2f} s: expected "
            f"{least_m:.2f} m between them, found {near[worst]:.2f} m; they give way by up to "
            f"{aside[0]:.2f} and {aside[1]:.2f} m"
            + (f" (the nearest of {len(times)} times)" if len(times) > 1 else "")
        )
