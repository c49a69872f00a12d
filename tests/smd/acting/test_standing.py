from __future__ import annotations

import numpy as np
import pytest

from smd.acting.legs import feet_of, legs_of, world_of
from smd.acting.standing import standing
from smd.character.kinematics import forward_kinematics


def test_toes_belong_to_their_foot(library):
    clip = library.clip("walk")
    names = [clip.skeleton.joints[foot] for foot in feet_of(clip)]
    assert names == ["left_foot", "right_foot"]


def test_a_leg_knows_its_joints_and_the_height_of_its_sole(library):
    skeleton = library.character.skeleton
    left, right = legs_of(skeleton, feet_of(library.clip("walk")))
    assert skeleton.joints[left.upper] == "left_upper_leg"
    assert skeleton.joints[right.lower] == "right_lower_leg"
    assert left.left_m > 0.0 > right.left_m
    ankle = skeleton.world_from_bind[left.foot, :3, 3]
    assert (ankle + left.heel_m)[1] == pytest.approx(0.0)
    assert (ankle + left.heel_m)[2] < ankle[2]
    assert (ankle + left.ball_m)[1] == pytest.approx(left.ball_height_m)


def test_a_joint_with_fewer_than_two_above_it_and_below_the_root_has_no_leg(skeleton):
    assert legs_of(skeleton, [1, 2]) == ()


def test_one_joint_s_world_is_that_of_the_whole_skeleton(library):
    clip = library.clip("throw")
    world_q, world_p = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    for joint in (0, 5, len(clip.skeleton) - 1):
        q, p = world_of(clip.skeleton, joint, clip.rotation_xyzw, clip.translation_m)
        assert q == pytest.approx(world_q[:, joint], abs=1e-12)
        assert p == pytest.approx(world_p[:, joint], abs=1e-12)


def test_a_step_stands_from_its_heel_on(library):
    """The shipped walk labels sole and toes; between landing and flat only the heel rests."""
    clip = library.clip("walk")
    feet = feet_of(clip)
    labelled, widened = standing(clip, ()), standing(clip, legs_of(clip.skeleton, feet))
    for foot in feet:
        assert not (labelled[foot] & ~widened[foot]).any()
        assert 3 <= np.count_nonzero(widened[foot] & ~labelled[foot]) <= 10


def test_a_foot_that_a_clip_never_labels_never_stands(library):
    clip = library.clip("fly")
    legs = legs_of(clip.skeleton, feet_of(library.clip("walk")))
    assert not any(stands.any() for stands in standing(clip, legs).values())
