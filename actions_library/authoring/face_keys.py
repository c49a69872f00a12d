"""Keys of the face: which shapes it shows, and when it blinks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.curves import smooth_curve
from actions_library.authoring.face_motion import SHAPE_NAMES
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray

BLINKS = ("eyeBlinkLeft", "eyeBlinkRight")

BLINK_S = (0.07, 0.04, 0.13)
"""How long lids close, stay closed, and open."""

Face = Mapping[str, float]
"""Weights of shapes, by name; those not named are 0."""


@dataclass(frozen=True, slots=True)
class FaceKey:
    """What the whole face shows at a time, in seconds."""

    at: float
    face: Face


def face(**weights: float) -> Face:
    """Return weights by shape; what a name without its side says is said of both sides."""
    found: dict[str, float] = {}
    for name, weight in weights.items():
        names = [own for own in (name, f"{name}Left", f"{name}Right") if own in SHAPE_NAMES]
        if not names:
            raise ValueError(f"{name}: expected a shape of the face")
        found |= dict.fromkeys(names, weight)
    return found


def blend(*parts: tuple[float, Face]) -> Face:
    """Return the sum of faces, each times its share, from 0 to 1."""
    names = dict.fromkeys(name for _, one in parts for name in one)
    sums = {name: sum(share * one.get(name, 0.0) for share, one in parts) for name in names}
    return {name: min(max(value, 0.0), 1.0) for name, value in sums.items()}


def face_tracks(
    keys: Sequence[FaceKey], blinks_s: Sequence[float], frames: int, rate_hz: float
) -> Tracks:
    """Return the tracks of a face that passes through keys, and blinks at some times."""
    used = {name for key in keys for name, weight in key.face.items() if weight > 0.0}
    names = [name for name in SHAPE_NAMES if name in used or (blinks_s and name in BLINKS)]
    values = [[key.face.get(name, 0.0) for name in names] for key in keys]
    curve = smooth_curve([key.at for key in keys], values, frames, rate_hz)
    closed = _closed(blinks_s, frames, rate_hz)
    for name in BLINKS:
        if name in names:
            own = curve[:, names.index(name)]
            curve[:, names.index(name)] = 1.0 - (1.0 - own) * (1.0 - closed)
    return Tracks(tuple(names), np.clip(curve, 0.0, 1.0))


def _closed(blinks_s: Sequence[float], frames: int, rate_hz: float) -> FloatArray:
    """Return how far lids are closed by blinks."""
    time_s = np.arange(frames) / rate_hz
    closed = np.zeros(frames)
    for start_s in blinks_s:
        ends = start_s + np.cumsum((0.0, *BLINK_S))
        closed = np.maximum(closed, np.interp(time_s, ends, (0.0, 1.0, 1.0, 0.0)))
    return np.asarray(closed * closed * (3.0 - 2.0 * closed))
