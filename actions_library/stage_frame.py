"""The coordinate frame of a USD stage: its up axis and its unit.

Our own space is metres, Y up. A stage of another frame holds the same world in other coordinates:
every point, transform and rotation is changed, so that no transform above them is left for a
reader to forget.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from pxr import Usd, UsdGeom

from smd.errors import ExportError
from smd.geometry.arrays import FloatArray

UNITS_M = {"m": 1.0, "cm": 0.01}
"""Units of a stage by name, in metres."""

_ROWS = {"y": np.eye(3), "z": np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])}


@dataclass(frozen=True, slots=True)
class StageFrame:
    """Coordinates of a stage, right-handed.

    Attributes
    ----------
    up : "y", or "z": then our +Y is its +Z, and our +Z its -Y.
    unit_m : length of its unit in metres, positive.
    """

    up: str = "y"
    unit_m: float = 1.0

    def __post_init__(self) -> None:
        if self.up not in _ROWS:
            raise ExportError(f"stage up: expected y or z, found {self.up!r}")
        if not (np.isfinite(self.unit_m) and self.unit_m > 0):
            raise ExportError(f"stage unit: expected a positive length, found {self.unit_m!r}")

    @classmethod
    def named(cls, up: str, unit: str) -> StageFrame:
        """Return the frame of an axis and of a unit in `UNITS_M`, or raise ExportError."""
        if unit not in UNITS_M:
            raise ExportError(f"stage unit: expected {' or '.join(UNITS_M)}, found {unit!r}")
        return cls(up, UNITS_M[unit])

    @classmethod
    def of(cls, stage: Usd.Stage) -> StageFrame:
        """Return the frame that a USD stage declares."""
        up = UsdGeom.GetStageUpAxis(stage)
        return cls(str(up).lower(), UsdGeom.GetStageMetersPerUnit(stage))

    def mark(self, stage: Usd.Stage) -> None:
        """Declare this frame in a USD stage."""
        UsdGeom.SetStageUpAxis(stage, self.up.upper())
        UsdGeom.SetStageMetersPerUnit(stage, self.unit_m)

    def length(self, length_m: float) -> float:
        """Return a length in the stage's unit."""
        return length_m / self.unit_m

    def directions(self, xyz: ArrayLike) -> FloatArray:
        """Return directions ``(…, 3)`` along the stage's axes, as long as they were."""
        given = np.asarray(xyz)
        return given if self.up == "y" else np.asarray(given @ _ROWS["z"].T.astype(given.dtype))

    def points(self, xyz_m: ArrayLike) -> FloatArray:
        """Return points or translations ``(…, 3)`` in the stage's axes and unit."""
        turned = self.directions(xyz_m)
        return turned if self.unit_m == 1.0 else turned / self.unit_m

    def boxes(self, corners_m: ArrayLike) -> FloatArray:
        """Return boxes ``(…, 2, 3)``, least and greatest corner, in the stage's axes and unit."""
        return np.sort(self.points(corners_m), axis=-2)

    def rotations(self, xyzw: ArrayLike) -> FloatArray:
        """Return quaternions ``(…, 4)`` that turn the stage's axes as these turn ours."""
        given = np.asarray(xyzw)
        if self.up == "y":
            return given
        return np.concatenate([self.directions(given[..., :3]), given[..., 3:]], axis=-1)

    def transforms(self, matrices: ArrayLike) -> FloatArray:
        """Return rigid transforms ``(…, 4, 4)`` of columns that move the stage's points."""
        given = np.asarray(matrices, dtype=np.float64)
        if self == OURS:
            return given
        rows = _ROWS[self.up]
        changed = given.copy()
        changed[..., :3, :3] = rows @ given[..., :3, :3] @ rows.T
        changed[..., :3, 3] = self.points(given[..., :3, 3])
        return changed


OURS = StageFrame()
"""Metres, Y up."""
