"""Where little is recognised, the next step is on the screen, and works."""

from __future__ import annotations

import json

import pytest


def test_what_was_not_recognised_is_printed_in_a_line_each(run_smd, stories):
    code, out, err = run_smd("parse", stories / "postman.csv", "--tolerance", "0.3")
    assert (code, err) == (0, "")
    lines = [line for line in out.splitlines() if "?" in line]
    assert lines
    assert all(" – " in line and "confidence" not in line for line in lines)


def test_explain_prints_no_empty_heading(run_smd, stories):
    for tolerance in ("0.05", "0.3", "1.0"):
        _, out, _ = run_smd("parse", stories / "duel.csv", "--explain", "--tolerance", tolerance)
        lines = out.splitlines()
        for line, following in zip(lines, [*lines[1:], ""], strict=True):
            if "weighed by, small" in line or "left unexplained" in line:
                assert following.startswith("    "), line


def test_explain_says_what_kept_each_action_out(run_smd, stories):
    _, out, _ = run_smd("parse", stories / "duel.csv", "--explain", "--tolerance", "0.3")
    explained = out[out.index("left unexplained") :].splitlines()[1:]
    assert any(line.split()[0] == "punch" and float(line.split()[1]) > 1.0 for line in explained)


def test_a_suggestion_is_performed_once_its_line_is_moved(run_smd, stories, tmp_path):
    score = tmp_path / "s.score.json"
    run_smd("parse", stories / "postman.csv", "-o", score, "--tolerance", "0.3")
    whole = json.loads(score.read_text(encoding="utf-8"))
    (part,) = whole["performers"]
    moved = part["suggestions"].pop()
    part["phrases"].append(moved)
    score.write_text(json.dumps(whole), encoding="utf-8")
    code, out, err = run_smd("animate", score, "-o", tmp_path / "out.usdc")
    assert (code, err) == (0, "")
    assert f"{len(part['phrases'])} phrase" in out
    part["suggestions"].append(moved)
    score.write_text(json.dumps(whole), encoding="utf-8")
    code, _, err = run_smd("animate", score, "-o", tmp_path / "out.usdc")
    assert code == 3
    assert "suggestions[" in err and err.count("\n") == 1


@pytest.fixture
def still(tmp_path):
    path = tmp_path / "still.csv"
    rows = "".join(f"{i / 60:.4f},0,1,0,0,0,0,1\n" for i in range(300))
    path.write_text("time_s,x,y,z,qx,qy,qz,qw\n" + rows, encoding="utf-8")
    return path


def test_a_recording_of_stillness_has_no_suggestion_and_no_heading(run_smd, still):
    code, out, err = run_smd("parse", still, "--explain")
    assert (code, err) == (0, "")
    assert "?" not in out
    assert "nothing in it is like an action" in out
