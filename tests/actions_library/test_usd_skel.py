from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel

from actions_library.storage import new_stage
from actions_library.usd_skel import (
    bind_animation,
    define_animation,
    define_character,
    joint_paths,
    read_animation,
    read_character,
    unique_identifiers,
    vertex_normals,
)
from smd.character.kinematics import forward_kinematics
from smd.errors import CharacterError
from tests.naive.puppet import puppet, wave

SINGLE = 2e-7
"""Relative precision of a float32, with room for one rounding."""


@pytest.fixture(scope="module")
def stage() -> Usd.Stage:
    stage = new_stage("Puppet")
    root = define_character(stage, "/Puppet", puppet())
    animation = define_animation(stage, "/Puppet/Animation", puppet().skeleton, *wave(20))
    bind_animation(root, animation)
    return stage


def test_joint_paths_lead_from_the_root():
    paths = joint_paths(puppet().skeleton)
    assert paths[:3] == ["root", "root/hips", "root/hips/spine"]
    assert list(UsdSkel.Topology(paths).GetParentIndices()) == puppet().skeleton.parents.tolist()


def test_any_names_become_valid_and_different_identifiers():
    names = unique_identifiers(["left hand", "left-hand", "1", "", "左", "left_hand"])
    assert len(set(names)) == len(names)
    assert all(Tf.IsValidIdentifier(name) for name in names)


def test_a_character_survives_the_round_trip(stage):
    ours, theirs = puppet(), read_character(stage, "puppet")
    assert theirs.skeleton.joints == ours.skeleton.joints
    assert theirs.skeleton.roles == ours.skeleton.roles
    assert np.array_equal(theirs.skeleton.parents, ours.skeleton.parents)
    assert np.array_equal(theirs.skeleton.world_from_bind, ours.skeleton.world_from_bind)
    assert np.array_equal(theirs.skeleton.rest_translation_m, ours.skeleton.rest_translation_m)
    np.testing.assert_allclose(
        theirs.skeleton.rest_rotation_xyzw, ours.skeleton.rest_rotation_xyzw, atol=1e-15
    )
    for a, b in zip(ours.meshes, theirs.meshes, strict=True):
        assert a.name == b.name
        assert np.array_equal(b.points_m, a.points_m.astype(np.float32))
        assert np.array_equal(b.triangles, a.triangles)
        assert np.array_equal(b.joint_indices, a.joint_indices)
        assert np.array_equal(b.joint_weights, a.joint_weights.astype(np.float32))
        np.testing.assert_allclose(b.color_rgb, a.color_rgb, rtol=SINGLE)


def test_poses_survive_the_round_trip_in_single_precision(stage):
    layer = stage.GetRootLayer()
    joints, rotation, translation, tracks = read_animation(layer, "/Puppet/Animation")
    assert tracks.names == ()
    assert joints == joint_paths(puppet().skeleton)
    assert np.array_equal(rotation, wave(20)[0].astype(np.float32))
    assert np.array_equal(translation, wave(20)[1].astype(np.float32))


def test_a_turn_about_y_is_the_same_turn_in_usd():
    stage = new_stage("A")
    rotation, translation = wave(2)
    rotation[:, 0] = [0.0, np.sin(np.pi / 6), 0.0, np.cos(np.pi / 6)]  # 60 degrees to the left
    animation = define_animation(stage, "/A", puppet().skeleton, rotation, translation)
    quaternion = animation.GetRotationsAttr().Get(0)[0]
    assert quaternion.GetReal() == pytest.approx(np.cos(np.pi / 6))
    turned = Gf.Rotation(Gf.Quatd(quaternion)).TransformDir(Gf.Vec3d(0, 0, 1))
    np.testing.assert_allclose(turned, [np.sin(np.pi / 3), 0, np.cos(np.pi / 3)], atol=1e-6)


def test_usd_stands_the_joints_where_our_kinematics_does(stage):
    cache = UsdSkel.Cache()
    root = UsdSkel.Root(stage.GetPrimAtPath("/Puppet"))
    cache.Populate(root, Usd.PrimDefaultPredicate)
    query = cache.GetSkelQuery(UsdSkel.Skeleton(stage.GetPrimAtPath("/Puppet/Skeleton")))
    rotation, translation = wave(20)
    _, positions = forward_kinematics(puppet().skeleton, rotation, translation)
    for frame in (0, 7, 19):
        transforms = query.ComputeJointSkelTransforms(frame)
        theirs = [matrix.ExtractTranslation() for matrix in transforms]
        np.testing.assert_allclose(theirs, positions[frame], atol=1e-5)


def test_the_mesh_inherits_skeleton_and_animation_from_the_root(stage):
    mesh = UsdSkel.BindingAPI(stage.GetPrimAtPath("/Puppet/Body"))
    assert mesh.GetInheritedSkeleton().GetPath() == "/Puppet/Skeleton"
    assert mesh.GetInheritedAnimationSource().GetPath() == "/Puppet/Animation"


def test_normals_of_a_sphere_are_its_points():
    import pyvista

    sphere = pyvista.Icosphere(radius=2.0, nsub=3)
    points = np.asarray(sphere.points, float)
    normals = vertex_normals(points, sphere.faces.reshape(-1, 4)[:, 1:].astype(np.int64))
    assert np.abs(normals - points / 2.0).max() < 0.01


def test_extent_of_the_mesh_holds_its_points_exactly(stage):
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/Puppet/Body"))
    low, high = mesh.GetExtentAttr().Get()
    points = puppet().meshes[0].points_m.astype(np.float32)
    assert np.array_equal(low, points.min(0))
    assert np.array_equal(high, points.max(0))


def test_a_stage_without_a_character_is_refused():
    with pytest.raises(CharacterError, match="SkelRoot"):
        read_character(new_stage("Nothing"), "x")


def test_a_layer_without_an_animation_is_refused():
    with pytest.raises(CharacterError, match="/A"):
        read_animation(Sdf.Layer.CreateAnonymous(".usda"), "/A")
