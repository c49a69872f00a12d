"""Shapes and tracks in a library's files: whole, as USD has them, and refused where damaged."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdSkel, UsdValidation, Vt

from actions_library.checking import check_library
from actions_library.folder import load_library, write_library
from actions_library.library import Library
from actions_library.stage_frame import StageFrame
from actions_library.storage import new_stage
from actions_library.usd_skel import define_character, read_character
from smd.character.blend_shape import BlendShape
from smd.character.character import Character
from smd.character.tracks import Tracks
from smd.errors import LibraryError
from smd.recognition.action import Action
from tests.naive.shaped import NAMES, shaped_clip, shaped_puppet, weights

GOLDEN = Path(__file__).parents[1] / "golden" / "libraries"


def written(folder: Path, character: Character | None = None) -> Library:
    clips = {"idle": replace(shaped_clip("idle"), cyclic=True), "wave": shaped_clip("wave")}
    actions = (Action("idle", None, cyclic=True), Action("wave", None))
    character = character or shaped_puppet()
    return write_library(folder, name="faces", character=character, clips=clips, actions=actions)


def same_shapes(ours: Character, theirs: Character) -> None:
    assert theirs.shapes == ours.shapes
    for a, b in zip(ours.meshes, theirs.meshes, strict=True):
        assert [shape.name for shape in b.shapes] == [shape.name for shape in a.shapes]
        for one, other in zip(a.shapes, b.shapes, strict=True):
            assert np.array_equal(other.indices, one.indices)
            assert np.array_equal(other.offsets_m, one.offsets_m)


def test_a_library_keeps_shapes_and_tracks_exactly(tmp_path):
    library = written(tmp_path / "faces")
    same_shapes(shaped_puppet(), library.character)
    tracks = library.clip("wave").tracks
    assert set(tracks.names) == {*NAMES, "gear"}
    assert np.array_equal(tracks.of(weights(30).names), weights(30).value)
    assert check_library(library).faults == ()


def test_writing_what_was_read_stores_the_same_numbers(tmp_path):
    first = written(tmp_path / "faces")
    again = write_library(
        tmp_path / "again",
        name="faces",
        character=first.character,
        clips=first.clips,
        actions=first.actions,
    )
    same_shapes(first.character, again.character)
    for file in (first.character_file, *first.clip_files.values()):
        one, other = (Sdf.Layer.FindOrOpen(str(each.folder / file)) for each in (first, again))
        found = 0
        for path in paths_of(one):
            if path.name in ("offsets", "pointIndices", "blendShapeWeights", "smd:controlValues"):
                found += 1
                assert (
                    one.GetAttributeAtPath(path).default == other.GetAttributeAtPath(path).default
                )
                for time in one.ListTimeSamplesForPath(path):
                    assert one.QueryTimeSample(path, time) == other.QueryTimeSample(path, time)
        assert found in (2, 8)


def paths_of(layer: Sdf.Layer) -> list[Sdf.Path]:
    paths: list[Sdf.Path] = []
    layer.Traverse(Sdf.Path.absoluteRootPath, paths.append)
    return [path for path in paths if path.IsPropertyPath()]


@pytest.mark.parametrize("file", ["character.usdc", "clips/wave.usdc"])
def test_usd_s_validators_are_silent(tmp_path, file):
    written(tmp_path / "faces")
    stage = Usd.Stage.Open(str(tmp_path / "faces" / file))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert UsdValidation.ValidationContext(validators).Validate(stage) == []


def test_the_clip_s_file_moves_the_shapes_in_other_programs(tmp_path):
    """USD's own queries find a mesh's weights; a control that is no shape is beside them."""
    written(tmp_path / "faces")
    stage = Usd.Stage.Open(str(tmp_path / "faces" / "clips" / "wave.usdc"))
    root = UsdSkel.Root(stage.GetPrimAtPath("/Clip"))
    cache = UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    animation = cache.GetSkelQuery(binding.GetSkeleton()).GetAnimQuery()
    for target in binding.GetSkinningTargets():
        names = target.GetBlendShapesAttr().Get()
        found = target.GetBlendShapeMapper().Remap(animation.ComputeBlendShapeWeights(11.0))
        assert list(found) == pytest.approx(weights(30).of(names)[11].tolist())
    gear = stage.GetPrimAtPath("/Clip/Animation").GetAttribute("smd:controlValues")
    assert list(gear.Get(11.0)) == pytest.approx(weights(30).of(["gear"])[11].tolist())


@pytest.mark.parametrize("frame", [StageFrame("z"), StageFrame("y", 0.01), StageFrame("z", 0.01)])
def test_offsets_are_those_between_points_in_any_frame(frame):
    stage = new_stage("Puppet", frame)
    define_character(stage, "/Puppet", shaped_puppet())
    in_frame = read_character(stage, "puppet")
    for mesh, ours in zip(in_frame.meshes, shaped_puppet().meshes, strict=True):
        for shape, own in zip(mesh.shapes, ours.shapes, strict=True):
            start = frame.points(ours.points_m[own.indices])
            end = frame.points(ours.points_m[own.indices] + own.offsets_m)
            np.testing.assert_allclose(shape.offsets_m, end - start, atol=2e-5)


def test_normals_of_a_shape_are_those_of_the_mesh_that_it_gives(tmp_path):
    """The normals and their offsets add up to the normals of the points and their offsets."""
    stage = new_stage("Puppet")
    define_character(stage, "/Puppet", shaped_puppet())
    (mesh, _) = shaped_puppet().meshes
    (smile, *_) = mesh.shapes
    points = mesh.points_m.copy()
    points[smile.indices] += smile.offsets_m
    formed = replace(shaped_puppet(), meshes=(replace(mesh, points_m=points, shapes=()),))
    other = new_stage("Puppet")
    define_character(other, "/Puppet", formed)
    plain, expected = (
        np.array(each.GetAttributeAtPath("/Puppet/Body.normals").Get()) for each in (stage, other)
    )
    shape = UsdSkel.BlendShape.Get(stage, "/Puppet/Body/smile")
    plain[smile.indices] += np.array(shape.GetNormalOffsetsAttr().Get())
    np.testing.assert_allclose(plain[smile.indices], expected[smile.indices], atol=1e-6)


def edited(folder: Path, file: str, path: str, value: object) -> None:
    """Give an attribute of one of a library's files another value, at each of its times."""
    layer = Sdf.Layer.FindOrOpen(str(folder / file))
    times = layer.ListTimeSamplesForPath(path)
    for time in times:
        layer.SetTimeSample(path, time, value)
    if not times:
        layer.GetAttributeAtPath(path).default = value
    layer.Save()


def face(name: str) -> str:
    return f"/puppet/Body/{name}"


@pytest.mark.parametrize(
    ("file", "path", "value", "said"),
    [
        (
            "character.usdc",
            face("smile.offsets"),
            Vt.Vec3fArray(3),
            r"shape 'smile': offsets_m: expected shape \(\d+, 3\), got \(3, 3\)",
        ),
        (
            "character.usdc",
            face("smile.pointIndices"),
            Vt.IntArray([0, 9999]),
            r"shape 'smile': offsets_m: expected shape \(2, 3\)",
        ),
        (
            "character.usdc",
            "/puppet/Body.skel:blendShapes",
            Vt.TokenArray(["smile"]),
            "/puppet/Body: expected 1 blend shapes, got 3",
        ),
        (
            "clips/wave.usdc",
            "/Clip/Animation.blendShapes",
            Vt.TokenArray(["smile", "jaw open", "frown"]),
            "blendShapes: expected shapes of the character, got 'frown'",
        ),
        (
            "clips/wave.usdc",
            "/Clip/Animation.blendShapes",
            Vt.TokenArray(["smile", "jaw open"]),
            r"blendShapeWeights: expected time samples of shape \(2,\), got \[\(3,\)\]",
        ),
        (
            "clips/wave.usdc",
            "/Clip/Animation.blendShapeWeights",
            Vt.FloatArray([0.0, float("nan"), 0.0]),
            "tracks: expected finite numbers, got nan",
        ),
        (
            "clips/wave.usdc",
            "/Clip/Animation.blendShapes",
            Vt.TokenArray(["smile", "smile", "jaw open"]),
            "tracks: 'smile' appears twice",
        ),
    ],
)
def test_damaged_shapes_and_tracks_are_refused_in_one_line(tmp_path, file, path, value, said):
    library = written(tmp_path / "faces")
    edited(library.folder, file, path, value)
    again = load_library(library.folder)
    with pytest.raises(LibraryError, match=said) as found:
        again.clip("wave")
    assert "\n" not in str(found.value)
    assert str(library.folder / file) in str(found.value)
    assert check_library(again).faults


def test_shapes_with_indices_beyond_the_mesh_are_refused(tmp_path):
    library = written(tmp_path / "faces")
    edited(library.folder, "character.usdc", face("smile.pointIndices"), Vt.IntArray([0, 9999]))
    edited(library.folder, "character.usdc", face("smile.offsets"), Vt.Vec3fArray(2))
    with pytest.raises(LibraryError, match=r"mesh 'Body': shape 'smile': expected indices below"):
        load_library(library.folder).character  # noqa: B018


def test_tracks_of_another_length_than_the_joints_are_refused(tmp_path):
    library = written(tmp_path / "faces")
    layer = Sdf.Layer.FindOrOpen(str(library.folder / "clips" / "wave.usdc"))
    for name in ("blendShapeWeights", "smd:controlValues"):
        layer.EraseTimeSample(f"/Clip/Animation.{name}", 3.0)
    layer.Save()
    with pytest.raises(LibraryError, match="tracks: expected 30 frames, got 29"):
        load_library(library.folder).clip("wave")


def test_ten_thousand_shapes_work(tmp_path):
    rng = np.random.default_rng(0)
    body = shaped_puppet().meshes[0]
    many = tuple(
        BlendShape(f"s{k}", np.array([k % len(body.points_m)]), rng.normal(size=(1, 3)))
        for k in range(10_000)
    )
    character = replace(shaped_puppet(), meshes=(replace(body, shapes=many),))
    names = tuple(f"s{k}" for k in range(10_000))
    clip = replace(shaped_clip("idle"), tracks=Tracks(names, rng.uniform(size=(30, 10_000))))
    idle = (Action("idle", None),)
    library = write_library(
        tmp_path / "many", name="many", character=character, clips={"idle": clip}, actions=idle
    )
    assert library.character.shapes == names
    assert library.clip("idle").tracks.names == names


@pytest.mark.parametrize("version", ["version_1", "version_2", "version_3"])
def test_libraries_from_before_there_were_shapes_load(tmp_path, version):
    library = load_library(shutil.copytree(GOLDEN / version, tmp_path / version))
    assert library.character.shapes == ()
    for clip in library.clips.values():
        assert clip.tracks.value.shape == (len(clip), 0)
