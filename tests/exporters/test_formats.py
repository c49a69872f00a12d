"""What holds of every output format: a new one is tried as soon as it is listed."""

from __future__ import annotations

import subprocess
import sys

import pytest

import exporters
from actions_library.stage_frame import StageFrame
from smd.errors import ExportError

CM = StageFrame.named("z", "cm")

every_suffix = pytest.mark.parametrize(
    "suffix", [suffix for kind in exporters.FORMATS for suffix in kind.suffixes]
)


@every_suffix
def test_a_file_is_whole_or_absent(performance, suffix, tmp_path):
    path = tmp_path / f"Take{suffix.upper()}"
    exporters.write(performance, path)
    written = path.read_bytes()
    assert len(written) > 1000
    exporters.write(performance, str(path))
    assert path.read_bytes()[:8] == written[:8]
    assert list(tmp_path.iterdir()) == [path]


@every_suffix
def test_what_cannot_be_written_is_one_line_that_begins_with_the_file(
    performance, suffix, tmp_path
):
    for path in (tmp_path / "nowhere" / f"take{suffix}", tmp_path / f"folder{suffix}"):
        if path.parent == tmp_path:
            path.mkdir()
        with pytest.raises(ExportError) as caught:
            exporters.write(performance, path)
        message = str(caught.value)
        assert message.startswith(f"{path}: expected ") and message.isprintable()
    assert [path.name for path in tmp_path.iterdir()] == [f"folder{suffix}"]


@every_suffix
def test_options_are_kept_or_refused(performance, suffix, tmp_path):
    (kind,) = (each for each in exporters.FORMATS if suffix in each.suffixes)
    path = tmp_path / f"take{suffix}"
    for options in ({"neutral": performance}, {"frame": CM}, {"keys_within_m": 0.01}):
        if kind.stage_writer is not None:
            exporters.write(performance, path, **options)
            assert path.exists()
            continue
        with pytest.raises(ExportError, match=f"expected .* with {next(iter(options))}"):
            exporters.write(performance, path, **options)


def test_a_format_without_options_refuses_them_and_is_written_without(
    performance, tmp_path, monkeypatch
):
    def write_frames(performance, path) -> None:
        path.write_text(str(len(performance)))

    frames = exporters.ExportFormat((".frames",), lambda: write_frames)
    monkeypatch.setattr(exporters, "FORMATS", (*exporters.FORMATS, frames))
    path = tmp_path / "take.frames"
    with pytest.raises(ExportError, match=r"take\.frames: expected \.usda, .* with frame, found"):
        exporters.write(performance, path, frame=StageFrame.named("z", "m"))
    assert not path.exists()
    exporters.write(performance, path)
    assert int(path.read_text()) == len(performance)


def test_a_suffix_is_of_one_format_and_none_is_loaded_before_it_is_asked_for():
    suffixes = [suffix for kind in exporters.FORMATS for suffix in kind.suffixes]
    assert len(set(suffixes)) == len(suffixes)
    code = "import sys, exporters; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert not {"pxr", "numpy", "exporters.usd"} & set(done.stdout.split())
