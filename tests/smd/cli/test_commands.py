"""The commands do on shipped recordings what their help says."""

from __future__ import annotations

import json

import pytest


def test_parse_prints_one_phrase_a_line(run_smd, stories):
    code, out, err = run_smd("parse", stories / "duel.csv")
    expected = json.loads((stories / "duel.score.json").read_text(encoding="utf-8"))
    actions = [phrase["action"] for part in expected["performers"] for phrase in part["phrases"]]
    assert (code, err) == (0, "")
    assert [line.split()[4] for line in out.splitlines() if "confidence" in line] == actions


def test_json_is_all_that_json_prints(run_smd, stories):
    code, out, _ = run_smd("parse", stories / "duel.csv", "--json")
    score = json.loads(out)
    assert code == 0
    assert (score["schema"], score["version"]) == ("smd.score", 2)
    phrase = score["performers"][0]["phrases"][0]
    assert {"action", "start_s", "end_s", "effort", "confidence", "alternatives"} == set(phrase)


def test_json_of_several_recordings_is_a_list(run_smd, stories):
    files = sorted(stories.glob("*.csv"))
    _, out, _ = run_smd("parse", *files, "--json")
    assert [score["recording"] for score in json.loads(out)] == [str(file) for file in files]


def test_parse_then_animate_is_convert(run_smd, stories, tmp_path):
    take, score = stories / "duel.csv", tmp_path / "duel.score.json"
    assert run_smd("parse", take, "-o", score)[0] == 0
    assert run_smd("animate", score, "-o", tmp_path / "two-steps.usdc")[0] == 0
    assert run_smd("convert", take, "-o", tmp_path / "one-step.usdc")[0] == 0
    from pxr import Usd, UsdSkel

    rotations = []
    for name in ("two-steps", "one-step"):
        stage = Usd.Stage.Open(str(tmp_path / f"{name}.usdc"))
        animation = next(UsdSkel.Animation(p) for p in stage.Traverse() if p.IsA(UsdSkel.Animation))
        rotations.append([animation.GetRotationsAttr().Get(code) for code in (0, 40, 200)])
    # times in a Score have three decimals, so poses differ by less than a frame's change
    for mine, theirs in zip(*rotations, strict=True):
        for a, b in zip(mine, theirs, strict=True):
            assert abs(a.GetReal() * b.GetReal() + a.GetImaginary() * b.GetImaginary()) > 0.999


def test_a_folder_in_gives_a_folder_out(run_smd, stories, tmp_path):
    code, _, err = run_smd("convert", stories, "-o", tmp_path / "out", "--as", ".usda")
    assert (code, err) == (0, "")
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == sorted(f"{file.stem}.usda" for file in stories.glob("*.csv"))


def test_library_list_names_every_action(run_smd):
    _, out, _ = run_smd("library", "list", "--json")
    names = {row["name"] for row in json.loads(out)}
    assert {"walk", "run", "jump", "punch", "throw", "fly", "bow", "turn_left"} <= names
    _, text, _ = run_smd("library", "list")
    assert all(name in text for name in names)


@pytest.mark.long
def test_demo_makes_what_it_says(run_smd, tmp_path):
    pytest.importorskip("pyvista")
    code, out, err = run_smd("demo", "-o", tmp_path / "demo")
    assert (code, err) == (0, "")
    made = {path.name for path in (tmp_path / "demo").iterdir()}
    assert {"duel.usda", "duel.timeline.png"} <= made
    assert "duel.filmstrip.png" in made or "no filmstrip" in out


def test_demo_writes_its_animation_as_it_is_told(run_smd, tmp_path, monkeypatch):
    from pxr import Usd, UsdGeom

    monkeypatch.setattr("smd.cli.demo._draw", lambda *_: None)
    options = ["--keys", "reduced", "--stage-up", "z", "--phrases"]
    code, _, err = run_smd("demo", "-o", tmp_path, *options)
    assert (code, err) == (0, "")
    stage = Usd.Stage.Open(str(tmp_path / "duel.usda"))
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z
    animation = stage.GetPrimAtPath("/Performance/Actors/knight_character/knight_animation")
    assert len(animation.GetAttribute("rotations").GetTimeSamples()) < stage.GetEndTimeCode()
    assert (tmp_path / "duel.phrases.csv").is_file()
    code, _, err = run_smd("demo", "-o", tmp_path / "none", "--within", "1")
    assert (code, len(err.splitlines())) == (3, 1)
    assert not (tmp_path / "none").exists()


def test_the_command_lines_figure_height_is_the_librarys():
    from smd.cli.parsing import FIGURE_HEIGHT_M
    from smd.doodle import DEFAULT_FIGURE_HEIGHT_M

    assert FIGURE_HEIGHT_M == DEFAULT_FIGURE_HEIGHT_M


def test_a_performer_may_have_a_library_of_its_own(run_smd, stories, tmp_path):
    folder = stories.parent / "actions_library" / "humanoid"
    take, score = stories / "duel.csv", tmp_path / "duel.score.json"
    assert run_smd("parse", take, "--library", f"rival={folder}", "-o", score)[0] == 0
    kept = json.loads(score.read_text(encoding="utf-8"))
    named = {part["device"]: part.get("library", "") for part in kept["performers"]}
    assert kept["library"] == named["knight"] == ""
    assert (tmp_path / named["rival"]).resolve() == folder.resolve()
    assert run_smd("animate", score, "-o", tmp_path / "duel.usda")[0] == 0
    code, _, err = run_smd("convert", take, "--library", f"fox={folder}", "-o", tmp_path / "x.usda")
    assert (code, len(err.splitlines())) == (3, 1)
    assert "expected devices of the recording (knight, rival), found 'fox'" in err
    both = ("--library", folder, "--library", tmp_path)
    assert run_smd("convert", take, *both, "-o", tmp_path / "x.usda")[0] == 2
    assert not (tmp_path / "x.usda").exists()


def test_a_ground_to_walk_on_is_shown_and_one_that_ends_is_refused(run_smd, stories, tmp_path):
    from pxr import Usd, UsdGeom

    def hill(name, half_m):
        stage = Usd.Stage.CreateNew(str(tmp_path / name))
        UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
        UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        mesh = UsdGeom.Mesh.Define(stage, "/Hill")
        corners = [(-1, -1), (-1, 1), (1, 1), (1, -1)]
        mesh.CreatePointsAttr([(half_m * x, 0.1 * half_m * x, half_m * z) for x, z in corners])
        mesh.CreateFaceVertexCountsAttr([4])
        mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 3])
        stage.GetRootLayer().Save()
        return tmp_path / name

    take, out = stories / "postman.csv", tmp_path / "out.usda"
    code, _, err = run_smd("convert", take, "--ground", hill("small.usda", 0.5), "-o", out)
    assert (code, len(err.splitlines()), out.exists()) == (3, 1, False)
    assert "small.usda: expected ground below 'postman' at " in err
    assert run_smd("convert", take, "--ground", tmp_path / "none.usda", "-o", out)[0] == 3
    assert run_smd("convert", take, "--heading", "camera", "-o", out)[0] == 2
    wide = ("--ground", hill("large.usda", 50.0), "--heading", "path")
    code, said, _ = run_smd("convert", take, *wide, "-o", out)
    assert code == 0
    assert "plan: 6 of 7 phrases moved" in said
    stage = Usd.Stage.Open(str(out))
    ground = UsdGeom.Mesh(stage.GetPrimAtPath("/Performance/Scenery/Ground"))
    assert ground.GetPointsAttr().Get()[2] == (50.0, 5.0, 50.0)


def test_a_shipped_library_is_named_not_its_folder(run_smd, stories, tmp_path):
    score = tmp_path / "story.score.json"
    code, _, err = run_smd("parse", stories / "postman.csv", "-o", score, "--library", "humanoid")
    assert code == 0, err
    assert json.loads(score.read_text(encoding="utf-8"))["library"] == "humanoid"
    code, _, err = run_smd("animate", score, "-o", tmp_path / "story.usdc")
    assert code == 0, err
