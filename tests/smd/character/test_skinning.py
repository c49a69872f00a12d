from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.character.blend_shape import BlendShape
from smd.character.character import Mesh
from smd.character.kinematics import forward_kinematics
from smd.character.skeleton import Skeleton
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from smd.geometry.rotations import (
    matrix_from_quaternion,
    multiply,
    normalized,
    quaternion_about,
    rotate,
)
from tests.naive.shaped import shaped, shaped_puppet, weights_of
from tests.naive.skinning import skinned

BONE_M = 0.5


def two_bones() -> Skeleton:
    """Two joints on +X, the second half a metre along, bound in a turned frame of its own."""
    world_from_bind = np.tile(np.eye(4), (2, 1, 1))
    turn = quaternion_about((1.0, 2.0, 3.0), 0.7)
    world_from_bind[1, :3, :3] = matrix_from_quaternion(turn)
    world_from_bind[1, :3, 3] = [BONE_M, 0.0, 0.0]
    return Skeleton(
        joints=("first", "second"),
        parents=np.array([-1, 0]),
        rest_rotation_xyzw=np.array([[0.0, 0.0, 0.0, 1.0], turn]),
        rest_translation_m=np.array([[0.0, 0.0, 0.0], [BONE_M, 0.0, 0.0]]),
        world_from_bind=world_from_bind,
        roles=("root", "end_effector"),
    )


def mesh_with(points: np.ndarray, second: np.ndarray) -> Mesh:
    """A mesh whose points follow the second joint by the given weights, the first by the rest."""
    weights = np.zeros((len(points), 4))
    weights[:, 0], weights[:, 1] = 1.0 - second, second
    indices = np.tile([0, 1, 0, 0], (len(points), 1))
    return Mesh("mesh", points, [[0, 1, 2]], indices, weights)


@pytest.fixture
def mesh() -> Mesh:
    rng = np.random.default_rng(0)
    return mesh_with(rng.normal(size=(40, 3)), rng.uniform(size=40))


def test_the_bind_pose_leaves_every_point_where_it_is(mesh):
    skeleton = two_bones()
    rest = forward_kinematics(skeleton, skeleton.rest_rotation_xyzw, skeleton.rest_translation_m)
    np.testing.assert_allclose(skin_points(mesh, skeleton, *rest), mesh.points_m, atol=2e-6)


def test_a_rigid_motion_of_the_skeleton_moves_the_points_rigidly(mesh):
    skeleton = two_bones()
    rng = np.random.default_rng(1)
    q = normalized(rng.normal(size=(5, 4)))
    shift = rng.normal(size=(5, 3))
    local_q = np.tile(skeleton.rest_rotation_xyzw, (5, 1, 1))
    local_p = np.tile(skeleton.rest_translation_m, (5, 1, 1))
    local_q[:, 0], local_p[:, 0] = q, shift
    skinned = skin_points(mesh, skeleton, *forward_kinematics(skeleton, local_q, local_p))
    expected = rotate(q[:, None], np.tile(mesh.points_m, (5, 1, 1))) + shift[:, None]
    np.testing.assert_allclose(skinned, expected, atol=2e-6)


def test_a_point_of_one_joint_keeps_its_place_in_that_joints_frame():
    skeleton = two_bones()
    points = np.random.default_rng(2).normal(size=(10, 3))
    mesh = mesh_with(points, np.ones(10))
    local_q = skeleton.rest_rotation_xyzw.copy()
    local_q[1] = multiply(local_q[1], quaternion_about((0.0, 1.0, 1.0), 1.2))
    q, p = forward_kinematics(skeleton, local_q, skeleton.rest_translation_m)
    bind = skeleton.world_from_bind[1]
    in_joint = (points - bind[:3, 3]) @ bind[:3, :3]
    expected = rotate(np.tile(q[1], (10, 1)), in_joint) + p[1]
    np.testing.assert_allclose(skin_points(mesh, skeleton, q, p), expected, atol=2e-6)


@pytest.mark.parametrize("bend_rad", [0.3, 1.5, 3.0])
def test_a_point_halfway_at_a_bent_hinge_moves_inwards_by_the_cosine_of_half_the_bend(bend_rad):
    """Two copies of a point, turned by 0 and by the bend, have their mean at r cos(bend / 2)."""
    skeleton = two_bones()
    radius_m = 0.1
    points = np.array([[BONE_M, radius_m, 0.0], [BONE_M, -radius_m, 0.0], [BONE_M, 0.0, 0.0]])
    mesh = mesh_with(points, np.full(3, 0.5))
    world_q = np.array([[0.0, 0.0, 0.0, 1.0], skeleton.rest_rotation_xyzw[1]])
    world_q[1] = multiply(quaternion_about((0.0, 0.0, 1.0), bend_rad), world_q[1])
    skinned = skin_points(mesh, skeleton, world_q, skeleton.world_from_bind[:, :3, 3])
    half = bend_rad / 2.0
    offset = radius_m * np.cos(half) * np.array([-np.sin(half), np.cos(half), 0.0])
    middle = np.array([BONE_M, 0.0, 0.0])
    expected = np.array([offset, -offset, np.zeros(3)]) + middle
    np.testing.assert_allclose(skinned, expected, atol=2e-6)


def test_frames_and_characters_may_lead(mesh):
    skeleton = two_bones()
    rng = np.random.default_rng(3)
    q, p = normalized(rng.normal(size=(3, 2, 2, 4))), rng.normal(size=(3, 2, 2, 3))
    together = skin_points(mesh, skeleton, q, p)
    assert together.shape == (3, 2, 40, 3)
    alone = skin_points(mesh, skeleton, q[2, 1], p[2, 1])
    np.testing.assert_allclose(together[2, 1], alone, atol=2e-6)


def test_the_humanoid_is_skinned_as_the_formula_says():
    library = load_library()
    for clip in (library.clip("walk"), library.clip("roll")):
        frames = slice(None, None, 20)
        q, p = forward_kinematics(
            clip.skeleton, clip.rotation_xyzw[frames], clip.translation_m[frames]
        )
        for mesh in library.character.meshes:
            fast = skin_points(mesh, clip.skeleton, q, p)
            plain = [skinned(mesh, clip.skeleton, *pose) for pose in zip(q, p, strict=True)]
            np.testing.assert_allclose(fast, plain, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_shapes_are_added_before_joints_as_the_formula_says(seed):
    rng = np.random.default_rng(seed)
    skeleton = two_bones()
    mesh = shaped(mesh_with(rng.normal(size=(400, 3)), rng.uniform(size=400)), seed=seed)
    q, p = normalized(rng.normal(size=(7, 2, 4))), rng.normal(size=(7, 2, 3))
    weights = rng.normal(size=(7, 3))
    fast = skin_points(mesh, skeleton, q, p, weights)
    plain = [skinned(mesh, skeleton, *pose) for pose in zip(q, p, weights, strict=True)]
    np.testing.assert_allclose(fast, plain, rtol=0.0, atol=5e-6)


def test_a_mesh_with_a_shape_in_is_skinned_as_that_shape_at_weight_one():
    """Two ways to one form: bake the offsets into the points, or mix the shape in."""
    rng = np.random.default_rng(7)
    character = shaped_puppet()
    q = normalized(rng.normal(size=(4, len(character.skeleton), 4)))
    p = rng.normal(size=(4, len(character.skeleton), 3))
    for mesh in character.meshes:
        smile = mesh.shapes[0]
        points = mesh.points_m.copy()
        points[smile.indices] += smile.offsets_m
        baked = skin_points(replace(mesh, points_m=points, shapes=()), character.skeleton, q, p)
        weights = weights_of(mesh, Tracks(("smile",), np.ones((4, 1))))
        mixed = skin_points(mesh, character.skeleton, q, p, weights)
        np.testing.assert_allclose(mixed, baked, rtol=0.0, atol=5e-6)


def test_shapes_at_weight_zero_or_that_move_nothing_leave_the_points(mesh):
    skeleton = two_bones()
    q, p = normalized(np.ones((3, 2, 4))), np.ones((3, 2, 3))
    plain = skin_points(mesh, skeleton, q, p)
    still = replace(mesh, shapes=(BlendShape.sparse("none", np.zeros((40, 3))),))
    assert np.array_equal(skin_points(still, skeleton, q, p, np.ones(1)), plain)
    assert np.array_equal(skin_points(shaped(mesh), skeleton, q, p, np.zeros((3, 3))), plain)
    assert np.array_equal(skin_points(shaped(mesh), skeleton, q, p), plain)


def test_weights_lead_as_frames_and_characters_do(mesh):
    skeleton, mesh = two_bones(), shaped(mesh)
    rng = np.random.default_rng(3)
    q, p = normalized(rng.normal(size=(3, 2, 2, 4))), rng.normal(size=(3, 2, 2, 3))
    weights = rng.uniform(size=(3, 2, 3))
    together = skin_points(mesh, skeleton, q, p, weights)
    alone = skin_points(mesh, skeleton, q[2, 1], p[2, 1], weights[2, 1])
    np.testing.assert_allclose(together[2, 1], alone, atol=2e-6)
