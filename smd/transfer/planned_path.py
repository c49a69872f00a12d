"""The path of a plan: where a performer is, and which way it faces, at the times it is there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from smd.acting.move import KNOT_RATE_HZ
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed
from smd.transfer.course import goes_on
from smd.transfer.facing import held, tangents
from smd.transfer.gait import planned_m_s
from smd.transfer.limits import Limits
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Piece, Repertoire
from smd.transfer.speeding import speeding
from smd.transfer.timeline import Span

STILL = 0.6
"""Share of the time of getting into a gait's pose in which it does not move along its path."""

LEAST_SHARE = 0.1
"""Share of an even part of a way's time that each of its gaits lasts at least."""

TURNED_S = (0.0, 0.1, 0.2, 0.3, 0.5, 0.8)
"""Smoothing tried of a heading, as the standard deviation of a Gaussian."""


@dataclass(slots=True)
class _Going:
    """A path while it is planned; all arrays are (n, …) by ``time_s``, and change in place.

    ``shown_s`` is the time of the recording that is shown.
    """

    time_s: FloatArray
    shown_s: FloatArray
    place_m: FloatArray
    heading_rad: FloatArray

    def rows(self, start_s: float, end_s: float) -> BoolArray:
        return np.asarray((self.time_s >= start_s) & (self.time_s <= end_s))


def planned_path(
    path: GroundPath,
    spans: Sequence[Span],
    pieces: Repertoire,
    drawn_s: FloatArray,
    played_s: FloatArray,
    limits: Limits,
) -> tuple[GroundPath, tuple[Span, ...], FloatArray, FloatArray]:
    """Return the path as it is gone, and when.

    Parameters
    ----------
    path
        As drawn.
    spans
        The performer's time, as shared out among phrases.
    drawn_s, played_s
        ``(k,)`` when each moment of the recording is played, by the spans.

    Returns
    -------
    path
        At the times at which it is gone.
    spans
        Between two gaits of one way, one ends and the next begins where they did.
    drawn_s, played_s
        ``(n,)`` as given, with the speed of each way.
    """
    starts_s = [span.start_s for span in spans]
    time_s = np.union1d(np.arange(played_s[0], played_s[-1], 1.0 / KNOT_RATE_HZ), starts_s)
    time_s = np.append(time_s[time_s < played_s[-1]], played_s[-1])
    shown_s = np.interp(time_s, played_s, drawn_s)
    going = _Going(time_s, shown_s, path.at(shown_s), path.heading_at(shown_s))
    spans = list(spans)
    ways = _ways(spans, pieces)
    for first, last in ways:
        spans[first : last + 1] = _stepped(going, spans[first : last + 1], pieces, limits)
    for span in spans:
        if span.planned is not None:
            _leapt(going, span, pieces, limits)
    going.heading_rad[:] = path.heading_at(going.shown_s)
    for first, last in ways:
        _face(going, spans[first : last + 1], pieces, limits)
    once = np.concatenate([[True], np.diff(going.shown_s) > 1e-9])
    gone = GroundPath(going.time_s, going.place_m, going.heading_rad)
    return gone, tuple(spans), going.shown_s[once], going.time_s[once]


def _ways(spans: Sequence[Span], pieces: Repertoire) -> list[tuple[int, int]]:
    """Return the first and last of the spans of each way from rest to rest."""
    found: list[tuple[int, int]] = []
    cast = [None if span.phrase is None else pieces.like(span.phrase) for span in spans]
    for i, piece in enumerate(cast):
        if piece is None or piece.gait is None:
            continue
        if i > 0 and found and found[-1][1] == i - 1 and goes_on(cast[i - 1], piece):
            found[-1] = (found[-1][0], i)
        else:
            found.append((i, i))
    return found


def _piece(span: Span, pieces: Repertoire) -> Piece:
    assert span.phrase is not None
    return pieces.like(span.phrase)


def _stepped(
    going: _Going, spans: Sequence[Span], pieces: Repertoire, limits: Limits
) -> list[Span]:
    """Give a way the speed of its gaits, in place, and return its spans with the times of that."""
    rows = going.rows(spans[0].start_s, spans[-1].end_s)
    own_s = going.time_s[rows]
    if len(own_s) < 5:
        return list(spans)
    goes_s = _within(own_s, STILL * spans[0].standing_s, STILL * spans[-1].standing_s)
    fastest = np.full(len(own_s), np.inf)
    for span in spans:
        gait = _piece(span, pieces).gait
        assert gait is not None
        fastest[own_s >= span.start_s] = planned_m_s(gait, limits.speed_m_s)
    at_s, place_m = speeding(goes_s, going.place_m[rows], fastest, limits)
    going.place_m[rows] = np.stack([np.interp(own_s, goes_s, axis) for axis in place_m.T], axis=-1)
    at_s = np.interp(np.interp(own_s, goes_s, at_s), goes_s, own_s)
    going.shown_s[rows] = np.interp(at_s, own_s, going.shown_s[rows])
    once = np.concatenate([[True], np.diff(at_s) > 1e-9])

    def moved_s(time_s: float) -> float:
        """Return when the place is reached that was reached at a time."""
        return float(np.interp(time_s, at_s[once], own_s[once]))

    cuts_s = [moved_s(span.start_s) for span in spans[1:]]
    # A moment each, even where a way gets nowhere: they stay in their order.
    least_s = 0.5 * (own_s[-1] - own_s[0]) * LEAST_SHARE / len(spans)
    edges_s = _apart([spans[0].start_s, *cuts_s, spans[-1].end_s], least_s)
    moved = []
    for span, (start_s, end_s) in zip(spans, pairwise(edges_s), strict=True):
        assert span.phrase is not None
        begins_s = float(np.clip(moved_s(span.phrase.start_s), start_s, end_s - 0.5 * least_s))
        if span is spans[0]:
            begins_s = min(span.phrase.start_s, end_s - 0.5 * least_s)
        phrase = replace(span.phrase, start_s=begins_s, end_s=end_s)
        moved.append(replace(span, start_s=start_s, end_s=end_s, phrase=phrase))
    return moved


def _apart(time_s: Sequence[float], least_s: float) -> list[float]:
    """Return times at least so far apart, between the first and the last, as near as may be."""
    steps = np.arange(len(time_s)) * least_s
    after = np.maximum.accumulate(np.array(time_s) - steps) + steps
    return [float(one) for one in np.minimum(after, time_s[-1] - steps[::-1])]


def _leapt(going: _Going, span: Span, pieces: Repertoire, limits: Limits) -> None:
    """Give what leaps or rolls a way that a body can go, in place: nothing turns in the air."""
    piece = _piece(span, pieces)
    rows = going.rows(span.start_s, span.end_s)
    own_s = going.time_s[rows]
    if not piece.travels or len(own_s) < 5:
        return
    place_m = going.place_m[rows]
    if piece.airborne is not None:
        ends_s = own_s[[0, -1]]
        straight = [np.interp(own_s, ends_s, axis[[0, -1]]) for axis in place_m.T]
        going.place_m[rows] = np.stack(straight, axis=-1)
        return
    fastest = np.full(len(own_s), limits.speed_m_s)
    at_s, going.place_m[rows] = speeding(own_s, place_m, fastest, limits)
    going.shown_s[rows] = np.interp(at_s, own_s, going.shown_s[rows])


def _face(going: _Going, spans: Sequence[Span], pieces: Repertoire, limits: Limits) -> None:
    """Turn no faster than a body does on a way, in place, and along it where that is planned."""
    for span in spans:
        rows = going.rows(span.start_s, span.end_s)
        if not span.along or np.count_nonzero(rows) < 3:
            continue
        part = GroundPath(going.time_s[rows], going.place_m[rows], going.heading_rad[rows])
        tangent, known = tangents(part)
        ahead = tangent - _piece(span, pieces).direction_rad
        first_rad = ahead[known][0] if known.any() else part.heading_rad[0]
        going.heading_rad[rows] = held(part.time_s, ahead, known, first_rad=float(first_rad))
    rows = going.rows(spans[0].start_s, spans[-1].end_s)
    if np.count_nonzero(rows) > 2:
        heading_rad = np.unwrap(going.heading_rad[rows])
        going.heading_rad[rows] = _steadied(going.time_s[rows], heading_rad, limits)


def _steadied(time_s: FloatArray, heading_rad: FloatArray, limits: Limits) -> FloatArray:
    """Return a heading that turns no faster than a body does, smoothed as little as is enough."""
    rate_hz = (len(time_s) - 1) / (time_s[-1] - time_s[0])
    for sigma_s in TURNED_S:
        smoothed = gaussian_smoothed(heading_rad, sigma_s * rate_hz)
        speed = np.gradient(smoothed) * rate_hz
        change = np.abs(np.gradient(speed)).max() * rate_hz
        if np.abs(speed).max() <= limits.turning_rad_s and change <= limits.turning_rad_s2:
            break
    return smoothed


def _within(time_s: FloatArray, after_s: float, before_s: float) -> FloatArray:
    """Return times that begin and end later and earlier, by no more than a third of the whole."""
    most_s = (time_s[-1] - time_s[0]) / 3.0
    ends = time_s[0] + min(after_s, most_s), time_s[-1] - min(before_s, most_s)
    return np.interp(time_s, time_s[[0, -1]], ends)
