"""`smd rehearse` adds one's own takes, says at once what each looked like, and what got better."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from actions_library import extension
from actions_library.folder import load_library, write_library
from smd.cli.app import main
from smd.doodle import Doodle, Recording
from smd.formats import read_recording, write_recording
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take
from tests.naive.puppet import puppet, waving_clip

GOLDEN = Path(__file__).parents[2] / "golden" / "libraries"


def performed(action: str, seed: int) -> Doodle:
    rng = np.random.default_rng(seed)
    person = simulated_person(np.random.default_rng(7))
    return Take(person, rng).pause(0.4).play(action).pause(0.4).doodle()


def large_and_slow(action: str, seed: int, larger: float = 3.0) -> Doodle:
    """A take that is larger than others' and takes four times as long."""
    doodle = performed(action, seed)
    return replace(doodle, time_s=4.0 * doodle.time_s, position_m=larger * doodle.position_m)


def still() -> Doodle:
    doodle = performed("bow", 3)
    return Doodle(doodle.time_s, 0.0 * doodle.position_m, [[0.0, 0.0, 0.0, 1.0]] * len(doodle))


@pytest.fixture
def takes(tmp_path):
    """Write doodles in a folder, as a replay finds them, and return their files."""

    def write(*doodles: Doodle) -> list[Path]:
        folder = tmp_path / "takes"
        folder.mkdir(exist_ok=True)
        first = len(list(folder.iterdir()))
        files = [folder / f"{first + i:02d}.csv" for i in range(len(doodles))]
        for file, doodle in zip(files, doodles, strict=True):
            write_recording(Recording((replace(doodle, device="left"),)), file)
        return files

    return write


@pytest.fixture(scope="module")
def few(tmp_path_factory) -> Path:
    """A library of three shipped actions, quick to write; tests copy it."""
    names, shipped = ("punch", "bow", "wave"), load_library()
    folder = tmp_path_factory.mktemp("few") / "few"
    actions = (*map(shipped.action, names), replace(shipped.action("idle"), rest=""))
    clips = {action.name: waving_clip(action.name) for action in actions}
    write_library(folder, name="few", character=puppet(), clips=clips, actions=actions)
    return folder


@pytest.fixture
def my(few, tmp_path) -> Path:
    return Path(shutil.copytree(few, tmp_path / "my"))


def content(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_a_new_library_has_all_shipped_actions_and_one_s_own_examples(run_smd, takes, tmp_path):
    source = f"replay:{takes(performed('punch', 0), performed('wave', 1))[0].parent}"
    my, kept = tmp_path / "my", tmp_path / "rehearsals"
    code, out, err = run_smd(
        "rehearse", "punch", "wave", "--library", my, "-o", kept, "--source", source
    )
    assert (code, err) == (0, "")
    assert re.search(r"1 of 2: hold the trigger, draw punch \(Thrust", out)
    assert re.search(r"punch-001\.csv: 1\.\d s, punch: first, 0\.\d\d x the limit", out)
    assert "2 of 2: hold the trigger, draw wave" in out
    assert "punch, wave: as it was; one take says nothing of itself" in out
    assert out.endswith(f"made: {my}: 2 own examples of punch, wave\n")
    assert {path.name for path in kept.iterdir()} == {"punch-001.csv", "wave-001.csv"}
    library, shipped = load_library(my), load_library()
    assert library.name == "my"
    for action in shipped.actions:
        ours = library.action(action.name)
        if action.name in ("punch", "wave"):
            assert ours.exemplar.ownership == (len(action.exemplar),)
            assert ours.learned_from == (f"{action.name}-001.csv",)
            ours = replace(ours, learned_from=())
        assert ours == action
        assert library.credit(action.name) == shipped.credit(action.name)
    clips = [each.clip("wave").translation_m for each in (library, shipped)]
    assert np.array_equal(*clips)


def test_rounds_are_one_after_another_and_tell_what_got_better(run_smd, takes, my, tmp_path):
    names = ["punch", "bow", "wave"]
    doodles = [large_and_slow(name, seed) for seed in (0, 1) for name in names]
    source = f"replay:{takes(*doodles)[0].parent}"
    options = ("--library", my, "-o", tmp_path / "kept", "--source", source, "--times", 2)
    code, out, err = run_smd("rehearse", *options)
    assert (code, err) == (0, "")
    assert re.findall(r"\d of 6: .* draw (\w+)", out) == names * 2
    share = r"(?:first|no\. \d), (\d\.\d\d) x the limit"
    for name in names:
        told = re.search(rf"^  {name} +{share} -> {share}$", out, re.M)
        assert float(told[2]) < float(told[1])
        assert load_library(my).action(name).exemplar.own.sum() == 2
    assert "extended: " in out


def test_what_is_still_or_another_action_is_said_at_once_and_asked_for_again(
    run_smd, takes, my, tmp_path
):
    files = takes(still(), performed("bow", 1), performed("wave", 2))
    source = f"replay:{files[0].parent}"
    code, out, err = run_smd(
        "rehearse", "wave", "--library", my, "-o", tmp_path / "kept", "--source", source
    )
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert [line.startswith("1 of 1: ") for line in lines[:6:2]] == [True] * 3
    assert re.fullmatch(
        r"  not added: wave-001\.csv: expected wave, got \d\.\d s of still.*", lines[1]
    )
    assert re.fullmatch(
        r"  not added: wave-002\.csv: expected wave, but that looked like bow \(0\.\d\d x the "
        r"limit\); wave: no\. 3, \d\.\d\d x the limit: again, or --keep",
        lines[3],
    )
    assert lines[5].startswith("  wave-003.csv: ")
    assert load_library(my).action("wave").learned_from == ("wave-003.csv",)


def test_recordings_are_added_all_at_once(run_smd, takes, my):
    (my / "notes.txt").write_text("mine")
    before = content(my)
    one, two, other = takes(performed("punch", 0), performed("punch", 1), performed("bow", 2))
    code, out, err = run_smd(
        "rehearse", "--library", my, "--take", f"punch={one}", "--take", f"punch={two}",
        "--take", f"bow={other}",
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert f"extended: {my}: 3 own examples of punch, bow" in out
    after = content(my)
    changed = {name for name in before | after if before.get(name) != after.get(name)}
    gone = {"exemplars/punch.npz", "exemplars/bow.npz"}
    come = {"exemplars/punch_2.npz", "exemplars/bow_2.npz"}
    assert changed == {"library.json", *gone, *come}
    assert not gone & set(after)
    library = load_library(my)
    assert library.action("punch").exemplar.ownership == (24, 25)
    assert library.action("wave").exemplar.ownership is False
    assert run_smd("library", "check", "--library", my)[0] == 0
    assert (
        "26 examples, 2 of them your own" in run_smd("library", "show", "punch", "--library", my)[1]
    )


def test_a_folder_of_recordings_is_all_of_one_action(run_smd, takes, my):
    folder = takes(performed("punch", 0), performed("punch", 1))[0].parent
    code, _, _ = run_smd("rehearse", "--library", my, "--take", f"punch={folder}")
    assert code == 0
    assert load_library(my).action("punch").learned_from == ("00.csv", "01.csv")


def test_one_s_own_way_of_drawing_is_found_afterwards(run_smd, takes, my):
    one, two, tested = takes(*(large_and_slow("punch", seed, 8.0) for seed in (0, 1, 2)))

    def found() -> list[str]:
        _, out, _ = run_smd("parse", tested, "--library", my, "--json")
        return [each["action"] for each in json.loads(out)["performers"][0]["phrases"]]

    assert found() != ["punch"]
    args = ("--take", f"punch={one}", "--take", f"punch={two}")
    assert run_smd("rehearse", "--library", my, *args)[0] == 0
    assert found() == ["punch"]


@pytest.mark.parametrize("wrong", ["still", "another", "twice", "short"])
def test_a_recording_that_is_refused_leaves_the_library_as_it_was(run_smd, takes, my, wrong):
    good, bad = takes(performed("punch", 0), still() if wrong == "still" else performed("bow", 1))
    if wrong == "short":
        bad.write_text("".join(bad.read_text().splitlines(keepends=True)[:8]))
    bad = good if wrong == "twice" else bad
    before = content(my)
    result = run_smd(
        "rehearse", "--library", my, "--take", f"punch={good}", "--take", f"punch={bad}"
    )
    code, out, err = result
    assert (code, len(err.splitlines())) == (3, 1)
    assert f"{good.name}: 1." in out  # what is good is said as well
    said = {
        "still": f"{bad.name}: expected punch, got .* s of stillness",
        "another": f"{bad.name}: expected punch, but that looked like bow",
        "twice": f"{bad.name}: expected a new take, got one that is there already",
        "short": f"{bad.name}: ",
    }
    assert re.search(said[wrong], err)
    assert content(my) == before


def test_what_looks_like_another_action_is_kept_if_one_insists(run_smd, takes, my):
    (bow,) = takes(performed("bow", 1))
    code, out, _ = run_smd("rehearse", "--library", my, "--take", f"wave={bow}", "--keep")
    assert code == 0
    assert re.search(r"wave: no\. 3, .* x the limit; it looked most like bow \(0\.", out)
    assert load_library(my).action("wave").exemplar.own.sum() == 1


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["punsh"], r"expected one of punch, bow, wave.*'punsh'"),
        (["idle"], r"'idle': expected one that is drawn, as punch"),
        (["punch", "--mount", "jaw=180"], "'jaw=180'"),
        (["punch", "--from", "humanoid"], "expected no library there"),
        (["punch", "--source", "openwr"], "source"),
        (["punch", "--rate", "1"], "rate"),
        (["--take", "punch=nowhere.csv"], r"nowhere\.csv"),
    ],
)
def test_bad_input_costs_a_line_before_anyone_performs(run_smd, my, tmp_path, arguments, said):
    before = content(my)
    code, out, err = run_smd("rehearse", *arguments, "--library", my, "-o", tmp_path / "kept")
    assert (code, out, len(err.splitlines())) == (3, "", 1)
    assert re.search(said, err)
    assert content(my) == before
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize(
    "arguments", [["punch", "--take", "punch=a.csv"], ["--take", "a.csv"], ["--take", "=a.csv"]]
)
def test_a_take_names_its_action(run_smd, my, arguments):
    code, _, err = run_smd("rehearse", *arguments, "--library", my)
    assert (code, "ACTION=FILE" in err) == (2, True)


def test_a_folder_of_other_files_is_left_alone(run_smd, takes, tmp_path):
    (punch,) = takes(performed("punch", 0))
    code, out, err = run_smd("rehearse", "--library", punch.parent, "--take", f"punch={punch}")
    assert (code, out) == (3, "")
    assert "expected a library or an empty folder" in err


def test_a_library_without_examples_goes_the_old_way_and_says_so(run_smd, takes, tmp_path):
    my = Path(shutil.copytree(GOLDEN / "version_1", tmp_path / "my"))
    before = load_library(my).action("walk")
    (file,) = takes(performed("bow", 1))
    code, out, _ = run_smd("rehearse", "--library", my, "--take", f"walk={file}", "--keep")
    assert code == 0
    assert out.startswith(f"walk: no examples in {my}: recognised by tokens alone, the old way")
    walk = load_library(my).action("walk")
    assert (walk.exemplar, walk.learned_from) == (None, ("00.csv",))
    assert str(walk.pattern).startswith(f"{before.pattern}|")
    assert json.loads((my / "library.json").read_text(encoding="utf-8"))["version"] == 4
    _, out, _ = run_smd("parse", file, "--library", my, "--json")
    assert [each["action"] for each in json.loads(out)["performers"][0]["phrases"]] == ["walk"]


def test_what_ends_too_early_keeps_the_takes_and_makes_nothing(run_smd, takes, tmp_path):
    source = f"replay:{takes(performed('punch', 0))[0].parent}"
    my, kept = tmp_path / "my", tmp_path / "kept"
    code, _, err = run_smd(
        "rehearse", "punch", "bow", "--library", my, "-o", kept, "--source", source
    )
    assert (code, len(err.splitlines())) == (3, 1)
    assert "expected 2 performances, got 1" in err
    assert "--take" in err
    assert not my.exists()
    # what was recorded is as good as new
    take = kept / "punch-001.csv"
    assert read_recording(take).doodles[0].duration_s > 1.0
    assert run_smd("rehearse", "--library", my, "--take", f"punch={take}")[0] == 0


@pytest.mark.parametrize("at", ["write_exemplar", "manifest_text"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError])
def test_an_interruption_while_writing_leaves_nothing_half_written(
    monkeypatch, takes, my, at, error
):
    one, two = takes(performed("punch", 0), performed("bow", 1))
    before, write, calls = content(my), getattr(extension, at), []

    def interrupted(*arguments):
        calls.append(arguments)
        if at == "manifest_text" or len(calls) == 2:
            raise error
        return write(*arguments)

    monkeypatch.setattr(extension, at, interrupted)
    with pytest.raises(SystemExit) as exit_:
        main(["rehearse", "--library", str(my), "--take", f"punch={one}", "--take", f"bow={two}"])
    assert exit_.value.code
    assert calls
    assert content(my) == before
