"""Skin weights of the shipped humanoid: which joints move a point, and how much.

Weights pass from joint to joint in soft steps across planes through the joints, first for the
left half, then mirrored. A limb's share follows from which part's surface a point lies on, so that
a hand hanging at the thigh never pulls it along; a few rounds of averaging over the mesh then take
out what is left of the steps' corners.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from actions_library.authoring.body_shape import BodyFields, finger_bones
from actions_library.authoring.body_surface import adjacency
from actions_library.authoring.hand_shape import DOWN_45, left_fingers
from actions_library.authoring.rigging import other_side
from smd.character.character import MAX_INFLUENCES
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray, IntArray
from smd.geometry.rotations import normalized

SMOOTHING_ROUNDS = 6
"""Rounds of averaging with the neighbours."""

FINGERS_BLEND_M = 0.0015
"""How soft the limit between two fingers is."""

Beyond = Callable[[str, ArrayLike, float], FloatArray]
"""How far points lie beyond a plane through a joint, square to a way, as a step of a half width."""


def body_weights(
    points: FloatArray,
    triangles: IntArray,
    mirror: NDArray[np.int64],
    fields: BodyFields,
    skeleton: Skeleton,
) -> FloatArray:
    """Return each joint's weight on each point, ``(p, j)``, exactly symmetric.

    Parameters
    ----------
    points, triangles, mirror
        The closed body and each point's image in the plane x = 0.
    fields
        Tell arm and leg from trunk.
    skeleton
        Its joints, by name.
    """
    left = points * np.where(points[:, :1] < 0, [-1.0, 1.0, 1.0], 1.0)
    shares = _left_shares(left, fields, skeleton)
    dense = np.zeros((len(points), len(skeleton)))
    other = points[:, 0] < 0
    for joint, share in shares.items():
        twin = other_side(joint)
        dense[~other, skeleton.index(joint)] += share[~other]
        dense[other, skeleton.index(twin)] += share[other]
    mean = adjacency(triangles, len(points))
    for _ in range(SMOOTHING_ROUNDS):
        dense = 0.5 * dense + 0.5 * (mean @ dense)
    twins = [skeleton.index(other_side(joint)) for joint in skeleton.joints]
    return 0.5 * (dense + dense[mirror][:, twins])


def weights_of_skin(
    points: FloatArray, body_points: FloatArray, body_weights: FloatArray, skeleton: Skeleton
) -> FloatArray:
    """Return the weights ``(p, j)`` at points near a body, from the body's points around each.

    Each side is asked about its own half alone: the inside of one trouser leg is as near to the
    other leg.
    """
    from scipy.spatial import KDTree

    left = body_points[:, 0] >= 0.0
    folded = points * np.where(points[:, :1] < 0, [-1.0, 1.0, 1.0], 1.0)
    distance, near = KDTree(body_points[left]).query(folded, k=12)
    share = 1.0 / (distance + 0.002) ** 2
    share /= share.sum(axis=1, keepdims=True)
    weights = np.einsum("pk,pkj->pj", share, body_weights[left][near])
    twins = [skeleton.index(other_side(joint)) for joint in skeleton.joints]
    swapped = weights[:, twins]
    x = points[:, :1]
    return np.where(x > 0, weights, np.where(x < 0, swapped, 0.5 * (weights + swapped)))


def strongest(dense: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the four largest weights of each row, normalised, and their places.

    The fifth is taken from each of the four first: a weight then fades before it is dropped, and
    of two equal ones, left and right, not one alone stays.
    """
    dense = np.where(dense < 2e-3, 0.0, dense)
    order = np.argsort(-dense, axis=1, kind="stable")
    largest = np.take_along_axis(dense, order[:, : MAX_INFLUENCES + 1], axis=1)
    weights = largest[:, :MAX_INFLUENCES] - largest[:, MAX_INFLUENCES:]
    return order[:, :MAX_INFLUENCES], weights / weights.sum(axis=1, keepdims=True)


def _step(value: FloatArray, low: float, high: float) -> FloatArray:
    """Return 0 below ``low``, 1 above ``high`` and a smooth step of three derivatives between."""
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return t**3 * (t * (6.0 * t - 15.0) + 10.0)


def _left_shares(
    points: FloatArray, fields: BodyFields, skeleton: Skeleton
) -> dict[str, FloatArray]:
    """Return the weights by joint for points with x from 0 up; they sum to 1."""
    places = {j: skeleton.world_from_bind[i, :3, 3] for i, j in enumerate(skeleton.joints)}

    def beyond(joint: str, direction: ArrayLike, half_m: float, shift_m: float = 0.0) -> FloatArray:
        """Return how far points lie beyond a plane through a joint, as a soft step."""
        along = (points - places[joint]) @ normalized(direction) - shift_m
        return _step(along, -half_m, half_m)

    x, y = points[:, 0], points[:, 1]
    trunk = fields.trunk.sample(points)
    arm = fields.arm.sample(points)
    on_arm = _step(trunk - arm, -0.030, 0.045) * (1.0 - _step(arm, 0.02, 0.05))
    on_leg = beyond("left_upper_leg", (0.45, -1.0, 0.0), 0.075, 0.005) * _step(x, 0.0, 0.06)
    on_leg = on_leg * _step(-y, -1.0, -0.97) * (1.0 - on_arm)
    on_leg = np.where(y < 0.78, 1.0 - on_arm, on_leg)

    up = (0.0, 1.0, 0.0)
    spine = _chain(
        ("hips", "spine", "chest", "upper_chest"),
        [beyond("spine", up, 0.065), beyond("chest", up, 0.07), beyond("upper_chest", up, 0.07)],
    )
    neck = beyond("neck", (0.0, 1.0, 0.4), 0.045) * (1.0 - _step(x, 0.06, 0.12))
    head = beyond("head", (0.0, 1.0, 0.9), 0.03)
    spine |= _chain(("upper_chest", "neck", "head"), [neck, head], spine["upper_chest"])
    collar = _step(x, 0.03, 0.15) * _step(y, 1.27, 1.40) * (1.0 - neck)
    shares = {joint: share * (1.0 - collar) for joint, share in spine.items()}
    shares["left_shoulder"] = collar

    hand_way = places["left_hand"] - places["left_lower_arm"]
    arm_shares = _chain(
        ("left_upper_arm", "left_lower_arm", "left_hand"),
        [beyond("left_lower_arm", DOWN_45, 0.045), beyond("left_hand", hand_way, 0.032)],
    )
    hand = arm_shares.pop("left_hand")
    arm_shares |= {joint: share * hand for joint, share in _hand_shares(points, beyond).items()}
    leg_shares = _chain(
        ("left_upper_leg", "left_lower_leg", "left_foot", "left_toes"),
        [
            beyond("left_lower_leg", (0.0, -1.0, 0.0), 0.055),
            beyond("left_foot", (0.0, -1.0, 0.15), 0.03),
            beyond("left_toes", (0.0, -0.1, 1.0), 0.022),
        ],
    )
    shares = {joint: share * (1.0 - on_arm) * (1.0 - on_leg) for joint, share in shares.items()}
    shares |= {joint: share * on_arm for joint, share in arm_shares.items()}
    return shares | {joint: share * on_leg for joint, share in leg_shares.items()}


def _hand_shares(points: FloatArray, beyond: Beyond) -> dict[str, FloatArray]:
    """Return the weights within a hand: each finger has what is nearer to it than to the others."""
    fingers = left_fingers()
    away = [np.min([b.distance(*points.T) for b in finger_bones(f)], axis=0) for f in fingers]
    near = np.exp(-(np.array(away) - np.min(away, axis=0)) / FINGERS_BLEND_M)
    near /= near.sum(axis=0)
    hand, shares = np.ones(len(points)), dict[str, FloatArray]()
    for finger, own, distance in zip(fingers, near, away, strict=True):
        joints = tuple(f"left_{joint}" for joint in finger.joints)
        ways = np.diff(finger.places, axis=0)
        if finger.name == "thumb":
            own = _step(-distance, -0.012, 0.0) * own
        passed = [own * beyond(joints[0], ways[0], 0.012)]
        passed += [beyond(joints[k], ways[k - 1] + ways[k], 0.007) for k in (1, 2)]
        hand = hand - passed[0]
        shares |= _chain(joints, passed[1:], passed[0])
    return shares | {"left_hand": hand}


def _chain(
    joints: tuple[str, ...], beyond: list[FloatArray], whole: FloatArray | None = None
) -> dict[str, FloatArray]:
    """Return what each joint of a chain keeps when each passes on a share to the next."""
    left = np.ones_like(beyond[0]) if whole is None else whole
    shares = {}
    for joint, share in zip(joints[:-1], beyond, strict=True):
        shares[joint] = left * (1.0 - share)
        left = left * share
    return shares | {joints[-1]: left}
