"""BlendShape: another form of some of a mesh's points, mixed in by its weight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.frozen import Frozen
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class BlendShape(Frozen):
    """Offsets of some points in the bind pose, added before joints move them.

    Attributes
    ----------
    name : of the track that has its weight: 0 leaves the points alone, 1 moves them by the
        offsets. Shapes of one name in several meshes have one weight.
    indices : (m,) int64, the points that it moves, increasing.
    offsets_m : (m, 3) float64.
    """

    name: str
    indices: IntArray
    offsets_m: FloatArray

    def __post_init__(self) -> None:
        place = f"shape {self.name!r}"
        indices = frozen_array(f"{place}: indices", self.indices, (None,), CharacterError, np.int64)
        if (np.diff(indices) <= 0).any() or (len(indices) and indices[0] < 0):
            raise CharacterError(f"{place}: indices: expected increasing ones from 0")
        offsets = frozen_array(
            f"{place}: offsets_m", self.offsets_m, (len(indices), 3), CharacterError
        )
        object.__setattr__(self, "indices", indices)
        object.__setattr__(self, "offsets_m", offsets)

    @classmethod
    def sparse(cls, name: str, offsets_m: FloatArray) -> BlendShape:
        """Return the shape of offsets ``(p, 3)`` of all points: those that are not zero."""
        moved = np.flatnonzero(np.any(offsets_m != 0.0, axis=-1))
        return cls(name, moved, offsets_m[moved])
