"""EffortModel: what was learned, and reading with it.

A model is small and frozen. Learning is in `laban.training`, the file in `laban.model_file`; this
module needs NumPy alone and is what live code loads.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from laban.description import describe
from laban.effort import AXES, Effort, LabanError
from laban.motion import FloatArray, RigidMotion
from laban.own import OwnMeasure
from laban.reader import Reader, StateReader
from laban.stillness import is_readable

POLES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "time": ("sustained", "sudden"),
        "weight": ("light", "strong"),
        "space": ("indirect", "direct"),
        "flow": ("free", "bound"),
    }
)
"""The words for -1 and 1 on each axis."""

NEUTRAL = "neutral"
"""The word for neither pole."""

STATES = ((-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0))
"""The joint states of Time and Weight that a model tells as one decision."""


@dataclass(frozen=True, slots=True, eq=False)
class AxisModel:
    """How one axis is read.

    Attributes
    ----------
    alone : where nothing else is known of the performer.
    own : where takes of the performer are known; None if the model has no such reader.
    examples : takes of the low pole, neither and the high pole.
    performers : how many people they come from.
    """

    alone: Reader
    own: Reader | None
    examples: tuple[int, int, int]
    performers: int

    def value(self, description: FloatArray, own: OwnMeasure | None = None) -> float:
        """Return the reading of a description ``(129,)``, in [-1, 1]."""
        if own is not None and self.own is not None:
            return self.own.value(description, own)
        return self.alone.value(description)


@dataclass(frozen=True, slots=True, eq=False)
class JointModel:
    """How the `STATES` of Time and Weight are read, as one decision.

    Attributes
    ----------
    alone, own : as in `AxisModel`.
    """

    alone: StateReader
    own: StateReader

    def chances(self, description: FloatArray, own: OwnMeasure | None = None) -> FloatArray:
        """Return the chance of each state ``(4,)``."""
        if own is not None:
            return self.own.chances(description, own)
        return self.alone.chances(description)


@dataclass(frozen=True, slots=True, eq=False)
class EffortModel:
    """A trained reader of Effort.

    Attributes
    ----------
    axes : by name, those of `laban.AXES` that were trained; at least one.
    trained_on : what the examples were, for people.
    seed : of the examples, where they were simulated.
    joint : of Time and Weight together; None where too few takes had a pole on both.
    """

    axes: Mapping[str, AxisModel]
    trained_on: str
    seed: int | None = None
    joint: JointModel | None = None

    def __post_init__(self) -> None:
        if not self.axes or any(axis not in AXES for axis in self.axes):
            raise LabanError(f"axes: expected some of {', '.join(AXES)}, got {list(self.axes)}")
        in_order = {axis: self.axes[axis] for axis in AXES if axis in self.axes}
        object.__setattr__(self, "axes", MappingProxyType(in_order))


def read_effort(motion: RigidMotion, model: EffortModel, own: OwnMeasure | None = None) -> Effort:
    """Return the Effort of one span of movement.

    Axes that the model was not trained for are None. All are where there is nothing to read: in
    fewer than `laban.features.MIN_SAMPLES` samples, and in a body at rest.

    Parameters
    ----------
    motion
        The span; stillness at its ends does not count.
    model
        A trained one.
    own
        How the performer moves anyway, from a few takes (`laban.own.own_measure`).
    """
    if not is_readable(motion):
        return Effort()
    return effort_of(describe(motion), model, own)


def effort_of(description: FloatArray, model: EffortModel, own: OwnMeasure | None = None) -> Effort:
    """Return the Effort of a description ``(129,)``."""
    return Effort(**{axis: part.value(description, own) for axis, part in model.axes.items()})


def read_state(
    motion: RigidMotion, model: EffortModel, own: OwnMeasure | None = None
) -> tuple[str, str, float] | None:
    """Return the words of the likeliest joint state of Time and Weight, and its chance.

    None where the model does not know joint states, or there is nothing to read.
    """
    return state_of(describe(motion), model, own) if is_readable(motion) else None


def state_of(
    description: FloatArray, model: EffortModel, own: OwnMeasure | None = None
) -> tuple[str, str, float] | None:
    """Return the joint state of a description ``(129,)``; None where the model knows none."""
    if model.joint is None:
        return None
    chances = model.joint.chances(description, own)
    best = int(np.argmax(chances))
    time, weight = STATES[best]
    return POLES["time"][int(time > 0)], POLES["weight"][int(weight > 0)], float(chances[best])


def confidence(value: float) -> float:
    """Return the chance of the pole that a reading leans to, in [0.5, 1]."""
    return 0.5 * (1.0 + abs(value))
