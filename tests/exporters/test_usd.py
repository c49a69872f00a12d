from __future__ import annotations

import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdSkel, UsdValidation

import exporters
from exporters.usd import write_usd
from smd.acting.grip import with_props_held
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.skinning import skin_points
from smd.errors import ExportError
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import rotate
from smd.score_file import score_from_json
from tests.exporters.skinned import skinned

SUFFIXES = (".usda", ".usdc", ".usdz")


@pytest.fixture(scope="module", params=SUFFIXES)
def written(request, performance, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("usd") / f"take{request.param}"
    write_usd(performance, path)
    return path


@pytest.fixture(scope="module")
def stage(performance, tmp_path_factory) -> Usd.Stage:
    path = tmp_path_factory.mktemp("usd") / "take.usdc"
    write_usd(performance, path)
    return Usd.Stage.Open(str(path))


def test_no_validator_finds_anything_wrong(written):
    stage = Usd.Stage.Open(str(written))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    context = UsdValidation.ValidationContext(validators)
    assert [error.GetErrorAsString() for error in context.Validate(stage)] == []


def test_the_validators_would_find_something_wrong(written):
    stage = Usd.Stage.Open(str(written))
    stage.SetEditTarget(stage.GetSessionLayer())
    stage.GetPrimAtPath("/Performance/Actors/left_hand_character").SetTypeName("Xform")
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert UsdValidation.ValidationContext(validators).Validate(stage)


def test_stage_says_its_axes_unit_and_times(written, performance):
    stage = Usd.Stage.Open(str(written))
    assert stage.GetDefaultPrim().GetPath() == "/Performance"
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == 24.0
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, len(performance) - 1)


def test_the_score_travels_along(written, performance):
    data = Sdf.Layer.FindOrOpen(str(written)).customLayerData
    assert data["smd:score"] == performance.source["score"]
    assert score_from_json(data["smd:score"]).recording == "made up"
    assert data["smd:start_s"] == performance.start_s


def test_the_same_input_gives_the_same_bytes_in_another_process_too(written, tmp_path):
    script = (
        "import sys; from exporters.usd import write_usd;"
        "from tests.naive.puppet import performance;"
        "write_usd(performance(2.0, 24.0), sys.argv[1])"
    )
    again = tmp_path / f"other{written.suffix}"
    root = Path(__file__).parents[2]
    subprocess.run([sys.executable, "-c", script, str(again)], check=True, cwd=root, timeout=60)
    assert again.read_bytes() == written.read_bytes()


@pytest.mark.parametrize("frame", [0, 17, 48])
def test_usd_skins_each_actor_as_we_do(stage, performance, frame):
    for name, actor in zip(("left_hand", "right_hand"), performance.actors, strict=True):
        skeleton = actor.character.skeleton
        pose = forward_kinematics(
            skeleton, actor.poses.rotation_xyzw[frame], actor.poses.translation_m[frame]
        )
        ours = skin_points(actor.character.meshes[0], skeleton, *pose)
        theirs = skinned(stage, f"/Performance/Actors/{name}_character", frame)
        np.testing.assert_allclose(theirs, ours, atol=2e-5)  # metres, in single precision


def test_the_extent_holds_the_skin_and_little_else(stage):
    for name in ("left_hand", "right_hand"):
        root = UsdSkel.Root(stage.GetPrimAtPath(f"/Performance/Actors/{name}_character"))
        for frame in range(0, 49, 6):
            low, high = map(np.array, root.GetExtentAttr().Get(frame))
            points = skinned(stage, f"/Performance/Actors/{name}_character", frame)
            assert (low <= points.min(axis=0)).all()
            assert (high >= points.max(axis=0)).all()
            assert (high - low - np.ptp(points, axis=0)).max() < 0.7  # metres


def test_the_prop_goes_where_the_doodle_went(stage, performance):
    actor = performance.actors[0]
    doodle = actor.doodles[0]
    prim = UsdGeom.Xformable(stage.GetPrimAtPath("/Performance/Props/left_hand_prop"))
    for frame in (0, 5, 48):
        at_s = [performance.start_s + frame / performance.rate_hz]
        matrix = prim.ComputeLocalToWorldTransform(frame)
        position = interpolate_linear(doodle.time_s, doodle.position_m, at_s)[0]
        orientation = interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, at_s)[0]
        np.testing.assert_allclose(matrix.ExtractTranslation(), position, atol=1e-12)
        for axis in np.eye(3):
            expected = rotate(orientation, axis)
            np.testing.assert_allclose(matrix.TransformDir(axis.tolist()), expected, atol=1e-6)


def test_a_held_prop_is_seen_where_the_hand_is(performance, stage, tmp_path):
    free = UsdGeom.Mesh(stage.GetPrimAtPath("/Performance/Props/left_hand_prop/Dart"))
    assert free.ComputePurpose() == UsdGeom.Tokens.guide
    held = replace(performance, actors=with_props_held(performance.actors))
    write_usd(held, tmp_path / "held.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "held.usdc"))
    actor = held.actors[0]
    hand = actor.character.skeleton.index("right_hand")
    _, place = forward_kinematics(actor.character.skeleton, *actor.poses)
    prim = UsdGeom.Xformable(stage.GetPrimAtPath("/Performance/Props/left_hand_prop"))
    for frame in (0, 20, 48):
        at = np.array(prim.ComputeLocalToWorldTransform(frame).ExtractTranslation())
        np.testing.assert_allclose(at, actor.held.position_m[frame], atol=1e-5)
        assert np.linalg.norm(at - place[frame, hand]) < 0.1
    dart = UsdGeom.Mesh(stage.GetPrimAtPath("/Performance/Props/left_hand_prop/Dart"))
    assert dart.ComputePurpose() == UsdGeom.Tokens.default_


def test_the_prop_hides_while_tracking_is_lost(stage):
    prop = UsdGeom.Imageable(stage.GetPrimAtPath("/Performance/Props/right_hand_prop"))
    # Lost from 10.8 to 11.2 s, that is from frame 19.2 to 28.8.
    seen = [prop.ComputeVisibility(frame) == UsdGeom.Tokens.inherited for frame in range(49)]
    assert seen == [not 19.2 < frame < 28.8 for frame in range(49)]


def test_the_doodle_is_one_curve_a_stretch(stage, performance):
    curves = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Performance/Doodles/left_hand_doodle"))
    counts = np.array(curves.GetCurveVertexCountsAttr().Get())
    colors = np.array(curves.GetDisplayColorPrimvar().ComputeFlattened())
    doodle = performance.actors[0].doodles[0]
    assert len(counts) == len(colors) == 5  # idle, walk, idle, punch, idle
    assert counts.sum() == len(doodle) + 4
    assert np.array_equal(colors[0], colors[2])
    assert len(np.unique(colors, axis=0)) == 3
    ends = np.cumsum(counts)
    points = np.array(curves.GetPointsAttr().Get())
    assert np.array_equal(points[ends[:-1] - 1], points[ends[:-1]])
    border_s = [10.2, 10.9, 11.2, 11.8]
    np.testing.assert_allclose(
        points[ends[:-1]], interpolate_linear(doodle.time_s, doodle.position_m, border_s), atol=0.05
    )
    # The other hand's doodle is lost from 10.8 to 11.2 s: idle, walk; punch, idle.
    other = UsdGeom.BasisCurves(stage.GetPrimAtPath("/Performance/Doodles/right_hand_doodle"))
    assert len(other.GetCurveVertexCountsAttr().Get()) == 4


def test_meshes_face_outward_and_enclose_their_volume(stage):
    for path in ("Actors/left_hand_character/Body", "Props/left_hand_prop/Dart"):
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"/Performance/{path}"))
        points = np.array(mesh.GetPointsAttr().Get())
        a, b, c = points[np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)].swapaxes(
            0, 1
        )
        assert np.einsum("ni,ni->", a, np.cross(b, c)) > 0


def test_the_camera_sees_every_body(stage):
    camera = UsdGeom.Camera(stage.GetPrimAtPath("/Performance/Scenery/Camera"))
    frustum = camera.GetCamera(0).frustum
    for name in ("left_hand", "right_hand"):
        for frame in (0, 24, 48):
            for point in skinned(stage, f"/Performance/Actors/{name}_character", frame)[::7]:
                assert frustum.Intersects(point.tolist())


def test_a_package_holds_one_aligned_uncompressed_layer(performance, tmp_path):
    path = tmp_path / "take.usdz"
    write_usd(performance, path)
    with zipfile.ZipFile(path) as package:
        (entry,) = package.infolist()
        assert package.testzip() is None
    raw = path.read_bytes()
    name, extra = (
        int.from_bytes(raw[entry.header_offset + i : entry.header_offset + i + 2], "little")
        for i in (26, 28)
    )
    start = entry.header_offset + 30 + name + extra
    assert start % 64 == 0
    assert raw[start : start + 8] == b"PXR-USDC"
    assert entry.compress_type == zipfile.ZIP_STORED


def test_devices_of_any_name_get_prims_of_their_own(performance, tmp_path):
    first, second = performance.actors
    odd = replace(performance, actors=(replace(first, name="手 1"), replace(second, name="手-1")))
    write_usd(odd, tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    roots = stage.GetPrimAtPath("/Performance/Actors").GetChildren()
    assert [root.GetCustomDataByKey("smd:device") for root in roots] == ["手 1", "手-1"]


def test_a_device_s_name_is_its_skeleton_s_alone(stage):
    # Blender names objects after prims: the armature is to have the name, and no number behind it.
    for name in ("left_hand", "right_hand"):
        named = [prim for prim in stage.Traverse() if prim.GetName() == name]
        assert [prim.GetTypeName() for prim in named] == ["Skeleton"]


@pytest.mark.parametrize("devices", [("Materials", "Body"), ("Body_animation", "Skeleton")])
def test_devices_may_be_called_as_prims_are(performance, tmp_path, devices):
    named = [replace(a, name=n) for a, n in zip(performance.actors, devices, strict=True)]
    write_usd(replace(performance, actors=tuple(named)), tmp_path / "a.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    for root, device in zip(
        stage.GetPrimAtPath("/Performance/Actors").GetChildren(), devices, strict=True
    ):
        assert root.GetCustomDataByKey("smd:device") == device
        skinned(stage, str(root.GetPath()), 17)
        kinds = [child.GetTypeName() for child in root.GetChildren()]
        assert sorted(kinds) == ["Mesh", "Scope", "SkelAnimation", "Skeleton"]


def test_a_single_frame_and_sample_is_a_stage_too(performance, tmp_path):
    actor = performance.actors[0]
    doodle = actor.doodles[0]
    short = replace(
        actor,
        poses=Poses(actor.poses.rotation_xyzw[:1], actor.poses.translation_m[:1]),
        doodles=(
            replace(
                doodle,
                time_s=doodle.time_s[:1],
                position_m=doodle.position_m[:1],
                orientation_xyzw=doodle.orientation_xyzw[:1],
                drawing=None,
            ),
        ),
    )
    write_usd(replace(performance, actors=(short,)), tmp_path / "a.usdc")
    assert Usd.Stage.Open(str(tmp_path / "a.usdc"))


def test_write_chooses_by_suffix(performance, tmp_path):
    exporters.write(performance, tmp_path / "A.USDC")
    assert (tmp_path / "A.USDC").read_bytes().startswith(b"PXR-USDC")
    exporters.write(performance, str(tmp_path / "a.usda"))
    assert (tmp_path / "a.usda").read_bytes().startswith(b"#usda")


def test_an_unknown_suffix_is_answered_with_the_known_ones(performance, tmp_path):
    with pytest.raises(ExportError, match=r"take\.fbx: .*\.usda, \.usdc, \.usdz"):
        exporters.write(performance, tmp_path / "take.fbx")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_missing_folder_is_named_and_nothing_is_left(performance, tmp_path, suffix):
    with pytest.raises(ExportError, match="nowhere"):
        write_usd(performance, tmp_path / "nowhere" / f"take{suffix}")
    assert list(tmp_path.iterdir()) == []
