"""The interface of a source of tracked poses: devices, and frames of poses in our convention."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol, TypeAlias

Kind = Literal["headset", "controller", "tracker"]
Tracking = Literal["tracked", "lost", "away"]

Pose: TypeAlias = tuple[float, float, float, float, float, float, float]
"""x, y, z in metres and qx, qy, qz, qw, in the world of `docs/conventions.md`."""

Row: TypeAlias = tuple[Pose | None, bool | None]
"""The record of a device at one moment: its pose, None if tracking was lost, and whether the user
means to draw, None if that is not known."""


@dataclass(frozen=True, slots=True)
class Device:
    """A tracked device.

    Attributes
    ----------
    serial : its unique identifier.
    kind : headset, controller or tracker.
    role : the hand it is in, "left" or "right", or "" where that is not known.
    model : the maker's name for it, or "".
    battery : charge from 0 to 1, None where not known.
    tracking : tracked, lost (switched on, but not seen) or away (not connected).
    """

    serial: str
    kind: Kind
    role: str = ""
    model: str = ""
    battery: float | None = None
    tracking: Tracking = "tracked"

    @property
    def name(self) -> str:
        """Its name in recordings: the hand it is in, "headset", or its serial."""
        return self.role or ("headset" if self.kind == "headset" else self.serial)


class Sample(NamedTuple):
    """One device at one moment.

    Attributes
    ----------
    serial : of the device.
    pose : None where tracking was lost; never a guess.
    trigger : whether it is pressed; None where the device has none.
    grip : whether the button on the handle is pressed.
    """

    serial: str
    pose: Pose | None
    trigger: bool | None = None
    grip: bool = False


class Frame(NamedTuple):
    """All devices that reported at one moment.

    Attributes
    ----------
    time_s : when, on the source's clock; later than in the frame before.
    samples : in no order, each of another device.
    """

    time_s: float
    samples: tuple[Sample, ...]


class Source(Protocol):
    """Where poses come from."""

    def devices(self) -> tuple[Device, ...]:
        """Return the devices there are now."""

    def poses(self) -> Iterator[Frame]:
        """Yield frames as they arrive, until there are no more.

        Raises
        ------
        CaptureError
            If the source breaks off.
        """

    def tick(self, serial: str) -> None:
        """Give a short haptic pulse on a device, if it can."""

    def close(self) -> None:
        """Release the devices."""
