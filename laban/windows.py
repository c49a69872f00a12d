"""Effort over time: a window that slides over a movement, whole or as it comes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from laban.effort import AXES, Effort
from laban.model import EffortModel, read_effort
from laban.motion import FloatArray, RigidMotion
from laban.own import OwnMeasure

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
    found = stream.push(motion)
    values = [[getattr(effort, axis) for axis in AXES] for _, effort in found]
    return EffortCurve(
        np.array([time_s for time_s, _ in found]),
        np.array(values, dtype=np.float64).reshape(-1, len(AXES)),  # None becomes NaN
    )


class EffortStream:
    """Reads Effort from a movement as it comes, a window every so often.

    It says what `effort_over_time` says of the whole, whatever the pieces, and keeps no more than
    a window.
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
        self._pieces: list[RigidMotion] = []  # from where the next window begins, or before
        self._next_s = np.nan

    def push(self, motion: RigidMotion) -> list[tuple[float, Effort]]:
        """Take the samples that follow, and return the windows they complete: middle and Effort."""
        if not len(motion):
            return []
        self._pieces.append(motion)
        if np.isnan(self._next_s):
            self._next_s = float(motion.time_s[0])
        last_s = float(motion.time_s[-1])
        if self._next_s + self._window_s > last_s + 1e-9:
            return []
        kept = joined(self._pieces)
        found = []
        while self._next_s + self._window_s <= last_s + 1e-9:
            end_s = self._next_s + self._window_s
            effort = read_effort(kept.between(self._next_s, end_s), self._model, self._own)
            found.append((0.5 * (self._next_s + end_s), effort))
            self._next_s += self._step_s
        self._pieces = [kept.between(self._next_s, np.inf)]
        return found


def joined(pieces: Sequence[RigidMotion]) -> RigidMotion:
    """Return pieces of a movement as one; each follows the one before at the same steps."""
    return RigidMotion(
        *(
            np.concatenate([getattr(piece, field.name) for piece in pieces])
            for field in fields(RigidMotion)
        )
    )
