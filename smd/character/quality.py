"""Quality: what can be measured of any clip, and what of it is a flaw."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.geometry.arrays import FloatArray

MOST_SLIDE_M_S = 0.02
"""Mean speed of joints while they are planted: more is seen as sliding."""

MOST_GAP_RAD = 1e-3
"""How far a joint of a cycle may be from its first turn in its last frame."""

MOST_TRACK_GAP = 1e-3
"""How far a track of a cycle may be from its first value in its last frame."""

LEAST_TRAVEL_M = 0.05
"""Way of a clip that travels."""

FASTEST_RAD_S = 40.0
"""A joint that turns faster has jumped from one frame to the next."""


def flaws(clip: Clip, *, travels: bool) -> Iterator[str]:
    """Yield what is wrong with a clip, each a phrase that goes on from "its clip".

    Parameters
    ----------
    travels
        Whether its action does.
    """
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    slide = mean_slide_m_s(clip, place)
    if slide > MOST_SLIDE_M_S:
        yield f"slides on planted feet: {slide:.2f} m/s on average, expected {MOST_SLIDE_M_S}"
    if clip.cyclic and (gap := pose_gap_rad(clip)) > MOST_GAP_RAD:
        yield f"does not close: its last pose is {np.degrees(gap):.1f}° from its first"
    if clip.cyclic and (open_ := open_tracks(clip)):
        yield f"does not close: {', '.join(open_)} end with other values than they begin"
    if travels and clip.cyclic and clip.travel_m < LEAST_TRAVEL_M:
        yield "travels nowhere, but its action travels"
    if (fastest := fastest_turn_rad_s(clip)) > FASTEST_RAD_S:
        yield f"jumps: a joint turns {np.degrees(fastest / clip.rate_hz):.0f}° in a frame"


def mean_slide_m_s(clip: Clip, position_m: FloatArray) -> float:
    """Return the mean speed of joints over the ground while they are planted; 0 if none ever is.

    Parameters
    ----------
    position_m
        ``(n, j, 3)`` of the clip's joints in the world.
    """
    speeds = [np.zeros(0)]
    for column, joint in enumerate(clip.contact_joints):
        path = position_m[:, clip.skeleton.index(joint)][:, ::2]
        speed = np.linalg.norm(np.diff(path, axis=0), axis=-1) * clip.rate_hz
        speeds.append(speed[clip.contacts[:-1, column] & clip.contacts[1:, column]])
    every = np.concatenate(speeds)
    return float(every.mean()) if len(every) else 0.0


def pose_gap_rad(clip: Clip) -> float:
    """Return the greatest difference of a joint's local turn between first and last frame."""
    dots = np.abs(np.sum(clip.rotation_xyzw[0, 1:] * clip.rotation_xyzw[-1, 1:], axis=-1))
    return float(2.0 * np.arccos(np.clip(dots, -1.0, 1.0)).max())


def open_tracks(clip: Clip) -> tuple[str, ...]:
    """Return the names of the tracks whose last value differs from their first."""
    gap = np.abs(clip.tracks.value[-1] - clip.tracks.value[0])
    return tuple(np.array(clip.tracks.names, dtype=object)[gap > MOST_TRACK_GAP])


def fastest_turn_rad_s(clip: Clip) -> float:
    """Return the greatest speed at which a joint turns from frame to frame."""
    q = clip.rotation_xyzw
    dots = np.abs(np.sum(q[:-1] * q[1:], axis=-1))
    return float(2.0 * np.arccos(np.clip(dots, 0.0, 1.0)).max()) * clip.rate_hz
