"""Laban Effort of a rigid body's movement: arrays in, Effort out."""

from laban.effort import AXES, Effort, LabanError
from laban.motion import RigidMotion

__all__ = ["AXES", "Effort", "LabanError", "RigidMotion"]
