"""Skeleton: a tree of joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from laban.frozen import Frozen
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array

Role = Literal["root", "spine", "intermediate", "end_effector"]


@dataclass(frozen=True, slots=True, eq=False)
class Skeleton(Frozen):
    """Joints in a tree, parents before children.

    Attributes
    ----------
    joints : names, unique.
    parents : (j,) int64, index of each joint's parent, smaller than its own; -1 for a root.
    rest_rotation_xyzw : (j, 4) float64, unit; each joint in its parent's frame, at rest.
    rest_translation_m : (j, 3) float64.
    world_from_bind : (j, 4, 4) float64, where each joint stood when the mesh was bound to it.
    roles : what each joint is for Effort's Shape operator (section 6.4.2 of the paper).
    """

    joints: tuple[str, ...]
    parents: IntArray
    rest_rotation_xyzw: FloatArray
    rest_translation_m: FloatArray
    world_from_bind: FloatArray
    roles: tuple[Role, ...]

    def __post_init__(self) -> None:
        joints, n = tuple(self.joints), len(self.joints)
        if n == 0 or len(set(joints)) != n:
            raise CharacterError("joints: expected at least one, with unique names")
        parents = frozen_array("parents", self.parents, (n,), CharacterError, np.int64)
        if (parents >= np.arange(n)).any() or parents.min() < -1 or parents[0] != -1:
            raise CharacterError("parents: expected each parent before its children, -1 for a root")
        rotation = frozen_array(
            "rest_rotation_xyzw", self.rest_rotation_xyzw, (n, 4), CharacterError
        )
        if np.abs(np.linalg.norm(rotation, axis=-1) - 1.0).max() > 1e-6:
            raise CharacterError("rest_rotation_xyzw: expected unit length")
        if len(self.roles) != n or not set(self.roles) <= set(get_args(Role)):
            raise CharacterError(f"roles: expected {n} of {', '.join(get_args(Role))}")
        object.__setattr__(self, "joints", joints)
        object.__setattr__(self, "parents", parents)
        object.__setattr__(self, "rest_rotation_xyzw", rotation)
        object.__setattr__(
            self,
            "rest_translation_m",
            frozen_array("rest_translation_m", self.rest_translation_m, (n, 3), CharacterError),
        )
        object.__setattr__(
            self,
            "world_from_bind",
            frozen_array("world_from_bind", self.world_from_bind, (n, 4, 4), CharacterError),
        )
        object.__setattr__(self, "roles", tuple(self.roles))

    def __len__(self) -> int:
        return len(self.joints)

    def index(self, joint: str) -> int:
        """Return the index of a joint, or raise CharacterError naming it."""
        try:
            return self.joints.index(joint)
        except ValueError:
            raise CharacterError(f"skeleton: expected a joint named {joint!r}") from None
