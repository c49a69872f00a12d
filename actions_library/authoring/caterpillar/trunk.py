"""The caterpillar's trunk by keys: how it is bent at five places, how long it is, where it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from actions_library.authoring.caterpillar.skeleton import (
    HEIGHT_M,
    LENGTH_M,
    SEGMENTS,
    TAIL_M,
    segment_ahead_m,
)
from actions_library.authoring.feet import Via
from actions_library.authoring.keys import Place
from actions_library.authoring.posing import RATE_HZ, RootCourse
from actions_library.authoring.rig import Rig
from actions_library.authoring.rig_keys import RigKey, key, rig_curve
from actions_library.authoring.rigging import place_of
from smd.geometry.arrays import FloatArray

BENT_AT = {"tail": 0.0, "loin": 0.30, "middle": 0.56, "breast": 0.78, "neck": 1.0}
"""Places that a `Turn` bends, in the clip's world, as shares of the length; between them evenly."""

HELD = SEGMENTS // 2
"""Segment whose joint the `place` of keys moves."""


VIAS = (0.12, 0.3, 0.5, 0.7, 0.88)
"""Shares of the time in the air at which a foot's way is given."""

RETRACTED_M = 0.012
"""How much shorter legs are in the air: prolegs are drawn in."""


def bent_spine_m(keys: Sequence[RigKey], ground: RootCourse, *, cyclic: bool = False) -> FloatArray:
    """Return where the segments begin, and where the last one ends, ``(n, 13, 3)``.

    Parameters
    ----------
    keys
        Of the places in `BENT_AT`, of ``place``, and of ``length``, 1 at rest.
    ground
        What carries it.
    """
    from scipy.interpolate import PchipInterpolator

    frames = len(ground.yaw_rad)

    def curve(part: str, at_rest: Sequence[float]) -> FloatArray:
        found = rig_curve(keys, part, frames, RATE_HZ, cyclic=cyclic)
        return np.tile(at_rest, (frames, 1)) if found is None else found

    along = (np.arange(SEGMENTS) + 0.5) / SEGMENTS
    bent = np.stack([curve(name, (0.0, 0.0, 0.0)) for name in BENT_AT])
    turns = np.radians(PchipInterpolator(list(BENT_AT.values()), bent)(along))
    yaw, lean = turns[..., 0].T, turns[..., 1].T
    to = np.stack([np.sin(yaw) * np.cos(lean), -np.sin(lean), np.cos(yaw) * np.cos(lean)], axis=-1)
    step = LENGTH_M / SEGMENTS * curve("length", (1.0,))[:, None] * to
    place = np.concatenate([np.zeros((frames, 1, 3)), np.cumsum(step, axis=1)], axis=1)
    at_rest_m = np.array([0.0, HEIGHT_M, TAIL_M + LENGTH_M * HELD / SEGMENTS])
    held = at_rest_m + curve("place", (0.0, 0.0, 0.0))
    held += np.column_stack([ground.left_m, np.zeros(frames), ground.ahead_m])
    return np.asarray(place + (held - place[:, HELD])[:, None])


def followed(spine_m: FloatArray) -> list[RigKey]:
    """Return keys of the rig's body that follow the middle of its spine."""
    middle_m = spine_m[:, HELD] - [0.0, HEIGHT_M, TAIL_M + LENGTH_M * HELD / SEGMENTS]
    last = len(spine_m) - 1
    return [
        key(frame / RATE_HZ, place=Place(*middle_m[frame].tolist()))
        for frame in (0, *range(6, last - 5, 3), last)  # curves rest at their ends
    ]


def carried_swing(
    rig: Rig, leg: str, k: int, segment_m: FloatArray, stood_m: float, way_m: float
) -> tuple[Via, ...]:
    """Return a foot's way through the air, below its segment and drawn in toward it.

    Parameters
    ----------
    segment_m
        ``(len(VIAS), 2, 3)`` where its segment begins and ends at those times.
    stood_m, way_m
        Where the foot stood, ahead, and how far ahead of that it will.
    """
    _, ankle, ahead = place_of(rig.skeleton, rig.leg(leg).foot)
    drop_m, ahead_m = ankle - HEIGHT_M, ahead - segment_ahead_m(k)
    swing = []
    for at, (begin, end) in zip(VIAS, segment_m, strict=True):
        pitch = np.arctan2(begin[1] - end[1], end[2] - begin[2])
        sine, cosine = np.sin(pitch), np.cos(pitch)
        drop = drop_m + RETRACTED_M * np.sin(np.pi * at)
        up = begin[1] + cosine * drop - sine * ahead_m - ankle
        along = (begin[2] + cosine * ahead_m + sine * drop - stood_m) / way_m
        swing.append(Via(at, float(up), along=float(along), pitch=float(np.degrees(pitch))))
    return tuple(swing)
