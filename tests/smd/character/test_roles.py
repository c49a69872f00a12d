"""What joints are, on skeletons of others; the answers were written down by looking at them."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest

from actions_library.adoption.character import plan_of, rest_pose
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.importers import import_file
from actions_library.importers.imported import Imported
from smd.character import roles
from smd.character.roles import BodyPlan, body_plan
from smd.errors import CharacterError
from smd.geometry.rotations import normalized, quaternion_between, rotate

EXPECTED = {
    "gltf/Knight.glb": {
        "pelvis": "hips",
        "chest": "chest",
        "head": "head",
        "spine": ("spine", "chest", "head"),
        "left leg": ("upperleg.l", "lowerleg.l", "foot.l"),
        "right arm": ("upperarm.r", "lowerarm.r", "wrist.r"),
        "front": (0.0, 1.0),
        "ends": ("toes.l", "toes.r", "handslot.l", "handslot.r"),
    },
    "bvh/cmu_12_01_walk.bvh": {
        "pelvis": "Hips",
        "chest": "Spine1",
        "head": "Head",
        "spine": ("LowerBack", "Spine", "Spine1", "Neck", "Neck1", "Head"),
        "left leg": ("LeftUpLeg", "LeftLeg", "LeftFoot"),
        "right arm": ("RightArm", "RightForeArm", "RightHand"),
        "front": (0.0, 1.0),
        "ends": ("LeftToeBase_end", "RightToeBase_end", "LThumb_end"),
    },
    "usd/CesiumMan.usdz": {
        "pelvis": "Skeleton_torso_joint_1",
        "left leg": ("leg_joint_L_1", "leg_joint_L_2", "leg_joint_L_3"),
        "right arm": (
            "Skeleton_arm_joint_R",
            "Skeleton_arm_joint_R__2_",
            "Skeleton_arm_joint_R__3_",
        ),
        "head": "Skeleton_neck_joint_2",
        "front": (0.0, 1.0),
        "ends": ("leg_joint_L_5", "leg_joint_R_5"),
    },
    "usd/RiggedFigure.usdz": {
        "pelvis": "torso_joint_1",
        "left leg": ("leg_joint_L_1", "leg_joint_L_2", "leg_joint_L_3"),
        "right arm": ("arm_joint_R_1", "arm_joint_R_2", "arm_joint_R_3"),
        "head": "neck_joint_2",
        "front": (0.0, 1.0),
        "ends": ("leg_joint_L_5", "leg_joint_R_5", "arm_joint_L_3", "arm_joint_R_3"),
    },
    "gltf/horse-animations.glb": {
        "pelvis": "hips",
        "chest": "spine_4",
        "head": "head",
        "left leg": ("back_leg_lower_l", "back_leg_ankle_l", "back_leg_foot_l"),
        "front": (0.0, 1.0),
        "ends": ("tail_leaf", "ear_leaf_l", "front_leg_leaf_r"),
    },
    "gltf/snake-animations.glb": {
        "pelvis": "root",
        "head": "head",
        "front": (0.0, 1.0),
        "ends": ("mouth_tip", "head_tip"),
    },
}


@functools.cache
def imported_clip(folder: Path, name: str) -> Imported:
    """A file of others, read once for all that is asked of it."""
    return import_file(folder / "clips" / name)


def named(names: tuple[str, ...], joints) -> tuple[str, ...]:
    return tuple(names[j] for j in joints)


@pytest.mark.parametrize("name", EXPECTED)
def test_the_skeletons_of_others_are_understood(shared_data, name):
    imported = imported_clip(shared_data, name)
    names, plan, wanted = imported.skeleton.joints, plan_of(imported), EXPECTED[name]
    assert names[plan.pelvis] == wanted["pelvis"]
    assert plan.head is not None and names[plan.head] == wanted["head"]
    if "chest" in wanted:
        assert names[plan.chest] == wanted["chest"]
    if "spine" in wanted:
        assert named(names, plan.spine) == wanted["spine"]
    for limb in ("left leg", "right arm"):
        if limb in wanted:
            side, kind = limb.split()
            found = plan.of(kind, side)
            assert found is not None
            assert named(names, (found.upper, found.middle, found.end)) == wanted[limb]
    assert (plan.front[0], plan.front[2]) == pytest.approx(wanted["front"], abs=0.05)
    for end in wanted["ends"]:
        assert plan.roles[names.index(end)] == "end_effector"


def test_a_horse_has_four_legs_and_a_snake_none(shared_data):
    horse = plan_of(imported_clip(shared_data, "gltf/horse-animations.glb"))
    assert [(limb.kind, limb.side) for limb in horse.limbs] == [
        ("leg", "left"),
        ("leg", "right"),
    ] * 2
    snake = plan_of(imported_clip(shared_data, "gltf/snake-animations.glb"))
    assert snake.limbs == ()
    assert len(snake.spine) > 15


def ours() -> BodyPlan:
    skeleton = humanoid_skeleton()
    return body_plan(skeleton.joints, skeleton.parents.tolist(), skeleton.world_from_bind[:, :3, 3])


def test_our_own_roles_are_found_again():
    skeleton = humanoid_skeleton()
    assert ours().roles == skeleton.roles
    assert skeleton.joints[ours().chest] == "upper_chest"
    assert [(limb.kind, limb.side) for limb in ours().limbs] == [
        ("leg", "left"),
        ("leg", "right"),
        ("arm", "left"),
        ("arm", "right"),
    ]


@pytest.mark.parametrize("turn", range(4))
def test_names_say_where_it_faces_wherever_it_faces(turn):
    skeleton = humanoid_skeleton()
    angle = turn * np.pi / 2
    cosine, sine = np.cos(angle), np.sin(angle)
    about = np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
    plan = body_plan(
        skeleton.joints, skeleton.parents.tolist(), skeleton.world_from_bind[:, :3, 3] @ about.T
    )
    assert plan.front == pytest.approx((sine, 0.0, cosine), abs=1e-9)
    assert plan.roles == skeleton.roles


def test_without_names_the_toes_say_where_it_faces():
    skeleton = humanoid_skeleton()
    names = [f"joint_{i}" for i in range(len(skeleton))]
    plan = body_plan(names, skeleton.parents.tolist(), skeleton.world_from_bind[:, :3, 3])
    assert plan.front == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    assert [(limb.upper, limb.end) for limb in plan.limbs] == [
        (limb.upper, limb.end) for limb in ours().limbs
    ]


def test_the_guess_may_be_overruled_and_must_be_level():
    skeleton = humanoid_skeleton()
    where = skeleton.parents.tolist(), skeleton.world_from_bind[:, :3, 3]
    plan = body_plan(skeleton.joints, *where, front=(1.0, 5.0, 0.0))
    assert plan.front == (1.0, 0.0, 0.0)
    with pytest.raises(CharacterError, match="front"):
        body_plan(skeleton.joints, *where, front=(0.0, 1.0, 0.0))


def test_a_single_joint_is_a_root():
    plan = body_plan(["one"], [-1], np.zeros((1, 3)))
    assert (plan.root, plan.spine, plan.limbs, plan.roles) == ((0,), (), (), ("root",))
    with pytest.raises(CharacterError):
        body_plan([], [], np.zeros((0, 3)))


def test_the_rest_pose_is_forward_kinematics_of_rest():
    skeleton = humanoid_skeleton()
    _, place = rest_pose(skeleton)
    np.testing.assert_allclose(place, skeleton.world_from_bind[:, :3, 3], atol=1e-12)


STANDING = [name for name in EXPECTED if "snake" not in name]
AXES = [(0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0)]


def assert_found_lying(names, parents, place, up):
    """What stands upright, turned so that its up is another axis, is the same body."""
    given_from_ours = quaternion_between((0.0, 1.0, 0.0), up)
    upright = body_plan(names, parents, place)
    lying = body_plan(names, parents, rotate(given_from_ours, place), up=None)
    assert lying.up == pytest.approx(up, abs=1e-9)
    assert lying.front == pytest.approx(rotate(given_from_ours, upright.front).tolist(), abs=1e-6)
    assert (lying.roles, lying.spine, lying.limbs) == (upright.roles, upright.spine, upright.limbs)


@pytest.mark.parametrize("up", AXES)
def test_which_axis_is_up_is_guessed_from_legs(up):
    skeleton = humanoid_skeleton()
    place = skeleton.world_from_bind[:, :3, 3]
    assert_found_lying(skeleton.joints, skeleton.parents.tolist(), place, up)


@pytest.mark.parametrize("up", AXES)
@pytest.mark.parametrize("name", STANDING)
def test_which_axis_is_up_is_guessed_for_the_skeletons_of_others(shared_data, name, up):
    skeleton = imported_clip(shared_data, name).skeleton
    place = rest_pose(skeleton)[1]
    assert_found_lying(skeleton.joints, skeleton.parents.tolist(), place, up)


def test_up_may_be_any_direction_that_is_said_and_must_be_one():
    skeleton = humanoid_skeleton()
    where = skeleton.parents.tolist(), skeleton.world_from_bind[:, :3, 3]
    up = normalized(np.array([0.3, 0.9, -0.2]))
    turned = rotate(quaternion_between((0.0, 1.0, 0.0), up), where[1])
    plan = body_plan(skeleton.joints, where[0], turned, up=up.tolist())
    assert plan.roles == skeleton.roles
    assert np.dot(plan.front, plan.up) == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(CharacterError, match="up"):
        body_plan(skeleton.joints, *where, up=(0.0, 0.0, 0.0))


@pytest.mark.parametrize("seed", range(10))
def test_a_branch_is_the_longest_way_to_a_tip(seed):
    rng = np.random.default_rng(seed)
    parents = [-1, *(int(rng.integers(j)) for j in range(1, 40))]
    place = rng.normal(size=(40, 3))
    tree = roles._Tree([f"joint_{j}" for j in range(40)], parents, place)

    def ways(j: int) -> list[tuple[int, ...]]:
        below = [way for child in tree.children[j] for way in ways(child)]
        return [(j, *way) for way in below] or [(j,)]

    def length_m(way: tuple[int, ...]) -> float:
        return sum(np.linalg.norm(place[j] - place[parents[j]]) for j in way)

    for j in range(1, 40):
        assert tree.branch(j) == max(ways(j), key=length_m)


def test_a_chain_is_not_gone_through_anew_from_every_pair_of_its_joints(monkeypatch):
    """A file may hang 192 joints one below another: that took 37,245 measurings of a chain."""
    measured, length = [], roles._Tree.length

    def counted(tree: roles._Tree, chain: tuple[int, ...]) -> float:
        measured.append(len(chain))
        return length(tree, chain)

    monkeypatch.setattr(roles._Tree, "length", counted)
    place = np.stack([np.zeros(192), np.arange(192.0), np.zeros(192)], axis=-1)
    body_plan([f"joint_{j}" for j in range(192)], [-1, *range(191)], place)
    assert len(measured) < 10 * 192
