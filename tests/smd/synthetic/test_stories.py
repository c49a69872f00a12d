from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.doodle import Doodle
from smd.formats import read_recording
from smd.geometry.resampling import interpolate_linear, interpolate_rotation
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition.token_spotter import recognize
from smd.recognition.tokenizer import tokenize
from smd.score_file import read_score
from smd.smoothing import smooth
from smd.synthetic.efforts import ACTIONS
from smd.synthetic.stories import STORIES, main

RECORDINGS = Path(__file__).parents[3] / "recordings"
PATTERNS = {a.name: a.pattern for a in HUMANOID_ACTIONS if a.name in ACTIONS}


def turned(doodle):
    quarter = quaternion_about([0.0, 1.0, 0.0], np.pi / 2.0)
    return Doodle(
        doodle.time_s,
        rotate(quarter, doodle.position_m),
        multiply(quarter, doodle.orientation_xyzw),
        doodle.device,
    )


def scaled(doodle, factor):
    return Doodle(doodle.time_s, factor * doodle.position_m, doodle.orientation_xyzw, doodle.device)


def resampled(doodle, rate_hz):
    at_s = np.arange(doodle.time_s[0], doodle.time_s[-1], 1.0 / rate_hz)
    return Doodle(
        at_s,
        interpolate_linear(doodle.time_s, doodle.position_m, at_s),
        interpolate_rotation(doodle.time_s, doodle.orientation_xyzw, at_s),
        doodle.device,
    )


CHANGES = {
    "as it is": lambda doodle: doodle,
    "turned by 90 degrees": turned,
    "half as large": lambda doodle: scaled(doodle, 0.5),
    "twice as large": lambda doodle: scaled(doodle, 2.0),
    "at 90 Hz": lambda doodle: resampled(doodle, 90.0),
}


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", STORIES)
def test_a_story_is_understood(name, change):
    recording = read_recording(RECORDINGS / f"{name}.csv")
    score = read_score(RECORDINGS / f"{name}.score.json")
    assert recording.devices == tuple(part.device for part in score.performers)
    for doodle, part in zip(recording.doodles, score.performers, strict=True):
        spans = recognize(tokenize(smooth(CHANGES[change](doodle))), PATTERNS)
        assert [span.action for span in spans] == [phrase.action for phrase in part.phrases]
        for span, phrase in zip(spans, part.phrases, strict=True):
            assert abs(span.start_s - phrase.start_s) <= 0.15, phrase
            assert abs(span.end_s - phrase.end_s) <= 0.15, phrase


def test_the_shipped_files_are_what_the_stories_make(tmp_path, capsys):
    assert main([str(tmp_path)]) == 0
    assert capsys.readouterr().out.count(" s\n") == len(STORIES)
    for name in STORIES:
        score = f"{name}.score.json"
        assert (tmp_path / score).read_bytes() == (RECORDINGS / score).read_bytes()
        made, shipped = (read_recording(f / f"{name}.csv") for f in (tmp_path, RECORDINGS))
        for a, b in zip(made.doodles, shipped.doodles, strict=True):
            assert np.array_equal(a.time_s, b.time_s)
            # sines differ between machines in their last digits
            assert a.position_m == pytest.approx(b.position_m, abs=1.1e-5)
            assert a.orientation_xyzw == pytest.approx(b.orientation_xyzw, abs=1e-9)


def test_every_action_is_played():
    played = {
        phrase.action
        for make in STORIES.values()
        for part in make().score.performers
        for phrase in part.phrases
    }
    assert played == set(PATTERNS)


def test_stories_are_short_and_stay_on_the_table():
    for make in STORIES.values():
        for doodle in make().recording.doodles:
            assert 12.0 < doodle.duration_s < 25.0
            assert np.abs(doodle.position_m[:, [0, 2]]).max() < 0.6


def test_the_duellists_never_stand_in_one_place():
    knight, rival = STORIES["duel"]().recording.doodles
    at_s = np.arange(0.0, min(knight.time_s[-1], rival.time_s[-1]), 0.01)
    apart = interpolate_linear(knight.time_s, knight.position_m, at_s) - interpolate_linear(
        rival.time_s, rival.position_m, at_s
    )
    assert np.linalg.norm(apart, axis=1).min() > 0.12


def test_a_folder_that_is_not_there_is_an_error_of_one_line(tmp_path, capsys):
    assert main([str(tmp_path / "nowhere")]) == 3
    assert capsys.readouterr().err.count("\n") == 1
    assert main([]) == 2
