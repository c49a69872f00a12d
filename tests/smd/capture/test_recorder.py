"""What was written stays, however the take ends."""

from __future__ import annotations

import numpy as np
import pytest

from smd.capture.recorder import Recorder
from smd.errors import CaptureError, RecordingError
from smd.formats import read_recording

POSE = (0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0)


def at(i: int):
    return (0.1 + 0.01 * i, *POSE[1:])


def write(path, frames: int, **more):
    with Recorder(path, {"LHR-1": "left", "LHR-2": "right"}, **more) as recorder:
        for i in range(frames):
            recorder.write(5.0 + i / 90, {"LHR-1": (at(i), True), "LHR-2": (POSE, i % 2 == 0)})


def test_what_is_written_reads_back(tmp_path):
    write(tmp_path / "take.csv", 50)
    recording = read_recording(tmp_path / "take.csv")
    left, right = recording.doodles
    np.testing.assert_allclose(left.time_s, np.arange(50) / 90, atol=1e-6)
    np.testing.assert_allclose(left.position_m[:, 0], 0.1 + 0.01 * np.arange(50), atol=1e-6)
    assert right.drawing.tolist() == [i % 2 == 0 for i in range(50)]
    assert dict(recording.metadata) == {"left": "LHR-1", "right": "LHR-2"}


def test_a_device_of_which_nothing_says_what_it_draws_reads_back_so(tmp_path):
    with Recorder(tmp_path / "take.csv", {"LHR-1": "left", "LHR-2": "right"}) as recorder:
        for i in range(30):
            recorder.write(i / 90, {"LHR-1": (at(i), None), "LHR-2": (at(i), True)})
    left, right = read_recording(tmp_path / "take.csv").doodles
    assert left.drawing is None
    assert right.drawing is not None and right.drawing.all()


def test_a_file_cut_anywhere_reads_without_repair(tmp_path):
    whole, cut = tmp_path / "whole.csv", tmp_path / "cut.csv"
    write(whole, 30)
    data = whole.read_bytes()
    for missing in range(150):  # some two rows
        cut.write_bytes(data[: len(data) - missing])
        left = read_recording(cut).of("left")[0]
        assert len(left) >= 30 - 3
        np.testing.assert_allclose(left.position_m[:, 0], [at(i)[0] for i in range(len(left))])
    cut.write_bytes(data + bytes(100))  # what some file systems leave after a power cut
    assert len(read_recording(cut).of("left")[0]) == 30


def test_a_file_cut_in_its_header_is_refused_in_one_line(tmp_path):
    write(tmp_path / "take.csv", 2)
    data = (tmp_path / "take.csv").read_bytes()
    header = data.index(b"drawing\n") + len(b"drawing")
    for length in range(10, header, 7):
        (tmp_path / "take.csv").write_bytes(data[:length])
        with pytest.raises(RecordingError):
            read_recording(tmp_path / "take.csv")


def test_a_file_is_not_written_over_without_being_told_to(tmp_path):
    take = tmp_path / "take.csv"
    take.write_text("precious")
    with pytest.raises(CaptureError, match="--force"):
        write(take, 1)
    assert take.read_text() == "precious"
    write(take, 20, force=True)
    assert len(read_recording(take).of("left")[0]) == 20


def test_a_full_disk_is_told_at_once_and_what_was_written_stays(tmp_path):
    resource = pytest.importorskip("resource")
    take = tmp_path / "take.csv"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, limits[1]))
    try:
        with pytest.raises(CaptureError, match=r"take.csv.*cannot be written.*0\.\d s"):
            write(take, 1000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    left, right = read_recording(take).doodles
    assert len(left) == len(right) > 20  # whole frames
    assert take.read_bytes().endswith(b"\n")


def test_a_device_that_was_never_seen_does_not_spoil_the_take(tmp_path):
    take = tmp_path / "take.csv"
    with Recorder(take, {"LHR-1": "left", "LHR-2": "right"}) as recorder:
        for i in range(50):
            recorder.write(i / 90, {"LHR-1": (at(i), True), "LHR-2": (None, True)})
    recording = read_recording(take)
    assert recording.devices == ("left",)
    (lost,) = recording.dropouts
    assert (lost.device, lost.kind, lost.bridged) == ("right", "invalid", False)
    with pytest.raises(RecordingError, match="right"):
        read_recording(take, device="right")


def test_a_name_with_a_comma_stays_one_cell(tmp_path):
    with Recorder(tmp_path / "take.csv", {"a": 'doll, "red"'}) as recorder:
        for i in range(20):
            recorder.write(i / 90, {"a": (at(i), True)})
    assert read_recording(tmp_path / "take.csv").devices == ('doll, "red"',)
