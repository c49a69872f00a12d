"""`smd learn` adds to a library what it learned, or says in a line why not and changes nothing."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from smd.doodle import Doodle, Recording
from smd.formats import write_recording
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take


def performed(action: str, seed: int) -> Doodle:
    rng = np.random.default_rng(seed)
    person = simulated_person(np.random.default_rng(7))
    return Take(person, rng).pause(0.4).play(action).pause(0.4).doodle()


@pytest.fixture
def takes(tmp_path):
    """Write recordings of simulated performances, and return their files."""

    def write(action: str, *seeds: int) -> list[Path]:
        files = [tmp_path / f"{action}_{seed}.csv" for seed in seeds]
        for file, seed in zip(files, seeds, strict=True):
            write_recording(Recording((performed(action, seed),)), file)
        return files

    return write


@pytest.fixture(scope="module")
def taught(tmp_path_factory) -> Path:
    """A library that has learned to throw; tests copy it."""
    from smd.cli.app import main

    folder = tmp_path_factory.mktemp("taught")
    files = [folder / f"throw_{seed}.csv" for seed in range(3)]
    for seed, file in enumerate(files):
        write_recording(Recording((performed("throw", seed),)), file)
    with pytest.raises(SystemExit) as exit_:
        main(["learn", "throw", *map(str, files), "--library", str(folder / "my")])
    assert not exit_.value.code
    return folder / "my"


@pytest.fixture
def my(taught, tmp_path) -> Path:
    return Path(shutil.copytree(taught, tmp_path / "my"))


def content(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def refused(result: tuple[int, str, str], *said: str) -> str:
    code, out, err = result
    assert (code, out, len(err.splitlines())) == (3, "", 1), (out, err)
    assert err.startswith("smd: ")
    for part in said:
        assert re.search(part, err), err
    return err


def test_a_new_library_has_the_action_the_character_and_idling(my):
    from actions_library.folder import load_library

    library = load_library(my)
    assert library.name == "my"
    assert {action.name for action in library.actions} == {"throw", "idle"}
    throw = library.action("throw")
    assert throw.learned_from == ("throw_0.csv", "throw_1.csv", "throw_2.csv")
    assert len(throw.exemplar) == 3
    assert (throw.travels, throw.cyclic) == (False, False)
    shipped = load_library()
    assert np.array_equal(library.clip("throw").translation_m, shipped.clip("throw").translation_m)


def test_what_was_learned_is_printed(run_smd, takes, tmp_path):
    files = takes("bow", 0, 1, 2)
    code, out, err = run_smd("learn", "bow", *files, "--library", tmp_path / "mine")
    assert (code, err) == (0, "")
    assert "bow: learned from 3 examples" in out
    for file in files:
        assert str(file) in out
    for said in ("must occur", "may occur", "pattern: ", "clip: bow", "made: "):
        assert said in out


def test_learning_extends_a_library_and_keeps_what_it_has(run_smd, takes, my):
    (my / "notes.txt").write_text("mine")
    before = content(my)
    code, out, _ = run_smd("learn", "bow", *takes("bow", 0, 1, 2), "--library", my)
    assert code == 0
    assert re.search("extended: .*bow", out)
    after = content(my)
    assert {name: after[name] for name in before if name != "library.json"} == {
        name: data for name, data in before.items() if name != "library.json"
    }
    assert set(after) - set(before) == {"clips/bow.usdc", "exemplars/bow.npz"}
    assert run_smd("library", "check", "--library", my)[0] == 0


def test_what_was_learned_is_found(run_smd, takes, my):
    (file,) = takes("throw", 11)
    code, out, _ = run_smd("parse", file, "--library", my, "--json")
    assert code == 0
    phrases = json.loads(out)["performers"][0]["phrases"]
    assert [phrase["action"] for phrase in phrases] == ["throw"]


def test_what_was_learned_is_animated(run_smd, takes, my, tmp_path):
    (file,) = takes("throw", 11)
    output = tmp_path / "out.usdc"
    code, out, err = run_smd("convert", file, "--library", my, "-o", output)
    assert (code, err, "1 phrase" in out) == (0, "", True)


def test_explaining_prints_the_terms_of_each_phrase(run_smd, takes, my):
    from smd.recognition.verification import TERMS

    (file,) = takes("throw", 11)
    _, out, _ = run_smd("parse", file, "--library", my, "--explain")
    assert all(re.search(rf"^ +{term} +-?\d+\.\d\d$", out, re.M) for term in TERMS)
    assert "nothing at all" in out


def test_the_clip_is_the_one_asked_for(run_smd, takes, my):
    from actions_library.folder import load_library

    code, out, _ = run_smd("learn", "fling", *takes("bow", 0), "--library", my, "--clip", "walk")
    assert (code, "clip: walk of the library 'humanoid'" in out) == (0, True)
    fling = load_library(my).action("fling")
    assert (fling.travels, fling.cyclic) == (True, True)
    _, out, _ = run_smd("learn", "greet", *takes("bow", 1), "--library", my)
    assert "clip: idle of the library 'my'; there is no clip 'greet', see --clip" in out


def test_a_clip_that_is_nowhere_is_refused_with_those_there_are(run_smd, takes, my):
    before = content(my)
    result = run_smd("learn", "bow", *takes("bow", 0), "--library", my, "--clip", "moonwalk")
    refused(result, "throw.*walk.*'moonwalk'")
    assert content(my) == before


def test_a_new_library_may_begin_with_all_shipped_actions(run_smd, takes, tmp_path):
    folder = tmp_path / "all"
    args = ["learn", "greet", *takes("bow", 0, 1), "--library", folder, "--from", "humanoid"]
    assert run_smd(*args)[0] == 0
    _, out, _ = run_smd("library", "list", "--library", folder, "--json")
    names = [row["name"] for row in json.loads(out)]
    assert {"walk", "bow", "idle", "greet"} <= set(names)
    refused(run_smd(*args), "no library there")


def test_a_collision_is_told_at_once_with_both_names_and_a_shared_string(run_smd, takes, my):
    code, out, _ = run_smd("learn", "hurl", *takes("throw", 0, 1, 2), "--library", my)
    assert code == 0
    assert re.search(r"warning: (hurl and throw|throw and hurl).*both accept T_\w+.*; draw", out)
    code, out, _ = run_smd("library", "check", "--library", my)
    assert (code, bool(re.search("hurl.*both accept", out))) == (0, True)


def _nothing_shared(files, takes):
    return [*takes("turn_left", 0, 1), *takes("walk", 3)]


def _still(files, takes):
    doodle = performed("bow", 3)
    still = Doodle(doodle.time_s, 0.0 * doodle.position_m, [[0.0, 0.0, 0.0, 1.0]] * len(doodle))
    write_recording(Recording((still,)), files[0].with_name("still.csv"))
    return [files[0], files[0].with_name("still.csv")]


def _lost(files, takes):
    lines = files[0].read_text().splitlines(keepends=True)
    middle = len(lines) // 2
    files[0].with_name("lost.csv").write_text("".join(lines[: middle - 20] + lines[middle + 20 :]))
    return [files[0].with_name("lost.csv")]


def _short(files, takes):
    lines = files[0].read_text().splitlines(keepends=True)
    files[0].with_name("short.csv").write_text("".join(lines[:8]))
    return [files[0].with_name("short.csv")]


def _missing(files, takes):
    return [*files, files[0].with_name("nowhere.csv")]


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (_nothing_shared, r"walk_3\.csv: expected a movement that another example has"),
        (_still, r"still\.csv: .*stillness"),
        (_lost, r"lost\.csv: expected one performance.*tracking was lost from"),
        (_short, r"short\.csv"),
        (_missing, r"nowhere\.csv"),
    ],
)
@pytest.mark.parametrize("new", [False, True])
def test_bad_examples_are_named_and_change_nothing(run_smd, takes, my, spoil, said, new, tmp_path):
    examples = spoil(takes("bow", 0, 1), takes)
    folder = tmp_path / "fresh" if new else my
    before = content(tmp_path)
    refused(run_smd("learn", "bow", *examples, "--library", folder), said)
    assert content(tmp_path) == before
    assert folder.exists() != new


def test_a_name_that_is_there_is_refused_unless_it_is_to_be_replaced(run_smd, takes, my):
    before = content(my)
    files = takes("bow", 0, 1)
    refused(run_smd("learn", "throw", *files, "--library", my), "'throw' is there already")
    assert content(my) == before
    assert run_smd("learn", "throw", *files, "--library", my, "--replace")[0] == 0
    after = content(my)
    assert after["library.json"] != before["library.json"]
    assert len(after) == len(before)
    assert run_smd("library", "check", "--library", my)[0] == 0
    _, out, _ = run_smd("library", "show", "throw", "--library", my)
    assert "learned from: bow_0.csv, bow_1.csv" in out


@pytest.mark.parametrize("name", ["Throw", "../up", "two words", "", "idle", "a/b", "9lives"])
def test_a_name_that_is_no_word_is_refused(run_smd, takes, my, name):
    before = content(my)
    refused(run_smd("learn", name, *takes("bow", 0), "--library", my), "action: expected")
    assert content(my) == before


def test_a_failure_while_writing_leaves_the_library_as_it_was(run_smd, takes, my, monkeypatch):
    import actions_library.extension as extension

    def fails(*_):
        raise OSError(28, "No space left on device")

    before = content(my)
    monkeypatch.setattr(extension, "manifest_text", fails)
    refused(run_smd("learn", "bow", *takes("bow", 0), "--library", my), "No space left")
    assert content(my) == before


@pytest.mark.long
def test_a_hundred_examples_are_learned(run_smd, takes, tmp_path):
    folder = tmp_path / "many"
    code, out, _ = run_smd("learn", "bow", *takes("bow", *range(100)), "--library", folder)
    assert (code, "learned from 100 examples" in out) == (0, True)
    assert len(out.splitlines()) < 25
    (file,) = takes("bow", 1000)
    _, out, _ = run_smd("parse", file, "--library", folder)
    assert " bow " in out


def test_examples_of_two_ways_to_draw_it_are_learned_with_a_warning(run_smd, takes, tmp_path):
    files = [*takes("turn_left", 0, 1), *takes("walk", 3, 4)]
    code, out, _ = run_smd("learn", "bow", *files, "--library", tmp_path / "mine")
    assert (code, "warning: no movement is in all examples" in out) == (0, True)


def test_a_recording_with_a_long_rest_is_asked_about(run_smd, takes, tmp_path):
    rng = np.random.default_rng(0)
    take = Take(simulated_person(np.random.default_rng(7)), rng)
    twice = take.play("bow").pause(2.0).play("bow").doodle()
    write_recording(Recording((twice,)), tmp_path / "twice.csv")
    code, out, _ = run_smd("learn", "bow", tmp_path / "twice.csv", "--library", tmp_path / "mine")
    assert code == 0
    assert re.search(r"warning: .*twice\.csv: rests from .* expected one performance", out)


def edited(folder: Path, change) -> None:
    file = folder / "library.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    change(document["actions"])
    file.write_text(json.dumps(document), encoding="utf-8")


def _throw(actions):
    return next(row for row in actions if row["name"] == "throw")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda rows: _throw(rows).update(pattern="T_Z ("), r"'throw'.pattern: .*character 6"),
        (lambda rows: _throw(rows).update(pattern="T_Z T_Q"), r"'throw'.pattern: .*character 5"),
        (lambda rows: _throw(rows).update(pattern="T_Z* T_Y*"), r"'throw'.*nothing at all"),
        (lambda rows: rows.append(rows[0]), r"'\w+' appears twice"),
        (lambda rows: _throw(rows).update(exemplar="../x.npz"), r"'throw'.exemplar: .*inside"),
        (lambda rows: _throw(rows).update(exemplar="exemplars/no.npz"), r"no\.npz"),
    ],
)
@pytest.mark.parametrize("command", ["parse", "check", "learn"])
def test_a_hand_written_fault_is_named_by_every_command(
    run_smd, takes, my, stories, change, said, command
):
    edited(my, change)
    before = content(my)
    arguments = {
        "parse": ["parse", stories / "duel.csv"],
        "check": ["library", "check"],
        "learn": ["learn", "bow", *takes("bow", 0)],
    }[command]
    refused(run_smd(*arguments, "--library", my), str(my), said)
    assert content(my) == before


def test_an_empty_library_recognises_nothing_and_is_warned_of(run_smd, takes, my):
    edited(my, lambda rows: rows.clear())
    (file,) = takes("throw", 0)
    code, out, _ = run_smd("parse", file, "--library", my)
    assert (code, "nothing recognised" in out) == (0, True)
    code, out, _ = run_smd("library", "check", "--library", my)
    assert (code, "nothing will be recognised" in out, "'idle'" in out) == (0, True, True)
    assert run_smd("learn", "bow", *takes("bow", 0), "--library", my)[0] == 0


def test_every_broken_file_is_listed(run_smd, my):
    (my / "clips" / "throw.usdc").unlink()
    (my / "clips" / "idle.usdc").write_bytes(b"not USD")
    code, out, err = run_smd("library", "check", "--library", my)
    assert (code, "2 faults" in out) == (3, True)
    assert [bool(re.search(f"{name}.usdc", err)) for name in ("throw", "idle")] == [True, True]
    assert len(err.splitlines()) == 2


def test_a_folder_of_other_things_is_not_made_a_library(run_smd, takes, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter1.tex").write_text("years of work")
    refused(run_smd("learn", "bow", *takes("bow", 0), "--library", tmp_path / "thesis"), "thesis")
    assert [path.name for path in (tmp_path / "thesis").iterdir()] == ["chapter1.tex"]


def test_the_shipped_library_is_whole(run_smd):
    code, out, err = run_smd("library", "check")
    assert (code, err, "0 faults" in out) == (0, "", True)
    assert "no pattern" not in out


def test_real_gestures_learned_from_three_are_found_in_a_fourth(run_smd, shared_data, tmp_path):
    from actions_library.folder import load_library
    from smd.formats import read_recording
    from smd.recognition import Recognizer

    gestures = {"swipe_right": "g07", "swipe_left": "g08", "rotate_ccw": "g06"}
    files = {
        name: sorted((shared_data / "gestures").glob(f"{code}_f1_s05_e*.csv"))
        for name, code in gestures.items()
    }
    for name, takes in files.items():
        assert run_smd("learn", name, *takes[:3], "--library", tmp_path / "my")[0] == 0
    recognizer = Recognizer(load_library(tmp_path / "my"))
    for name, takes in files.items():
        doodle = read_recording(takes[3]).doodles[0]
        assert recognizer.rank(doodle)[0].action == name
        assert [span.action for span in recognizer.spot(doodle)] == [name]
