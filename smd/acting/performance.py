"""Performance: characters with their poses over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.acting.terrain import Terrain
from smd.character.character import Character
from smd.doodle import Doodle
from smd.errors import TransferError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.score import Part, Score


@dataclass(frozen=True, slots=True, eq=False)
class Actor:
    """A character acting out one device's doodles.

    Attributes
    ----------
    device : whose doodles it performs.
    character : what is seen.
    rotation_xyzw : (n, j, 4) local joint rotations, a frame each, sign-continuous.
    translation_m : (n, j, 3) local joint translations; joint 0 is the ground root in the world.
    doodles : the device's doodles, at stage scale (metres of the character's world).
    part : the phrases it performs.
    """

    device: str
    character: Character
    rotation_xyzw: FloatArray
    translation_m: FloatArray
    doodles: tuple[Doodle, ...]
    part: Part

    def __post_init__(self) -> None:
        j = len(self.character.skeleton)
        rotation = frozen_array("rotation_xyzw", self.rotation_xyzw, (None, j, 4), TransferError)
        object.__setattr__(self, "rotation_xyzw", rotation)
        object.__setattr__(
            self,
            "translation_m",
            frozen_array("translation_m", self.translation_m, (len(rotation), j, 3), TransferError),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Performance:
    """Everything that is on stage, at an even rate.

    Attributes
    ----------
    rate_hz : frames per second.
    start_s : the recording's time at frame 0; frame i is at ``start_s + i / rate_hz``.
    actors : one per performer of the Score; all with the same number of frames.
    score : what they perform; its warnings are followed by those of acting it out.
    terrain : what they go on; None for the level ground.
    """

    rate_hz: float
    start_s: float
    actors: tuple[Actor, ...]
    score: Score
    terrain: Terrain | None = None

    def __post_init__(self) -> None:
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise TransferError(f"rate_hz: expected a positive number, got {self.rate_hz!r}")
        if not self.actors:
            raise TransferError("performance: expected at least one actor, got none")
        if len({len(actor.rotation_xyzw) for actor in self.actors}) > 1:
            raise TransferError("performance: expected actors of one length")

    def __len__(self) -> int:
        return len(self.actors[0].rotation_xyzw)
