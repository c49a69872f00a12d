from __future__ import annotations

from pathlib import Path

import pytest

from smd.errors import ExportError
from smd.files import write_together


def writes(text: str):
    return lambda path: path.write_text(text)


def fails(_: Path) -> None:
    raise OSError(28, "No space left on device")


def test_all_files_are_written(tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    one.write_text("before")
    write_together({one: writes("1"), two: writes("2")})
    assert (one.read_text(), two.read_text()) == ("1", "2")
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("broken", ["one", "two", "three"])
def test_where_one_cannot_be_written_none_is(tmp_path, broken):
    paths = [tmp_path / name for name in ("one", "two", "three")]
    paths[1].write_text("before")
    writers = {path: fails if path.name == broken else writes("after") for path in paths}
    with pytest.raises(ExportError, match=rf"{broken}: cannot be written: No space left"):
        write_together(writers)
    assert [path.name for path in tmp_path.iterdir()] == ["two"]
    assert paths[1].read_text() == "before"


@pytest.mark.parametrize("broken", ["one", "two", "three"])
def test_where_one_cannot_be_renamed_the_others_are_put_back(tmp_path, monkeypatch, broken):
    paths = [tmp_path / name for name in ("one", "two", "three")]
    paths[0].write_text("before")
    rename = Path.replace

    def renamed(self, target):
        if target.name == broken:
            raise OSError(13, "Permission denied")
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", renamed)
    with pytest.raises(ExportError, match=rf"{broken}: cannot be written: Permission denied"):
        write_together({path: writes("after") for path in paths})
    assert [path.name for path in tmp_path.iterdir()] == ["one"]
    assert paths[0].read_text() == "before"


def test_they_appear_in_their_order(tmp_path, monkeypatch):
    order = []
    rename = Path.replace

    def renamed(self, target):
        order.append(target.name)
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", renamed)
    write_together({tmp_path / name: writes("") for name in ("layer", "other", "main")})
    assert order == ["layer", "other", "main"]
