"""Clip: a skeleton's poses and tracks over time, with its stages and contacts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.frozen import Frozen
from smd.character.skeleton import Skeleton
from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import CharacterError
from smd.geometry.arrays import BoolArray, FloatArray, IntArray, frozen_array
from smd.geometry.rotations import sign_continuous

STAGES = ("preparation", "anticipation", "execution", "follow_through", "transition")
"""The five stages of a movement, in their order (section 5.1 of the paper)."""


@dataclass(frozen=True, slots=True, eq=False)
class Clip(Frozen):
    """Local poses at an even rate.

    Joint 0 is the *ground root*: it stands on the ground under the body and carries travel and
    heading, so that every other joint's motion is in place. A cyclic clip's last frame is its
    first one again, but for the ground root.

    Attributes
    ----------
    name : of the action it shows.
    skeleton : what it moves.
    rate_hz : frames per second, positive.
    rotation_xyzw : (n, j, 4) float64, unit, sign-continuous; n is at least 2.
    translation_m : (n, j, 3) float64.
    stage_end_frames : (5,) int64, the last frame of each stage in `STAGES`, not decreasing; the
        last is n - 1. A stage that ends where the one before it ends is absent.
    contact_joints : joints that touch the ground at some time.
    contacts : (n, c) bool, when each of them does.
    cyclic : repeats seamlessly.
    tracks : of its n frames: weights of shapes, and any other control.
    """

    name: str
    skeleton: Skeleton
    rate_hz: float
    rotation_xyzw: FloatArray
    translation_m: FloatArray
    stage_end_frames: IntArray
    contact_joints: tuple[str, ...]
    contacts: BoolArray
    cyclic: bool = False
    tracks: Tracks = NO_TRACKS

    def __post_init__(self) -> None:
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise CharacterError(f"rate_hz: expected a positive number, got {self.rate_hz!r}")
        j = len(self.skeleton)
        rotation = frozen_array("rotation_xyzw", self.rotation_xyzw, (None, j, 4), CharacterError)
        n = len(rotation)
        if n < 2:
            raise CharacterError(f"clip {self.name!r}: expected at least 2 frames, got {n}")
        length = np.sqrt(np.einsum("nji,nji->nj", rotation, rotation))
        if np.abs(length - 1.0).max() > 1e-3:
            raise CharacterError(f"clip {self.name!r}: rotation_xyzw: expected unit length")
        translation = frozen_array("translation_m", self.translation_m, (n, j, 3), CharacterError)
        ends = frozen_array(
            "stage_end_frames", self.stage_end_frames, (5,), CharacterError, np.int64
        )
        if ends[0] < 0 or (np.diff(ends) < 0).any() or ends[-1] != n - 1:
            raise CharacterError(
                f"clip {self.name!r}: stage_end_frames: expected five frames in order, the last "
                f"{n - 1}, got {ends.tolist()}"
            )
        for joint in self.contact_joints:
            self.skeleton.index(joint)
        contacts = frozen_array(
            "contacts", self.contacts, (n, len(self.contact_joints)), CharacterError, np.bool_
        )
        object.__setattr__(
            self,
            "rotation_xyzw",
            frozen_array(
                "rotation_xyzw",
                sign_continuous(rotation / length[..., None]),
                (n, j, 4),
                CharacterError,
            ),
        )
        object.__setattr__(self, "translation_m", translation)
        object.__setattr__(self, "stage_end_frames", ends)
        object.__setattr__(self, "contact_joints", tuple(self.contact_joints))
        object.__setattr__(self, "contacts", contacts)
        object.__setattr__(self, "tracks", self.tracks.over(n))

    def __len__(self) -> int:
        return len(self.rotation_xyzw)

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame."""
        return (len(self) - 1) / self.rate_hz

    @property
    def travel_m(self) -> float:
        """Distance over the ground from the first to the last frame's ground root."""
        step = self.translation_m[-1, 0] - self.translation_m[0, 0]
        return float(np.hypot(step[0], step[2]))
