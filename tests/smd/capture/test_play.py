"""The loops of play and of teaching, from recordings and from the stand-in runtime."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.capture.take import Progress
from smd.cli.capturing import LiveLine
from smd.doodle import Recording
from smd.formats import read_recording, write_recording
from smd.score_file import read_score
from tests.smd.capture.conftest import hand, played
from tests.standin.runtime import CONTROLLER, GRIP, LEFT, TRACKER, TRIGGER, Played, Scene


def test_a_replayed_story_is_recognised_and_written_under_one_name(run_smd, tmp_path):
    doodle = played("punch", "bow")
    write_recording(Recording((doodle,)), tmp_path / "take.csv")
    stories = tmp_path / "stories"
    code, out, err = run_smd(
        "play", "-o", stories, "--source", f"replay:{tmp_path / 'take.csv'}", "--picture"
    )
    assert (code, err) == (0, "")
    names = {f"story-001.{kind}" for kind in ("csv", "score.json", "usdc", "timeline.png")}
    assert {path.name for path in stories.iterdir()} == names
    score = read_score(stories / "story-001.score.json")
    assert [phrase.action for phrase in score.performers[0].phrases] == ["punch", "bow"]
    assert (stories / score.recording).resolve() == (stories / "story-001.csv").resolve()
    again = read_recording(stories / "story-001.csv").doodles[0]
    np.testing.assert_allclose(again.position_m, doodle.position_m, atol=1e-6)
    # both as they are decided and in the table, there with what else it could have been
    assert out.count(" punch ") == out.count(" bow ") == 2
    assert "  or " in out


def test_hold_the_trigger_for_each_story_and_grip_to_discard_the_last(
    play_scene, run_smd, tmp_path
):
    doodle = played("punch", pause_s=0.3)
    n = len(doodle)
    time_s = np.arange(3 * n) / 90
    pressed = [(0.1, 0.9, TRIGGER), (1.1, 1.5, TRIGGER), (1.7, 1.8, GRIP)]
    hand = Played(
        CONTROLLER,
        LEFT,
        "LHR-1",
        time_s,
        np.tile(doodle.position_m, (3, 1)),
        np.tile(doodle.orientation_xyzw, (3, 1)),
        buttons=lambda s: sum(button for start, end, button in pressed if start <= s < end),
    )
    play_scene(Scene([hand], quit_s=1.9))
    stories = tmp_path / "stories"
    code, out, err = run_smd("play", "-o", stories)
    assert (code, len(err.splitlines())) == (3, 1)  # the runtime has quit
    assert "story-002: discarded" in out
    assert {path.name.split(".")[0] for path in stories.iterdir()} == {"story-001"}
    recording = read_recording(stories / "story-001.csv")
    assert recording.of("left")[0].duration_s == pytest.approx(0.8, abs=0.06)


def lessons(tmp_path, *doodles):
    folder = tmp_path / "takes"
    folder.mkdir()
    for i, doodle in enumerate(doodles):
        write_recording(Recording((replace(doodle, device="left"),)), folder / f"{i}.csv")
    return f"replay:{folder}"


def test_three_performances_teach_an_action(run_smd, tmp_path):
    source = lessons(tmp_path, *(played("throw", seed=seed) for seed in (1, 2, 3)))
    my, takes = tmp_path / "my", tmp_path / "lessons"
    code, out, err = run_smd("teach", "hurl", "--library", my, "-o", takes, "--source", source)
    assert (code, err) == (0, "")
    for i in (1, 2, 3):
        assert f"{i} of 3: hold the trigger" in out
        assert f"hurl-00{i}.csv: " in out
    assert "hurl: learned from 3 examples" in out
    assert "  agree in " in out
    assert "must occur, in this order" in out
    # what was learned is understood
    write_recording(Recording((played("throw", seed=4),)), tmp_path / "take.csv")
    assert " hurl " in run_smd("parse", tmp_path / "take.csv", "--library", my)[1]


def test_fewer_performances_than_asked_for_teach_nothing(run_smd, tmp_path):
    source = lessons(tmp_path, played("throw"))
    my = tmp_path / "my"
    code, _, err = run_smd(
        "teach", "hurl", "--library", my, "-o", tmp_path / "lessons", "--source", source
    )
    assert code == 3
    assert "expected 3 performances of 'hurl', got 1" in err
    assert not my.exists()
    assert (tmp_path / "lessons" / "hurl-001.csv").is_file()


@pytest.mark.parametrize("name", ["Hurl it", "idle"])
def test_a_bad_name_is_refused_before_anyone_performs(run_smd, tmp_path, name):
    code, out, err = run_smd("teach", name, "--library", tmp_path / "my", "--source", "openvr")
    assert (code, out) == (3, "")
    assert "action" in err


@pytest.mark.parametrize("command", [["play"], ["teach", "hurl", "--library", "my"]])
def test_without_a_trigger_nobody_waits(play_scene, run_smd, tmp_path, command):
    play_scene(Scene([hand("TRK-1", TRACKER, 0)]))
    code, out, err = run_smd(*command, "-o", tmp_path / "takes")
    assert (code, out) == (3, "")
    assert "expected a controller" in err
    assert "TRK-1 (tracker)" in err
    assert not (tmp_path / "takes").exists()


def test_a_live_line_tells_how_a_take_goes(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    line = LiveLine({"LHR-1": "left", "TRK-1": "TRK-1"})
    line.show(Progress(time_s=2.0, frames=181, lost={"TRK-1": 1.5}, losses=1))
    line.clear()
    err = capsys.readouterr().err
    assert "2.0 s   90.0 Hz  left  TRK-1 lost  dropouts 1" in err
    assert err.count("\n") == 0


@pytest.mark.parametrize("command", [["play"], ["teach", "hurl", "--library", "my"]])
def test_a_bad_mount_is_told_before_anyone_plays(run_smd, tmp_path, command):
    code, out, err = run_smd(*command, "-o", tmp_path / "takes", "--mount", "jaw=180")
    assert (code, out) == (3, "")
    assert "'jaw=180'" in err


def test_the_grip_takes_the_last_rehearsed_take_back(play_scene, run_smd, tmp_path):
    doodle = played("punch", pause_s=0.3)
    time_s = np.arange(3 * len(doodle)) / 90
    length_s = len(doodle) / 90
    pressed = [
        (0.1, length_s - 0.1, TRIGGER),
        (length_s, length_s + 0.1, GRIP),
        (length_s + 0.2, length_s + 0.3, GRIP),  # nothing is left to discard
        (2 * length_s, 3 * length_s - 0.1, TRIGGER),
    ]
    prop = Played(
        CONTROLLER,
        LEFT,
        "LHR-1",
        time_s,
        np.tile(doodle.position_m, (3, 1)),
        np.tile(doodle.orientation_xyzw, (3, 1)),
        buttons=lambda s: sum(button for start, end, button in pressed if start <= s < end),
    )
    play_scene(Scene([prop], quit_s=3 * length_s))
    my, kept = tmp_path / "my", tmp_path / "kept"
    code, out, err = run_smd("rehearse", "punch", "bow", "--library", my, "-o", kept)
    assert (code, len(err.splitlines())) == (3, 1)  # the runtime has quit
    assert out.count("punch-001.csv: discarded") == 1
    assert out.count("1 of 2: hold the trigger, draw punch") == 2
    assert "2 of 2: hold the trigger, draw bow" in out
    assert {path.name for path in kept.iterdir()} == {"punch-002.csv"}
    assert not my.exists()
