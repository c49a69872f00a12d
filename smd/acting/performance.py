"""Performance: characters with their poses over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from laban.frozen import Frozen
from smd.acting.terrain import Terrain
from smd.character.character import Character
from smd.character.poses import Poses
from smd.character.tracks import NO_TRACKS, Tracks
from smd.doodle import Doodle
from smd.errors import TransferError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.geometry.rotations import sign_continuous
from smd.score import Phrase

UNIT_TOLERANCE = 1e-3
"""How much longer or shorter than 1 a rotation's quaternion may be: that of `Clip`."""


@dataclass(frozen=True, slots=True, eq=False)
class HeldProp(Frozen):
    """A prop in an actor's hand, a frame each.

    Attributes
    ----------
    position_m : (n, 3) in the world.
    orientation_xyzw : (n, 4) unit; it turns the prop's +Z to where its front points.
    """

    position_m: FloatArray
    orientation_xyzw: FloatArray

    def __post_init__(self) -> None:
        position = frozen_array("position_m", self.position_m, (None, 3), TransferError)
        shape = (len(position), 4)
        turns = frozen_array("orientation_xyzw", self.orientation_xyzw, shape, TransferError)
        object.__setattr__(self, "position_m", position)
        object.__setattr__(self, "orientation_xyzw", turns)


@dataclass(frozen=True, slots=True, eq=False)
class Actor(Frozen):
    """A character, and what it does.

    Attributes
    ----------
    name : unique in its performance; a device's where it acts out what somebody drew.
    character : what is seen.
    poses : local, a frame each, at least one; rotations of unit length, made sign-continuous; joint
        0 is the ground root in the world.
    phrases : what it performs, in time order, where that has names.
    doodles : what it was drawn with, if it was, in metres of the character's world.
    tracks : weights of the character's shapes, and any other control, a value each frame.
    held : where the prop is in its hand; None where it is not held.
    """

    name: str
    character: Character
    poses: Poses
    phrases: tuple[Phrase, ...] = ()
    doodles: tuple[Doodle, ...] = ()
    tracks: Tracks = NO_TRACKS
    held: HeldProp | None = None

    def __post_init__(self) -> None:
        j = len(self.character.skeleton)
        rotation, translation = self.poses
        rotation = frozen_array("rotation_xyzw", rotation, (None, j, 4), TransferError)
        if len(rotation) == 0:
            raise TransferError(f"actor {self.name!r}: expected at least one frame, got none")
        if np.abs(np.linalg.norm(rotation, axis=-1) - 1.0).max() > UNIT_TOLERANCE:
            raise TransferError(f"actor {self.name!r}: rotation_xyzw: expected unit length")
        rotation = sign_continuous(rotation)
        rotation.flags.writeable = False
        shape = (len(rotation), j, 3)
        translation = frozen_array("translation_m", translation, shape, TransferError)
        if self.held is not None and len(self.held.position_m) != len(rotation):
            raise TransferError(
                f"actor {self.name!r}: held: expected {len(rotation)} frames, as poses have, got "
                f"{len(self.held.position_m)}"
            )
        object.__setattr__(self, "poses", Poses(rotation, translation))
        object.__setattr__(self, "tracks", self.tracks.over(len(rotation), TransferError))
        object.__setattr__(self, "phrases", tuple(self.phrases))
        object.__setattr__(self, "doodles", tuple(self.doodles))

    def __len__(self) -> int:
        return len(self.poses.rotation_xyzw)


@dataclass(frozen=True, slots=True, eq=False)
class Performance(Frozen):
    """Everything that is in a scene, at an even rate.

    Attributes
    ----------
    rate_hz : frames per second.
    start_s : time at frame 0, on the clock of phrases and doodles; frame i is at
        ``start_s + i / rate_hz``.
    actors : at least one; all with the same number of frames, and names of their own.
    terrain : what they go on; None for the level ground.
    warnings : what a person should know before trusting it.
    source : what it comes from, as text by name, for whoever makes it again: a Score's JSON is
        its ``score``.
    """

    rate_hz: float
    start_s: float
    actors: tuple[Actor, ...]
    terrain: Terrain | None = None
    warnings: tuple[str, ...] = ()
    source: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise TransferError(f"rate_hz: expected a positive number, got {self.rate_hz!r}")
        if not np.isfinite(self.start_s):
            raise TransferError(f"start_s: expected a finite number, got {self.start_s!r}")
        object.__setattr__(self, "actors", tuple(self.actors))
        if not self.actors:
            raise TransferError("performance: expected at least one actor, got none")
        if len({len(actor) for actor in self.actors}) > 1:
            raise TransferError("performance: expected actors of one length")
        names = [actor.name for actor in self.actors]
        for name in names:
            if names.count(name) > 1:
                raise TransferError(f"performance: actor {name!r} appears twice")
        object.__setattr__(self, "warnings", tuple(self.warnings))
        object.__setattr__(self, "source", MappingProxyType(dict(self.source)))

    def __len__(self) -> int:
        return len(self.actors[0])
