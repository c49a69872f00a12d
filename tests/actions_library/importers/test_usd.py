from __future__ import annotations

import re

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdSkel

from actions_library.folder import load_library
from actions_library.importers import import_file
from actions_library.importers.usd_meshes import fans
from smd.character.kinematics import forward_kinematics
from smd.errors import ImportedFileError

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
        uniform token[] skel:blendShapes = ["smile", "frown"]
        rel skel:blendShapeTargets = [</Root/Skin/Up>, </Root/Skin/Down>]
        def BlendShape "Up"
        {
            uniform vector3f[] offsets = [(0, 0.5, 0), (0, 0, 0.25)]
            uniform int[] pointIndices = [3, 1]
        }
        def BlendShape "Down"
        {
            uniform vector3f[] offsets = [(0, 0, 0), (1, 0, 0), (0, 0, 0), (0, -1, 0)]
        }
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


def test_blend_shapes_come_with_their_offsets(tmp_path):
    (mesh,) = import_file(written(tmp_path)).meshes
    smile, frown = mesh.shapes
    assert (smile.name, frown.name) == ("smile", "frown")
    assert smile.indices.tolist() == frown.indices.tolist() == [1, 3]
    assert smile.offsets_m == pytest.approx(np.array([[0, 0, 0.25], [0, 0.5, 0]]))
    assert frown.offsets_m == pytest.approx(np.array([[1, 0, 0], [0, -1, 0]]))


def test_offsets_turn_and_grow_with_their_points(tmp_path):
    """A mesh turned and scaled when it was bound: its offsets are, and are not moved."""
    bind = "geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))"
    turned = ARM.replace(bind, "geomBindTransform = ((0,2,0,0),(-2,0,0,0),(0,0,2,0),(5,6,7,1))")
    assert turned != ARM
    (mesh,) = import_file(written(tmp_path, turned)).meshes
    smile, _ = mesh.shapes
    assert smile.offsets_m == pytest.approx(np.array([[0, 0, 0.5], [-1, 0, 0]]))


def test_weights_of_blend_shapes_are_sampled(tmp_path):
    imported = import_file(written(tmp_path))
    (animation,) = imported.animations
    assert animation.tracks.names == ("frown", "smile")
    np.testing.assert_allclose(animation.tracks.value[:, 1], np.linspace(1, 0, 11), atol=1e-6)
    np.testing.assert_allclose(animation.tracks.value[:, 0], np.linspace(0, 1, 11), atol=1e-6)
    part = imported.part(animation, 0.2, 0.5)
    np.testing.assert_array_equal(part.tracks.value, animation.tracks.value[2:6])


def test_weights_that_nothing_animates_are_those_at_rest(tmp_path):
    still = re.sub(r"\.timeSamples = \{ 0: \[0, 1\], 10: \[1, 0\] \}", " = [0.25, 0]", ARM)
    still = re.sub(
        r"translations\.timeSamples = \{ 0: (.*), 10: .* \}", r"translations = \1", still
    )
    imported = import_file(written(tmp_path, still))
    assert imported.animations == ()
    assert imported.rest_tracks.of(["frown", "smile"]).tolist() == [[0.25, 0.0]]


def test_a_file_of_movement_alone_keeps_weights_of_any_name(tmp_path):
    alone = ARM[: ARM.index("    def Mesh")] + "}\n"
    (animation,) = import_file(written(tmp_path, alone)).animations
    assert animation.tracks.names == ("frown", "smile")


@pytest.mark.parametrize(
    ("what", "instead", "said"),
    [
        ('= ["frown", "smile"]', '= ["brow", "smile"]', "expected shapes of its meshes, .*brow"),
        ('skel:blendShapes = ["smile", "frown"]', 'skel:blendShapes = ["smile"]', "1 targets"),
        ("[(0, 0.5, 0), (0, 0, 0.25)]", "[(0, 0.5, 0)]", "Up: expected 2 offsets, found 1"),
        ("(0, 0.5, 0), (0", "(0, nan, 0), (0", "Up: expected finite offsets"),
        ("(0, 0.5, 0), (0", "(0, inf, 0), (0", "Up: expected finite offsets"),
        ("[3, 1]", "[4, 1]", "Up: expected point indices from 0 to 3, found 1 to 4"),
        ("[3, 1]", "[-1, 1]", "Up: expected point indices from 0 to 3, found -1 to 1"),
        (", (0, -1, 0)]", "]", "Down: expected 4 offsets, found 3"),
        ("</Root/Skin/Up>", "</Root/Skin/Gone>", "Gone: expected a BlendShape, found none"),
        ("10: [1, 0]", "10: [1, 0, 0]", "blendShapeWeights, time code .*: expected 2 finite"),
        ("10: [1, 0]", "10: [1, nan]", "blendShapeWeights, time code .*: expected 2 finite"),
        ('= ["frown", "smile"]', '= ["smile", "smile"]', "'smile' appears twice"),
        ('= ["smile", "frown"]', '= ["smile", "smile"]', "smile|unique"),
    ],
)
def test_damaged_blend_shapes_are_refused_in_one_line(tmp_path, what, instead, said):
    assert what in ARM
    with pytest.raises(ImportedFileError, match=said) as found:
        import_file(written(tmp_path, ARM.replace(what, instead)))
    assert "\n" not in str(found.value)


def test_very_many_blend_shapes_are_refused_at_once(tmp_path):
    names = ", ".join(f'"s{k}"' for k in range(10_000))
    targets = ", ".join(f"</Root/Skin/s{k}>" for k in range(10_000))
    many = ARM.replace('skel:blendShapes = ["smile", "frown"]', f"skel:blendShapes = [{names}]")
    many = re.sub(r"blendShapeTargets = \[.*\]", f"blendShapeTargets = [{targets}]", many)
    with pytest.raises(ImportedFileError, match="at most 4096 shapes, found 10000"):
        import_file(written(tmp_path, many))


def test_blend_shapes_alone_are_an_animation(shared_data):
    path = shared_data / "clips" / "usd" / "blendshape-and-animation-test-001.usda"
    imported = import_file(path)
    (mesh,) = imported.meshes
    (shape,) = mesh.shapes
    assert shape.indices.tolist() == [0, 4]
    assert np.linalg.norm(shape.offsets_m, axis=-1) == pytest.approx(
        np.hypot(0.6491, 1.0786), abs=1e-4
    )
    assert np.ptp(imported.animations[0].tracks.of([shape.name])) > 0.0


@pytest.mark.parametrize("name", ["./a.usda", "../a.usda", "../meshes/a.usda"])
def test_a_layer_of_the_same_asset_is_composed(tmp_path, name):
    clips = tmp_path / "clips"
    for folder in (clips, tmp_path / "meshes"):
        folder.mkdir()
    written((clips / name).parent.resolve())
    path = written(clips, f"#usda 1.0\n(\n    subLayers = [@{name}@]\n)\n", "b.usda")
    assert len(import_file(path).skeleton) == 2
