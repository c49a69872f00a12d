from __future__ import annotations

import json
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdSkel

from actions_library.folder import load_library, shipped_libraries, write_library
from actions_library.library import Library
from smd.errors import LibraryError
from smd.recognition.action import Action
from smd.recognition.pattern import Pattern
from tests.naive.puppet import puppet, waving_clip

ACTIONS = (
    Action("walk", Pattern.parse("T_Z+ (T_Y|T_Y_Z)* T_N_Y+"), True, True, "Moves – “ahead”."),
    Action("idle", None, cyclic=True),
)


def made(folder: Path) -> Library:
    return write_library(
        folder,
        name="puppets",
        character=puppet(),
        clips={"walk": waving_clip("walk", 40, cyclic=True), "idle": waving_clip("idle")},
        actions=ACTIONS,
    )


@pytest.fixture(scope="module")
def library(tmp_path_factory) -> Library:
    return made(tmp_path_factory.mktemp("library") / "puppets")


def bytes_of(folder: Path) -> dict[str, bytes]:
    return {
        p.relative_to(folder).as_posix(): p.read_bytes()
        for p in sorted(folder.rglob("*"))
        if p.is_file()
    }


def test_actions_survive_the_round_trip(library):
    assert load_library(library.folder).actions == ACTIONS
    assert library.name == "puppets"


def test_clips_survive_the_round_trip_in_single_precision(library):
    for name, ours in (("walk", waving_clip("walk", 40, cyclic=True)), ("idle", waving_clip())):
        theirs = library.clip(name)
        assert (theirs.name, theirs.cyclic, theirs.rate_hz) == (name, ours.cyclic, 30.0)
        assert theirs.contact_joints == ours.contact_joints
        assert np.array_equal(theirs.contacts, ours.contacts)
        assert np.array_equal(theirs.stage_end_frames, ours.stage_end_frames)
        assert np.array_equal(theirs.translation_m, ours.translation_m.astype(np.float32))
        np.testing.assert_allclose(theirs.rotation_xyzw, ours.rotation_xyzw, atol=2e-7)


def test_a_clip_that_touches_nothing_survives_the_round_trip(tmp_path):
    from dataclasses import replace

    clip = replace(waving_clip("idle"), contact_joints=(), contacts=np.empty((30, 0), bool))
    library = write_library(
        tmp_path / "a", name="a", character=puppet(), clips={"idle": clip}, actions=ACTIONS[1:]
    )
    assert library.clip("idle").contacts.shape == (30, 0)


def test_writing_twice_gives_the_same_bytes_in_another_process_too(library, tmp_path):
    script = (
        "import sys; from pathlib import Path;"
        "from tests.actions_library.test_library import made; made(Path(sys.argv[1]))"
    )
    subprocess.run(
        [sys.executable, "-c", script, str(tmp_path / "b")],
        check=True,
        cwd=Path(__file__).parents[2],
        timeout=60,
    )
    made(tmp_path / "a")
    assert bytes_of(tmp_path / "a") == bytes_of(library.folder)
    assert bytes_of(tmp_path / "b") == bytes_of(library.folder)


def test_a_library_written_again_from_what_was_read_keeps_its_bytes(library, tmp_path):
    again = write_library(
        tmp_path / "again",
        name=library.name,
        character=library.character,
        clips=library.clips,
        actions=library.actions,
    )
    assert (again.folder / "library.json").read_bytes() == (
        library.folder / "library.json"
    ).read_bytes()
    for name, clip in again.clips.items():
        assert np.array_equal(clip.translation_m, library.clip(name).translation_m)
        np.testing.assert_allclose(clip.rotation_xyzw, library.clip(name).rotation_xyzw, atol=1e-7)


def test_every_file_plays_on_its_own(library):
    for file in ("character.usdc", "clips/walk.usdc", "clips/idle.usdc"):
        stage = Usd.Stage.Open(str(library.folder / file))
        root = UsdSkel.Root(stage.GetDefaultPrim())
        cache = UsdSkel.Cache()
        assert cache.Populate(root, Usd.PrimDefaultPredicate)
        bindings = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
        assert [len(binding.GetSkinningTargets()) for binding in bindings] == [1]
        query = cache.GetSkelQuery(bindings[0].GetSkeleton())
        assert bool(query.GetAnimQuery()) == file.startswith("clips")
        assert query.ComputeSkinningTransforms(3.0)


def test_reading_the_patterns_loads_no_usd():
    script = (
        "import sys; from actions_library.folder import load_library;"
        "load_library(sys.argv[1]); assert not [m for m in sys.modules if m.startswith('pxr')]"
    )
    folder = Path(__file__).parents[2] / "tests"
    result = subprocess.run(
        [sys.executable, "-c", script, str(folder)],
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2],
        timeout=60,
    )
    assert "LibraryError" in result.stderr
    assert "AssertionError" not in result.stderr


def test_writing_replaces_a_library_and_leaves_nothing_beside_it(tmp_path):
    made(tmp_path / "a")
    write_library(
        tmp_path / "a",
        name="b",
        character=puppet(),
        clips={"idle": waving_clip("idle")},
        actions=ACTIONS[1:],
    )
    assert [p.name for p in tmp_path.iterdir()] == ["a"]
    assert load_library(tmp_path / "a").name == "b"
    assert not (tmp_path / "a" / "clips" / "walk.usdc").exists()


def test_a_folder_of_other_things_is_never_replaced(tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter1.tex").write_text("years of work")
    with pytest.raises(LibraryError, match="thesis"):
        made(tmp_path / "thesis")
    assert (tmp_path / "thesis" / "chapter1.tex").read_text() == "years of work"


def test_a_failed_writing_leaves_the_old_library(library, tmp_path):
    made(tmp_path / "a")
    before = bytes_of(tmp_path / "a")
    with pytest.raises(LibraryError, match="fly"):
        write_library(
            tmp_path / "a",
            name="b",
            character=puppet(),
            clips={},
            actions=(Action("fly", None),),
        )
    assert bytes_of(tmp_path / "a") == before
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


def test_an_unknown_action_is_answered_with_those_there_are(library):
    with pytest.raises(LibraryError, match=r"walk, idle.*'moonwalk'"):
        library.action("moonwalk")


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"schema": "other"}, "schema"),
        ({"version": 5}, "version"),
        ({"version": 0}, "version"),
        ({"version": True}, "version"),
        ({"version": "2"}, "version"),
        ({"name": 3}, "name"),
        ({"character": "../../etc/passwd"}, "character"),
        ({"character": "/etc/passwd"}, "character"),
        ({"character": "C:x"}, "character"),
        ({"actions": {}}, "actions"),
        ({"actions": ["walk"]}, r"actions\[0\]"),
        ({"actions": [{"name": "walk"}]}, "action 'walk': expected the key .travels., found none"),
        ({"actions": [{"name": "w", "pattern": "T_Q", "clip": "a"}]}, "pattern"),
        ({"actions": [{"name": "w", "pattern": 5, "clip": "a"}]}, "pattern"),
        ({"actions": [{"name": "w", "pattern": "T_Z (", "clip": "a"}]}, r"'w'.*character 6"),
        ({"actions": [{"name": "w", "pattern": "T_Z*", "clip": "a"}]}, r"'w'.*nothing at all"),
    ],
)
def test_a_wrong_entry_is_named_with_its_file(library, tmp_path, change, named):
    folder = tmp_path / "a"
    shutil.copytree(library.folder, folder)
    document = json.loads((folder / "library.json").read_text(encoding="utf-8"))
    (folder / "library.json").write_text(json.dumps({**document, **change}))
    with pytest.raises(LibraryError, match=named) as caught:
        load_library(folder)
    assert "library.json" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * 100_000, "expected JSON, found JSON nested too deeply"),
        ('{"schema":', "line 1, column 11: expected JSON, found the end (expecting value)"),
        ("[]", "expected an object, found a list"),
    ],
)
def test_what_is_no_table_of_contents_is_named_with_its_file(tmp_path, text, said):
    file = tmp_path / "library.json"
    file.write_text(text)
    with pytest.raises(LibraryError) as caught:
        load_library(tmp_path)
    assert str(caught.value) == f"{file}: {said}"


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("library.json", None),
        ("library.json", b"{"),
        ("library.json", b"\xff\xfe{\x00"),
        ("character.usdc", None),
        ("character.usdc", b"PXR-USDC and then nothing"),
        ("character.usdc", b""),
        ("clips/walk.usdc", None),
        ("clips/walk.usdc", b"#usda 1.0\n"),
    ],
)
def test_a_missing_or_damaged_file_is_named(library, tmp_path, file, content):
    folder = tmp_path / "a"
    shutil.copytree(library.folder, folder)
    (folder / file).unlink()
    if content is not None:
        (folder / file).write_bytes(content)
    with pytest.raises(LibraryError, match=file.split("/")[-1]) as caught:
        load_library(folder).clip("walk")
    assert "\n" not in str(caught.value)


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(LibraryError, match="nowhere"):
        load_library(tmp_path / "nowhere")


def test_shipped_libraries_are_found_by_name_and_folders_come_first(tmp_path, monkeypatch):
    shipped = load_library().folder
    assert "humanoid" in shipped_libraries()
    assert load_library("humanoid") is load_library()
    assert pickle.loads(pickle.dumps(load_library("humanoid"))) is load_library()
    monkeypatch.chdir(tmp_path)
    made(tmp_path / "humanoid")
    assert load_library("humanoid").folder == Path("humanoid")
    assert load_library().folder == shipped


def test_an_unknown_name_is_answered_with_those_there_are():
    with pytest.raises(LibraryError, match=r"humanoyd: expected a library's folder, or one of .*"):
        load_library("humanoyd")


def test_a_file_is_not_a_library(library):
    with pytest.raises(LibraryError, match=r"library\.json"):
        load_library(library.folder / "library.json")


@pytest.mark.rebuild
def test_the_shipped_library_is_what_the_authoring_makes():
    from actions_library.authoring.actions import HUMANOID_ACTIONS
    from actions_library.authoring.clips import humanoid_clips

    shipped = load_library()
    assert shipped.actions == HUMANOID_ACTIONS
    made = {clip.name: clip for clip in humanoid_clips(shipped.character.skeleton)}
    assert list(made) == list(shipped.clips)
    for name, clip in made.items():
        stored = shipped.clip(name)
        assert (stored.rate_hz, stored.cyclic) == (clip.rate_hz, clip.cyclic)
        assert np.array_equal(stored.stage_end_frames, clip.stage_end_frames)
        assert np.array_equal(stored.contacts, clip.contacts)
        # Positions are stored to 6e-8 of a metre; another machine's sines may differ in the last.
        np.testing.assert_allclose(stored.translation_m, clip.translation_m, atol=1e-5)
        np.testing.assert_allclose(stored.rotation_xyzw, clip.rotation_xyzw, atol=1e-5)
