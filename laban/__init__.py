"""Laban Effort of a rigid body's movement: arrays in, Effort out."""

from laban.effort import AXES, Effort, LabanError
from laban.features import FEATURES, effort_features
from laban.model import EffortModel, load_effort_model, read_effort
from laban.motion import RigidMotion

__all__ = [
    "AXES",
    "FEATURES",
    "Effort",
    "EffortModel",
    "LabanError",
    "RigidMotion",
    "effort_features",
    "load_effort_model",
    "read_effort",
]
