"""The humanoid's hands: five fingers, and poses with names."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.hand_poses import (
    FLAT,
    HAND_POSES,
    RELAXED,
    HandPose,
    bent_at_knuckles,
    turn_fingers,
)
from actions_library.authoring.hand_shape import FINGERS, left_fingers
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.keys import ArmKey
from smd.character.kinematics import forward_kinematics
from smd.character.roles import body_plan
from smd.geometry.arrays import FloatArray
from smd.geometry.rotations import rotate

SKELETON = humanoid_skeleton()
OUT = {"left": 1.0, "right": -1.0}


def posed(numbers: FloatArray, side: str) -> tuple[FloatArray, FloatArray]:
    """Joints in the world, their rotations and places, in one pose of one hand."""
    q = SKELETON.rest_rotation_xyzw.copy()

    def turn(joint: str, rotation: FloatArray) -> None:
        q[SKELETON.index(joint)] = rotation[0]

    turn_fingers(turn, side, OUT[side], numbers)
    return forward_kinematics(SKELETON, q, SKELETON.rest_translation_m)


def chain(pose: HandPose, finger: int, side: str = "left") -> FloatArray:
    """Places of a finger's joints and its tip ``(4, 3)``, seen from the wrist."""
    rotation, place = posed(np.array([pose]), side)
    own = left_fingers()[finger]
    joints = [SKELETON.index(f"{side}_{joint}") for joint in own.joints]
    last = (own.places[3] - own.places[2]) * [OUT[side], 1.0, 1.0]
    tip = place[joints[2]] + rotate(rotation[joints[2]], last)
    return np.array([*place[joints], tip]) - place[SKELETON.index(f"{side}_hand")]


def bend_deg(points: FloatArray) -> float:
    """How far the last of some segments is turned from the first."""
    first, last = points[1] - points[0], points[-1] - points[-2]
    cosine = first @ last / np.linalg.norm(first) / np.linalg.norm(last)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_hand_has_five_fingers_of_three_joints_and_the_arm_ends_in_the_middle_one(side):
    plan = body_plan(SKELETON.joints, SKELETON.parents.tolist(), SKELETON.world_from_bind[:, :3, 3])
    arm = plan.of("arm", side)
    assert arm is not None
    assert SKELETON.joints[arm.end] == f"{side}_hand"
    names = [SKELETON.joints[j] for j in arm.chain]
    assert names[-3:] == [
        f"{side}_middle_{part}" for part in ("proximal", "intermediate", "distal")
    ]
    assert plan.roles == SKELETON.roles
    parents = SKELETON.parents.tolist()
    roots = [j for j, parent in enumerate(parents) if parent == arm.end]
    assert [SKELETON.joints[j].split("_")[1] for j in roots] == list(FINGERS)
    for root in roots:
        assert parents.count(root) == 1
        assert parents.count(parents.index(root)) == 1


@pytest.mark.parametrize("name", HAND_POSES)
def test_the_right_hand_is_the_mirror_image_of_the_left(name):
    for finger in range(5):
        left = chain(HAND_POSES[name], finger, "left")
        np.testing.assert_allclose(
            chain(HAND_POSES[name], finger, "right"), left * [-1.0, 1.0, 1.0], atol=1e-12
        )


def test_poses_are_what_they_are_called():
    for finger in range(1, 5):
        assert bend_deg(chain(FLAT, finger)) < 10.0
        assert 100.0 < bend_deg(chain(HAND_POSES["hold"], finger)) < 140.0
        assert bend_deg(chain(HAND_POSES["fist"], finger)) > 160.0
        reach = [
            np.linalg.norm(chain(HAND_POSES[p], finger)[3]) for p in ("flat", "relaxed", "fist")
        ]
        assert reach[0] > reach[1] > reach[2]
        assert reach[2] < 0.085
    assert bend_deg(chain(HAND_POSES["point"], 1)) < 12.0
    for finger in (2, 3, 4):
        assert bend_deg(chain(HAND_POSES["point"], finger)) > 150.0


def test_in_a_fist_the_thumb_lies_over_the_fingers():
    """Its tip is farther from the back of the hand than the fingers' bones before it."""
    down = np.array([-(2**-0.5), -(2**-0.5), 0.0])
    thumb = chain(HAND_POSES["fist"], 0)[3]
    middle = chain(HAND_POSES["fist"], 2)
    assert thumb @ down > (middle[0] @ down) + 0.02
    assert np.linalg.norm(middle - thumb, axis=1).min() < 0.045


def test_an_arms_key_hangs_its_hand_relaxed_and_fingers_bend_at_their_knuckles():
    assert ArmKey().fingers == RELAXED
    numbers = bent_at_knuckles(FLAT, np.radians([0.0, 30.0]))
    np.testing.assert_array_equal(numbers[0], FLAT)
    np.testing.assert_allclose(numbers[1] - numbers[0], [0, 0, 0, 30, 0, 30, 0, 30, 0, 30, 0, 0])


def test_the_bind_pose_is_where_no_joint_is_turned():
    """Each finger's own bends, given back to it, turn nothing."""
    numbers = np.zeros(12)
    numbers[11] = 1.0
    for k, finger in enumerate(left_fingers()[1:]):
        numbers[3 + 2 * k : 5 + 2 * k] = np.degrees(finger.bends_rad[:2])
    _, place = posed(numbers[None], "left")
    for finger in left_fingers():
        joints = [SKELETON.index(f"left_{joint}") for joint in finger.joints]
        np.testing.assert_allclose(place[joints], finger.places[:3], atol=1e-12)
