"""Against the stand-in runtime: what it plays is recorded, through the real openvr package."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from smd.capture.openvr import pose_of
from smd.formats import SourceFrame, read_recording
from smd.geometry.rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    rotvec_from_quaternion,
)
from tests.smd.capture.conftest import circling, hand
from tests.standin import runtime
from tests.standin.runtime import CONTROLLER, HMD, RIGHT, TRACKER, TRIGGER, Scene, asked

ROOM = [
    hand("HMD-1", HMD, 0),
    hand("LHR-1", battery=0.75),
    hand("LHR-2", CONTROLLER, RIGHT, lost=(0.4, 0.9)),
    hand("TRK-1", TRACKER, 0),
]


def test_devices_are_told_as_they_are(play_scene, run_smd):
    play_scene(Scene([*ROOM, hand("LHR-3", CONTROLLER, 0, away=(0.0, 9.0))]))
    code, out, err = run_smd("devices", "--json")
    assert (code, err) == (0, "")
    told = [
        (d["serial"], d["kind"], d["role"], d["battery"], d["tracking"]) for d in json.loads(out)
    ]
    assert told == [
        ("HMD-1", "headset", "", None, "tracked"),
        ("LHR-1", "controller", "left", 0.75, "tracked"),
        ("LHR-2", "controller", "right", None, "tracked"),
        ("TRK-1", "tracker", "", None, "tracked"),
        ("LHR-3", "controller", "", None, "away"),
    ]
    assert "battery 75 %" in run_smd("devices")[1]


def test_a_take_is_what_was_played_when_it_was_asked_for(play_scene, run_smd, tmp_path):
    play_scene(Scene(ROOM))
    take = tmp_path / "take.csv"
    code, _, err = run_smd("record", "-o", take, "--seconds", 1.2, "--rate", 60)
    assert (code, err) == (0, "")
    recording = read_recording(take)
    assert recording.devices == ("left", "right", "TRK-1")
    assert recording.metadata["left"] == "LHR-1"
    (left,) = recording.of("left")
    asked_s = runtime.answered(
        tmp_path, left.time_s, left.position_m, lambda time_s: circling(time_s)[0]
    )
    np.testing.assert_allclose(left.time_s, asked_s - asked_s[0], atol=2e-3)
    position, orientation = circling(asked_s)
    np.testing.assert_allclose(left.position_m, position, atol=6e-6)  # of it 5: interpolation
    apart = rotvec_from_quaternion(multiply(inverse(orientation), left.orientation_xyzw))
    assert np.degrees(np.linalg.norm(apart, axis=1)).max() < 1e-3
    # each controller is felt when the take begins and when it ends
    assert asked(tmp_path, "tick").tolist() == [1, 2, 3, 1, 2, 3]


def test_a_loss_is_marked_and_splits_the_doodle(play_scene, run_smd, tmp_path):
    play_scene(Scene([hand("LHR-1", away=(0.5, 0.9)), ROOM[2]]))
    take = tmp_path / "take.csv"
    code, out, _ = run_smd("record", "-o", take, "--seconds", 1.2)
    assert code == 0
    assert "lost 2 times" in out
    recording = read_recording(take)
    for name in ("left", "right"):
        before, after = recording.of(name)
        assert after.time_s[0] - before.time_s[-1] == pytest.approx(0.45, abs=0.1)
    assert [dropout.kind for dropout in recording.dropouts] == ["invalid", "invalid"]
    out = run_smd("convert", take, "-o", tmp_path / "take.usda")[1]
    assert "2 dropouts (2 over 0.25 s)" in out
    assert "tracking was lost once (1 split the doodle)" in out


def test_the_trigger_says_what_is_drawn(play_scene, run_smd, tmp_path):
    held = hand("LHR-1", buttons=lambda s: TRIGGER if 0.3 <= s < 0.6 else 0)
    play_scene(Scene([held, hand("LHR-2", CONTROLLER, RIGHT), hand("TRK-1", TRACKER, 0)]))
    take = tmp_path / "take.csv"
    assert run_smd("record", "-o", take, "--seconds", 0.9, "--hold-to-draw")[0] == 0
    recording = read_recording(take)
    for name, drawn_s in (("left", 0.3), ("right", 0.0), ("TRK-1", 0.3)):
        (doodle,) = recording.of(name)
        assert doodle.drawing.mean() * doodle.duration_s == pytest.approx(drawn_s, abs=0.04)


def test_when_the_runtime_quits_the_take_is_kept(play_scene, run_smd, tmp_path):
    play_scene(Scene(ROOM, quit_s=0.5))
    take = tmp_path / "take.csv"
    code, _, err = run_smd("record", "-o", take, "--seconds", 5)
    assert code == 3
    assert err == "smd: SteamVR has quit; start it, and record again\n"
    assert asked(tmp_path, "acknowledged")
    assert read_recording(take).of("left")[0].duration_s == pytest.approx(0.45, abs=0.1)


def _listens() -> None:
    """Let Ctrl-C be heard: who runs the tests in the background has them ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize("name", ["SIGINT", "SIGKILL"])
def test_a_take_that_is_stopped_reads_to_its_end(play_scene, tmp_path, name):
    stop = getattr(signal, name)  # not every system has them all; play_scene asks for Linux
    variables = play_scene(Scene(ROOM))
    take = tmp_path / "take.csv"
    process = subprocess.Popen(
        [sys.executable, "-m", "smd.cli", "record", "-o", str(take)],
        env={**os.environ, **variables},
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=_listens,
    )
    deadline = time.monotonic() + 60.0
    while not take.exists() or take.stat().st_size < 8_000:
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)
    process.send_signal(stop)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == (0 if stop == signal.SIGINT else -signal.SIGKILL)
    assert ("frames at" in out) == (stop == signal.SIGINT)
    (left,) = read_recording(take).of("left")
    asked_s = asked(tmp_path, "poses") if stop == signal.SIGINT else None
    if asked_s is not None:
        assert left.duration_s == pytest.approx(asked_s[-1] - asked_s[1], abs=0.2)
    assert np.diff(left.time_s).max() < 0.2


def test_a_pose_is_that_of_the_conversion_of_such_files():
    rng = np.random.default_rng(5)
    turns = rng.normal(size=(300, 4))
    turns[:8, :3] = 0.0, 0.0, 0.0  # no turn, and then half turns about each axis
    turns[8:20] = np.tile(np.eye(4)[:3], (4, 1)) + 1e-9
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    positions = rng.normal(size=(300, 3))
    matrices = np.dstack([matrix_from_quaternion(turns), positions])
    found = np.array([pose_of(matrix.ravel().tolist()) for matrix in matrices])
    conversion = SourceFrame.from_options(front="-z").completed(SourceFrame.ours()).conversion()
    position, orientation = conversion.poses(positions, turns)
    np.testing.assert_allclose(found[:, :3], position)
    apart = rotvec_from_quaternion(multiply(inverse(orientation), found[:, 3:]))
    assert np.abs(apart).max() < 1e-7
    np.testing.assert_allclose(np.linalg.norm(found[:, 3:], axis=1), 1.0)


BAD = {
    "refuses": (Scene(refuse=108), [], "connect the headset"),
    "not running": (Scene(refuse=121), [], "start SteamVR"),
    "no controller": (Scene(ROOM[:1]), [], "switch one on"),
    "unknown serial": (Scene(ROOM), ["--device", "LHR-9"], "LHR-1 (left controller)"),
    "two of one role": (Scene([ROOM[1], hand("LHR-7")]), [], "--device LHR-1 or LHR-7"),
    "rate of 0": (Scene(ROOM), ["--rate", "0"], "10 to 1000"),
    "rate of a million": (Scene(ROOM), ["--rate", "1000000"], "10 to 1000"),
    "no time": (Scene(ROOM), ["--seconds", "0"], "positive"),
    "missing folder": (Scene(ROOM), ["-o", "absent/take.csv"], "existing folder"),
    "no CSV": (Scene(ROOM), ["-o", "take.usda"], ".csv"),
    "unknown source": (Scene(ROOM), ["--source", "vive"], "replay:FILE"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_input_costs_one_line_with_the_next_step(play_scene, run_smd, tmp_path, name):
    scene, options, said = BAD[name]
    play_scene(scene)
    take = tmp_path / "take.csv"
    code, out, err = run_smd("record", "-o", take, "--seconds", "0.2", *options)
    assert (code, out) == (3, "")
    assert len(err.splitlines()) == 1
    assert said in err
    assert not take.exists()


def test_without_a_runtime_it_says_what_to_do_and_the_loader_nothing(tmp_path):
    pytest.importorskip("openvr")
    nowhere = {"XDG_CONFIG_HOME": str(tmp_path), "HOME": str(tmp_path)}
    told = subprocess.run(
        [sys.executable, "-m", "smd.cli", "devices", "--json"],
        env={**os.environ, **nowhere},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (told.returncode, told.stdout) == (3, "")
    assert told.stderr == (
        "smd: no OpenVR runtime is installed: install SteamVR, start it, and try again\n"
    )
