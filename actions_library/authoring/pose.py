"""A pose at every frame, worked out from the root to the tips."""

from __future__ import annotations

import numpy as np

from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import IDENTITY_XYZW, inverse, multiply, rotate


class Pose:
    """World rotations and positions of the joints as they are worked out, root to tip."""

    def __init__(self, skeleton: Skeleton, frames: int) -> None:
        self.skeleton = skeleton
        self.rotation = np.tile(IDENTITY_XYZW, (frames, len(skeleton), 1))
        self.position = np.zeros((frames, len(skeleton), 3))

    def set(self, joint: str, world_xyzw: FloatArray) -> None:
        """Give a joint its rotation in the world; its parent must have been set."""
        j = self.skeleton.index(joint)
        parent = int(self.skeleton.parents[j])
        bone = self.skeleton.rest_translation_m[j]
        self.rotation[:, j] = world_xyzw
        self.position[:, j] = self.position[:, parent] + rotate(self.rotation[:, parent], bone)

    def put(self, joint: str, world_xyzw: FloatArray, world_m: FloatArray) -> None:
        """Give a joint its rotation and its place in the world, whatever its bone's length."""
        j = self.skeleton.index(joint)
        self.rotation[:, j] = world_xyzw
        self.position[:, j] = world_m

    def turn(self, joint: str, local_xyzw: FloatArray) -> None:
        """Give a joint its rotation from its parent's."""
        self.set(joint, multiply(self.parent_rotation(joint), local_xyzw))

    def parent_rotation(self, joint: str) -> FloatArray:
        """Return the rotation in the world of a joint's parent."""
        return self.rotation[:, int(self.skeleton.parents[self.skeleton.index(joint)])]

    def at(self, joint: str) -> FloatArray:
        """Return where a joint will be, its parent being set."""
        j = self.skeleton.index(joint)
        parent = int(self.skeleton.parents[j])
        bone = self.skeleton.rest_translation_m[j]
        return self.position[:, parent] + rotate(self.rotation[:, parent], bone)

    def local(self) -> tuple[FloatArray, FloatArray]:
        """Return local rotations ``(n, j, 4)`` and translations ``(n, j, 3)``."""
        rotation, position = self.rotation.copy(), self.position.copy()
        for j, parent in enumerate(self.skeleton.parents):
            if parent >= 0:
                turn_back = inverse(self.rotation[:, parent])
                rotation[:, j] = multiply(turn_back, self.rotation[:, j])
                position[:, j] = rotate(turn_back, self.position[:, j] - self.position[:, parent])
        return rotation, position
