from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.humanoid import HEIGHT_M, humanoid_skeleton
from smd.character.kinematics import forward_kinematics, joints_in_world
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError


def parts() -> dict[str, object]:
    """What a skeleton of three joints in a row is made of."""
    return {
        "joints": ("root", "middle", "end"),
        "parents": np.array([-1, 0, 1]),
        "rest_rotation_xyzw": np.tile([0.0, 0.0, 0.0, 1.0], (3, 1)),
        "rest_translation_m": np.tile([0.0, 1.0, 0.0], (3, 1)),
        "world_from_bind": np.tile(np.eye(4), (3, 1, 1)),
        "roles": ("root", "spine", "end_effector"),
    }


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("joints", (), "expected at least one"),
        ("joints", ("root", "end", "end"), "unique names"),
        ("parents", np.array([-1, 2, 0]), "each parent before its children"),
        ("parents", np.array([-1, 1, 1]), "each parent before its children"),
        ("parents", np.array([0, 0, 1]), "each parent before its children"),
        ("parents", np.array([-1, -2, 1]), "each parent before its children"),
        ("parents", np.array([-1, 0]), r"expected shape \(3\), got \(2,\)"),
        ("rest_rotation_xyzw", np.ones((3, 4)), "expected unit length"),
        ("rest_translation_m", np.full((3, 3), np.nan), "expected finite numbers, got nan"),
        ("world_from_bind", np.eye(4), r"expected shape \(3, 4, 4\)"),
        ("roles", ("root", "spine", "wing"), "roles: expected 3 of root, spine"),
        ("roles", ("root",), "roles: expected 3 of"),
    ],
)
def test_what_is_no_skeleton_is_refused_by_name(name, value, message):
    with pytest.raises(CharacterError, match=message):
        Skeleton(**(parts() | {name: value}))


def test_a_joint_is_found_by_name_or_named_in_the_error():
    skeleton = Skeleton(**parts())
    assert [skeleton.index(joint) for joint in skeleton.joints] == [0, 1, 2]
    with pytest.raises(CharacterError, match="expected a joint named 'tail'"):
        skeleton.index("tail")


def test_a_skeleton_does_not_change_with_the_arrays_it_was_made_of():
    given = parts()
    skeleton = Skeleton(**given)
    given["rest_translation_m"][0] = 9.0
    assert skeleton.rest_translation_m.max() == 1.0
    with pytest.raises(ValueError, match="read-only"):
        skeleton.rest_translation_m[0] = 9.0


def test_the_humanoid_at_rest_stands_as_it_was_bound():
    skeleton = humanoid_skeleton()
    rotation, position = forward_kinematics(
        skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m
    )
    np.testing.assert_allclose(position, skeleton.world_from_bind[:, :3, 3], atol=1e-12)
    np.testing.assert_allclose(rotation, np.tile([0.0, 0.0, 0.0, 1.0], (len(skeleton), 1)))


def test_the_humanoid_has_a_persons_proportions():
    """Segment lengths and heights over body height, against D. A. Winter, "Biomechanics and Motor
    Control of Human Movement", Figure 4.1."""
    skeleton = humanoid_skeleton()
    place = dict(zip(skeleton.joints, skeleton.world_from_bind[:, :3, 3], strict=True))

    def length(a: str, b: str) -> float:
        return float(np.linalg.norm(place[a] - place[b])) / HEIGHT_M

    assert len(skeleton) >= 22
    assert length("left_upper_arm", "left_lower_arm") == pytest.approx(0.186, rel=0.15)
    assert length("left_lower_arm", "left_hand") == pytest.approx(0.146, rel=0.1)
    assert length("left_upper_leg", "left_lower_leg") == pytest.approx(0.245, rel=0.1)
    assert length("left_lower_leg", "left_foot") == pytest.approx(0.246, rel=0.1)
    assert place["left_upper_arm"][1] / HEIGHT_M == pytest.approx(0.818, rel=0.1)
    assert place["left_lower_leg"][1] / HEIGHT_M == pytest.approx(0.285, rel=0.1)


def test_the_humanoids_sides_mirror_each_other():
    skeleton = humanoid_skeleton()
    for joint in skeleton.joints:
        if not joint.startswith("left_"):
            continue
        left, right = skeleton.index(joint), skeleton.index(joint.replace("left_", "right_"))
        np.testing.assert_allclose(
            skeleton.world_from_bind[left, :3, 3],
            skeleton.world_from_bind[right, :3, 3] * [-1.0, 1.0, 1.0],
        )
        assert skeleton.roles[left] == skeleton.roles[right]


def test_some_joints_alone_are_where_the_whole_skeleton_has_them():
    skeleton = humanoid_skeleton()
    random = np.random.default_rng(5)
    q = random.normal(size=(4, len(skeleton), 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    t = random.normal(size=(4, len(skeleton), 3))
    whole = forward_kinematics(skeleton, q, t)
    for joints in ([0], [len(skeleton) - 1, 5], [7, 7, 3]):
        for one, other in zip(joints_in_world(skeleton, joints, q, t), whole, strict=True):
            np.testing.assert_allclose(one, other[:, joints], atol=1e-12)
