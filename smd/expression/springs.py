"""Springs: joints that follow their motion with a lag, or are held (Laban's Flow)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.character.clip import Clip
from smd.character.poses import Poses
from smd.expression.body import Body
from smd.geometry.arrays import FloatArray
from smd.geometry.easing import gaussian_smoothed, smootherstep
from smd.geometry.rotations import normalized, sign_continuous

SPRING_HZ, SOFTER = 4.0, 0.85
"""Frequency of a joint next to the trunk, and the factor on it for each joint further out."""

DAMPING = 0.3
"""Damping ratio: these springs overshoot by 3/8, then by 1/7. A hinge is critically damped (1), so
that no elbow overextends."""

DIED_AWAY = 12.0
"""Time constants after which a spring is at rest: 6 millionths are left."""

DAMPED_S = 0.07
"""Smoothing of bound movement."""


def sprung(poses: Poses, clip: Clip, joints: Sequence[int], body: Body, share: FloatArray) -> Poses:
    """Return poses in which joints lag, overshoot and overlap, each following by a spring.

    Parameters
    ----------
    poses
        ``(n, …, j, 4)``, as those of an operator.
    clip
        Whose they are, changed or not.
    share
        ``(n, …)`` from 0, the poses themselves, to 1, the spring's.
    """
    at = list(joints)
    softer = np.array([SOFTER ** _depth(clip, joint, body) for joint in at])
    omega = 2.0 * np.pi * SPRING_HZ / clip.rate_hz * softer
    damping = np.array([1.0 if joint in body.hinges else DAMPING for joint in at])
    own = sign_continuous(poses.rotation_xyzw[..., at, :])
    swung = _swung(_laps(own) if clip.cyclic else own, omega, damping)[-len(own) :]
    return _with(poses, at, _mixed(own, swung, share))


def damped(poses: Poses, clip: Clip, joints: Sequence[int], share: FloatArray) -> Poses:
    """Return poses whose joints lose quick, small movements; parameters as in `sprung`."""
    at = list(joints)
    own, n = sign_continuous(poses.rotation_xyzw[..., at, :]), len(clip) - 1
    whole = _laps(own) if clip.cyclic else own
    even = gaussian_smoothed(whole, DAMPED_S * clip.rate_hz)
    if clip.cyclic:
        even = even[n : 2 * n + 1]
    return _with(poses, at, _mixed(own, even, share))


def _with(poses: Poses, joints: list[int], rotation_xyzw: FloatArray) -> Poses:
    """Return poses in which some joints are rotated otherwise."""
    rotation = poses.rotation_xyzw.copy()
    rotation[..., joints, :] = rotation_xyzw
    return Poses(rotation, poses.translation_m)


def _laps(own: FloatArray) -> FloatArray:
    """Return a cycle three times over, its first frame being its last one again."""
    return sign_continuous(np.concatenate([own[:-1], own[:-1], own]))


def _swung(wanted: FloatArray, omega: FloatArray, damping: FloatArray) -> FloatArray:
    """Return how springs follow values ``(n, …, j, 4)`` from rest; ``omega`` is in radians a frame.

    x'' = omega^2 (wanted - x) - 2 damping omega x', by the trapezoidal rule: stable for any omega.
    It is solved in the frequency domain, with room after the end for the swing to decay.
    """
    half = 0.5 * omega
    size = len(wanted) + int(np.ceil(DIED_AWAY / (omega * damping).min()))
    late = np.exp(-2j * np.pi * np.arange(size // 2 + 1) / size)[:, None]  # by one frame
    pull = (half * (1.0 + late)) ** 2
    response = pull / ((1.0 - late) ** 2 + 2.0 * damping * half * (1.0 - late**2) + pull)
    response = response.reshape(len(late), *(1,) * (wanted.ndim - 3), len(omega), 1)
    moved = np.fft.rfft(wanted - wanted[:1], size, axis=0) * response
    return wanted[:1] + np.fft.irfft(moved, size, axis=0)[: len(wanted)]


def _mixed(own: FloatArray, other: FloatArray, share: FloatArray) -> FloatArray:
    other = np.where(np.sum(own * other, axis=-1, keepdims=True) < 0.0, -other, other)
    return normalized(own + share[..., None, None] * (other - own))


def _depth(clip: Clip, joint: int, body: Body) -> int:
    """Return the number of joints between one and the trunk."""
    depth = 0
    parent = int(clip.skeleton.parents[joint])
    while parent >= 0 and parent not in body.spine:
        depth, parent = depth + 1, int(clip.skeleton.parents[parent])
    return depth if parent >= 0 else 0


def settled(n: int, edge: float) -> FloatArray:
    """Return 1, but rising over the first ``edge`` of ``n`` frames and falling over the last."""
    u = np.arange(n) / (n - 1)
    return smootherstep(np.minimum(u, 1.0 - u) / edge)
