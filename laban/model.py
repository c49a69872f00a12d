"""EffortModel: a trained model, and reading Effort with it.

A model is small and frozen. Training is in `laban.training`, the file in `laban.model_file`. This
module needs NumPy alone, and is the one that live code loads.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from laban.description import described_in_steps
from laban.effort import AXES, POLES, Effort, LabanError
from laban.frozen import Frozen
from laban.motion import FloatArray, RigidMotion
from laban.own import OwnMeasure
from laban.reader import Reader
from laban.steps import Steps, finished
from laban.stillness import is_readable

STATE_AXES = ("time", "weight")
"""The axes whose poles are classified jointly as well: the two of the paper."""

STATES = ((-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0))
"""The joint states of `STATE_AXES`, which a model classifies in one decision."""


def state_words(state: tuple[float, float]) -> tuple[str, str]:
    """Return the words of a joint state's two poles."""
    first, second = (POLES[axis][int(v > 0)] for axis, v in zip(STATE_AXES, state, strict=True))
    return first, second


@dataclass(frozen=True, slots=True)
class Taught:
    """The training data of an axis.

    Attributes
    ----------
    examples : number of takes of the low pole, neither and the high pole.
    performers : number of people they come from.
    """

    examples: tuple[int, int, int]
    performers: int


@dataclass(frozen=True, slots=True, eq=False)
class EffortModel(Frozen):
    """A trained reader of Effort.

    Attributes
    ----------
    axes : by name, those of `laban.AXES` that were trained; at least one.
    alone : the reader for an unknown performer.
    own : the reader for a performer some of whose takes are known.
    trained_on : a description of the training data, for people to read.
    seed : of the training data, if they were simulated.
    """

    axes: Mapping[str, Taught]
    alone: Reader
    own: Reader
    trained_on: str
    seed: int | None = None

    def __post_init__(self) -> None:
        if not self.axes or any(axis not in AXES for axis in self.axes):
            raise LabanError(f"axes: expected some of {', '.join(AXES)}, got {list(self.axes)}")
        in_order = {axis: self.axes[axis] for axis in AXES if axis in self.axes}
        object.__setattr__(self, "axes", MappingProxyType(in_order))

    def reader(self, own: OwnMeasure | None) -> Reader:
        """Return the reader for a performer whose own measure is given, or is None."""
        return self.alone if own is None else self.own


def read_effort(motion: RigidMotion, model: EffortModel, own: OwnMeasure | None = None) -> Effort:
    """Return the Effort of one span of movement.

    Axes that the model was not trained for are None. All are None if there is nothing to read:
    fewer than `laban.features.MIN_SAMPLES` samples, or a body at rest.

    Parameters
    ----------
    motion
        The span; stillness at its ends does not count.
    model
        A trained one.
    own
        The performer's usual description, from a few takes (`laban.own.own_measure`).
    """
    return finished(read_in_steps(motion, model, own))


def read_in_steps(
    motion: RigidMotion, model: EffortModel, own: OwnMeasure | None = None
) -> Steps[Effort]:
    """Do what `read_effort` does, in steps; the first does nothing, as a stream opens a window."""
    yield
    if not is_readable(motion):
        return Effort()
    description = yield from described_in_steps(motion)
    yield
    effort = yield from model.reader(own).effort_in_steps(description, own)
    return effort


def effort_of(description: FloatArray, model: EffortModel, own: OwnMeasure | None = None) -> Effort:
    """Return the Effort of a description ``(132,)``."""
    return model.reader(own).effort(description, own)


def read_state(
    motion: RigidMotion, model: EffortModel, own: OwnMeasure | None = None
) -> tuple[str, str, float] | None:
    """Return the words of the likeliest joint state of Time and Weight, and its probability.

    None if the model was not trained on joint states, or there is nothing to read.
    """
    if not is_readable(motion):
        return None
    return state_of(finished(described_in_steps(motion)), model, own)


def state_of(
    description: FloatArray, model: EffortModel, own: OwnMeasure | None = None
) -> tuple[str, str, float] | None:
    """Return the joint state of a description ``(132,)``; None if the model has none."""
    chances = model.reader(own).chances(description, own)
    if chances is None:
        return None
    best = int(np.argmax(chances))
    return *state_words(STATES[best]), float(chances[best])


def confidence(value: float) -> float:
    """Return the probability of the likelier pole of a reading, in [0.5, 1]."""
    return 0.5 * (1.0 + abs(value))
