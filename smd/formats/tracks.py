"""What a format reads: poses as they stand in the file, before frames, checks and dropouts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from smd.formats.frame import SourceFrame
from smd.geometry.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """The rows of one device.

    Attributes
    ----------
    device : its name.
    time_s : (n,).
    position : (n, 3) in the file's axes and unit; NaN where the file has no number.
    quaternion : (n, 4) in the file's axes and order; NaN where the file has no number.
    place : where row i stands in the file, for messages ("line 12").
    drawing : (n,) 1 while the user meant to draw, else 0; NaN where a row does not say, and None
        where the file never does.
    """

    device: str
    time_s: FloatArray
    position: FloatArray
    quaternion: FloatArray
    place: Callable[[int], str]
    drawing: FloatArray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Content:
    """All that a format found in a file.

    Attributes
    ----------
    tracks : at least one.
    frame : the format's axes, unit and order, complete, for whatever the user leaves open.
    order_is_given : true where the file itself says which component of a rotation is which.
    clock_means_something : false where time is counted from 1970 or from a program's start; it
        is then counted from the first pose, and what the clock read there is kept in the
        metadata as ``clock_zero_s``.
    metadata : what else it says.
    """

    tracks: tuple[Track, ...]
    frame: SourceFrame = field(default_factory=SourceFrame.ours)
    order_is_given: bool = False
    clock_means_something: bool = True
    metadata: Mapping[str, str] = field(default_factory=dict)


def shown(found: object) -> str:
    """Return a value as a message shows it: on one line, not too long."""
    text = repr(found)
    return text if len(text) <= 40 else text[:36] + "…" + text[-1]
