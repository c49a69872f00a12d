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


def typed_advice(out: str) -> list[str]:
    """Return the options that a command says to try, as they are to be typed."""
    (line,) = [line for line in out.splitlines() if line.startswith("  try --")]
    return line.removeprefix("  try ").partition(":")[0].split()


@pytest.mark.parametrize(
    "mistake", [["--mount", "yaw=180"], ["--mount", "roll=180"], ["--unit", "mm"], ["--up", "-y"]]
)
def test_a_story_read_wrongly_is_mended_by_what_is_printed(run_smd, stories, mistake):
    take = stories / "fledgling.csv"
    _, right, _ = run_smd("parse", take)
    code, out, err = run_smd("parse", take, *mistake)
    assert (code, err) == (0, "")
    advice = typed_advice(out)
    assert "8 phrases would be recognised" in out
    said = dict(zip(mistake[::2], mistake[1::2], strict=True))
    said |= dict(zip(advice[::2], advice[1::2], strict=True))
    _, mended, _ = run_smd("parse", take, *(part for pair in said.items() for part in pair))
    assert mended == right


def test_convert_says_the_same_and_json_stays_json(run_smd, stories, tmp_path):
    take = stories / "fledgling.csv"
    _, out, _ = run_smd("convert", take, "-o", tmp_path / "out.usdc", "--mount", "roll=180")
    assert typed_advice(out) == ["--mount", "yaw=0"]
    _, out, _ = run_smd("parse", take, "--mount", "roll=180", "--json")
    assert json.loads(out)["performers"]


@pytest.fixture
def one_way(tmp_path):
    """A prop that goes to its left for a metre and rests."""
    path = tmp_path / "one_way.csv"
    at_m = [min(i, 120) / 120 for i in range(180)]
    rows = "".join(f"{i / 60:.4f},{x:.4f},1,0,0,0,0,1\n" for i, x in enumerate(at_m))
    path.write_text("time_s,x,y,z,qx,qy,qz,qw\n" + rows, encoding="utf-8")
    return path


def test_where_no_reading_helps_other_ways_on_are_named(run_smd, one_way):
    code, out, err = run_smd("parse", one_way, "--tolerance", "0.05")
    assert (code, err) == (0, "")
    assert "nothing recognised" in out
    for word in ("smd rehearse", "smd teach", "--unexplained follow"):
        assert word in out


def test_following_is_printed_as_implied_and_not_proposed_again(run_smd, one_way, tmp_path):
    how = ["--tolerance", "0.05", "--unexplained", "follow"]
    code, out, err = run_smd("parse", one_way, *how)
    assert (code, err) == (0, "")
    assert "0 phrases, 1 implied" in out
    assert "--unexplained" not in out
    (line,) = [line for line in out.splitlines() if line.endswith("implied")][1:]
    assert "side_step_left" in line or "run" in line
    code, out, err = run_smd("convert", one_way, "-o", tmp_path / "out.usdc", *how)
    assert (code, err) == (0, "")
    assert "1 implied" in out
