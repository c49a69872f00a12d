"""A recording that is played back is what was recorded."""

from __future__ import annotations

import io
import sys
from itertools import pairwise

import numpy as np

from smd.capture.opening import open_source
from smd.doodle import Doodle, Recording
from smd.formats import read_recording, write_recording
from tests.smd.capture.conftest import circling


def story() -> Recording:
    t = np.arange(60) / 60
    held = (t > 0.2) & (t < 0.6)
    return Recording(
        (Doodle(t, *circling(t), "left", held), Doodle(t + 0.005, *circling(t), "hmd"))
    )


def test_a_replay_recorded_again_is_the_recording(run_smd, tmp_path):
    take, again = tmp_path / "take.csv", tmp_path / "again.csv"
    write_recording(story(), take)
    code, _, err = run_smd(
        "record", "-o", again, "--source", f"replay:{take}", "--hold-to-draw", "--device", "left"
    )
    assert (code, err) == (0, "")
    (mine,), (theirs,) = read_recording(again).doodles, read_recording(take).of("left")
    np.testing.assert_allclose(mine.time_s, theirs.time_s, atol=1e-6)
    np.testing.assert_allclose(mine.position_m, theirs.position_m, atol=1e-6)
    assert mine.drawing.tolist() == theirs.drawing.tolist()


def test_a_recording_says_what_was_drawn_where_the_trigger_was_to_be_held(run_smd, tmp_path):
    take = tmp_path / "take.csv"
    write_recording(story(), take)
    freely, held = tmp_path / "freely.csv", tmp_path / "held.csv"
    options = ("--source", f"replay:{take}", "--device", "left", "--device", "headset")
    assert run_smd("record", "-o", freely, *options)[0] == 0
    assert [one.drawing for one in read_recording(freely).doodles] == [None, None]
    assert run_smd("record", "-o", held, *options, "--hold-to-draw")[0] == 0
    left, headset = read_recording(held).doodles
    assert 0 < left.drawing.sum() < len(left)
    assert headset.drawing.all()  # of which the recording says nothing: held all along


def test_recordings_of_a_folder_follow_one_another(tmp_path):
    for name in ("a.csv", "b.csv"):
        write_recording(story(), tmp_path / name)
    with open_source(f"replay:{tmp_path}", 90.0) as source:
        assert [(d.name, d.kind) for d in source.devices()] == [
            ("left", "controller"),
            ("headset", "headset"),
        ]
        frames = list(source.poses())
    times = [frame.time_s for frame in frames]
    assert times == sorted(set(times))
    pressed = [s.trigger for frame in frames for s in frame.samples if s.serial == "left"]
    assert sum(a and not b for a, b in pairwise(pressed)) == 2


def test_a_recording_comes_on_standard_input(tmp_path, monkeypatch):
    write_recording(story(), tmp_path / "take.csv")
    data = io.BytesIO((tmp_path / "take.csv").read_bytes())
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(data))
    with open_source("replay:-", 90.0) as source:
        assert len(list(source.poses())) == 2 * 60 + 1
