"""SmoothingStream: the smooth motion of a doodle that is still being drawn."""

from __future__ import annotations

from dataclasses import fields
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from laban import RigidMotion
from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray
from smd.smoothing import (
    RATE_HZ,
    WINDOW_S,
    fitted,
    half_window,
    resampled,
    smooth,
    stride_of,
)

Arrays: TypeAlias = tuple[FloatArray, ...]
"""The arrays of a `RigidMotion`, in the order of its fields; unchecked, as they grow often."""

DECIDE_S = 0.5
"""After this the sensor's rate is known, and with it how fine the grid is."""


class SmoothingStream:
    """Resamples, smooths and differentiates samples as they come, as `smooth` does.

    A smoothed sample is there half a window and two sensor samples after its time. All are those
    of `smooth` to rounding, if the sensor's rate in the first `DECIDE_S` asks for the same grid as
    its rate over the whole recording.
    """

    def __init__(self, *, rate_hz: float = RATE_HZ, window_s: float = WINDOW_S) -> None:
        self._rate_hz = rate_hz
        self._window_s = window_s
        self._half = half_window(rate_hz, window_s)
        self._stride = 0  # not known yet
        self._start_s = 0.0
        self._times: list[float] = []
        self._positions: list[FloatArray] = []
        self._orientations: list[FloatArray] = []
        self._measured = np.zeros((0, 3)), np.zeros((0, 4))
        self._first = 0  # grid sample that the measured ones begin with
        self._next = 0  # smoothed sample to give next

    def push(self, time_s: float, position_m: ArrayLike, orientation_xyzw: ArrayLike) -> None:
        """Take one sample.

        Raises
        ------
        DoodleError
            If it is not later than the last one, not finite, or no rotation; it is not taken.
        """
        position = np.asarray(position_m, dtype=np.float64)
        q = np.asarray(orientation_xyzw, dtype=np.float64)
        for name, value, n in (("position_m", position, 3), ("orientation_xyzw", q, 4)):
            if value.shape != (n,) or not np.isfinite(value).all():
                raise DoodleError(f"{name}: expected {n} finite numbers, got {value.tolist()}")
        length = float(np.linalg.norm(q))
        if abs(length - 1.0) > 1e-3:
            raise DoodleError(f"orientation_xyzw: expected unit length, got {length:g}")
        if not np.isfinite(time_s) or (self._times and time_s <= self._times[-1]):
            before = f"later than {self._times[-1]:g}" if self._times else "finite"
            raise DoodleError(f"time_s: expected a time that is {before}, got {time_s:g}")
        if self._orientations and float(q @ self._orientations[-1]) < 0.0:
            q = -q
        if not self._times:
            self._start_s = float(time_s)
        self._times.append(float(time_s))
        self._positions.append(position)
        self._orientations.append(q / length)

    def ready(self) -> Arrays | None:
        """Return the smoothed samples that are known since the last call, or None."""
        if not self._stride:
            passed_s = self._times[-1] - self._start_s if self._times else 0.0
            if passed_s < DECIDE_S:
                return None
            self._stride = stride_of((len(self._times) - 1) / passed_s, self._rate_hz)
        # A cubic needs two samples on either side.
        self._measure(before_s=self._times[-2] - self._start_s)
        count = self._first + len(self._measured[0])
        last = (count - 1) // self._stride - self._half
        return self._smoothed(last + 1) if last >= self._next else None

    def finish(self) -> Arrays | None:
        """Return the smoothed samples that are left, or None; nothing comes after it."""
        if not self._stride:
            try:
                motion = smooth(self._doodle(), rate_hz=self._rate_hz, window_s=self._window_s)
            except DoodleError:  # shorter than anything that can be smoothed
                return None
            return arrays_of(motion)
        periods = int(np.floor((self._times[-1] - self._start_s) * self._rate_hz + 1e-9))
        self._measure(before_s=np.inf, count=periods * self._stride + 1)
        return self._smoothed(periods + 1) if periods >= self._next else None

    def _doodle(self) -> Doodle:
        return Doodle(self._times, self._positions, self._orientations)  # type: ignore[arg-type]

    def _measure(self, *, before_s: float, count: int | None = None) -> None:
        """Bring the sensor's samples to the grid, as far as that is known or wanted."""
        step_s = 1.0 / (self._rate_hz * self._stride)
        have = self._first + len(self._measured[0])
        until = int(np.ceil(before_s / step_s - 1e-9)) if count is None else count
        if until <= have:
            return
        at_s = np.arange(have, until, dtype=np.float64) * step_s
        offset_s = self._times[0] - self._start_s
        new = resampled(self._doodle(), at_s - offset_s)
        positions, orientations = self._measured
        self._measured = (
            np.concatenate([positions, new[0]]),
            np.concatenate([orientations, new[1]]),
        )
        # What is before the left neighbour of the left neighbour of the next one plays no part.
        times_s = np.array(self._times) - self._start_s
        kept = max(int(np.searchsorted(times_s, until * step_s, side="right")) - 3, 0)
        for samples in (self._times, self._positions, self._orientations):
            del samples[: max(min(kept, len(samples) - 4), 0)]

    def _smoothed(self, until: int) -> Arrays:
        """Return the smoothed samples from the next one to ``until`` (excluded)."""
        step_s = 1.0 / (self._rate_hz * self._stride)
        last = self._first // self._stride + (len(self._measured[0]) - 1) // self._stride
        begin = max(min(self._next - self._half, last - 2 * self._half), 0)
        skip = begin * self._stride - self._first
        positions, orientations = (values[skip:] for values in self._measured)
        numbers = np.arange(begin * self._stride, self._first + len(self._measured[0]))
        time_s = self._start_s + numbers.astype(np.float64) * step_s
        half = self._half * self._stride
        motion = fitted(time_s, positions, orientations, step_s, half, self._stride)
        part = tuple(array[self._next - begin : until - begin] for array in arrays_of(motion))
        self._next = until
        self._measured = positions, orientations
        self._first = begin * self._stride
        return part


def arrays_of(motion: RigidMotion) -> Arrays:
    """Return a motion's arrays, in the order of its fields."""
    return tuple(getattr(motion, field.name) for field in fields(motion))
