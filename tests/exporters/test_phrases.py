from __future__ import annotations

import csv

import pytest
from pxr import Usd

from exporters.figures import read_scene
from exporters.phrases import PHRASES_KEY, phrases_of, write_phrase_table
from exporters.usd import write_usd
from smd.errors import ExportError


def test_each_character_names_its_phrases_in_seconds_and_time_codes(performance, tmp_path):
    write_usd(performance, tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    prim = stage.GetPrimAtPath("/Performance/Actors/left_hand_character")
    named = prim.GetCustomDataByKey(PHRASES_KEY)
    assert list(named) == ["p0000", "p0001"]
    walk, punch = named["p0000"], named["p0001"]
    assert walk["action"] == "walk"
    # The recording begins at 10 s, at 24 frames a second.
    assert (walk["start_s"], walk["end_s"]) == pytest.approx((10.2, 10.9))
    assert (walk["start"], walk["end"]) == pytest.approx((4.8, 21.6))
    assert walk["effort"] == {"time": 0.5, "weight": -0.25}
    assert punch["confidence"] == 0.75


def test_the_table_has_a_row_a_phrase(performance, tmp_path):
    write_phrase_table(performance, tmp_path / "a.csv")
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["device"], row["action"]) for row in rows] == [
        ("left hand", "walk"),
        ("left hand", "punch"),
        ("right-hand", "walk"),
        ("right-hand", "punch"),
    ]
    assert (rows[0]["start_frame"], rows[0]["end_frame"]) == ("5", "22")
    assert (rows[0]["time"], rows[0]["weight"], rows[0]["space"]) == ("0.500", "-0.250", "")


def test_phrases_are_read_back_as_they_were_written(performance, tmp_path):
    write_usd(performance, tmp_path / "a.usdc")
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    prims = stage.GetPrimAtPath("/Performance/Actors").GetChildren()
    assert [phrases_of(prim) for prim in prims] == [a.phrases for a in performance.actors]


@pytest.mark.parametrize(
    "entries",
    [
        {"p0000": 3},
        {"p0000": {"action": "walk"}},
        {"p0000": {"action": "walk", "start_s": 2.0, "end_s": 1.0, "confidence": 1.0}},
        {"p0000": {"action": "walk", "start_s": "x", "end_s": 1.0, "confidence": 1.0}},
        {
            "p0000": {
                "action": "walk",
                "start_s": 0.0,
                "end_s": 1.0,
                "confidence": 1.0,
                "effort": {"mood": 1.0},
            }
        },
    ],
)
def test_phrases_of_somebody_else_are_one_line_that_names_file_and_prim(
    performance, entries, tmp_path
):
    path = tmp_path / "a.usdc"
    write_usd(performance, path)
    stage = Usd.Stage.Open(str(path))
    prim = stage.GetPrimAtPath("/Performance/Actors").GetChildren()[0]
    prim.SetCustomDataByKey(PHRASES_KEY, entries)
    stage.GetRootLayer().Save()
    prim_path = "/Performance/Actors/left_hand_character"
    with pytest.raises(ExportError, match=rf"a\.usdc: {prim_path}: smd:phrases"):
        read_scene(path)
