"""What the options that say how an animation is written give, and what they refuse."""

from __future__ import annotations

from dataclasses import replace

import pytest
from pxr import Usd, UsdGeom, UsdSkel

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
    options += ["--keys", "reduced", "--within", "2.5"]
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
    for options in (
        ["--layers"],
        ["--variants"],
        ["--stage-up", "z"],
        ["--stage-unit", "cm"],
        ["--keys", "reduced"],
    ):
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


def keys_of(path) -> list[float]:
    stage = Usd.Stage.Open(str(path))
    (animation,) = (prim for prim in stage.Traverse() if prim.IsA(UsdSkel.Animation))
    return UsdSkel.Animation(animation).GetRotationsAttr().GetTimeSamples()


def test_keys_are_as_many_as_the_millimetres_allow(animate, tmp_path):
    counts = []
    for index, options in enumerate(
        [[], ["--keys", "all"], *(["--keys", "reduced", *w] for w in WITHIN)]
    ):
        code, _, err = animate(f"{index}.usda", *options)
        assert code == 0, err
        counts.append(len(keys_of(tmp_path / f"{index}.usda")))
    plain, every, default, one, five = counts
    assert plain == every > default == one > five > 2
    assert (tmp_path / "0.usda").read_bytes() == (tmp_path / "1.usda").read_bytes()
    assert (tmp_path / "2.usda").read_bytes() == (tmp_path / "3.usda").read_bytes()


WITHIN = ([], ["--within", "1"], ["--within", "5"])


@pytest.mark.parametrize("within", ["0", "-1", "nan", "inf", "-inf", "1e400"])
def test_millimetres_that_are_none_cost_one_line(animate, tmp_path, within):
    code, _, err = animate("out.usda", "--keys", "reduced", f"--within={within}")
    assert "--within: expected millimetres above 0, found" in expect_one_line(code, err)
    assert [path.name for path in tmp_path.iterdir()] == ["a.score.json"]


def test_millimetres_without_few_keys_cost_one_line(animate, tmp_path):
    code, _, err = animate("out.usda", "--within", "2")
    assert "--within: expected --keys reduced with it" in expect_one_line(code, err)
    assert [path.name for path in tmp_path.iterdir()] == ["a.score.json"]


@pytest.mark.parametrize(
    "options",
    [
        ("--stage-up", "x"),
        ("--stage-unit", "mm"),
        ("--fps", "0"),
        ("--fps", "fast"),
        ("--keys", "few"),
        ("--within", "little"),
    ],
)
def test_an_unknown_value_is_wrong_usage(animate, tmp_path, options):
    code, _, err = animate("out.usda", *options)
    assert code == 2
    assert options[0] in err
    assert [path.name for path in tmp_path.iterdir()] == ["a.score.json"]
