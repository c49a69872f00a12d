from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from pxr import Usd

from actions_library.folder import load_library
from tests.actions_library.importers.test_bvh import ARM

SHIPPED = load_library().folder / "character.usdc"


def refused(result: tuple[int, str, str], *said: str) -> None:
    code, _, err = result
    assert code == 3
    assert err.startswith("smd: ") and err.count("\n") == 1
    for words in said:
        assert re.search(words, err), err


@pytest.fixture
def mine(run_smd, tmp_path) -> Path:
    folder = tmp_path / "mine"
    assert run_smd("library", "new", folder, "--character", SHIPPED)[0] == 0
    return folder


def content(folder: Path) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_a_new_library_has_a_character_that_idles(run_smd, mine):
    code, out, _ = run_smd("library", "list", "--library", mine)
    assert (code, out.split()[0]) == (0, "idle")
    assert run_smd("library", "check", "--library", mine)[0] == 0
    shipped = load_library().character.skeleton
    assert len(load_library(mine).character.skeleton) == len(shipped)  # its root is one already


def test_what_was_found_out_is_said(run_smd, tmp_path):
    _, out, _ = run_smd("library", "new", tmp_path / "a", "--character", SHIPPED)
    assert f"{len(load_library().character.skeleton)} joints" in out
    assert "left leg: left_upper_leg, left_lower_leg, left_foot" in out
    assert "pelvis hips, chest upper_chest, head head" in out


def test_a_clip_is_imported_learned_and_played(run_smd, mine, stories, tmp_path):
    clip = load_library().folder / "clips" / "walk.usdc"
    code, out, err = run_smd(
        *("library", "import", mine, clip, "--action", "walk", "--travels", "--cyclic"),
        *("--author", "Somebody", "--licence", "CC0"),
    )
    assert (code, err) == (0, "")
    assert "no gesture yet: smd learn walk" in out
    library = load_library(mine)
    assert library.action("walk").travels and library.clip("walk").cyclic
    row = json.loads((mine / "library.json").read_text())["actions"][1]
    assert (row["author"], row["licence"]) == ("Somebody", "CC0")
    assert run_smd("learn", "walk", stories / "none.csv", "--library", mine)[0] == 3
    assert load_library(mine).action("walk").pattern is None


def test_an_action_without_a_gesture_is_warned_of_unless_a_word_says_that_it_is_meant(
    run_smd, mine
):
    clip = load_library().folder / "clips" / "walk.usdc"
    imported = ("library", "import", mine, clip, "--action", "walk", "--travels", "--cyclic")
    for options, warned in (((), True), (("--replace", "--description", "Not drawn."), False)):
        assert run_smd(*imported, *options)[0] == 0
        code, out, _ = run_smd("library", "check", "--library", mine)
        assert (code, "'walk': no pattern: it will not be recognised" in out) == (0, warned)


def test_gestures_are_lent_to_clips_that_are_called_as_actions(run_smd, stories, tmp_path):
    folder, shelf, walker = tmp_path / "mine", load_library().folder / "clips", tmp_path / "w.usda"
    with_walk = Usd.Stage.Open(str(shelf / "walk.usdc")).Flatten().ExportToString()
    walker.write_text(re.sub(r"\bAnimation\b(?=[\">])", "Walk", with_walk))
    code, out, err = run_smd(
        *("library", "new", folder, "--character", walker, "--gestures", "humanoid")
    )
    assert (code, err) == (0, "")
    assert "drawn as in humanoid: walk (Walk)" in out
    code, out, _ = run_smd(
        *("library", "import", folder, shelf / "bow.usdc", "--action", "bow"),
        *("--gestures", "humanoid"),
    )
    assert code == 0 and "no gesture yet" not in out
    library = load_library(folder)
    assert [action.name for action in library.actions] == ["idle", "walk", "bow"]
    for name in ("walk", "bow"):
        ours, theirs = library.action(name), load_library().action(name)
        assert (ours.pattern, ours.travels) == (theirs.pattern, theirs.travels)
        assert ours.exemplar is not None and theirs.exemplar is not None
        assert (ours.exemplar.measures == theirs.exemplar.measures).all()
    assert run_smd("library", "check", "--library", folder)[0] == 0
    postman = stories / "postman.csv"
    code, out, _ = run_smd("parse", postman, "--library", folder, "-o", tmp_path / "score.json")
    assert code == 0 and out.count(" walk ") >= 2 and " bow " in out


def test_gestures_of_nobody_are_refused_and_nothing_is_made(run_smd, mine, tmp_path):
    walk = load_library().folder / "clips" / "walk.usdc"
    making = ("library", "new", tmp_path / "a", "--character", walk)
    refused(run_smd(*making, "--gestures", "humanoids"), "humanoids: expected a library's folder")
    assert not (tmp_path / "a").exists()
    before = content(mine)
    importing = ("library", "import", mine, walk, "--action")
    refused(run_smd(*importing, "walk", "--gestures", tmp_path), "library.json")
    refused(
        run_smd(*importing, "stroll", "--gestures", "humanoid"),
        "gestures: expected an action of walk, run.*got 'stroll'",
    )
    assert content(mine) == before


def test_an_action_that_is_there_needs_replace_and_keeps_its_gesture(run_smd, tmp_path):
    import shutil

    shutil.copytree(load_library().folder, tmp_path / "all")
    clip = load_library().folder / "clips" / "bow.usdc"
    arguments = ["library", "import", tmp_path / "all", clip, "--action", "nod"]
    before = content(tmp_path / "all")
    refused(run_smd(*arguments), "nod.*--replace")
    assert content(tmp_path / "all") == before
    assert run_smd(*arguments, "--replace")[0] == 0
    library = load_library(tmp_path / "all")
    assert library.action("nod").pattern == load_library().action("nod").pattern
    assert library.clip("nod").duration_s == pytest.approx(load_library().clip("bow").duration_s)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--action", "Two Words"], "lower-case word"),
        (["--action", "walk", "--clip", "moonwalk"], "moonwalk"),
        (["--action", "walk", "--front", "up"], "front"),
        (["--action", "walk", "--up", "w"], "up"),
        (["--action", "walk", "--unit", "0"], "unit"),
        (["--action", "walk", "--start", "5", "--end", "4"], "start before an end"),
    ],
)
def test_what_means_nothing_is_refused_and_the_library_stays(run_smd, mine, options, said):
    before = content(mine)
    clip = load_library().folder / "clips" / "walk.usdc"
    refused(run_smd("library", "import", mine, clip, *options), said)
    assert content(mine) == before


def test_broken_and_foreign_files_leave_the_library_as_it_was(run_smd, mine, tmp_path):
    before = content(mine)
    broken, arm = tmp_path / "broken.glb", tmp_path / "arm.bvh"
    broken.write_bytes(b"glTF")
    arm.write_text(ARM)
    refused(run_smd("library", "import", mine, broken, "--action", "walk"), "broken.glb")
    refused(run_smd("library", "import", mine, arm, "--action", "walk"), "arm.bvh.*same kind")
    refused(run_smd("library", "import", mine, tmp_path / "no.bvh", "--action", "walk"), "no.bvh")
    assert content(mine) == before


def test_a_skeleton_without_a_mesh_is_no_character(run_smd, tmp_path):
    arm = tmp_path / "arm.bvh"
    arm.write_text(ARM)
    refused(run_smd("library", "new", tmp_path / "a", "--character", arm), "mesh")
    assert not (tmp_path / "a").exists()


def test_a_folder_with_other_things_stays_what_it_is(run_smd, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter1.tex").write_text("years of work")
    refused(run_smd("library", "new", tmp_path / "thesis", "--character", SHIPPED), "thesis")
    assert [p.name for p in (tmp_path / "thesis").iterdir()] == ["chapter1.tex"]


def test_a_fox_walks_and_runs_as_people_draw_it(run_smd, shared_data, tmp_path):
    fox = shared_data / "clips" / "gltf" / "Fox.glb"
    made = ("library", "new", tmp_path / "fox", "--character", fox, "--gestures", "humanoid")
    code, out, err = run_smd(*made)
    assert (code, err) == (0, "")
    assert "drawn as in humanoid: walk (Walk), run (Run)" in out
    assert run_smd("library", "check", "--library", tmp_path / "fox")[0] == 0


def test_showing_draws_gesture_and_clip(run_smd, tmp_path):
    pytest.importorskip("pyvista")
    from PIL import Image

    picture = tmp_path / "wave.png"
    code, out, _ = run_smd("library", "show", "wave", "-o", picture)
    assert code == 0 and "by Spatial Motion Doodles, MIT" in out
    with Image.open(picture) as image:
        assert image.width > 2200
    refused(run_smd("library", "show", "wave", "-o", tmp_path / "wave.jpg"), "png")


def test_the_knight_acts_out_a_doodle(run_smd, shared_data, tmp_path):
    """From nothing, as a user would: a character, its clips, gestures of three, a doodle."""
    import numpy as np

    from smd.doodle import Recording
    from smd.formats import write_recording
    from smd.score_file import read_score
    from smd.synthetic.person import simulated_person
    from smd.synthetic.takes import Take

    files_of, folder = shared_data / "clips" / "gltf", tmp_path / "knight"
    made = run_smd("library", "new", folder, "--character", files_of / "Knight.glb")
    assert (made[0], "idles with: Idle" in made[1]) == (0, True)
    clips = {"walk": ("MovementBasic", "Walking_B"), "pick_up": ("General", "PickUp")}
    for action, (pack, clip) in clips.items():
        source = files_of / f"Med_{pack}.glb"
        asked = ["--clip", f"Rig_Medium|{clip}", "--action", action]
        assert run_smd("library", "import", folder, source, *asked)[0] == 0
        files = []
        for k in range(3):
            rng = np.random.default_rng([900, k])
            take = Take(simulated_person(rng), rng).pause(0.4).play(action).pause(0.4)
            files.append(tmp_path / f"{action}_{k}.csv")
            write_recording(Recording((take.doodle(),), action), files[-1])
        assert run_smd("learn", action, *files, "--library", folder)[0] == 0
    rng = np.random.default_rng(901)
    take = Take(simulated_person(rng), rng).pause(0.8)
    for action in clips:
        take.play(action).pause(0.8)
    write_recording(Recording((take.doodle(),), "play"), tmp_path / "play.csv")
    score = tmp_path / "play.score.json"
    assert run_smd("parse", tmp_path / "play.csv", "--library", folder, "-o", score)[0] == 0
    (part,) = read_score(score).performers
    assert [phrase.action for phrase in part.phrases] == list(clips)
    out = tmp_path / "play.usda"
    assert run_smd("convert", tmp_path / "play.csv", "--library", folder, "-o", out)[0] == 0
    assert out.stat().st_size > 100_000
