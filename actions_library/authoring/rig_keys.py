"""Key poses of any rig: what an animator sets, by the names of the rig's parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from actions_library.authoring.curves import smooth_curve
from actions_library.authoring.keys import LegKey, Place, Turn
from actions_library.authoring.rigging import other_side
from smd.geometry.arrays import FloatArray

Part = Place | Turn | LegKey | float
"""Where the body is, how it or a chain is turned, a leg in the air, the value of a track."""


@dataclass(frozen=True, slots=True)
class RigKey:
    """Some parts' poses at a time: seconds, or a fraction of the cycle in a cyclic clip."""

    at: float
    parts: Mapping[str, Part]


def key(at: float, **parts: Part) -> RigKey:
    """Return a key: ``key(0.5, place=Place(up=-0.02), tail=Turn(yaw=20.0), smile=0.4)``."""
    return RigKey(at, parts)


def mirrored_key(one: RigKey) -> RigKey:
    """Return the key with left and right exchanged."""
    return RigKey(one.at, {other_side(name): _image(part) for name, part in one.parts.items()})


def on_both_sides(one: RigKey) -> RigKey:
    """Return the key with the image of each part that is named ``left_…`` or ``right_…`` too."""
    sided = RigKey(one.at, {n: part for n, part in one.parts.items() if other_side(n) != n})
    return RigKey(one.at, {**mirrored_key(sided).parts, **one.parts})


def whole_cycle(half: Iterable[RigKey]) -> tuple[RigKey, ...]:
    """Return a whole cycle from the keys of its first half, the second being its mirror image."""
    half = tuple(half)
    return half + tuple(replace(mirrored_key(one), at=one.at + 0.5) for one in half)


def parts_named(keys: Iterable[RigKey]) -> list[str]:
    """Return the names of all parts that keys pose, each once, in their first order."""
    return list(dict.fromkeys(name for one in keys for name in one.parts))


def rig_curve(
    keys: Iterable[RigKey],
    part: str,
    frames: int,
    rate_hz: float,
    *,
    cyclic: bool,
    lag_s: float = 0.0,
) -> FloatArray | None:
    """Sample one part's numbers, in its fields' order, ``(frames, c)``; None if it has no key."""
    posed = sorted((one for one in keys if part in one.parts), key=lambda one: one.at)
    if not posed:
        return None
    kinds = {type(one.parts[part]) for one in posed}
    if len({float if kind is int else kind for kind in kinds}) > 1:
        raise ValueError(f"{part}: expected keys of one kind, got {sorted(map(str, kinds))}")
    scale = (frames - 1) / rate_hz if cyclic else 1.0
    return smooth_curve(
        [one.at * scale for one in posed],
        [_numbers(one.parts[part]) for one in posed],
        frames,
        rate_hz,
        lag_s=lag_s,
        cyclic=cyclic,
    )


def rekeyed(time: float, one: RigKey) -> RigKey:
    """Return a key at another time."""
    return replace(one, at=time)


def track_curves(
    keys: Iterable[RigKey], tracks: Iterable[str], frames: int, rate_hz: float, *, cyclic: bool
) -> FloatArray:
    """Sample tracks ``(frames, k)``, a column a name; 0 for one that has no key."""
    keys = tuple(keys)
    columns = [rig_curve(keys, name, frames, rate_hz, cyclic=cyclic) for name in tracks]
    still = np.zeros((frames, 1))
    return np.hstack([np.zeros((frames, 0)), *(still if c is None else c for c in columns)])


def _numbers(part: Part) -> FloatArray:
    if isinstance(part, Place | Turn | LegKey):
        return np.hstack([getattr(part, field.name) for field in fields(part)])
    return np.array([float(part)])


def _image(part: Part) -> Part:
    """Return a part's pose on the other side; legs are written alike for both sides."""
    if isinstance(part, Turn):
        return Turn(-part.yaw, part.lean, -part.tilt)
    if isinstance(part, Place):
        return replace(part, left=-part.left)
    return part
