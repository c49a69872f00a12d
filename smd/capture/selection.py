"""Which of the devices are recorded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from smd.capture.source import Device
from smd.errors import CaptureError


def chosen_devices(devices: Sequence[Device], asked: Sequence[str] = ()) -> tuple[Device, ...]:
    """Return the devices to record.

    Parameters
    ----------
    devices
        All there are.
    asked
        Serials, roles (left, right) or kinds (headset, controller, tracker); by default all
        controllers and trackers that are connected.

    Raises
    ------
    CaptureError
        If there is none, one that was asked for is not there, or a role or kind is that of
        several: their rows could not be told apart.
    """
    there = _listed(devices)
    if asked:
        chosen = tuple(dict.fromkeys(_one(devices, word, there) for word in asked))
    else:
        chosen = tuple(d for d in devices if d.kind != "headset" and d.tracking != "away")
    if not chosen:
        raise CaptureError(
            f"expected a controller or a tracker, found {there}: switch one on, and try again"
        )
    for name, count in Counter(device.name for device in chosen).items():
        if count > 1:
            serials = " or ".join(device.serial for device in chosen if device.name == name)
            raise CaptureError(
                f"expected one device of role {name!r}, found {count}: "
                f"name one with --device {serials}"
            )
    return chosen


def require_trigger(devices: Sequence[Device]) -> None:
    """Raise CaptureError unless there is a controller, whose trigger says when the user draws."""
    if not any(d.kind == "controller" and d.tracking != "away" for d in devices):
        raise CaptureError(
            f"expected a controller, whose trigger says when you draw, found {_listed(devices)}: "
            "switch one on, and try again"
        )


def _one(devices: Sequence[Device], word: str, there: str) -> Device:
    """Return the one device that a serial, role or kind means."""
    by_serial = [device for device in devices if device.serial == word]
    found = by_serial or [d for d in devices if word.lower() in (d.role, d.kind)]
    if not found:
        raise CaptureError(
            f"expected a device {word!r}, found {there}: name one of these with --device"
        )
    if len(found) > 1:
        serials = " or ".join(device.serial for device in found)
        raise CaptureError(
            f"expected one device {word!r}, found {len(found)}: name one with --device {serials}"
        )
    return found[0]


def _listed(devices: Sequence[Device]) -> str:
    """Return devices as a message names them."""
    shown = (f"{d.serial} ({' '.join(filter(None, (d.role, d.kind)))})" for d in devices)
    return ", ".join(shown) or "none"
