"""Pushes: how feet that push and let go carry a body along, up and down and to and fro."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from actions_library.authoring.posing import RATE_HZ
from smd.acting.flight import GRAVITY_M_S2
from smd.geometry.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Push:
    """A foot that pushes on the ground.

    Attributes
    ----------
    start, end : when it does, within the cycle (s).
    before, after : how far the body is past the foot then (m); below 0 while it is still coming.
    """

    start: float
    end: float
    before: float
    after: float


def driven(
    pushes: Sequence[Push], duration_s: float, *, height_m: float
) -> tuple[FloatArray, FloatArray]:
    """Return how a body leaves steady travel, frame by frame of a cycle.

    Between pushes it falls freely. Pushes bear it evenly, and the body moves away from them as an
    inverted pendulum does [1]_: its acceleration over the ground is to the load as its distance
    from the foot is to its height. What would make it faster from cycle to cycle is taken from all
    of them.

    Parameters
    ----------
    pushes
        One at a time.
    duration_s
        Of the cycle, whole frames of `RATE_HZ`.
    height_m
        Of the mass centre.

    Returns
    -------
    up_m, along_m
        ``(n,)``, 0 in the mean; the cycle's end is left out.

    References
    ----------
    .. [1] S. Kajita et al., "The 3D linear inverted pendulum mode", IROS 2001.
    """
    frames = round(duration_s * RATE_HZ)
    edge_s = (np.arange(frames + 1) - 0.5) / RATE_HZ  # a frame stands for the time about it
    bears, past_m = np.zeros(frames), np.zeros(frames)
    for push in pushes:
        for lap_s in (-duration_s, 0.0, duration_s):
            inside_s = np.clip(edge_s + lap_s, push.start, push.end)
            share = np.diff(inside_s) * RATE_HZ
            middle_s = 0.5 * (inside_s[1:] + inside_s[:-1])
            ends = [push.start, push.end], [push.before, push.after]
            bears += share
            past_m += share * np.interp(middle_s, *ends)
    past_m -= bears * past_m.sum() / bears.sum()
    load_m_s2 = GRAVITY_M_S2 / bears.mean()
    up_m = _travelled_m(load_m_s2 * bears - GRAVITY_M_S2)
    return up_m, _travelled_m(load_m_s2 / height_m * past_m)


def _travelled_m(acceleration_m_s2: FloatArray) -> FloatArray:
    """Return a cycle's way whose second differences are an acceleration; 0 in the mean."""
    step_m = np.cumsum(acceleration_m_s2) / RATE_HZ**2
    way_m = np.cumsum(step_m - step_m.mean())
    return np.asarray(np.roll(way_m - way_m.mean(), 1))
