"""Laban Effort of a rigid body's movement: arrays in, Effort out."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from laban.effort import AXES, Effort, LabanError
    from laban.features import FEATURES, effort_features
    from laban.model import EffortModel, read_effort, read_state
    from laban.model_file import load_effort_model
    from laban.motion import RigidMotion
    from laban.own import OwnMeasure, own_measure
    from laban.windows import EffortCurve, EffortStream, effort_over_time

_HOME = {
    "AXES": "laban.effort",
    "FEATURES": "laban.features",
    "Effort": "laban.effort",
    "EffortCurve": "laban.windows",
    "EffortModel": "laban.model",
    "EffortStream": "laban.windows",
    "LabanError": "laban.effort",
    "OwnMeasure": "laban.own",
    "RigidMotion": "laban.motion",
    "effort_features": "laban.features",
    "effort_over_time": "laban.windows",
    "load_effort_model": "laban.model_file",
    "own_measure": "laban.own",
    "read_effort": "laban.model",
    "read_state": "laban.model",
}
"""Where each public name is defined; it is imported when it is first asked for."""

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


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'laban' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
