"""What the options that say how an animation is written give, and what they refuse."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pxr import Usd, UsdGeom

import exporters
from laban import Effort
from smd.cli.places import recording_files
from smd.score_file import read_score, write_score
from tests.smd.cli.test_bad_input import expect_one_line


@pytest.fixture
def animate(run_smd, stories, tmp_path):
    """Act out a shipped Score's first phrase; return what `run_smd` does."""

    def run(name, *options, effort=None):
        score = read_score(stories / "fledgling.score.json")
        (part,) = score.performers
        phrase = part.phrases[0] if effort is None else replace(part.phrases[0], effort=effort)
        score = replace(score, performers=(replace(part, phrases=(phrase,)),))
        write_score(score, tmp_path / "a.score.json")
        recording = stories / "fledgling.csv"
        return run_smd(
            "animate",
            tmp_path / "a.score.json",
            *("--recording", recording),
            *("-o", tmp_path / name),
            *options,
        )

    return run


def test_every_option_together(animate, tmp_path):
    options = ["--layers", "--phrases", "--variants", "--stage-up", "z", "--stage-unit", "cm"]
    code, _, err = animate("out.usda", *options, "--fps", "30", effort=Effort(0.5, 0.5))
    assert code == 0, err
    stage = Usd.Stage.Open(str(tmp_path / "out.usda"))
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01
    assert stage.GetFramesPerSecond() == 30.0
    (actor,) = stage.GetPrimAtPath("/Performance/Actors").GetChildren()
    assert actor.GetVariantSets().GetVariantSelection("expression") == "expressive"
    assert (tmp_path / f"out.{actor.GetCustomDataByKey('smd:device')}.usdc").is_file()
    assert len((tmp_path / "out.phrases.csv").read_text().splitlines()) == 2


def test_a_table_of_phrases_in_the_recordings_folder_is_no_recording(tmp_path):
    for name in ("take.csv", "take.phrases.csv", "take.score.json"):
        (tmp_path / name).touch()
    assert list(recording_files([tmp_path])) == [tmp_path / "take.csv"]


def test_without_effort_there_is_nothing_to_vary(animate, tmp_path):
    code, _, err = animate("out.usdc", "--variants", effort=Effort())
    assert code == 0, err
    stage = Usd.Stage.Open(str(tmp_path / "out.usdc"))
    (actor,) = stage.GetPrimAtPath("/Performance/Actors").GetChildren()
    assert actor.GetVariantSets().GetNames() == []


def test_a_package_with_layers_costs_one_line(animate, tmp_path):
    code, _, err = animate("out.usdz", "--layers")
    assert "--layers" in expect_one_line(code, err)
    assert [path.name for path in tmp_path.iterdir()] == ["a.score.json"]


def write_frames(performance, path) -> None:
    path.write_text(str(len(performance)))


def test_another_format_needs_one_line_and_refuses_what_only_usd_has(
    animate, tmp_path, monkeypatch
):
    frames = exporters.ExportFormat((".xyz",), lambda: write_frames)
    monkeypatch.setattr(exporters, "FORMATS", (*exporters.FORMATS, frames))
    code, _, err = animate("out.xyz", "--phrases")
    assert code == 0, err
    assert int((tmp_path / "out.xyz").read_text()) > 100
    for options in (["--layers"], ["--variants"], ["--stage-up", "z"], ["--stage-unit", "cm"]):
        code, _, err = animate("other.xyz", *options)
        assert f"with {options[0]}, found .xyz" in expect_one_line(code, err)
    assert not (tmp_path / "other.xyz").exists()


@pytest.mark.parametrize("folder", ["out.usda", "out.phrases.csv"])
def test_a_folder_in_the_way_costs_one_line_and_nothing_is_left(animate, tmp_path, folder):
    (tmp_path / folder).mkdir()
    code, _, err = animate("out.usda", "--layers", "--phrases")
    assert f"{folder}: expected a file to write, found a folder" in expect_one_line(code, err)
    assert {path.name for path in tmp_path.iterdir()} == {"a.score.json", folder}
    assert list((tmp_path / folder).iterdir()) == []


@pytest.mark.parametrize(
    "options", [("--stage-up", "x"), ("--stage-unit", "mm"), ("--fps", "0"), ("--fps", "fast")]
)
def test_an_unknown_value_is_wrong_usage(animate, tmp_path, options):
    code, _, err = animate("out.usda", *options)
    assert code == 2
    assert options[0] in err
    assert [path.name for path in tmp_path.iterdir()] == ["a.score.json"]
