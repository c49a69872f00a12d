"""Bad input costs the user one line that names the place, exit code 3, and nothing on disk."""

from __future__ import annotations

import os
import re

import pytest

HEADER = "time_s,x,y,z,qx,qy,qz,qw\n"
ROW = "{t},0.1,0.2,0.3,0,0,0,1\n"
GOOD = HEADER + "".join(ROW.format(t=i / 60) for i in range(120))


def broken(row: int, line: str) -> bytes:
    """A good recording with the line of data row ``row`` (from 0) replaced."""
    lines = GOOD.splitlines(keepends=True)
    lines[row + 1] = line + "\n"
    return "".join(lines).encode()


# content of the file, and what the message must say
RECORDINGS = {
    "empty": (b"", "empty"),
    "header only": (HEADER.encode(), "row"),
    "wrong column count": (broken(10, "0.1667,1,2"), r"12.*8.*3"),
    "text in numbers": (broken(10, "0.1667,0.1,up,0.3,0,0,0,1"), r"12.*up"),
    "infinite values": (broken(10, "0.1667,0.1,inf,0.3,0,0,0,1"), r"12.*inf"),
    "all NaN": ((HEADER + "".join(f"{i / 60},nan,0,0,0,0,0,1\n" for i in range(60))).encode(), ""),
    "zero quaternion": (broken(10, "0.1667,0.1,0.2,0.3,0,0,0,0"), r"12.*quaternion"),
    "time going back": (broken(10, "0.01,0.1,0.2,0.3,0,0,0,1"), r"12.*time"),
    "time repeated": (broken(10, "0.15,0.1,0.2,0.3,0,0,0,1"), r"12.*time"),
    "one sample": ((HEADER + ROW.format(t=0)).encode(), ""),
    "UTF-16": (GOOD.encode("utf-16"), "UTF-16"),
    "binary": (bytes(range(256)) * 4, ""),
    "prose": (b"Dear diary, today I moved a prop.\n", ""),
    "deep JSON": (b"[" * 100_000, ""),
    "JSON of another kind": (b'{"camera": 3}', ""),
}


def expect_one_line(code: int, err: str) -> str:
    assert code == 3, err
    lines = err.splitlines()
    assert len(lines) == 1, err
    assert lines[0].startswith("smd: ")
    assert "Traceback" not in err
    return lines[0]


@pytest.mark.parametrize("name", RECORDINGS)
@pytest.mark.parametrize("command", ["parse", "convert"])
def test_a_broken_recording_costs_one_line(run_smd, tmp_path, name, command):
    content, said = RECORDINGS[name]
    take = tmp_path / ("take.json" if "JSON" in name else "take.csv")
    take.write_bytes(content)
    output = tmp_path / "out.usda"
    code, out, err = run_smd(command, take, *(["-o", output] if command == "convert" else []))
    line = expect_one_line(code, err)
    assert take.name in line
    assert re.search(said, line, re.I), line
    assert out == ""
    assert sorted(tmp_path.iterdir()) == [take]


def test_a_missing_recording_is_named(run_smd, tmp_path):
    code, _, err = run_smd("parse", tmp_path / "nowhere.csv")
    assert "nowhere.csv" in expect_one_line(code, err)


def test_a_folder_without_recordings_is_named(run_smd, tmp_path):
    code, _, err = run_smd("parse", tmp_path)
    assert str(tmp_path) in expect_one_line(code, err)


@pytest.mark.parametrize("output", ["nowhere/out.usda", "out.docx", "out"])
def test_an_output_that_cannot_be_is_refused(run_smd, tmp_path, stories, output):
    code, _, err = run_smd("convert", stories / "duel.csv", "-o", tmp_path / output)
    assert "out" in expect_one_line(code, err)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(
    os.name == "nt" or (hasattr(os, "geteuid") and os.geteuid() == 0),
    reason="this user may write anywhere",
)
def test_a_folder_that_cannot_be_written_is_refused(run_smd, tmp_path, stories):
    tmp_path.chmod(0o500)
    code, _, err = run_smd("convert", stories / "duel.csv", "-o", tmp_path / "out.usda")
    tmp_path.chmod(0o700)
    assert "out.usda" in expect_one_line(code, err)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--up", "w"),
        ("--front", "forward"),
        ("--handedness", "both"),
        ("--unit", "parsec"),
        ("--quaternion", "wxzy"),
        ("--mount", "yaw=left"),
        ("--device", "nobody"),
        ("--figure-height", "-1"),
        ("--figure-height", "nan"),
        ("--library", "no-such-library"),
    ],
)
def test_an_option_that_makes_no_sense_is_refused(run_smd, stories, option, value):
    code, _, err = run_smd("parse", stories / "duel.csv", option, value)
    expect_one_line(code, err)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('"version": 2', '"version": 99'), "99"),
        (('"smd.score"', '"smd.tale"'), "smd.tale"),
        (('"start_s"', '"begin_s"'), "begin_s|start_s"),
        (("{", "["), ""),
    ],
)
def test_a_broken_score_is_named(run_smd, tmp_path, stories, change, said):
    text = (stories / "duel.score.json").read_text(encoding="utf-8").replace(*change, 1)
    score = tmp_path / "duel.score.json"
    score.write_text(text, encoding="utf-8")
    take = ["--recording", stories / "duel.csv"]
    code, _, err = run_smd("animate", score, *take, "-o", tmp_path / "out.usda")
    line = expect_one_line(code, err)
    assert re.search(said, line), line
    assert sorted(tmp_path.iterdir()) == [score]


def test_an_action_that_nobody_has_is_named_and_idled_through(run_smd, tmp_path, stories):
    text = (stories / "duel.score.json").read_text(encoding="utf-8")
    score = tmp_path / "duel.score.json"
    score.write_text(text.replace('"action": "', '"action": "moon', 1), encoding="utf-8")
    take = ["--recording", stories / "duel.csv"]
    code, out, _ = run_smd("animate", score, *take, "-o", tmp_path / "out.usda")
    assert code == 0
    assert re.search(
        r"device '\w+': 'moon\w+' at .*its character has no such action, and idles", out
    )


@pytest.mark.parametrize("picture", ["strip.jpg", "nowhere/strip.png"])
def test_a_picture_that_cannot_be_is_refused(run_smd, tmp_path, picture):
    code, _, err = run_smd("render", tmp_path / "any.usda", "-o", tmp_path / picture)
    assert "strip" in expect_one_line(code, err)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_thirty_minutes_of_stillness_is_no_error(run_smd, tmp_path):
    take, output = tmp_path / "still.csv", tmp_path / "still.usdc"
    rows = "".join(ROW.format(t=round(i / 60, 4)) for i in range(30 * 60 * 60))
    take.write_text(HEADER + rows, encoding="utf-8")
    code, out, err = run_smd("convert", take, "-o", output)
    assert (code, err) == (0, "")
    assert "0 phrases" in out
    assert output.stat().st_size > 0


def test_one_broken_recording_does_not_stop_the_others(run_smd, tmp_path):
    takes, output = tmp_path / "takes", tmp_path / "out"
    takes.mkdir()
    (takes / "a.csv").write_text(GOOD, encoding="utf-8")
    (takes / "b.csv").write_bytes(RECORDINGS["empty"][0])
    (takes / "c.csv").write_text(GOOD, encoding="utf-8")
    code, _, err = run_smd("convert", takes, "-o", output)
    assert code == 3
    assert "b.csv" in err
    assert sorted(path.name for path in output.iterdir()) == ["a.usdc", "c.usdc"]


def test_wrong_usage_is_exit_code_two(run_smd):
    assert run_smd("convert")[0] == 2
    assert run_smd("no-such-command")[0] == 2
