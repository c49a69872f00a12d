"""Repertoire: what a performer can do, each clip studied once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.library import IDLE, Library
from smd.character.clip import Clip
from smd.geometry.arrays import BoolArray, FloatArray
from smd.transfer.gait import Gait, gait_of
from smd.transfer.ground_root import GroundRoot, ground_root
from smd.transfer.legs import Leg, feet_of, legs_of, world_of, yaw_of
from smd.transfer.standing import standing


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """An action's clip, with what is known of it.

    Attributes
    ----------
    clip : neutral. Its expression by Effort would be a clip of the same kind in its place.
    travels : moves along the doodle's path.
    root : how its ground root goes.
    stands : (n,) when each foot stands, by the foot's joint.
    yaw_rad : (n,) which way each foot points in the clip's own world, without jumps.
    gait : what it does per cycle, if it steps along the path.
    """

    clip: Clip
    travels: bool
    root: GroundRoot
    stands: Mapping[int, BoolArray]
    yaw_rad: Mapping[int, FloatArray]
    gait: Gait | None

    @property
    def last_frame(self) -> int:
        """Index of the clip's last frame."""
        return len(self.clip) - 1

    def yaw_at(self, foot: int, frame: FloatArray) -> FloatArray:
        """Return which way a foot points at fractional frames; cycles add up."""
        if foot not in self.yaw_rad:
            return np.zeros(len(frame))
        yaw = self.yaw_rad[foot]
        laps = np.floor(frame / self.last_frame) if self.clip.cyclic else np.zeros(len(frame))
        within = np.interp(frame - laps * self.last_frame, np.arange(len(yaw)), yaw)
        return np.asarray(within + laps * (yaw[-1] - yaw[0]))

    def stands_at(self, foot: int, frame: FloatArray) -> BoolArray:
        """Return whether a foot stands at the frames nearest to fractional ones."""
        if foot not in self.stands:
            return np.zeros(len(frame), dtype=bool)
        within = np.mod(frame, self.last_frame) if self.clip.cyclic else frame
        nearest = np.clip(np.round(within), 0, self.last_frame).astype(np.int64)
        return self.stands[foot][nearest]


@dataclass(frozen=True, slots=True, eq=False)
class Repertoire:
    """The pieces of a Score, and the legs that stand in any of them.

    Attributes
    ----------
    pieces : by action.
    legs : of the character.
    """

    pieces: Mapping[str, Piece]
    legs: tuple[Leg, ...]

    @property
    def idle(self) -> Piece:
        """What is played where nothing is performed."""
        return self.pieces[IDLE]


def repertoire(library: Library, actions: Iterable[str]) -> Repertoire:
    """Study the clips of some actions, and of idling."""
    names = sorted({IDLE, *actions})
    clips = [library.clip(name) for name in names]
    legs = legs_of(library.character.skeleton, sorted({f for clip in clips for f in feet_of(clip)}))
    pieces = {
        name: piece_of(clip, travels=library.action(name).travels, legs=legs)
        for name, clip in zip(names, clips, strict=True)
    }
    return Repertoire(pieces, legs)


def piece_of(clip: Clip, *, travels: bool, legs: Sequence[Leg]) -> Piece:
    """Study one clip."""
    stands = standing(clip, legs)
    gait = gait_of(clip, stands) if travels and clip.cyclic else None
    yaw = {
        leg.foot: yaw_of(
            leg, world_of(clip.skeleton, leg.foot, clip.rotation_xyzw, clip.translation_m)[0]
        )
        for leg in legs
    }
    return Piece(clip, travels, ground_root(clip), stands, yaw, gait)
