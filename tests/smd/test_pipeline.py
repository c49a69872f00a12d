"""Shipped stories are parsed to the Scores that stand beside them, however they were recorded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import smd
from smd.doodle import DEFAULT_FIGURE_HEIGHT_M, Doodle
from smd.errors import ScoreError
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition.reasons import FITS
from smd.score_file import score_from_json, score_to_json

RECORDINGS = Path(__file__).parents[2] / "recordings"
STORIES = sorted(path.stem for path in RECORDINGS.glob("*.csv"))
QUARTER_TURN = quaternion_about([0.0, 1.0, 0.0], np.pi / 2)


def turned(doodle: Doodle) -> Doodle:
    return replace(
        doodle,
        position_m=rotate(QUARTER_TURN, doodle.position_m),
        orientation_xyzw=multiply(QUARTER_TURN, doodle.orientation_xyzw),
    )


def at_90_hz(doodle: Doodle) -> Doodle:
    time_s = np.arange(doodle.time_s[0], doodle.time_s[-1], 1.0 / 90.0)
    return Doodle(
        time_s,
        interpolate_linear(doodle.time_s, doodle.position_m, time_s),
        interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, time_s),
        doodle.device,
    )


CHANGES = {
    "as it is": lambda doodle: doodle,
    "turned by 90 degrees": turned,
    "half as large": lambda doodle: replace(doodle, position_m=0.5 * doodle.position_m),
    "twice as large": lambda doodle: replace(doodle, position_m=2.0 * doodle.position_m),
    "at 90 Hz": at_90_hz,
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("story", STORIES)
def test_a_story_is_parsed_to_its_score(story, change):
    recording = smd.read_recording(RECORDINGS / f"{story}.csv")
    recording = replace(recording, doodles=tuple(CHANGES[change](d) for d in recording.doodles))
    # What is drawn so large by chance is rejected: who plays with a larger figure says so.
    height_m = DEFAULT_FIGURE_HEIGHT_M * (2.0 if change == "twice as large" else 1.0)
    found = smd.parse(recording, smd.load_library(), figure_height_m=height_m)
    meant = smd.read_score(RECORDINGS / f"{story}.score.json")
    for ours, theirs in zip(found.performers, meant.performers, strict=True):
        assert ours.device == theirs.device
        assert [p.action for p in ours.phrases] == [p.action for p in theirs.phrases]
        for our, their in zip(ours.phrases, theirs.phrases, strict=True):
            assert our.start_s == pytest.approx(their.start_s, abs=0.15), their
            assert our.end_s == pytest.approx(their.end_s, abs=0.15), their


def test_headsets_do_not_perform_unless_asked_for():
    recording = smd.read_recording(RECORDINGS / "duel.csv")
    first, second = recording.doodles
    recording = replace(recording, doodles=(first, replace(second, device="Headset")))
    library = smd.load_library()
    assert [part.device for part in smd.parse(recording, library).performers] == [first.device]
    asked = smd.parse(recording, library, devices=["Headset"])
    assert [part.device for part in asked.performers] == ["Headset"]


def test_tolerance_says_how_much_is_rejected():
    recording = smd.read_recording(RECORDINGS / "postman.csv")
    library = smd.load_library()
    counts = [
        len(smd.parse(recording, library, tolerance=tolerance).performers[0].phrases)
        for tolerance in (0.05, 1.0)
    ]
    assert counts == [0, 7]


def test_an_unknown_device_is_refused_by_name():
    recording = smd.read_recording(RECORDINGS / "duel.csv")
    with pytest.raises(ScoreError, match=r"knight, rival.*'nobody'"):
        smd.parse(recording, smd.load_library(), devices=["nobody"])


def test_a_doodle_too_short_to_smooth_is_left_out_with_a_warning():
    recording = smd.read_recording(RECORDINGS / "postman.csv")
    (whole,) = recording.doodles
    glimpse = Doodle(
        whole.time_s[-1] + [1.0, 1.01], whole.position_m[:2], whole.orientation_xyzw[:2], "postman"
    )
    score = smd.parse(replace(recording, doodles=(whole, glimpse)), smd.load_library())
    assert len(score.performers[0].phrases) == 7
    assert any("left out" in line for line in score.warnings)


def test_what_is_not_recognised_is_suggested_outside_of_phrases():
    recording = smd.read_recording(RECORDINGS / "postman.csv")
    library = smd.load_library()
    whole = smd.parse(recording, library)
    assert whole.suggestions == ()
    few = smd.parse(recording, library, tolerance=0.45)
    (part,) = few.performers
    assert 0 < len(part.phrases) < 7
    known = {phrase.action for phrase in part.phrases}
    missing = [phrase for phrase in whole.performers[0].phrases if phrase.action not in known]
    for phrase in missing:
        (one,) = [s for s in part.suggestions if abs(s.start_s - phrase.start_s) < 0.2]
        assert one.action == phrase.action
        best = one.likeliest[0]
        assert best.distance > best.most or best.reason == FITS  # weighed by itself
    source = score_from_json(smd.animate(few, recording, library).source["score"])
    assert source.suggestions == score_from_json(score_to_json(few)).suggestions


def test_a_library_without_examples_is_said_to_be_one():
    recording = smd.read_recording(RECORDINGS / "postman.csv")
    library = smd.load_library()
    plain = replace(
        library,
        actions=tuple(replace(action, exemplar=None) for action in library.actions),
        exemplar_files={},
    )
    score = smd.parse(recording, plain)
    assert score.performers[0].phrases
    assert any("no action has examples" in line for line in score.warnings)
    assert not any("examples" in line for line in smd.parse(recording, library).warnings)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan"), float("inf")])
def test_a_tolerance_is_positive(tolerance):
    with pytest.raises(ScoreError, match="tolerance: expected a positive number, got"):
        smd.Parser(smd.load_library(), tolerance=tolerance)


def test_one_device_is_named_in_a_list_too():
    with pytest.raises(ScoreError, match="devices: expected a list of names, got 'left' alone"):
        smd.Parser(smd.load_library(), devices="left")
