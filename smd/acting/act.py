"""Acting: the moves of a performer, or its poses, become an actor with its feet on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from smd.acting.flight import flights, height_of, in_air, raised
from smd.acting.grounding import Rise, grounded, level
from smd.acting.legs import Leg
from smd.acting.move import Footwork, Move, Playable
from smd.acting.moving import Idling, placed, posed, stepped, tracked
from smd.acting.performance import Actor
from smd.acting.slope import slope
from smd.acting.terrain import Terrain
from smd.character.character import Character
from smd.character.mass import Mass
from smd.character.poses import Poses
from smd.character.roles import without_digits
from smd.character.tracks import NO_TRACKS, Tracks
from smd.doodle import Doodle
from smd.errors import TransferError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.score import Phrase


@dataclass(frozen=True, slots=True)
class Frames:
    """When the frames of a performance are.

    Attributes
    ----------
    start_s : of frame 0.
    rate_hz : frames per second, positive.
    count : at least 1.
    """

    start_s: float
    rate_hz: float
    count: int

    @property
    def time_s(self) -> FloatArray:
        """Time of each frame, ``(count,)``."""
        return self.start_s + np.arange(self.count) / self.rate_hz


def act(
    name: str,
    character: Character,
    moves: Sequence[Move[Playable]],
    idling: Idling,
    legs: Sequence[Leg],
    frames: Frames,
    *,
    phrases: Sequence[Phrase] = (),
    doodles: Sequence[Doodle] = (),
    terrain: Terrain | None = None,
    mass: Mass | None = None,
) -> Actor:
    """Act out moves, one after the other.

    Parameters
    ----------
    name
        Of the actor.
    character
        The one whose skeleton the moves pose.
    moves
        From the first of the frames to the last.
    idling
        The idle clip, seen where the blend weight of a move is below 1.
    legs
        Those of the moves' foot contacts, in their order.
    frames
        Times of the poses.
    phrases, doodles
        What it performs, and its doodles: their heights decide those of its flights.
    terrain
        The ground; by default level.
    mass
        Where the body's weight is, if it is to be brought over its feet.

    Raises
    ------
    TransferError
        If there is no ground below its path, or several surfaces one above another.
    """
    time_s, joints = frames.time_s, without_digits(character.skeleton)
    flown = list(flights(moves, height_of(doodles) if doodles else None))
    return grounded_actor(
        name,
        character,
        placed(posed(moves, time_s, idling, joints), moves, time_s, frames.rate_hz),
        stepped(moves, time_s, idling),
        legs,
        start_s=frames.start_s,
        rate_hz=frames.rate_hz,
        rise=Rise(*raised(flown, time_s), in_air(flown, time_s)),
        phrases=phrases,
        doodles=doodles,
        terrain=terrain,
        mass=mass,
        tracks=tracked(moves, time_s, idling, joints),
    )


def grounded_actor(
    name: str,
    character: Character,
    poses: Poses,
    footwork: Footwork,
    legs: Sequence[Leg],
    *,
    rate_hz: float,
    start_s: float = 0.0,
    rise: Rise | None = None,
    phrases: Sequence[Phrase] = (),
    doodles: Sequence[Doodle] = (),
    terrain: Terrain | None = None,
    mass: Mass | None = None,
    tracks: Tracks = NO_TRACKS,
) -> Actor:
    """Put poses on the ground: feet that should stand do, and none is in the ground.

    Call it directly if you have poses and their foot contacts.

    Parameters
    ----------
    poses
        Of the character, one per frame, with the ground root at its position on level ground.
    footwork
        Contacts of the feet of ``legs`` in each frame.
    rate_hz, start_s
        Frames per second, and the time of frame 0.
    rise
        How much higher than in the poses the body and its feet are.
    tracks
        Weights of shapes and other controls in each frame.

    The others are those of `act`.

    Raises
    ------
    TransferError
        As in `act`; if the rate is not positive; or if poses, footwork, rise and tracks do not fit
        the skeleton, the legs and each other.
    """
    poses, footwork = _fitting(character, poses, footwork, legs, rate_hz)
    count = len(poses.rotation_xyzw)
    rise = rise or level(count)
    if len(rise.flies) != count:
        raise TransferError(f"rise: expected {count} frames, as poses have, got {len(rise.flies)}")
    ground = None
    if terrain is not None:
        way, time_s = poses.translation_m[:, 0, [0, 2]], Frames(start_s, rate_hz, count).time_s
        ground = slope(terrain, way, rise.flies, time_s, rate_hz, name)
    done = grounded(character.skeleton, poses, footwork, legs, rate_hz, rise, ground, mass)
    return Actor(name, character, done, tuple(phrases), tuple(doodles), tracks)


def _fitting(
    character: Character, poses: Poses, footwork: Footwork, legs: Sequence[Leg], rate_hz: float
) -> tuple[Poses, Footwork]:
    """Return poses and footwork as arrays, or raise TransferError where they do not fit."""
    if not (np.isfinite(rate_hz) and rate_hz > 0.0):
        raise TransferError(f"rate_hz: expected a positive number, got {rate_hz!r}")
    joints = len(character.skeleton)
    rotation = frozen_array("rotation_xyzw", poses.rotation_xyzw, (None, joints, 4), TransferError)
    count = len(rotation)
    if count == 0:
        raise TransferError("poses: expected at least one frame, got none")
    of_joints = (count, joints, 3)
    translation = frozen_array("translation_m", poses.translation_m, of_joints, TransferError)
    shape = (count, len(legs))
    return Poses(rotation, translation), Footwork(
        frozen_array("stands", footwork.stands, shape, TransferError, np.bool_),
        frozen_array("pivot_rad", footwork.pivot_rad, shape, TransferError),
    )
