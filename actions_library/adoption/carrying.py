"""Retargeting a movement to another skeleton of the same kind, by the roles of its joints.

A joint's rotation from its rest pose is applied to the other body too, after the difference of the
two rest poses is removed: a bone that points down at rest in one and sideways in the other points
the same way in every pose. The movement of the pelvis is scaled by leg length.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from smd.character.roles import BodyPlan, LimbPlan
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_between,
)

LEAST_LEG = 0.4
"""Of a body's height: shorter legs stand on feet that are large for them."""


def partners(source: BodyPlan, target: BodyPlan) -> dict[int, int]:
    """Return for joints of a target the corresponding joint of a source.

    Raises
    ------
    CharacterError
        If a limb of the target has no partner, or there are limbs of a kind that it lacks.
    """
    lacking = [_called(x, target) for x in target.limbs if _partner(x, target, source) is None]
    over = [_called(x, source) for x in source.limbs if _partner(x, source, target) is None]
    if lacking or over:
        missing = f"the clip lacks {', '.join(lacking)}" if lacking else ""
        more = f"the character lacks {', '.join(over)}" if over else ""
        raise CharacterError(
            "skeletons: expected two of the same kind, found that "
            + "; ".join(part for part in (missing, more) if part)
        )
    found = {target.pelvis: source.pelvis}
    found.update(_along(source.spine, target.spine))
    for limb in target.limbs:
        other = _partner(limb, target, source)
        assert other is not None
        found.update(_limb(other, limb))
    return found


def _called(limb: LimbPlan, plan: BodyPlan) -> str:
    alike = [x for x in plan.limbs if (x.kind, x.side) == (limb.kind, limb.side)]
    return f"{'a' if alike.index(limb) == 0 else 'another'} {limb.side} {limb.kind}"


def _partner(limb: LimbPlan, own: BodyPlan, other: BodyPlan) -> LimbPlan | None:
    """Return the limb of the same kind, side and place in the order from back to front."""
    alike = [x for x in own.limbs if (x.kind, x.side) == (limb.kind, limb.side)]
    others = [x for x in other.limbs if (x.kind, x.side) == (limb.kind, limb.side)]
    at = alike.index(limb)
    return others[at] if at < len(others) else None


def _along(source: tuple[int, ...], target: tuple[int, ...]) -> Iterator[tuple[int, int]]:
    """Yield corresponding joints in two chains of any length: the last ones, others by share."""
    for i, joint in enumerate(target):
        share = (i + 1) / len(target)
        if source:
            yield joint, source[max(round(share * len(source)), 1) - 1]


def _limb(source: LimbPlan, target: LimbPlan) -> Iterator[tuple[int, int]]:
    """Yield corresponding joints in two limbs: the three of its bones, those before and beyond."""
    yield from zip(
        (target.upper, target.middle, target.end),
        (source.upper, source.middle, source.end),
        strict=True,
    )
    before, other = (x.chain[: x.chain.index(x.upper)] for x in (target, source))
    yield from zip(reversed(before), reversed(other), strict=False)
    beyond, further = (x.chain[x.chain.index(x.end) + 1 :] for x in (target, source))
    yield from zip(beyond, further, strict=False)


def carried_over(
    rotation_xyzw: FloatArray,
    source_rest: tuple[FloatArray, FloatArray],
    target_rest: tuple[FloatArray, FloatArray],
    target_parents: list[int],
    moves: dict[int, int],
    source_children: dict[int, int],
    target_children: dict[int, int],
) -> FloatArray:
    """Return the target's joints in the world, ``(n, j, 4)``.

    Parameters
    ----------
    rotation_xyzw
        ``(n, k, 4)`` of the source's joints in the world.
    source_rest, target_rest
        Rotations and positions of the joints in the world at rest.
    target_parents
        ``(j,)``; a joint that nothing moves keeps its place on its parent.
    moves
        The joint of the source that moves each of the target.
    source_children, target_children
        The joint that a bone points to, by the joint it begins at.
    """
    rest_q, rest_p = target_rest
    n, j = len(rotation_xyzw), len(rest_q)
    world = np.empty((n, j, 4))
    for joint in range(j):
        parent = target_parents[joint]
        if joint in moves:
            other = moves[joint]
            turned = multiply(rotation_xyzw[:, other], inverse(source_rest[0][other]))
            alike = _alike(joint, other, source_rest[1], rest_p, source_children, target_children)
            world[:, joint] = multiply(turned, multiply(alike, rest_q[joint]))
        elif parent >= 0:
            local = multiply(inverse(rest_q[parent]), rest_q[joint])
            world[:, joint] = multiply(world[:, parent], local)
        else:
            world[:, joint] = rest_q[joint]
    return world


def _alike(
    joint: int,
    other: int,
    source_place: FloatArray,
    target_place: FloatArray,
    source_children: dict[int, int],
    target_children: dict[int, int],
) -> FloatArray:
    """Return the turn that makes a bone of the target point at rest as its partner does."""
    if joint not in target_children or other not in source_children:
        return np.array([0.0, 0.0, 0.0, 1.0])
    own = target_place[target_children[joint]] - target_place[joint]
    wanted = source_place[source_children[other]] - source_place[other]
    if min(np.linalg.norm(own), np.linalg.norm(wanted)) < 1e-6:
        return np.array([0.0, 0.0, 0.0, 1.0])
    return quaternion_between(own, wanted)


def bones(plan: BodyPlan) -> dict[int, int]:
    """Return the joint that each bone of limbs and spine points to."""
    found = dict(zip((plan.pelvis, *plan.spine[:-1]), plan.spine, strict=False))
    for limb in plan.limbs:
        found.update(zip(limb.chain[:-1], limb.chain[1:], strict=True))
        found[limb.upper], found[limb.middle] = limb.middle, limb.end
    return found


def stature_m(plan: BodyPlan, place: FloatArray) -> float:
    """Return what lengths of a body are measured by: its legs' length, more if they are short."""
    return max(leg_length_m(plan, place), LEAST_LEG * float(np.ptp(place[:, 1])))


def leg_length_m(plan: BodyPlan, place: FloatArray) -> float:
    """Return how high the pelvis is above the feet at rest, or above the lowest joint."""
    feet = [limb.end for limb in plan.limbs if limb.kind == "leg"]
    ground = place[feet, 1].mean() if feet else place[:, 1].min()
    return max(float(place[plan.pelvis, 1] - ground), 1e-6)
