from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.feet import FootPath, foot_path
from actions_library.authoring.humanoid import LEGS, humanoid_skeleton
from actions_library.authoring.legs import STRAIGHTEST_DEG, foot_shape, leg_room_m, pose_leg
from actions_library.authoring.pose import Pose
from actions_library.authoring.stance import LEFT_STANCE


def standing(up_m: float) -> tuple[Pose, FootPath]:
    """Hips so far above standing straight, the left foot planted."""
    skeleton = humanoid_skeleton()
    pose = Pose(skeleton, 1)
    hips = skeleton.index("hips")
    pose.position[:, hips] = skeleton.rest_translation_m[hips] + [0.0, up_m, 0.1]
    path = foot_path([LEFT_STANCE], foot_shape(skeleton, LEGS["left"]), 1.0, np.zeros(1))
    pose_leg(pose, LEGS["left"], None, path)
    return pose, path


def knee_deg(pose: Pose) -> float:
    hip, knee, ankle = (
        pose.position[0, pose.skeleton.index(f"left_{joint}")]
        for joint in ("upper_leg", "lower_leg", "foot")
    )
    thigh, shin = knee - hip, ankle - knee
    cosine = thigh @ shin / np.linalg.norm(thigh) / np.linalg.norm(shin)
    return float(np.degrees(np.arccos(cosine)))


@pytest.mark.parametrize("up_m", [-0.3, -0.1, 0.02])
def test_hips_may_rise_until_the_knee_is_as_straight_as_it_gets(up_m):
    pose, path = standing(up_m)
    room_m = float(leg_room_m(pose, LEGS["left"], path)[0])
    risen, _ = standing(up_m + room_m)
    assert knee_deg(risen) == pytest.approx(STRAIGHTEST_DEG, abs=1.0)  # the last of it softens


def test_hips_have_no_room_above_a_foot_that_is_out_of_reach():
    pose, path = standing(0.10)
    assert leg_room_m(pose, LEGS["left"], path)[0] < 0.0
