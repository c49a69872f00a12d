"""Laban Effort of a rigid body's movement: arrays in, Effort out."""

from laban.effort import AXES, Effort, LabanError
from laban.features import FEATURES, effort_features
from laban.model import EffortModel, read_effort, read_state
from laban.model_file import load_effort_model
from laban.motion import RigidMotion
from laban.own import OwnMeasure, own_measure
from laban.windows import EffortCurve, EffortStream, effort_over_time

__all__ = [
    "AXES",
    "FEATURES",
    "Effort",
    "EffortCurve",
    "EffortModel",
    "EffortStream",
    "LabanError",
    "OwnMeasure",
    "RigidMotion",
    "effort_features",
    "effort_over_time",
    "load_effort_model",
    "own_measure",
    "read_effort",
    "read_state",
]
