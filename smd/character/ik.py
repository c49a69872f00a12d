"""Two-bone inverse kinematics: arms and legs, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from laban.frozen import Frozen
from smd.character.kinematics import rest_in_world
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, frozen_array
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_between,
    quaternion_from_rotvec,
    rotate,
)

_PARALLEL = 1e-9
"""Sine below which a pole says nothing about the plane a limb bends in."""


@dataclass(frozen=True, slots=True, eq=False)
class Limb(Frozen):
    """Two bones that bend one way: thigh and shin, or upper arm and forearm.

    Attributes
    ----------
    upper_bone_m : (3,) from the upper joint to the middle one, in the upper joint's frame.
    lower_bone_m : (3,) from the middle joint to the end, in the middle joint's frame.
    upper_hinge : (3,) unit axis about which the limb folds, in the upper joint's frame.
    lower_hinge : (3,) the same axis in the middle joint's frame.
    """

    upper_bone_m: FloatArray
    lower_bone_m: FloatArray
    upper_hinge: FloatArray
    lower_hinge: FloatArray

    def __post_init__(self) -> None:
        for name in ("upper_bone_m", "lower_bone_m", "upper_hinge", "lower_hinge"):
            vector = frozen_array(name, getattr(self, name), (3,), CharacterError)
            if np.linalg.norm(vector) < _PARALLEL:
                raise CharacterError(f"limb: {name}: expected a length above zero, got {vector}")
            object.__setattr__(self, name, vector)

    @property
    def upper_length_m(self) -> float:
        """Length of the upper bone."""
        return float(np.linalg.norm(self.upper_bone_m))

    @property
    def lower_length_m(self) -> float:
        """Length of the lower bone."""
        return float(np.linalg.norm(self.lower_bone_m))

    @property
    def reach_m(self) -> float:
        """Length of the straight limb."""
        return self.upper_length_m + self.lower_length_m

    def span_m(self, bend_rad: ArrayLike) -> FloatArray:
        """Return the distance from the upper joint to the end when bent by ``bend_rad``."""
        a, b = self.upper_length_m, self.lower_length_m
        return np.sqrt(a * a + b * b + 2.0 * a * b * np.cos(np.asarray(bend_rad, dtype=np.float64)))

    def reachable_m(self, distance_m: ArrayLike, softness: float = 0.0) -> FloatArray:
        """Return the distance from the upper joint to the end that is taken for a wanted one.

        Parameters
        ----------
        softness
            Last fraction of the reach in which the limb straightens ever more slowly.
        """
        nearest = abs(self.upper_length_m - self.lower_length_m) + _PARALLEL
        zone = self.reach_m * softness
        wanted = np.maximum(np.asarray(distance_m, dtype=np.float64), nearest)
        if zone == 0.0:
            return np.minimum(wanted, self.reach_m)
        hard = self.reach_m - zone
        beyond = np.maximum(wanted - hard, 0.0)
        return np.where(beyond > 0, hard + zone * (1.0 - np.exp(-beyond / zone)), wanted)

    def bend_rad(self, span_m: ArrayLike) -> FloatArray:
        """Return how far the limb is bent, 0 when straight, for a distance it can take."""
        a, b = self.upper_length_m, self.lower_length_m
        span = np.asarray(span_m, dtype=np.float64)
        return np.arccos(np.clip((span * span - a * a - b * b) / (2.0 * a * b), -1.0, 1.0))


def limb_of(skeleton: Skeleton, upper: str, middle: str, end: str, rest_pole: ArrayLike) -> Limb:
    """Return the limb of three joints, of which each is the parent of the next.

    Parameters
    ----------
    rest_pole
        ``(3,)`` where the middle joint points when the resting limb bends, in the world: ahead
        for a knee, behind for an elbow. The limb folds away from it.

    Raises
    ------
    CharacterError
        If the joints do not follow each other, a bone has no length, or the pole lies along
        the limb.
    """
    u, m, e = skeleton.index(upper), skeleton.index(middle), skeleton.index(end)
    if skeleton.parents[m] != u or skeleton.parents[e] != m:
        raise CharacterError(f"limb: expected {upper!r}, {middle!r}, {end!r} each to hold the next")
    world_q, world_p = rest_in_world(skeleton)
    hinge = np.cross(normalized(rest_pole), normalized(world_p[e] - world_p[u]))
    return Limb(
        upper_bone_m=skeleton.rest_translation_m[m],
        lower_bone_m=skeleton.rest_translation_m[e],
        upper_hinge=normalized(rotate(inverse(world_q[u]), hinge)),
        lower_hinge=normalized(rotate(inverse(world_q[m]), hinge)),
    )


def two_bone_ik(
    limb: Limb,
    base_m: ArrayLike,
    target_m: ArrayLike,
    pole: ArrayLike,
    *,
    softness: float = 0.0,
) -> tuple[FloatArray, FloatArray]:
    """Turn a limb's two joints so that its end is at the target.

    The law of cosines gives the bend; the pole gives the plane it bends in. The hinge never
    turns over, so a knee or elbow bends one way whatever the target.

    Parameters
    ----------
    base_m, target_m
        ``(…, 3)`` where the upper joint is and where the end should be, in the world.
    pole
        ``(…, 3)`` direction in which the middle joint points, of any length. Only its part
        across the limb counts; where it has none, some plane is chosen.
    softness
        Last fraction of the reach in which the limb straightens ever more slowly and so falls
        short of its target a little. Without it a limb snaps straight: its bend changes
        infinitely fast with distance at full reach.

    Returns
    -------
    upper_xyzw, lower_xyzw
        ``(…, 4)`` rotations in the world of the upper and the middle joint. Out of reach, the
        limb stretches toward the target; nearer than it can fold, it folds toward it.
    """
    base, target, pole = np.broadcast_arrays(
        np.asarray(base_m, np.float64), np.asarray(target_m, np.float64), np.asarray(pole, float)
    )
    distance = np.linalg.norm(target - base, axis=-1)
    toward = np.where(distance[..., None] > _PARALLEL, normalized(target - base), [0.0, -1.0, 0.0])
    span = limb.reachable_m(distance, softness)
    across = _across(toward, pole)

    a, b = limb.upper_length_m, limb.lower_length_m
    cosine = np.clip((a * a + span**2 - b * b) / (2.0 * a * span), -1.0, 1.0)[..., None]
    upper = toward * cosine + across * np.sqrt(1.0 - cosine * cosine)
    lower = normalized(toward * span[..., None] - upper * a)
    hinge = normalized(np.cross(across, toward))
    return (
        _turn(limb.upper_bone_m, limb.upper_hinge, upper, hinge),
        _turn(limb.lower_bone_m, limb.lower_hinge, lower, hinge),
    )


def _across(toward: FloatArray, pole: FloatArray) -> FloatArray:
    """Return the unit part of the pole across the limb, or of any direction where it has none."""
    pole = normalized(pole)
    part = pole - toward * np.sum(pole * toward, axis=-1, keepdims=True)
    spare = np.where(np.abs(toward[..., 2:]) < 0.9, [0.0, 0.0, 1.0], [0.0, 1.0, 0.0])
    spare = spare - toward * np.sum(spare * toward, axis=-1, keepdims=True)
    clear = np.linalg.norm(part, axis=-1, keepdims=True) > _PARALLEL
    return normalized(np.where(clear, part, spare))


def _turn(
    bone: FloatArray, hinge: FloatArray, to_bone: FloatArray, to_hinge: FloatArray
) -> FloatArray:
    """Return the rotation that takes a bone's direction and its hinge to wanted ones."""
    swing = quaternion_between(np.broadcast_to(bone, to_bone.shape), to_bone)
    have = rotate(swing, np.broadcast_to(hinge, to_bone.shape))
    # Both hinges are seen across the bone; what is left is a twist about it.
    have = have - to_bone * np.sum(have * to_bone, axis=-1, keepdims=True)
    sine = np.sum(np.cross(have, to_hinge) * to_bone, axis=-1, keepdims=True)
    cosine = np.sum(have * to_hinge, axis=-1, keepdims=True)
    return multiply(quaternion_from_rotvec(to_bone * np.arctan2(sine, cosine)), swing)
