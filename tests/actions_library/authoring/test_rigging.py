from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.rigging import (
    JointRow,
    other_side,
    place_of,
    skeleton_of,
    with_right_side,
)
from smd.character.kinematics import forward_kinematics
from smd.errors import CharacterError

ROWS = (
    JointRow("root", "", (0.0, 0.0, 0.0), "root"),
    JointRow("body", "root", (0.0, 0.5, 0.1), "spine"),
    JointRow("left_wing", "body", (0.2, 0.6, 0.0), "intermediate"),
    JointRow("left_wing_tip", "left_wing", (0.7, 0.8, -0.1), "end_effector"),
)


def test_the_right_side_is_the_mirror_image_of_the_left():
    skeleton = skeleton_of(with_right_side(ROWS))
    assert skeleton.joints[4:] == ("right_wing", "right_wing_tip")
    for joint in skeleton.joints:
        x, y, z = place_of(skeleton, joint)
        assert place_of(skeleton, other_side(joint)) == (-x, y, z)
        parent = skeleton.joints[skeleton.parents[skeleton.index(joint)]]
        if joint != "root":
            twin_parent = skeleton.parents[skeleton.index(other_side(joint))]
            assert skeleton.joints[twin_parent] == other_side(parent)


def test_at_rest_the_joints_are_where_the_rows_say():
    rows = with_right_side(ROWS)
    skeleton = skeleton_of(rows)
    _, place = forward_kinematics(
        skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
    )
    np.testing.assert_allclose(place, [row.place for row in rows], atol=1e-15)


def test_a_name_of_no_side_is_its_own_twin():
    assert other_side("leftover") == "leftover"
    assert other_side(other_side("left_ear")) == "left_ear"


def test_a_parent_must_come_first():
    with pytest.raises(CharacterError, match="each parent before its children"):
        skeleton_of([ROWS[1], ROWS[0]])
