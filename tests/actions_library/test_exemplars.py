"""What was learned survives the way to disk, and a damaged file is named with its key."""

from __future__ import annotations

import io
import json
import pickle
import shutil
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library, write_library
from actions_library.library import Credit, Library
from smd.errors import LibraryError
from smd.recognition.action import Action
from smd.recognition.exemplar import Exemplar, exemplar_of
from smd.recognition.pattern import Pattern
from smd.recognition.traits import traits_of
from smd.smoothing import smooth
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take
from tests.naive.puppet import puppet, waving_clip

GOLDEN = Path(__file__).parents[1] / "golden" / "libraries"


def an_exemplar(examples: int = 3) -> Exemplar:
    traits = []
    for seed in range(examples):
        rng = np.random.default_rng(seed)
        take = Take(simulated_person(rng), rng)
        traits.append(traits_of(smooth(take.play("throw").doodle())))
    return exemplar_of(traits)


def with_exemplar(folder: Path, exemplar: Exemplar) -> Library:
    action = Action(
        "hurl", Pattern.parse("T_Z+ T_Y"), learned_from=("a.csv", "b.csv"), exemplar=exemplar
    )
    return write_library(
        folder,
        name="puppets",
        character=puppet(),
        clips={"hurl": waving_clip("hurl")},
        actions=(action,),
    )


@pytest.fixture(scope="module")
def library(tmp_path_factory) -> Library:
    return with_exemplar(tmp_path_factory.mktemp("library") / "puppets", an_exemplar())


@pytest.fixture
def folder(library, tmp_path) -> Path:
    return Path(shutil.copytree(library.folder, tmp_path / "copy"))


@pytest.mark.parametrize("examples", [1, 3])
def test_an_exemplar_survives_the_round_trip_in_single_precision(tmp_path, examples):
    exemplar = an_exemplar(examples)
    action = with_exemplar(tmp_path / "a", exemplar).action("hurl")
    assert action.learned_from == ("a.csv", "b.csv")
    ours, theirs = exemplar.to_arrays(), action.exemplar.to_arrays()
    assert set(ours) == set(theirs)
    for key in ours:
        assert np.array_equal(ours[key].astype(np.float32), theirs[key]), key


def test_the_same_exemplar_gives_the_same_bytes(library, tmp_path):
    again = write_library(
        tmp_path / "again",
        name=library.name,
        character=library.character,
        clips=library.clips,
        actions=library.actions,
    )
    for file in ("library.json", "exemplars/hurl.npz"):
        assert (again.folder / file).read_bytes() == (library.folder / file).read_bytes()


def arrays_of(file: Path) -> dict[str, np.ndarray]:
    with np.load(file, allow_pickle=False) as stored:
        return dict(stored)


def expect(folder: Path, *named: str) -> None:
    with pytest.raises(LibraryError) as caught:
        load_library(folder)
    message = str(caught.value)
    assert "\n" not in message
    for part in ("hurl.npz", *named):
        assert part in message


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 and then nothing", None])
def test_a_file_that_is_no_npz_is_named(folder, content):
    file = folder / "exemplars" / "hurl.npz"
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    expect(folder)


@pytest.mark.parametrize("key", ["measures", "apart", "flow_prop"])
def test_a_missing_or_misshapen_array_is_named(folder, key):
    file = folder / "exemplars" / "hurl.npz"
    arrays = arrays_of(file)
    np.savez(file, **{name: value for name, value in arrays.items() if name != key})
    expect(folder, key)
    np.savez(file, **{**arrays, key: np.zeros((3, 2))})
    expect(folder, key)
    np.savez(file, **{**arrays, key: np.full_like(arrays[key], np.nan)})
    expect(folder, key)
    np.savez(file, **{**arrays, key: np.array(["a"])})
    expect(folder, key)


def test_a_pickled_array_is_never_run(folder):
    class Trap:
        def __reduce__(self):
            return Path.touch, (folder / "trapped",)

    file = folder / "exemplars" / "hurl.npz"
    arrays = arrays_of(file)
    np.savez(file, **{**arrays, "measures": np.array([Trap()], dtype=object)})
    expect(folder, "measures")
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("measures.npy", pickle.dumps(Trap()))
    expect(folder, "measures")
    assert not (folder / "trapped").exists()


def test_a_header_that_promises_too_much_is_refused_unread(folder):
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 4)}
    )
    file = folder / "exemplars" / "hurl.npz"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("measures.npy", header.getvalue())
    expect(folder, "measures", "1000000000000")


def test_a_damaged_byte_is_noticed(folder):
    file = folder / "exemplars" / "hurl.npz"
    content = bytearray(file.read_bytes())
    content[len(content) // 3] ^= 0xFF
    file.write_bytes(content)
    expect(folder)


@pytest.mark.parametrize("path", ["../hurl.npz", "/etc/hurl.npz", "a/../../hurl.npz", "C:hurl"])
def test_an_exemplar_outside_the_folder_is_refused(folder, path):
    file = folder / "library.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    document["actions"][0]["exemplar"] = path
    file.write_text(json.dumps(document))
    with pytest.raises(LibraryError, match=r"library\.json: action 'hurl'.exemplar: .*inside"):
        load_library(folder)


@pytest.mark.parametrize("wrong", ["a.csv", [1], None])
def test_what_it_was_learned_from_is_a_list_of_text(folder, wrong):
    file = folder / "library.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    document["actions"][0]["learned_from"] = wrong
    file.write_text(json.dumps(document))
    with pytest.raises(LibraryError, match=r"library\.json: action 'hurl'.learned_from"):
        load_library(folder)


def test_a_library_of_version_1_still_loads():
    library = load_library(GOLDEN / "version_1")
    walk = library.action("walk")
    assert (str(walk.pattern), walk.travels, walk.cyclic) == (
        "T_Z+ (T_Y|T_Y_Z)* T_N_Y+",
        True,
        True,
    )
    assert (walk.exemplar, walk.learned_from) == (None, ())
    assert library.clip("walk").cyclic


def test_a_library_of_version_2_still_loads_with_nobody_s_clips_and_one_idling():
    library = load_library(GOLDEN / "version_2")
    walk = library.action("walk")
    assert walk.learned_from == ("one.csv", "two.csv")
    assert walk.exemplar is not None and len(walk.exemplar) == 2
    assert (walk.rest, library.credit("walk")) == ("", Credit())


def test_what_a_library_of_version_3_learned_is_its_user_s_own_and_the_rest_is_not():
    library = load_library(GOLDEN / "version_3")
    assert library.action("walk").exemplar.own.all()
    assert not library.action("bow").exemplar.own.any()
    assert library.action("bow").rest == "walk"
    assert library.credit("bow") == Credit("Ann", "CC0")


@pytest.mark.parametrize("own", [False, True, (2,), (0, 2)])
def test_whose_examples_are_survives_the_round_trip(tmp_path, own):
    exemplar = replace(an_exemplar(), own=exemplar_of(an_exemplar().examples(), own=own).own)
    library = with_exemplar(tmp_path / "a", exemplar)
    assert library.action("hurl").exemplar.ownership == own
    row = json.loads((library.folder / "library.json").read_text(encoding="utf-8"))["actions"][0]
    assert row["own"] == (own if isinstance(own, bool) else list(own))


@pytest.mark.parametrize("own", [None, 1, "all", [0.5], [True], [3], [-1]])
def test_whose_examples_are_is_told_in_numbers_that_there_are(folder, own):
    file = folder / "library.json"
    document = json.loads(file.read_text(encoding="utf-8"))
    document["actions"][0]["own"] = own
    file.write_text(json.dumps(document))
    with pytest.raises(LibraryError, match=r"hurl.*own: expected"):
        load_library(folder)


def test_a_library_of_version_1_is_written_again_as_the_present_one(tmp_path):
    old = load_library(GOLDEN / "version_1")
    new = write_library(
        tmp_path / "a",
        name=old.name,
        character=old.character,
        clips=old.clips,
        actions=old.actions,
    )
    assert new.actions == old.actions
    document = json.loads((new.folder / "library.json").read_text(encoding="utf-8"))
    assert document["version"] == 4
    assert replace(new.action("walk")) == old.action("walk")


@pytest.mark.rebuild
def test_the_shipped_exemplars_are_what_the_authoring_makes():
    from actions_library.authoring.actions import HUMANOID_ACTIONS
    from actions_library.authoring.examples import with_examples

    shipped = load_library()
    for action in HUMANOID_ACTIONS:
        assert (shipped.action(action.name).exemplar is None) == (action.pattern is None)
    some = [action for action in HUMANOID_ACTIONS if action.pattern][::8]  # a second each
    for action in with_examples(some):
        stored = shipped.action(action.name).exemplar
        assert len(stored) == len(action.exemplar)
        for key, array in action.exemplar.to_arrays().items():
            # single precision, and another machine's sines
            np.testing.assert_allclose(stored.to_arrays()[key], array, rtol=1e-4, atol=1e-4)
