"""Doodle and Recording: what a tracked prop drew, on one clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Literal

import numpy as np

from laban.frozen import Frozen
from smd.errors import DoodleError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray, frozen_array
from smd.geometry.rotations import sign_continuous

DEFAULT_FIGURE_HEIGHT_M = 0.175
"""Height of the figurine that a prop stands for; 1 : 10 of a person of 1.75 m."""

HEADSETS = frozenset({"camera", "head", "headset", "hmd"})
"""Names of devices that are worn, not played with."""


@dataclass(frozen=True, slots=True, eq=False)
class Doodle(Frozen):
    """The 6DOF trajectory of one device, in the world frame (right-handed, Y up).

    Attributes
    ----------
    time_s : (n,) float64, strictly increasing, on the recording's clock; n is at least 1.
    position_m : (n, 3) float64.
    orientation_xyzw : (n, 4) float64, unit length, no sign flips between neighbours; turns the
        prop's frame (+Z front, +X left, +Y up) into the world's.
    device : name of the device that drew it.
    drawing : (n,) bool, true while the user meant to draw (trigger held); None where nothing says
        so, which is not the same as drawn throughout.
    """

    time_s: FloatArray
    position_m: FloatArray
    orientation_xyzw: FloatArray
    device: str = "prop"
    drawing: BoolArray | None = None

    def __post_init__(self) -> None:
        time_s = frozen_array("time_s", self.time_s, (None,), DoodleError)
        n = len(time_s)
        if n == 0:
            raise DoodleError("time_s: expected at least one sample, got none")
        steps = np.diff(time_s)
        if n > 1 and steps.min() <= 0:
            i = int(np.argmin(steps > 0))
            raise DoodleError(
                f"time_s: expected increasing times, got {time_s[i]:g} then {time_s[i + 1]:g}"
            )
        position = frozen_array("position_m", self.position_m, (n, 3), DoodleError)
        q = frozen_array("orientation_xyzw", self.orientation_xyzw, (n, 4), DoodleError)
        length = np.linalg.norm(q, axis=-1, keepdims=True)
        if np.abs(length - 1.0).max() > 1e-3:
            worst = float(length[np.argmax(np.abs(length - 1.0)), 0])
            raise DoodleError(f"orientation_xyzw: expected unit length, got {worst:g}")
        orientation = frozen_array(
            "orientation_xyzw", sign_continuous(q / length), (n, 4), DoodleError
        )
        object.__setattr__(self, "time_s", time_s)
        object.__setattr__(self, "position_m", position)
        object.__setattr__(self, "orientation_xyzw", orientation)
        if self.drawing is not None:
            drawing = frozen_array("drawing", self.drawing, (n,), DoodleError, np.bool_)
            object.__setattr__(self, "drawing", drawing)

    def __len__(self) -> int:
        return len(self.time_s)

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample."""
        return float(self.time_s[-1] - self.time_s[0])

    def drawing_at(self, time_s: FloatArray) -> BoolArray | None:
        """Return whether the user meant to draw at some times ``(m,)``; None where nothing says so.

        What a sample says holds until the next one, and that of the first one before it.
        """
        if self.drawing is None:
            return None
        # + 1e-9: times that were counted from a rate may fall a little short of the sample's.
        before = np.searchsorted(self.time_s, time_s + 1e-9, side="right") - 1
        return self.drawing[np.maximum(before, 0)]

    def selected(self, rows: IntArray | BoolArray | slice) -> Doodle:
        """Return the doodle of some samples: their indices in order, a mask ``(n,)`` or a slice."""
        return replace(
            self,
            time_s=self.time_s[rows],
            position_m=self.position_m[rows],
            orientation_xyzw=self.orientation_xyzw[rows],
            drawing=None if self.drawing is None else self.drawing[rows],
        )


DropoutKind = Literal["gap", "frozen", "invalid"]


@dataclass(frozen=True, slots=True)
class Dropout:
    """A stretch in which tracking was lost.

    Attributes
    ----------
    device : which device.
    start_s, end_s : the last good sample before and the first one after.
    kind : no rows at all, rows that repeat one pose, or poses that are not numbers.
    bridged : true where the doodle goes on across it, false where it splits.
    """

    device: str
    start_s: float
    end_s: float
    kind: DropoutKind
    bridged: bool


@dataclass(frozen=True, slots=True, eq=False)
class Recording(Frozen):
    """Doodles of one or more devices on a common clock.

    Attributes
    ----------
    doodles : at least one; grouped by device, in time order within a device; a device has
        several where tracking was lost for long.
    source : the file it came from, or what made it.
    dropouts : where tracking was lost.
    metadata : what else the file said of itself.
    """

    doodles: tuple[Doodle, ...]
    source: str = ""
    dropouts: tuple[Dropout, ...] = ()
    metadata: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.doodles:
            raise DoodleError("recording: expected at least one doodle, got none")
        last_end_s: dict[str, float] = {}
        for before, doodle in zip((None, *self.doodles), self.doodles, strict=False):
            name = doodle.device
            if name in last_end_s and (before is None or before.device != name):
                raise DoodleError(f"recording: doodles of device {name!r} are not together")
            if doodle.time_s[0] <= last_end_s.get(name, -np.inf):
                raise DoodleError(f"recording: doodles of device {name!r} overlap in time")
            last_end_s[name] = float(doodle.time_s[-1])
        object.__setattr__(self, "doodles", tuple(self.doodles))
        object.__setattr__(self, "dropouts", tuple(self.dropouts))
        object.__setattr__(self, "metadata", MappingProxyType(dict(self.metadata)))

    @property
    def devices(self) -> tuple[str, ...]:
        """Device names in their order of appearance."""
        return tuple(dict.fromkeys(doodle.device for doodle in self.doodles))

    def of(self, device: str) -> tuple[Doodle, ...]:
        """Return the doodles of one device, in time order."""
        return tuple(doodle for doodle in self.doodles if doodle.device == device)
