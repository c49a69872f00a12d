"""--timing, --stretch and --hold: what they give, and what they refuse."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pxr import Usd, UsdGeom

from smd.score_file import read_score, write_score
from tests.smd.cli.test_bad_input import expect_one_line


@pytest.fixture
def animate(run_smd, stories, tmp_path):
    """Act out the first phrases of a shipped Score; return what `run_smd` does."""
    score = read_score(stories / "fledgling.score.json")
    (part,) = score.performers
    score = replace(score, performers=(replace(part, phrases=part.phrases[:3]),))
    write_score(score, tmp_path / "a.score.json")

    def run(name, *options):
        recording = ("--recording", stories / "fledgling.csv")
        return run_smd(
            "animate", tmp_path / "a.score.json", *recording, "-o", tmp_path / name, *options
        )

    return run


def lasting_s(path) -> float:
    stage = Usd.Stage.Open(str(path))
    frames = stage.GetEndTimeCode() - stage.GetStartTimeCode()
    return frames / stage.GetTimeCodesPerSecond()


@pytest.mark.parametrize("stretch", ["x", "nan", "0", "-1", "30", "1,5"])
def test_a_stretch_that_is_none_costs_one_line(run_smd, stories, tmp_path, stretch):
    output = tmp_path / "out.usda"
    code, _, err = run_smd(
        "convert", stories / "fledgling.csv", "-o", output, f"--stretch={stretch}"
    )
    line = expect_one_line(code, err)
    assert f"stretch: expected 'auto' or a number from 0.1 to 20, got {stretch!r}" in line
    assert not output.exists()


def test_a_take_as_drawn_is_not_stretched_by_itself(animate, tmp_path):
    code, _, err = animate("out.usda", "--timing", "drawn", "--stretch", "auto")
    assert "stretch: expected a number with the timing 'drawn'" in expect_one_line(code, err)
    assert not (tmp_path / "out.usda").exists()


def test_a_timing_that_is_none_is_wrong_usage(animate):
    code, _, err = animate("out.usda", "--timing", "later")
    assert code == 2
    assert "later" in err


def test_an_animation_lasts_as_many_times_as_long_as_it_is_told_and_says_so(animate, tmp_path):
    code, _, err = animate("own.usda", "--timing", "drawn")
    assert code == 0, err
    code, out, err = animate("slow.usda", "--stretch", "1.5")
    assert code == 0, err
    assert "plan: 1.5 times as long as the recording" in out + err
    ratio = lasting_s(tmp_path / "slow.usda") / lasting_s(tmp_path / "own.usda")
    assert ratio == pytest.approx(1.5, abs=0.01)


def test_a_prop_is_held_on_request(animate, tmp_path):
    for name, options in (("free", ()), ("held", ("--hold",))):
        code, _, err = animate(f"{name}.usda", *options)
        assert code == 0, err
        stage = Usd.Stage.Open(str(tmp_path / f"{name}.usda"))
        meshes = (UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
        darts = [mesh for mesh in meshes if mesh.GetPrim().GetName() == "Dart"]
        assert darts
        seen = UsdGeom.Tokens.default_ if options else UsdGeom.Tokens.guide
        assert {dart.ComputePurpose() for dart in darts} == {seen}
