"""Poses: local joint rotations and translations over time, sampled from clips and mixed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from smd.character.clip import Clip
from smd.character.tracks import Tracks
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized


class Poses(NamedTuple):
    """Local poses, a frame each.

    Attributes
    ----------
    rotation_xyzw : (n, j, 4) unit.
    translation_m : (n, j, 3).
    """

    rotation_xyzw: FloatArray
    translation_m: FloatArray


def sampled(clip: Clip, frame: FloatArray) -> Poses:
    """Return a clip's poses at fractional frames ``(n,)``, its ground root in place.

    A cyclic clip goes on beyond its ends, any other holds them. Neighbouring frames differ by
    little, so that their rotations are mixed linearly and brought to unit length.
    """
    left, fraction = _neighbours(clip, frame)
    fraction = fraction[:, None, None]
    a, b = clip.rotation_xyzw[left], clip.rotation_xyzw[left + 1]
    rotation = normalized(a + fraction * (b - a))
    a, b = clip.translation_m[left], clip.translation_m[left + 1]
    translation = a + fraction * (b - a)
    rotation[:, 0] = [0.0, 0.0, 0.0, 1.0]
    translation[:, 0, [0, 2]] = 0.0
    return Poses(rotation, translation)


def sampled_tracks(clip: Clip, frame: FloatArray) -> Tracks:
    """Return a clip's tracks at fractional frames ``(n,)``, beyond its ends as `sampled`."""
    return clip.tracks.at(_within(clip, frame))


def _within(clip: Clip, frame: FloatArray) -> FloatArray:
    """Return which of a clip's own fractional frames is shown at any."""
    last = len(clip) - 1
    return np.asarray(np.mod(frame, last) if clip.cyclic else np.clip(frame, 0.0, last))


def _neighbours(clip: Clip, frame: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the frames to the left of fractional ones, and how far beyond them they are."""
    frame = _within(clip, frame)
    left = np.minimum(frame.astype(np.int64), len(clip) - 2)
    return left, frame - left


def mixed(a: Poses, b: Poses, share: FloatArray) -> Poses:
    """Return poses ``share (n,)`` of the way from ``a`` to ``b``, each joint by its shorter way."""
    share = share[:, None, None]
    same = np.sum(a.rotation_xyzw * b.rotation_xyzw, axis=-1, keepdims=True)
    toward = np.where(same < 0.0, -b.rotation_xyzw, b.rotation_xyzw)
    return Poses(
        normalized(a.rotation_xyzw + share * (toward - a.rotation_xyzw)),
        a.translation_m + share * (b.translation_m - a.translation_m),
    )
