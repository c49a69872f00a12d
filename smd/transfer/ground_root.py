"""The root motion of a clip: position and heading of its ground root in each frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.character.clip import STAGES, Clip
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import heading_rad

EXECUTION = STAGES.index("execution")


@dataclass(frozen=True, slots=True, eq=False)
class GroundRoot:
    """A clip's root motion, in the coordinate frame of its first frame.

    Attributes
    ----------
    position_m : (n, 2) to the left and ahead; the first is zero.
    yaw_rad : (n,) turned to the left since the first frame, without jumps.
    """

    position_m: FloatArray
    yaw_rad: FloatArray

    @property
    def turn_rad(self) -> float:
        """The whole turn, to the left."""
        return float(self.yaw_rad[-1])

    def position_at(self, frame: FloatArray) -> FloatArray:
        """Return the place ``(m, 2)`` at fractional frames."""
        frames = np.arange(len(self.yaw_rad))
        return np.stack([np.interp(frame, frames, axis) for axis in self.position_m.T], axis=-1)

    def yaw_at(self, frame: FloatArray) -> FloatArray:
        """Return the turn at fractional frames."""
        return np.asarray(np.interp(frame, np.arange(len(self.yaw_rad)), self.yaw_rad))


def ground_root(clip: Clip) -> GroundRoot:
    """Return a clip's root motion."""
    return ground_roots(clip.rotation_xyzw[:, :1], clip.translation_m[:, :1])[0]


def ground_roots(rotation_xyzw: FloatArray, place_m: FloatArray) -> list[GroundRoot]:
    """Return the root motion of clips of one length.

    Parameters
    ----------
    rotation_xyzw, place_m
        ``(n, e, 4)`` and ``(n, e, 3)`` their ground roots, each in its own world.
    """
    yaw = np.unwrap(heading_rad(rotation_xyzw), axis=0)
    over_ground = place_m[..., [0, 2]]
    position_m = turned(over_ground - over_ground[0], -yaw[0])
    return [
        GroundRoot(position_m[:, i], yaw[:, i] - yaw[0, i]) for i in range(rotation_xyzw.shape[1])
    ]


def turned(over_ground: FloatArray, angle_rad: FloatArray | float) -> FloatArray:
    """Turn x and z ``(…, 2)`` by an angle about +Y."""
    x, z = over_ground[..., 0], over_ground[..., 1]
    sine, cosine = np.sin(angle_rad), np.cos(angle_rad)
    return np.stack([cosine * x + sine * z, cosine * z - sine * x], axis=-1)


def executed(clip: Clip, root: GroundRoot) -> FloatArray:
    """Return the share ``(n,)`` of a clip's travel that is done by each frame.

    The ground root stays in place up to the execution's start and from its end on [1]_. In between
    it moves as in the clip, or, where the clip does not travel, at constant speed.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 6.2.
    """
    n = len(clip)
    start, end = clip.stage_end_frames[EXECUTION - 1], clip.stage_end_frames[EXECUTION]
    if end <= start:
        start, end = 0, n - 1
    steps = np.linalg.norm(np.diff(root.position_m, axis=0), axis=-1)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    if way[end] - way[start] < 1e-6:
        way = np.arange(n, dtype=np.float64)
    return np.clip((way - way[start]) / (way[end] - way[start]), 0.0, 1.0)
