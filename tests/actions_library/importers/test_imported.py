"""Animations of an imported file, by name."""

from __future__ import annotations

from dataclasses import replace

import pytest

from actions_library.importers import Imported, import_file
from smd.errors import ImportedFileError
from tests.actions_library.importers.test_bvh import ARM


@pytest.fixture
def named(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text(ARM)
    (one,) = (imported := import_file(path)).animations

    def make(*names: str) -> Imported:
        return replace(imported, animations=tuple(replace(one, name=name) for name in names))

    return make


def test_an_action_is_found_with_its_rig_and_without(named):
    imported = named("Rig|Walk", "Rig|Run", "Idle")
    for asked in ("Rig|Walk", "Walk"):
        assert imported.animation(asked).name == "Rig|Walk"
    assert imported.animation("Idle").name == "Idle"


def test_an_action_of_two_rigs_is_none_of_them_and_its_own_name_comes_first(named):
    with pytest.raises(ImportedFileError, match=r"Knight\|Walk, Horse\|Walk, found Walk"):
        named("Knight|Walk", "Horse|Walk").animation("Walk")
    assert named("Rig|Walk", "Walk").animation("Walk").name == "Walk"
