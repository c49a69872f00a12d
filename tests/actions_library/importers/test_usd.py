from __future__ import annotations

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdSkel

from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.importers.usd import fans
from smd.character.kinematics import forward_kinematics

FILES = [
    "CesiumMan.usdz",
    "RiggedFigure.usdz",
    "RiggedSimple.usdz",
    "arm.usda",
    "skinCluster.usda",
    "skeleton.usda",
    "openusd_usdSkel/doxygen/skinnedArm.usda",
    "openusd_usdSkel/testenv/testUsdSkelBakeSkinning/dqs.usda",
    "openusd_usdSkel/testenv/testUsdSkelRoot/root.usda",
]


@pytest.mark.parametrize("name", FILES)
def test_joints_stand_where_usd_s_own_query_has_them(shared_data, name):
    path = shared_data / "clips" / "usd" / name
    imported = import_file(path)
    stage = Usd.Stage.Open(str(path))
    unit, z_up = UsdGeom.GetStageMetersPerUnit(stage), UsdGeom.GetStageUpAxis(stage) == "Z"
    (animation,) = imported.animations
    _, place = forward_kinematics(
        imported.skeleton, animation.rotation_xyzw, animation.translation_m
    )
    queries = {}
    cache = UsdSkel.Cache()
    for prim in stage.Traverse():
        if prim.IsA(UsdSkel.Root):
            cache.Populate(UsdSkel.Root(prim), Usd.TraverseInstanceProxies())
    for prim in stage.Traverse():
        if prim.IsA(UsdSkel.Skeleton):
            query = cache.GetSkelQuery(UsdSkel.Skeleton(prim))
            if query and len(query.GetJointOrder()) == len(imported.skeleton):
                queries[str(prim.GetPath())] = query
    (query, *_) = queries.values()
    times = sorted(query.GetAnimQuery().GetJointTransformTimeSamples())
    for frame in np.linspace(0, len(place) - 1, 5).astype(int):
        code = min(times[0] + frame, times[-1])
        world = np.array(query.ComputeJointWorldTransforms(UsdGeom.XformCache(code)))
        at = unit * world[:, 3, :3]
        if z_up:
            at = at[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
        np.testing.assert_allclose(place[frame], at, atol=1e-4)


def test_our_own_character_comes_back_as_it_was():
    library = load_library()
    character = library.character
    imported = import_file(library.folder / library.character_file)
    assert imported.skeleton.joints == character.skeleton.joints
    assert imported.skeleton.roles == character.skeleton.roles
    np.testing.assert_allclose(
        imported.skeleton.rest_translation_m, character.skeleton.rest_translation_m, atol=1e-6
    )
    for one, other in zip(imported.meshes, character.meshes, strict=True):
        np.testing.assert_allclose(one.points_m, other.points_m, atol=1e-6)
        np.testing.assert_array_equal(one.triangles, other.triangles)
        np.testing.assert_allclose(one.joint_weights, other.joint_weights, atol=1e-6)


def test_a_face_becomes_a_fan_of_triangles():
    triangles = fans(np.array([3, 4, 5, 2]), np.arange(14))
    assert triangles.tolist() == [
        *([0, 1, 2], [3, 4, 5], [3, 5, 6]),
        *([7, 8, 9], [7, 9, 10], [7, 10, 11]),
    ]


def test_what_is_not_kept_is_said(shared_data):
    imported = import_file(shared_data / "clips" / "usd" / "blendshape-and-animation-test-001.usda")
    assert any("blend shapes" in note for note in imported.notes)
