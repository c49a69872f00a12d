"""Frames, variants and layers show the same world as the plain file does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdSkel, UsdValidation

from exporters.performer import EXPRESSION
from exporters.usd import write_usd, write_usd_layers
from smd import StageFrame
from smd.errors import ExportError
from tests.exporters.skinned import skinned

FRAMES = [StageFrame(up, unit_m) for up in "yz" for unit_m in (1.0, 0.01)]
ACTOR = "/Performance/Actors/left_hand_character"


@pytest.fixture(scope="module")
def neutral(performance):
    """The same, with arms at rest."""

    def still(actor):
        return np.repeat(actor.poses.rotation_xyzw[:1], len(performance), axis=0)

    actors = tuple(
        replace(actor, poses=actor.poses._replace(rotation_xyzw=still(actor)))
        for actor in performance.actors
    )
    return replace(performance, actors=actors)


@pytest.fixture(scope="module", params=FRAMES, ids=lambda f: f"{f.up}-{f.unit_m}")
def framed(request, performance, neutral, tmp_path_factory):
    path = tmp_path_factory.mktemp("frames") / "take.usdc"
    write_usd(performance, path, neutral=neutral, frame=request.param)
    return Usd.Stage.Open(str(path))


@pytest.fixture(scope="module")
def both(performance, neutral, tmp_path_factory):
    path = tmp_path_factory.mktemp("both") / "take.usdc"
    write_usd(performance, path, neutral=neutral)
    return Usd.Stage.Open(str(path))


@pytest.fixture(scope="module")
def plain(performance, tmp_path_factory):
    path = tmp_path_factory.mktemp("plain") / "take.usdc"
    write_usd(performance, path)
    return Usd.Stage.Open(str(path))


def ours_m(stage: Usd.Stage, points) -> np.ndarray:
    """Return a stage's points in metres, Y up, by what the stage says of itself."""
    x, y, z = np.moveaxis(np.array(points, dtype=float), -1, 0)
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z:
        y, z = z, -y
    return np.stack([x, y, z], axis=-1) * UsdGeom.GetStageMetersPerUnit(stage)


def findings(stage: Usd.Stage) -> list[str]:
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    return [error.GetErrorAsString() for error in found]


def test_no_validator_finds_anything_in_any_frame(framed):
    assert findings(framed) == []


@pytest.mark.parametrize("code", [0, 17, 48])
def test_usd_skins_to_the_same_world_in_any_frame(framed, plain, code):
    theirs, expected = ours_m(framed, skinned(framed, ACTOR, code)), skinned(plain, ACTOR, code)
    np.testing.assert_allclose(theirs, expected, atol=1e-5)  # metres


def test_what_stands_around_is_converted_too(framed, both):
    def everything(stage):
        prim = stage.GetPrimAtPath
        curves = UsdGeom.BasisCurves(prim("/Performance/Doodles/left_hand_doodle"))
        dart = UsdGeom.Mesh(prim("/Performance/Props/left_hand_prop/Dart"))
        world = UsdGeom.Xformable(dart).ComputeLocalToWorldTransform(17)
        camera = UsdGeom.Camera(prim("/Performance/Scenery/Camera"))
        lens = camera.GetCamera(0)
        unit_m = UsdGeom.GetStageMetersPerUnit(stage)
        eye = lens.transform.ExtractTranslation()
        yield curves.GetPointsAttr().Get()
        yield UsdGeom.Mesh(prim("/Performance/Scenery/Ground")).GetPointsAttr().Get()
        yield [world.Transform(point) for point in dart.GetPointsAttr().Get()]
        yield [eye, eye + lens.transform.TransformDir((0, 0, -1)) / unit_m]
        yield [eye, eye + lens.transform.TransformDir((0, 1, 0)) / unit_m]
        yield np.sort(UsdSkel.Root(prim(ACTOR)).GetExtentAttr().Get(17), axis=0)

    for theirs, expected in zip(everything(framed), everything(both), strict=True):
        theirs, expected = ours_m(framed, theirs), np.array(expected)
        if len(expected) == 2:  # boxes: which corner is least differs between the axes
            theirs, expected = (np.sort(corners, axis=0) for corners in (theirs, expected))
        np.testing.assert_allclose(theirs, expected, atol=2e-5)


def test_lenses_and_widths_are_lengths(framed):
    unit_m = UsdGeom.GetStageMetersPerUnit(framed)
    camera = UsdGeom.Camera(framed.GetPrimAtPath("/Performance/Scenery/Camera"))
    # USD: in tenths of the stage's unit
    assert camera.GetFocalLengthAttr().Get() * unit_m / 10 == pytest.approx(0.040)
    assert camera.GetHorizontalApertureAttr().Get() * unit_m / 10 == pytest.approx(0.036)
    assert camera.GetVerticalApertureAttr().Get() * unit_m / 10 == pytest.approx(0.02025)
    assert camera.GetClippingRangeAttr().Get()[0] * unit_m == pytest.approx(0.05)
    curves = UsdGeom.BasisCurves(framed.GetPrimAtPath("/Performance/Doodles/left_hand_doodle"))
    assert curves.GetWidthsAttr().Get()[0] * unit_m == pytest.approx(0.03)


def test_the_skeleton_at_rest_is_the_same_in_any_frame(framed, plain):
    for name in ("GetBindTransformsAttr", "GetRestTransformsAttr"):
        theirs, expected = (
            getattr(UsdSkel.Skeleton(stage.GetPrimAtPath(f"{ACTOR}/left_hand")), name)().Get()
            for stage in (framed, plain)
        )
        places = [matrix.ExtractTranslation() for matrix in theirs]
        expected_m = [matrix.ExtractTranslation() for matrix in expected]
        np.testing.assert_allclose(ours_m(framed, places), expected_m, atol=1e-12)


def test_each_variant_plays_its_own_performance(framed, performance, neutral, tmp_path):
    write_usd(neutral, tmp_path / "neutral.usdc")
    write_usd(performance, tmp_path / "expressive.usdc")
    stage = Usd.Stage.Open(framed.GetRootLayer())
    stage.SetEditTarget(stage.GetSessionLayer())
    variants = stage.GetPrimAtPath(ACTOR).GetVariantSets().GetVariantSet(EXPRESSION)
    assert variants.GetVariantNames() == ["expressive", "neutral"]
    assert variants.GetVariantSelection() == "expressive"
    for name in variants.GetVariantNames():
        variants.SetVariantSelection(name)
        alone = Usd.Stage.Open(str(tmp_path / f"{name}.usdc"))
        for code in (5, 40):
            theirs = ours_m(stage, skinned(stage, ACTOR, code))
            np.testing.assert_allclose(theirs, skinned(alone, ACTOR, code), atol=1e-5)
        assert findings(stage) == []


def test_what_both_variants_share_is_stored_once(performance, tmp_path):
    write_usd(performance, tmp_path / "one.usdc")
    # Arrays of another performance, equal but not the same.
    again = tuple(replace(actor) for actor in performance.actors)
    write_usd(performance, tmp_path / "two.usdc", neutral=replace(performance, actors=again))
    one, two = ((tmp_path / f"{name}.usdc").stat().st_size for name in ("one", "two"))
    assert two - one < 1000


def test_without_a_neutral_performance_there_are_no_variants(plain):
    assert plain.GetPrimAtPath(ACTOR).GetVariantSets().GetNames() == []


def test_a_neutral_performance_of_other_frames_is_refused(performance, tmp_path):
    with pytest.raises(ExportError, match=r"neutral: expected .* same devices"):
        write_usd(performance, tmp_path / "a.usda", neutral=replace(performance, rate_hz=30.0))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".usda", ".usdc"])
def test_layers_compose_to_the_plain_stage(performance, neutral, plain, tmp_path, suffix):
    write_usd_layers(performance, tmp_path / f"take{suffix}", neutral=neutral)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {f"take{suffix}", "take.left_hand.usdc", "take.right_hand.usdc"}
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    for name in names:
        (tmp_path / name).rename(moved / name)
    stage = Usd.Stage.Open(str(moved / f"take{suffix}"))
    assert findings(stage) == []
    paths = {str(prim.GetPath()) for prim in stage.Traverse()}
    assert paths == {str(prim.GetPath()) for prim in plain.Traverse()}
    np.testing.assert_array_equal(skinned(stage, ACTOR, 17), skinned(plain, ACTOR, 17))
    alone = Usd.Stage.Open(str(moved / "take.left_hand.usdc"))
    assert findings(alone) == []
    assert str(alone.GetDefaultPrim().GetPath()) == "/Performer"


def test_the_file_over_layers_is_small(performance, tmp_path):
    write_usd_layers(performance, tmp_path / "take.usda")
    assert (tmp_path / "take.usda").stat().st_size < 8_000


def test_a_package_cannot_have_layers_beside_it(performance, tmp_path):
    with pytest.raises(ExportError, match=r"expected \.usda or \.usdc"):
        write_usd_layers(performance, tmp_path / "take.usdz")
    assert list(tmp_path.iterdir()) == []


def test_a_layer_that_cannot_be_written_leaves_everything_as_it_was(performance, tmp_path):
    (tmp_path / "take.usda").write_text("before")
    (tmp_path / "take.right_hand.usdc").mkdir()
    with pytest.raises(ExportError, match=r"take\.right_hand\.usdc: expected a file"):
        write_usd_layers(performance, tmp_path / "take.usda")
    assert (tmp_path / "take.usda").read_text() == "before"
    assert {path.name for path in tmp_path.iterdir()} == {"take.usda", "take.right_hand.usdc"}


@pytest.mark.parametrize("devices", [("手 1", "手-1"), ("Left", "left")])
def test_devices_of_like_names_get_layers_of_their_own(performance, tmp_path, devices):
    actors = tuple(
        replace(actor, name=name) for actor, name in zip(performance.actors, devices, strict=True)
    )
    odd = replace(performance, actors=actors)
    write_usd_layers(odd, tmp_path / "ein Stück [1] @.usda")
    assert len({path.name.lower() for path in tmp_path.iterdir()}) == 3
    stage = Usd.Stage.Open(str(tmp_path / "ein Stück [1] @.usda"))
    roots = stage.GetPrimAtPath("/Performance/Actors").GetChildren()
    assert [root.GetCustomDataByKey("smd:device") for root in roots] == list(devices)


@pytest.mark.parametrize(("up", "unit"), [("x", "m"), ("y", "mm")])
def test_an_unknown_axis_or_unit_is_named(up, unit):
    with pytest.raises(ExportError, match=r"stage (up|unit): expected (y or z|m or cm), found '"):
        StageFrame.named(up, unit)
