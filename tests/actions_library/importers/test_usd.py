from __future__ import annotations

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdSkel

from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.importers.usd_meshes import fans
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


ARM = """#usda 1.0
(
    upAxis = "Y"
    metersPerUnit = 1
    timeCodesPerSecond = 10
)
def SkelRoot "Root"
{
    def Skeleton "Arm" (prepend apiSchemas = ["SkelBindingAPI"])
    {
        uniform token[] joints = ["Upper", "Upper/Lower"]
        uniform matrix4d[] bindTransforms = [
            ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,2,0,1))]
        uniform matrix4d[] restTransforms = [
            ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,2,0,1))]
        rel skel:animationSource = </Root/Move>
    }
    def Skeleton "Other" (prepend apiSchemas = ["SkelBindingAPI"])
    {
        uniform token[] joints = ["Only"]
        uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))]
        uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))]
    }
    def SkelAnimation "Move"
    {
        uniform token[] joints = ["Upper/Lower"]
        float3[] translations.timeSamples = { 0: [(0, 2, 0)], 10: [(0, 4, 0)] }
        quatf[] rotations = [(1, 0, 0, 0)]
        half3[] scales = [(1, 1, 1)]
        uniform token[] blendShapes = ["frown", "smile"]
        float[] blendShapeWeights.timeSamples = { 0: [0, 1], 10: [1, 0] }
    }
    def Mesh "Skin" (prepend apiSchemas = ["SkelBindingAPI"])
    {
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0)]
        rel skel:skeleton = </Root/Arm>
        uniform token[] skel:blendShapes = ["smile"]
        int[] primvars:skel:jointIndices = [0,1,0,1,0,1, 0,1,0,1,0,1, 0,1,0,1,0,1, 0,1,0,1,0,1] (
            interpolation = "vertex"
            elementSize = 6
        )
        float[] primvars:skel:jointWeights = [6,5,4,3,2,1, 6,5,4,3,2,1, 6,5,4,3,2,1, 6,5,4,3,2,1] (
            interpolation = "vertex"
            elementSize = 6
        )
        matrix4d primvars:skel:geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))
    }
}
"""


def written(tmp_path, text: str = ARM, name: str = "a.usda"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_an_arm_moves_as_its_file_says(tmp_path):
    imported = import_file(written(tmp_path))
    (animation,), (mesh,) = imported.animations, imported.meshes
    assert animation.rate_hz == 10.0
    np.testing.assert_allclose(animation.translation_m[:, 1, 1], np.linspace(2, 4, 11), atol=1e-6)
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    np.testing.assert_allclose(mesh.joint_weights, [[6 / 18, 5 / 18, 4 / 18, 3 / 18]] * 4)


@pytest.mark.parametrize(
    ("up", "place"), [("Y", [0, 0.02, 0]), ("Z", [0, 0, -0.02]), ("-x", [0.0, 0.0, 0.0])]
)
def test_up_and_unit_are_the_stage_s_or_those_given(tmp_path, up, place):
    said = up in "YZ"
    text = ARM.replace("metersPerUnit = 1", "metersPerUnit = 0.01")
    path = written(tmp_path, text.replace('upAxis = "Y"', f'upAxis = "{up if said else "Y"}"'))
    bind = import_file(path, up=None if said else up).skeleton.world_from_bind
    if said:
        assert bind[1, :3, 3] == pytest.approx(place)
    else:
        assert bind[1, 1, 3] == pytest.approx(0.0)
        assert np.linalg.norm(bind[1, :3, 3]) == pytest.approx(0.02)


def test_the_stage_s_own_turn_and_scale_are_folded_in(tmp_path):
    placed = """double3 xformOp:scale = (2, 2, 2)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        uniform token[] joints = ["Upper", "Upper/Lower"]"""
    path = written(
        tmp_path, ARM.replace('uniform token[] joints = ["Upper", "Upper/Lower"]', placed)
    )
    (animation,) = import_file(path).animations
    assert animation.translation_m[-1, 1, 1] == pytest.approx(8.0)


def test_of_several_skeletons_one_is_taken_by_name_or_because_it_moves_most(tmp_path):
    path = written(tmp_path)
    assert import_file(path).skeleton.joints == ("Upper", "Lower")
    assert "1 other skeletons are not kept" in import_file(path).notes
    for name in ("Other", "/Root/Other"):
        other = import_file(path, skeleton=name)
        assert other.skeleton.joints == ("Only",)
        assert (other.meshes, other.animations) == ((), ())


def test_blend_shapes_are_named_and_their_weights_sampled(tmp_path):
    imported = import_file(written(tmp_path))
    assert imported.shapes == ("smile", "frown")
    weights = imported.animations[0].shape_weights
    np.testing.assert_allclose(weights[:, 0], np.linspace(1, 0, 11), atol=1e-6)
    np.testing.assert_allclose(weights[:, 1], np.linspace(0, 1, 11), atol=1e-6)
    part = imported.part(imported.animations[0], 0.2, 0.5)
    np.testing.assert_array_equal(part.shape_weights, weights[2:6])


def test_blend_shapes_alone_are_an_animation(shared_data):
    path = shared_data / "clips" / "usd" / "blendshape-and-animation-test-001.usda"
    imported = import_file(path)
    assert imported.shapes
    assert np.ptp(imported.animations[0].shape_weights) > 0.0


@pytest.mark.parametrize("name", ["./a.usda", "../a.usda", "../meshes/a.usda"])
def test_a_layer_of_the_same_asset_is_composed(tmp_path, name):
    clips = tmp_path / "clips"
    for folder in (clips, tmp_path / "meshes"):
        folder.mkdir()
    written((clips / name).parent.resolve())
    path = written(clips, f"#usda 1.0\n(\n    subLayers = [@{name}@]\n)\n", "b.usda")
    assert len(import_file(path).skeleton) == 2
