"""What must hold of a track before it can become doodles, whatever file it came from."""

from __future__ import annotations

import numpy as np

from laban.faults import Fault
from smd.formats.dropouts import LONGEST_BRIDGE_S
from smd.formats.tracks import Track
from smd.geometry.arrays import BoolArray

FARTHEST_M = 1e6
"""Beyond 1000 km a position is in another unit, and its squares lose all precision."""

LATEST_S = 1e10
"""Three centuries from zero: a clock in milliseconds since 1970 is beyond it."""

SHORTEST_STEP_S = 1e-9
"""Two rows closer than this are one instant; speeds between them would mean nothing."""

LENGTH_TOLERANCE = 0.02
"""How far a quaternion's length may be from 1: what rounding to two decimals does to it."""


def checked(track: Track, metres_per_unit: float) -> BoolArray:
    """Return where the poses of a track are valid (n,); NaN poses are not, and no error.

    Raises
    ------
    Fault
        If there are fewer than two rows, times are not finite, increasing seconds, a position
        is infinite or absurd, or a quaternion is zero or far from unit length; the message names
        the first row at fault.
    """
    device = f"device {track.device!r}"
    if len(track.time_s) < 2:
        raise Fault(device, "at least two poses", str(len(track.time_s)))
    _check_times(track)
    pose = np.concatenate([track.position, track.quaternion], axis=1)
    infinite = np.isinf(pose).any(axis=1)
    if infinite.any():
        row = int(np.argmax(infinite))
        raise Fault(track.place(row), "finite numbers", "inf")
    valid = ~np.isnan(pose).any(axis=1)
    _check_poses(track, valid, metres_per_unit)
    return valid


def _check_times(track: Track) -> None:
    """Raise unless times are finite, increasing, and close enough for seconds."""
    time_s = track.time_s
    absurd = ~(np.abs(time_s) <= LATEST_S)  # written so that NaN is absurd too
    if absurd.any():
        row = int(np.argmax(absurd))
        raise Fault(
            track.place(row), f"a time in seconds, at most {LATEST_S:g}", f"{time_s[row]:g}"
        )
    steps = np.diff(time_s)
    if steps.min() < SHORTEST_STEP_S:
        row = int(np.argmax(steps < SHORTEST_STEP_S)) + 1
        raise Fault(
            track.place(row),
            f"a time at least 1 ns after {time_s[row - 1].item()!r} s",
            f"{time_s[row].item()!r} s",
        )
    if np.median(steps) > LONGEST_BRIDGE_S + 1e-9:
        raise Fault(
            f"device {track.device!r}",
            f"times in seconds, rows at most {LONGEST_BRIDGE_S:g} s apart",
            f"most rows {np.median(steps):g} s apart",
        )


def _check_poses(track: Track, valid: BoolArray, metres_per_unit: float) -> None:
    """Raise unless valid poses have sane positions and quaternions near unit length."""
    far = np.abs(track.position).max(axis=1) * metres_per_unit > FARTHEST_M
    if far.any():
        row = int(np.argmax(far))
        found = f"{np.abs(track.position[row]).max() * metres_per_unit:g} m"
        raise Fault(track.place(row), f"positions within {FARTHEST_M:g} m", found)
    with np.errstate(over="ignore"):  # absurd components end as an infinite length
        length = np.linalg.norm(track.quaternion, axis=1)
    wrong = valid & ~(np.abs(length - 1.0) <= LENGTH_TOLERANCE)
    if wrong.any():
        row = int(np.argmax(wrong))
        found = "zero" if length[row] == 0 else f"length {length[row]:g}"
        raise Fault(track.place(row), "a unit quaternion", found)
