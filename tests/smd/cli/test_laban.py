from __future__ import annotations

import json
from typing import get_type_hints

import pytest

from laban import AXES, load_effort_model
from smd.doodle import Recording
from smd.formats import write_recording
from smd.synthetic.efforts import labelled_takes


@pytest.fixture(scope="module")
def takes(tmp_path_factory):
    """A folder of 24 simulated takes with a manifest that labels their Time."""
    folder = tmp_path_factory.mktemp("takes")
    words = {-1.0: "sustained", 0.0: "neutral", 1.0: "sudden"}
    lines = ["file,time,weight,space,flow,performer"]
    played = [t for t in labelled_takes(people=4, repeats=2, seed=5) if t.effort.weight == 0]
    for i, take in enumerate(played):
        write_recording(Recording((take.doodle,)), folder / f"take{i:02d}.csv")
        lines.append(f"take{i:02d}.csv,{words[take.effort.time]},,,,{take.player}")
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def test_classify_prints_a_line_per_doodle(run_smd, takes):
    code, out, err = run_smd("laban", "classify", takes / "take00.csv", takes / "take01.csv")
    assert (code, err) == (0, "")
    assert len(out.splitlines()) == 2
    assert "time " in out
    assert "weight " in out
    assert "flow " in out
    assert " and " in out  # the joint state


def test_classify_prints_json_and_nothing_else(run_smd, takes):
    code, out, _ = run_smd("laban", "classify", takes / "take00.csv", "--json")
    (row,) = json.loads(out)
    assert code == 0
    assert set(row) == {"file", "device", "start_s", "end_s", "effort", "confidence", "state"}
    assert set(row["effort"]) == set(row["confidence"]) == {"time", "weight", "space", "flow"}
    assert all(-1.0 <= value <= 1.0 for value in row["effort"].values())
    for axis, value in row["effort"].items():
        assert row["confidence"][axis] == pytest.approx(0.5 + 0.5 * abs(value), abs=1e-3)
    assert set(row["state"]) == {"time", "weight", "confidence"}


def test_a_performers_other_takes_are_read_against(run_smd, takes):
    others = [word for i in range(6) for word in ("--performer", takes / f"take{i:02d}.csv")]
    alone, own = (
        json.loads(run_smd("laban", "classify", takes / "take00.csv", "--json", *more)[1])
        for more in ([], others)
    )
    assert alone[0]["effort"] != own[0]["effort"]
    code, _, err = run_smd(
        "laban", "classify", takes / "take00.csv", "--performer", takes / "take01.csv"
    )
    assert (code, "expected at least 3 takes that move, got 1" in err) == (3, True)


def test_a_trained_model_classifies(run_smd, takes, tmp_path):
    model = tmp_path / "mine.json"
    code, out, err = run_smd("laban", "train", takes / "manifest.csv", "-o", model)
    assert (code, err) == (0, "")
    assert out.startswith("time: ")
    assert "each judged without its performer" in out
    assert f"written: {model}" in out
    assert tuple(load_effort_model(model).axes) == ("time",)
    _, out, _ = run_smd("laban", "classify", takes / "take00.csv", "--model", model, "--json")
    assert set(json.loads(out)[0]["effort"]) == {"time"}


@pytest.mark.parametrize("arguments", [[], ["--simulated", "manifest.csv"]])
def test_train_wants_either_a_manifest_or_simulated_people(run_smd, arguments, tmp_path):
    code, _, err = run_smd("laban", "train", *arguments, "-o", tmp_path / "m.json")
    assert code == 2
    assert "MANIFEST or --simulated" in " ".join(err.replace("│", " ").split())


def test_bad_input_costs_one_line_and_leaves_nothing_behind(run_smd, takes, tmp_path):
    for arguments, said in (
        (["train", tmp_path / "absent.csv", "-o", tmp_path / "m.json"], "absent.csv"),
        (["train", takes / "take00.csv", "-o", tmp_path / "m.json"], "expected the columns file"),
        (["train", "--simulated", "-o", tmp_path / "no" / "m.json"], "existing folder"),
        (["classify", takes / "take00.csv", "--model", takes / "take00.csv"], "expected JSON"),
        (["classify", tmp_path / "absent.csv"], "absent.csv"),
    ):
        code, _, err = run_smd("laban", *arguments)
        assert code == 3
        assert err.startswith("smd: ")
        assert said in err
        assert len(err.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_the_help_of_train_names_the_columns_of_a_manifest():
    from smd.cli.laban import train

    manifest = get_type_hints(train, include_extras=True)["manifest"]
    assert f"file,{','.join(AXES)},performer" in manifest.__metadata__[0].help
