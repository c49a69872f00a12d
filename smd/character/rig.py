"""Rigs: named controls, and the surface that they move.

Whoever works with poses as vectors of numbers, of a character or of anything else, needs no more
than this of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from laban.frozen import Frozen
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class Controls(Frozen):
    """The numbers that pose a rig.

    Attributes
    ----------
    names : (d,) unique, at least one.
    rest : (d,) float64, the pose in which nothing is done.
    low, high : (d,) between which each usually is; rest too. Nothing clips poses to them.
    """

    names: tuple[str, ...]
    rest: FloatArray
    low: FloatArray
    high: FloatArray

    def __post_init__(self) -> None:
        names = tuple(self.names)
        if not names or len(set(names)) != len(names):
            raise CharacterError("controls: expected at least one, with unique names")
        object.__setattr__(self, "names", names)
        for part in ("rest", "low", "high"):
            shape = (len(names),)
            value = frozen_array(f"controls: {part}", getattr(self, part), shape, CharacterError)
            object.__setattr__(self, part, value)
        outside = (self.rest < self.low) | (self.rest > self.high)
        if outside.any():
            k = int(np.argmax(outside))
            raise CharacterError(
                f"control {names[k]!r}: expected its rest within {self.low[k]:g} to "
                f"{self.high[k]:g}, got {self.rest[k]:g}"
            )

    def __len__(self) -> int:
        return len(self.names)

    def poses(self, values: ArrayLike) -> FloatArray:
        """Return poses ``(n, d)`` as a read-only array, or raise CharacterError."""
        return frozen_array("poses", values, (None, len(self)), CharacterError)


class ControlRig(Protocol):
    """What can be posed by numbers and has a surface of one topology."""

    @property
    def controls(self) -> Controls:
        """What poses it."""

    @property
    def triangles(self) -> IntArray:
        """Faces ``(t, 3)`` of its surface."""

    def surface_m(self, poses: ArrayLike) -> FloatArray:
        """Return the points of its surface ``(n, p, 3)``, in metres, for poses ``(n, d)``.

        Raises
        ------
        CharacterError
            If the poses are not of its controls, or the surface changes its topology.
        """


class FunctionRig:
    """A rig that a Python function poses.

    Parameters
    ----------
    controls
        What the function is given.
    triangles
        ``(t, 3)`` faces of its points.
    function
        Returns points ``(n, p, 3)`` for poses ``(n, d)``; as many for all poses.

    Raises
    ------
    CharacterError
        If there is no face, or the function's points at rest do not fit the faces.
    """

    def __init__(
        self,
        controls: Controls,
        triangles: ArrayLike,
        function: Callable[[FloatArray], ArrayLike],
    ) -> None:
        self._controls, self._function = controls, function
        self._triangles = frozen_array("triangles", triangles, (None, 3), CharacterError, np.int64)
        at_rest = frozen_array(
            "surface", function(controls.rest[None]), (1, None, 3), CharacterError
        )
        self._count = at_rest.shape[1]
        faces = self._triangles
        if not len(faces) or faces.min() < 0 or faces.max() >= self._count:
            raise CharacterError(f"triangles: expected indices below {self._count}")

    @property
    def controls(self) -> Controls:
        """What poses it."""
        return self._controls

    @property
    def triangles(self) -> IntArray:
        """Faces ``(t, 3)`` of its surface."""
        return self._triangles

    def surface_m(self, poses: ArrayLike) -> FloatArray:
        """Return the points of its surface, as `ControlRig.surface_m` does."""
        given = self._controls.poses(poses)
        shape = (len(given), self._count, 3)
        return frozen_array("surface", self._function(given), shape, CharacterError)
