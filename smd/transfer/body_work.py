"""Body work: how hard a clip pushes the mass of a body about, at its own pace."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from smd.character.clip import Clip
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed

STEADIED_S = 0.04
"""Smoothing of the centre of mass before its acceleration is taken."""

AROUND_S = 0.08
"""Time around a push that it takes too: a pace cannot change within it."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyWork:
    """What a clip asks of the mass of a body.

    Attributes
    ----------
    centre_m : (n, 3) the centre of mass; of what travels, seen from the ground root.
    aside_m_s2, up_m_s2, down_m_s2 : (n,) its acceleration over the ground, upwards and downwards,
        the greatest around each frame.
    """

    centre_m: FloatArray
    aside_m_s2: FloatArray
    up_m_s2: FloatArray
    down_m_s2: FloatArray


def body_work(clip: Clip, centre_m: FloatArray, *, travels: bool) -> BodyWork:
    """Return what a clip asks of the mass of a body.

    Parameters
    ----------
    centre_m
        ``(n, 3)`` its centre of mass, in the clip's own world.
    """
    if travels:
        went_m = clip.translation_m[:, 0] - clip.translation_m[0, 0]
        centre_m = centre_m - went_m * [1.0, 0.0, 1.0]
    steady_m = gaussian_smoothed(centre_m, STEADIED_S * clip.rate_hz)
    push = np.gradient(np.gradient(steady_m, axis=0), axis=0) * clip.rate_hz**2
    aside = np.linalg.norm(push[:, [0, 2]], axis=-1)
    around = [_around(value, clip.rate_hz) for value in (aside, push[:, 1], -push[:, 1])]
    return BodyWork(centre_m, *around)


def _around(value: FloatArray, rate_hz: float) -> FloatArray:
    """Return the greatest value around each frame ``(n,)``, softly."""
    reach = int(np.ceil(AROUND_S * rate_hz))
    padded = np.pad(value, reach, mode="edge")
    highest = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).max(axis=-1)
    return gaussian_smoothed(highest, 0.5 * reach)
