"""Effort over time: a window that slides over a movement, offline or as a stream."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, fields

import numpy as np

from laban.effort import AXES, Effort
from laban.model import EffortModel, read_in_steps
from laban.motion import FloatArray, RigidMotion
from laban.own import OwnMeasure
from laban.steps import Steps

WINDOW_S = 1.0
"""Long enough for a stroke and its rhythm."""

STEP_S = 0.25
"""From one window to the next."""


@dataclass(frozen=True, slots=True, eq=False)
class EffortCurve:
    """Effort over time.

    Attributes
    ----------
    time_s : (k,) the middles of the windows.
    values : (k, 4) in the order of `laban.AXES`; NaN where an axis was not read.
    """

    time_s: FloatArray
    values: FloatArray


def effort_over_time(
    motion: RigidMotion,
    model: EffortModel,
    own: OwnMeasure | None = None,
    *,
    window_s: float = WINDOW_S,
    step_s: float = STEP_S,
) -> EffortCurve:
    """Return the Effort in a window that slides over a movement.

    Parameters
    ----------
    motion
        The whole movement; windows begin with its first sample.
    model, own
        As in `read_effort`.
    window_s, step_s
        Length of a window, and time from one to the next.
    """
    stream = EffortStream(model, own, window_s=window_s, step_s=step_s)
    found = [*stream.push(motion), *stream.finish()]
    values = [[getattr(effort, axis) for axis in AXES] for _, effort in found]
    return EffortCurve(
        np.array([time_s for time_s, _ in found]),
        np.array(values, dtype=np.float64).reshape(-1, len(AXES)),  # None becomes NaN
    )


class EffortStream:
    """Reads Effort from a stream of samples, in a window every so often.

    Each sample does one short piece of the reading of the windows that are complete, so that no
    sample takes long; a reading comes some samples after its window's end. The readings equal
    those of `effort_over_time` on the whole, for any pieces. Only the current window is kept, and
    the one that is being read.
    """

    def __init__(
        self,
        model: EffortModel,
        own: OwnMeasure | None = None,
        *,
        window_s: float = WINDOW_S,
        step_s: float = STEP_S,
    ) -> None:
        self._model = model
        self._own = own
        self._window_s = window_s
        self._step_s = step_s
        self._arrays: tuple[FloatArray, ...] = ()  # a motion's, from the next window's beginning on
        self._next_s = np.nan
        self._reading: deque[tuple[float, Steps[Effort]]] = deque()

    def push(self, motion: RigidMotion) -> list[tuple[float, Effort]]:
        """Take the samples that follow; return the windows whose reading is done: middle, Effort.

        A sample does one piece of the work that is left. If windows follow faster than that, all
        but the last are read to their end.
        """
        if not len(motion):
            return []
        new = [getattr(motion, field.name) for field in fields(RigidMotion)]
        if self._arrays:
            new = [np.concatenate(both) for both in zip(self._arrays, new, strict=True)]
        else:
            self._next_s = float(motion.time_s[0])
        self._arrays = tuple(new)
        self._open_windows(float(motion.time_s[-1]))
        found = self._read(len(motion))
        while len(self._reading) > 1:
            found += self._read(1)
        return found

    def finish(self) -> list[tuple[float, Effort]]:
        """End the movement; return the windows that were not yet read."""
        found = []
        while self._reading:
            found += self._read(1)
        return found

    def _open_windows(self, last_s: float) -> None:
        """Begin to read the complete windows."""
        while self._next_s + self._window_s <= last_s + 1e-9:
            end_s = self._next_s + self._window_s
            time_s = self._arrays[0]
            last = int(np.searchsorted(time_s, end_s + 1e-9, side="right"))
            window = RigidMotion(*(array[:last] for array in self._arrays))
            middle_s = 0.5 * (self._next_s + end_s)
            self._reading.append((middle_s, read_in_steps(window, self._model, self._own)))
            self._next_s += self._step_s
            first = int(np.searchsorted(time_s, self._next_s - 1e-9))
            self._arrays = tuple(array[first:] for array in self._arrays)

    def _read(self, steps: int) -> list[tuple[float, Effort]]:
        """Do some steps of the pending readings."""
        found = []
        for _ in range(steps):
            if not self._reading:
                break
            middle_s, reading = self._reading[0]
            try:
                next(reading)
            except StopIteration as done:
                found.append((middle_s, done.value))
                self._reading.popleft()
        return found
