"""Arms of the humanoid, posed by their keys, or by where hands are put."""

from __future__ import annotations

import numpy as np

from actions_library.authoring.feet import FootPath, FootShape
from actions_library.authoring.hand_poses import FLAT, bent_at_knuckles, turn_fingers
from actions_library.authoring.keys import ArmKey, Hand, Numbers, columns_of
from actions_library.authoring.pose import Pose
from smd.character.ik import limb_of, two_bone_ik
from smd.character.skeleton import Skeleton
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    inverse,
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_euler,
    quaternion_from_matrix,
    rotate,
    slerp,
)

ARM_SOFTNESS = 0.02
"""Last part of an arm's reach that softens: where a hand is put, it may fall a little short."""

WRIST_HEIGHT_M, HEEL_OF_HAND_M = 0.034, 0.012
"""Of a flat hand: the wrist above the ground, and the heel of the hand behind it."""

_FOREARM_TWIST_SHARE = 0.5


def pose_arm(
    pose: Pose,
    side: str,
    out: float,
    arm_numbers: FloatArray,
    hand_numbers: FloatArray | None,
    palm: FootPath | None,
) -> None:
    """Pose a shoulder, an arm and its hand, above a chest that is posed.

    Parameters
    ----------
    out
        +1 for the left arm, -1 for the right one.
    arm_numbers, hand_numbers
        The curves of its `ArmKey` and `Hand` keys.
    palm
        Where the flat hand goes on the ground, which overrules both.
    """
    arm = columns_of(ArmKey(), arm_numbers)
    mirror = np.array([out, 1.0, 1.0])
    chest = pose.rotation[:, pose.skeleton.index("upper_chest")]
    frame = slerp(np.broadcast_to(IDENTITY_XYZW, chest.shape), chest, arm["follow"])
    to = rotate(frame, normalized(arm["to"]) * mirror)
    elbow = rotate(frame, normalized(arm["elbow"]) * mirror)
    pose.turn(f"{side}_shoulder", _shoulder(rotate(inverse(chest), to) * mirror, arm, out))

    upper, lower, hand = f"{side}_upper_arm", f"{side}_lower_arm", f"{side}_hand"
    limb = limb_of(pose.skeleton, upper, lower, hand, [0.0, 0.0, -1.0])
    base = pose.at(upper)
    span = limb.span_m(np.radians(arm["bend"]))[:, None]
    wrist, softness = base + to * span, 0.0
    held = None if hand_numbers is None else _held(hand_numbers, out)
    if palm is not None:
        wrist, softness = palm.ankle_m, ARM_SOFTNESS
    elif held is not None:
        place, _, hold = held
        wrist, softness = wrist + hold[:, None] * (place - wrist), ARM_SOFTNESS
    upper_q, lower_q = two_bone_ik(limb, base, wrist, elbow, softness=softness)
    pose.set(upper, upper_q)

    along = normalized(pose.skeleton.rest_translation_m[pose.skeleton.index(hand)])
    twist = out * np.radians(arm["twist"])
    pose.set(lower, multiply(lower_q, quaternion_about(along, _FOREARM_TWIST_SHARE * twist)))
    fold = np.array([0.0, 0.0, -out])
    pose.turn(
        hand,
        multiply(
            quaternion_about(along, (1.0 - _FOREARM_TWIST_SHARE) * twist),
            quaternion_about(fold, np.radians(arm["flex"])),
        ),
    )
    fingers = arm["fingers"]
    if palm is not None:
        pose.set(hand, multiply(palm.rotation_xyzw, _flat_hand(out)))
        fingers = bent_at_knuckles(FLAT, -palm.toes_up_rad)
    elif held is not None:
        _, turned, hold = held
        own = pose.rotation[:, pose.skeleton.index(hand)]
        pose.set(hand, slerp(own, turned, hold))
    turn_fingers(pose.turn, side, out, fingers)


def _held(numbers: FloatArray, out: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return where a hand is put, how it is turned, and how firmly: place, rotation, hold."""
    hand = columns_of(Hand(), numbers)
    mirror = np.array([out, 1.0, 1.0])
    turned = _hand_rotation(hand["fingers"] * mirror, hand["palm"] * mirror, out)
    return hand["place"] * mirror, turned, hand["hold"]


def _hand_rotation(fingers: FloatArray, palm: FloatArray, out: float) -> FloatArray:
    """Return rotations in the world ``(n, 4)`` whose fingers point and palm faces as asked.

    At rest the fingers point outward and down at 45°, and the palm faces the body.
    """
    half = np.sqrt(0.5)
    rest = _axes(np.array([[out * half, -half, 0.0]]), np.array([[-out * half, -half, 0.0]]))
    return quaternion_from_matrix(_axes(fingers, palm) @ np.swapaxes(rest, -1, -2))


def _axes(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return right-handed axes ``(n, 3, 3)`` in columns; the second is made square to the first."""
    a = normalized(first)
    b = normalized(second - a * np.sum(a * second, axis=-1, keepdims=True))
    return np.stack([a, b, np.cross(a, b)], axis=-1)


def _shoulder(to: FloatArray, arm: Numbers, out: float) -> FloatArray:
    """Return the collar bone's turn: it rises with a raised arm and goes along with a reach."""
    raised = np.clip((to[:, 1] + 0.3) / 1.3, 0.0, 1.0)
    lift = 24.0 * raised * raised * (3.0 - 2.0 * raised) + arm["shrug"]
    straight = np.clip(1.0 - arm["bend"] / 150.0, 0.0, 1.0)
    forward = 14.0 * to[:, 2] * straight
    degrees = np.column_stack([-out * forward, np.zeros_like(lift), out * lift])
    return quaternion_from_euler("YXZ", np.radians(degrees))


def palm_shape(skeleton: Skeleton, side: str) -> FootShape:
    """Return a flat hand's measures, as a foot's: it rolls over the knuckles."""
    out = 1.0 if side == "left" else -1.0
    knuckles = skeleton.rest_translation_m[skeleton.index(f"{side}_middle_proximal")]
    return FootShape(
        ball=rotate(_flat_hand(out)[0], knuckles),
        heel=np.array([0.0, -WRIST_HEIGHT_M, -HEEL_OF_HAND_M]),
        ankle_height=WRIST_HEIGHT_M,
    )


def _flat_hand(out: float) -> FloatArray:
    """Return the rotation ``(1, 4)`` of a hand whose fingers point ahead, the palm down."""
    return _hand_rotation(np.array([[0.0, 0.0, 1.0]]), np.array([[0.0, -1.0, 0.0]]), out)
