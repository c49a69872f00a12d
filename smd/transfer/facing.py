"""Facing: which way a performer faces, by its prop or by its path."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Repertoire
from smd.transfer.timeline import Span

STILL_M_S = 0.25
"""Speed in the scene below which a path has no direction: a hand's 2.5 cm/s, about its tremor."""

TANGENT_SIGMA_S = 0.15
"""Smoothing of the direction: a body turns less briskly than a hand changes its way. At a cusp,
half a turn takes 0.4 s and goes at most at 8.4 rad/s."""

TURNING_S = 0.6
"""Time in which a standing performer turns to the path's next direction, before moving on."""


def by_prop(path: GroundPath, spans: Sequence[Span], pieces: Repertoire) -> GroundPath:
    """Face along the prop's front: moved backwards, it makes its character walk backwards."""
    return path


def by_path(path: GroundPath, spans: Sequence[Span], pieces: Repertoire) -> GroundPath:
    """Face along the path while a phrase travels, so that its clip travels in its own direction.

    A walk faces ahead, a walk backwards the other way, a side step across. Where the path does not
    move, and while nothing travels, the heading is held; before the path continues, it turns.
    """
    tangent, moves = tangents(path)
    goes, own_rad = np.zeros(len(moves), dtype=bool), np.zeros(len(moves))
    for span in spans:
        if span.phrase is None:
            continue
        piece = pieces.of(span.phrase)
        if piece.travels:
            inside = (path.time_s >= span.start_s) & (path.time_s <= span.end_s)
            goes |= inside & moves
            own_rad[inside] = piece.direction_rad
    heading = held(path.time_s, tangent - own_rad, goes, first_rad=float(path.heading_rad[0]))
    return replace(path, heading_rad=heading)


HEADINGS: Mapping[str, Callable[[GroundPath, Sequence[Span], Repertoire], GroundPath]] = {
    "prop": by_prop,
    "path": by_path,
}
"""How a heading is found, by its name."""


def tangents(path: GroundPath) -> tuple[FloatArray, BoolArray]:
    """Return a path's direction ``(n,)``, about +Y from +Z, and where it is fast enough for one."""
    if len(path.time_s) < 2:
        return path.heading_rad, np.zeros(len(path.time_s), dtype=bool)
    velocity = np.gradient(path.position_m, path.time_s, axis=0)
    speed = np.linalg.norm(velocity, axis=-1)
    return np.arctan2(velocity[:, 0], velocity[:, 1]), speed > STILL_M_S


def held(
    time_s: FloatArray, heading_rad: FloatArray, known: BoolArray, *, first_rad: float
) -> FloatArray:
    """Return a heading without jumps that holds where it is not known, and turns at the end of it.

    Parameters
    ----------
    heading_rad
        ``(n,)``; whole turns do not matter.
    known
        ``(n,)`` where it counts.
    first_rad
        What is held until then.
    """
    at = np.flatnonzero(known)
    if len(at) == 0:
        return np.full(len(time_s), first_rad)
    whole = np.unwrap(np.concatenate([[first_rad], heading_rad[at]]))
    before = np.searchsorted(at, np.arange(len(time_s)), side="right")
    left = whole[before]
    right = whole[np.minimum(before + 1, len(at))]
    since_s = np.concatenate([[time_s[0]], time_s[at]])[before]
    until_s = time_s[at[np.minimum(before, len(at) - 1)]]
    over_s = np.maximum(np.minimum(until_s - since_s, TURNING_S), 1e-9)
    share = np.where(before < len(at), smootherstep(1.0 - (until_s - time_s) / over_s), 0.0)
    heading = np.where(known, left, left + share * (right - left))
    rate_hz = (len(time_s) - 1) / max(time_s[-1] - time_s[0], 1e-9)
    return gaussian_smoothed(heading, TANGENT_SIGMA_S * rate_hz)
