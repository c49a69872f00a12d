"""A-Frame motion capture: JSON with the poses of a headset and its controllers [1]_.

``{"left": {"poses": [{"position": {x, y, z}, "rotation": {x, y, z}, "timestamp"}, …]}, …}``, or
the same under ``"recording"``. Metres; degrees, Euler angles in Three.js's order YXZ (A-Frame's
default); milliseconds. The world is right-handed, Y up; a controller faces its own -Z.

References
----------
.. [1] https://github.com/dmarcos/aframe-motion-capture-components
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from laban.faults import Fault
from laban.json_node import parse_json
from smd.formats.file import RecordingFile
from smd.formats.format import RecordingFormat
from smd.formats.frame import Mount, SourceFrame
from smd.formats.tracks import Content, Track, shown
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import multiply, quaternion_about

FRAME = SourceFrame("y", "-z", "right", "m", "xyzw", Mount())

_NUMBERS = (int, float, type(None))  # by exact type: JSON's true is no number, though Python's is


def matches(head: str) -> bool:
    """Return whether a text begins like JSON."""
    return head.lstrip().startswith(("{", "["))


def read(file: RecordingFile) -> Content:
    """Return a track for every device that has poses; the one named ``camera`` is the headset.

    Raises
    ------
    Fault
        If the text is not JSON, no device has poses, or a pose lacks a number.
    """
    whole = parse_json(file.text).value  # poses by the thousand: read without places of their own
    devices = whole.get("recording", whole) if isinstance(whole, dict) else whole
    poses = {
        str(device): content["poses"]
        for device, content in (devices.items() if isinstance(devices, dict) else ())
        if isinstance(content, dict) and content.get("poses")
    }
    if not poses:
        keys = ", ".join(list(whole)[:6]) if isinstance(whole, dict) else type(whole).__name__
        raise Fault("", "JSON with devices that have poses", shown(keys))
    numbers = {device: _numbers(device, listed) for device, listed in poses.items()}
    tracks = tuple(
        Track(
            device=device,
            time_s=rows[:, 0] / 1000.0,
            position=rows[:, 1:4],
            quaternion=_quaternion_from_degrees(rows[:, 4:7]),
            place=partial(_place, device),
        )
        for device, rows in numbers.items()
    )
    return Content(tracks, FRAME, order_is_given=True, clock_means_something=False)


def _place(device: str, i: int) -> str:
    """Return where pose ``i`` of a device stands in the file."""
    return f"device {device!r}, pose {i}"


def _quaternion_from_degrees(rotation_deg: FloatArray) -> FloatArray:
    """Return quaternions ``(n, 4)`` of Three.js Euler angles x, y, z of order YXZ."""
    x, y, z = np.radians(rotation_deg).T
    turned = multiply(quaternion_about([0, 1, 0], y), quaternion_about([1, 0, 0], x))
    return multiply(turned, quaternion_about([0, 0, 1], z))


def _numbers(device: str, poses: Any) -> FloatArray:
    """Return timestamp, position and rotation ``(n, 7)``; null is NaN."""
    if not isinstance(poses, list):
        raise Fault(f"device {device!r}", "a list of poses", shown(poses))
    rows = []
    for i, pose in enumerate(poses):
        try:
            row = (
                pose["timestamp"],
                *(pose["position"][axis] for axis in "xyz"),
                *(pose["rotation"][axis] for axis in "xyz"),
            )
            if not all(type(value) in _NUMBERS for value in row):
                raise TypeError
            rows.append([np.nan if value is None else float(value) for value in row])
        except (KeyError, TypeError, IndexError, OverflowError):
            raise Fault(
                _place(device, i),
                "numbers in timestamp, position x y z and rotation x y z",
                shown(pose),
            ) from None
    numbers = np.array(rows, dtype=np.float64)
    infinite = np.isinf(numbers).any(axis=1)
    if infinite.any():  # here, since an infinite angle would pass for one that is lost
        raise Fault(_place(device, int(np.argmax(infinite))), "finite numbers", "inf")
    return numbers


FORMAT = RecordingFormat("A-Frame motion capture", (".json",), read, matches)
