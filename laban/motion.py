"""RigidMotion: the pose of a rigid body over time, with its derivatives."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from laban.effort import LabanError
from laban.frozen import Frozen

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class RigidMotion(Frozen):
    """A rigid body's pose at even times, and three derivatives of it.

    The caller provides the derivatives, because estimating them depends on the sensor's noise
    (a doodle's come from `smd.smooth`, a robot's from its controller).

    Attributes
    ----------
    time_s : (n,) even steps, strictly increasing.
    position_m : (n, 3) in the world, Y up.
    orientation_xyzw : (n, 4) unit, turns the body's axes (+Z front, +X left) into the world's.
    velocity_m_s, acceleration_m_s2, jerk_m_s3 : (n, 3) of the position, in the world.
    angular_velocity_rad_s, angular_acceleration_rad_s2, angular_jerk_rad_s3 : (n, 3) in the
        body's axes.
    """

    time_s: FloatArray
    position_m: FloatArray
    orientation_xyzw: FloatArray
    velocity_m_s: FloatArray
    acceleration_m_s2: FloatArray
    jerk_m_s3: FloatArray
    angular_velocity_rad_s: FloatArray
    angular_acceleration_rad_s2: FloatArray
    angular_jerk_rad_s3: FloatArray

    def __post_init__(self) -> None:
        n = len(np.atleast_1d(self.time_s))
        widths = {"time_s": (), "orientation_xyzw": (4,)}
        for field in fields(self):
            value = np.array(getattr(self, field.name), dtype=np.float64)
            expected = (n, *widths.get(field.name, (3,)))
            if value.shape != expected:
                raise LabanError(f"{field.name}: expected shape {expected}, got {value.shape}")
            if not np.isfinite(value).all():
                raise LabanError(f"{field.name}: expected finite numbers")
            value.flags.writeable = False
            object.__setattr__(self, field.name, value)
        steps = np.diff(self.time_s)
        if n > 1 and (steps.min() <= 0 or np.ptp(steps) > 1e-6 + 1e-3 * steps.mean()):
            raise LabanError("time_s: expected even, increasing steps")

    def __len__(self) -> int:
        return len(self.time_s)

    @property
    def step_s(self) -> float:
        """Time from one sample to the next; there are at least two."""
        return float(self.time_s[-1] - self.time_s[0]) / (len(self) - 1)

    def between(self, start_s: float, end_s: float) -> RigidMotion:
        """Return the samples with ``start_s <= time_s <= end_s``."""
        first = int(np.searchsorted(self.time_s, start_s - 1e-9))
        last = int(np.searchsorted(self.time_s, end_s + 1e-9, side="right"))
        return RigidMotion(*(getattr(self, field.name)[first:last] for field in fields(self)))
