"""What others recorded with controllers, played as a new user would."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from smd.formats import read_recording
from smd.score_file import read_score

FRAMES = 450
"""Six of sixteen seconds: hands grab things from the first one on."""


def beginning_of(path: Path) -> str:
    """The text of a recording's first frames."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".csv":
        return "".join(text.splitlines(keepends=True)[: 1 + FRAMES])
    whole = json.loads(text)
    for device in whole.values():
        device["poses"] = device["poses"][:FRAMES]
    return json.dumps(whole)


@pytest.mark.parametrize("name", ["raw/grabLeft.json", "grabRight_right.csv"])
def test_hands_that_grab_are_played_from_their_recording(run_smd, shared_data, tmp_path, name):
    whole = shared_data / "controllers" / "aframe" / name
    source = tmp_path / whole.name
    source.write_text(beginning_of(whole), encoding="utf-8")
    code, _, err = run_smd("play", "-o", tmp_path / "stories", "--source", f"replay:{source}")
    assert (code, err) == (0, "")
    recording = read_recording(tmp_path / "stories" / "story-001.csv")
    score = read_score(tmp_path / "stories" / "story-001.score.json")
    assert {part.device for part in score.performers} == set(recording.devices)
    assert (tmp_path / "stories" / "story-001.usdc").is_file()
    played = read_recording(source)
    for device in recording.devices:
        (mine,), theirs = recording.of(device), played.of(device)[0]
        assert len(mine) == len(theirs)
        assert abs(mine.position_m - theirs.position_m).max() < 1e-6
