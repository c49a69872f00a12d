"""Mass: where a body's weight is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from laban.frozen import Frozen
from smd.character.kinematics import joints_in_world, rest_in_world
from smd.character.roles import BodyPlan, LimbPlan, plan_of
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array

LEG = (("upper", "middle", 0.1), ("middle", "end", 0.0465), ("end", "tip", 0.0145))
ARM = (("upper", "middle", 0.028), ("middle", "end", 0.022))
"""Segments of a limb, from joint to joint, with their shares of a body's mass [1]_.

References
----------
.. [1] D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th ed., Wiley 2009,
   table 4.1.
"""

TRUNK, HEAD = 0.497, 0.081
"""The same of the trunk, between the middles of hips and shoulders, and of head and neck."""

ABOVE_SHOULDERS = 0.4
"""How far above the shoulders the centre of the head is, as a share of the trunk's length."""


@dataclass(frozen=True, slots=True, eq=False)
class Mass(Frozen):
    """A body's centre of mass, as a mean of places of its joints.

    Attributes
    ----------
    joints : (k,) int64, those that count.
    share : (k,) of the mass; they add up to 1. One that is below zero lengthens a segment.
    height_m : over the ground at rest.
    """

    joints: IntArray
    share: FloatArray
    height_m: float

    def __post_init__(self) -> None:
        joints = frozen_array("joints", self.joints, (None,), CharacterError, np.int64)
        share = frozen_array("share", self.share, (len(joints),), CharacterError)
        object.__setattr__(self, "joints", joints)
        object.__setattr__(self, "share", share)

    def centre_m(
        self, skeleton: Skeleton, rotation_xyzw: FloatArray, translation_m: FloatArray
    ) -> FloatArray:
        """Return where the centre of mass is ``(n, 3)`` in local poses ``(n, j, …)``."""
        _, place_m = joints_in_world(skeleton, self.joints.tolist(), rotation_xyzw, translation_m)
        return self.mean_m(place_m)

    def mean_m(self, place_m: FloatArray) -> FloatArray:
        """Return the centre of mass ``(…, 3)``, given where its joints are ``(…, k, 3)``."""
        return np.asarray(np.einsum("k,...kc->...c", self.share, place_m))


def mass_of(skeleton: Skeleton) -> Mass | None:
    """Return where a body's weight is; None where no legs carry it."""
    _, place_m = rest_in_world(skeleton)
    plan = plan_of(skeleton)
    legs = [limb for limb in plan.limbs if limb.kind == "leg"]
    if not legs:
        return None
    share = np.zeros(len(skeleton))
    for limb in plan.limbs:
        joints = _joints(limb)
        for one, other, mass in LEG if limb.kind == "leg" else ARM:
            share[[joints[one], joints[other]]] += 0.5 * mass
    _add_trunk(share, plan)
    share /= share.sum()
    counted = np.flatnonzero(share)
    height_m = float(share[counted] @ place_m[counted, 1] - place_m[:, 1].min())
    return Mass(counted, share[counted], height_m)


def _joints(limb: LimbPlan) -> dict[str, int]:
    after = [joint for joint in limb.chain if joint > limb.end]
    tip = after[0] if after else limb.end
    return {"upper": limb.upper, "middle": limb.middle, "end": limb.end, "tip": tip}


def _add_trunk(share: FloatArray, plan: BodyPlan) -> None:
    """Add trunk and head, between what legs and arms hang from, in place."""
    low = [limb.upper for limb in plan.limbs[:2]]  # the hind legs come first
    high = [limb.upper for limb in plan.limbs[2:4]] or [plan.chest]
    for joint in low:
        share[joint] += (0.5 * TRUNK - ABOVE_SHOULDERS * HEAD) / len(low)
    for joint in high:
        share[joint] += (0.5 * TRUNK + (1.0 + ABOVE_SHOULDERS) * HEAD) / len(high)
