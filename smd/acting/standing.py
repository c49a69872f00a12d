"""Standing: when each foot of a clip bears weight on the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.acting.legs import Leg, feet_of
from smd.character.clip import Clip
from smd.character.kinematics import joints_in_world
from smd.geometry.arrays import BoolArray, FloatArray
from smd.geometry.rotations import rotate

TOUCHING_M = 0.005
"""Height up to which a point of the sole touches the ground."""

RESTING_M_S = 0.1
"""Speed up to which a touching point rests: slower than a heel that drags."""


def standing(
    clip: Clip,
    legs: Sequence[Leg],
    feet: Sequence[int] | None = None,
    rests: BoolArray | None = None,
) -> dict[int, BoolArray]:
    """Return when each foot stands ``(n,)``, by its joint.

    It stands when the clip labels it or a joint below it as a contact. It also stands next to such
    frames, where its heel or its ball rests on the ground: clips label soles and toes, but a step
    begins on the heel.

    Parameters
    ----------
    feet
        Joints; by default `feet_of` the clip.
    rests
        ``(n, legs)`` of the legs' feet, where known: `resting`.
    """
    feet = feet_of(clip) if feet is None else feet
    labelled = {foot: np.zeros(len(clip), dtype=bool) for foot in feet}
    for joint, touches in zip(clip.contact_joints, clip.contacts.T, strict=True):
        foot = clip.skeleton.index(joint)
        while foot >= 0 and foot not in labelled:
            foot = int(clip.skeleton.parents[foot])
        if foot >= 0:  # no foot: a hand
            labelled[foot] |= touches
    if rests is None:
        local = clip.rotation_xyzw, clip.translation_m
        world = joints_in_world(clip.skeleton, [leg.foot for leg in legs], *local)
        rests = resting(legs, *world, clip.rate_hz)
    for i, leg in enumerate(legs):
        if leg.foot in labelled and labelled[leg.foot].any():
            labelled[leg.foot] |= rests[:, i]
    return labelled


def resting(
    legs: Sequence[Leg], foot_xyzw: FloatArray, ankle_m: FloatArray, rate_hz: float
) -> BoolArray:
    """Return when heels or balls of feet rest on the ground ``(n, …, legs)``.

    Parameters
    ----------
    foot_xyzw, ankle_m
        ``(n, …, legs, 4)`` and ``(n, …, legs, 3)`` in the clip's own world.
    """
    rests = np.zeros(ankle_m.shape[:-1], dtype=bool)
    if not legs:
        return rests
    balls = [leg.ball_height_m for leg in legs]
    for points_m, height_m in (
        ([leg.heel_m for leg in legs], np.zeros(len(legs))),
        ([leg.ball_m for leg in legs], np.array(balls)),
    ):
        place = ankle_m + rotate(foot_xyzw, np.array(points_m))
        step = np.diff(place, axis=0)
        still = np.hypot(step[..., 0], step[..., 2]) * rate_hz < RESTING_M_S
        touches = place[..., 1] - height_m < TOUCHING_M
        rests[1:] |= still & touches[1:]
        rests[:-1] |= still & touches[:-1]
    return rests
