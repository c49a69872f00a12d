"""Body work: how hard a clip pushes the mass of a body about, at its own pace."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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


def body_works(
    root_m: FloatArray, centre_m: FloatArray, rate_hz: float, *, travels: bool
) -> list[BodyWork]:
    """Return what clips of one length ask of the mass of a body.

    Parameters
    ----------
    root_m, centre_m
        ``(n, e, 3)`` their ground roots and centres of mass, each in its own world.
    """
    if travels:
        centre_m = centre_m - (root_m - root_m[:1]) * [1.0, 0.0, 1.0]
    steady_m = gaussian_smoothed(centre_m, STEADIED_S * rate_hz)
    push = np.gradient(np.gradient(steady_m, axis=0), axis=0) * rate_hz**2
    aside, up = np.linalg.norm(push[..., [0, 2]], axis=-1), push[..., 1]
    around = _around(np.stack([aside, up, -up], axis=1), rate_hz)
    return [
        BodyWork(centre_m[:, i], *(around[:, of, i] for of in range(3)))
        for i in range(centre_m.shape[1])
    ]


def _around(value: FloatArray, rate_hz: float) -> FloatArray:
    """Return the greatest values around each frame ``(n, …)``, softly."""
    reach = int(np.ceil(AROUND_S * rate_hz))
    padded = np.concatenate([value[:1].repeat(reach, 0), value, value[-1:].repeat(reach, 0)])
    near = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=0)
    return gaussian_smoothed(near.max(axis=-1), 0.5 * reach)
