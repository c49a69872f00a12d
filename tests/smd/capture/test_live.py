"""What is recognised while playing is what the streaming recogniser says of each device."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import load_effort_model, read_effort
from smd.capture.live import LiveRecognition
from smd.capture.replay import ReplaySource
from smd.capture.take import rows_of
from smd.formats import Mount, write_recording
from smd.recognition import Recognizer
from smd.recognition.acceptance import Intent
from smd.smoothing import smooth
from tests.smd.capture.conftest import played


@pytest.fixture(scope="module")
def recognizer():
    return Recognizer(load_library())


def heard(live: LiveRecognition, frames):
    decided = []
    for time_s, rows in frames:
        decided += live.push(time_s, rows)
    return decided + live.finish()


def frames_of(doodle, serial="LHR-1"):
    for time_s, position, orientation in zip(
        doodle.time_s.tolist(),
        doodle.position_m.tolist(),
        doodle.orientation_xyzw.tolist(),
        strict=True,
    ):
        yield time_s, {serial: ((*position, *orientation), True)}


def test_phrases_are_the_streams_each_with_its_effort(recognizer):
    doodle = played("punch", "bow")
    decided = heard(
        LiveRecognition(recognizer, load_effort_model(), {"LHR-1": "left"}), frames_of(doodle)
    )
    stream = recognizer.stream(intent=Intent.DRAWN)
    expected = [
        span for time_s, rows in frames_of(doodle) for span in stream.push(time_s, *split(rows))
    ]
    expected += stream.finish()
    assert [each.detection for each in decided] == expected
    assert [each.detection.action for each in decided] == ["punch", "bow"]
    motion = smooth(doodle)
    for each in decided:
        assert each.device == "left"
        part = motion.between(each.detection.start_s, each.detection.end_s)
        alone = read_effort(part, load_effort_model())
        assert each.effort.time == pytest.approx(alone.time, abs=1e-6)


def split(rows):
    pose, drawing = rows["LHR-1"]
    return pose[:3], pose[3:], drawing


def test_a_mounted_tracker_is_heard_as_the_prop(recognizer):
    doodle = played("punch")
    mount = Mount(yaw_deg=180.0)
    turned = [
        (t, {"LHR-1": ((*pose[:3], -pose[5], pose[6], pose[3], -pose[4]), drawing)})  # about Y
        for t, rows in frames_of(doodle)
        for pose, drawing in rows.values()
    ]
    live = LiveRecognition(recognizer, load_effort_model(), {"LHR-1": "left"}, mount)
    assert [each.detection.action for each in heard(live, turned)] == ["punch"]


def test_after_a_long_loss_a_doodle_begins_anew(recognizer):
    doodle = played("punch")
    frames = list(frames_of(doodle))
    later = [(t + doodle.time_s[-1] + 1.0, rows) for t, rows in frames]
    between = [(doodle.time_s[-1] + 0.5, {"LHR-1": (None, True)})]
    live = LiveRecognition(recognizer, load_effort_model(), {"LHR-1": "left"})
    decided = heard(live, [*frames, *between, *later])
    assert [each.detection.action for each in decided] == ["punch", "punch"]


def test_what_a_frame_does_not_say_is_not_made_up(tmp_path):
    from smd.doodle import Recording

    doodle = played("punch")
    write_recording(Recording((doodle,)), tmp_path / "take.csv")
    frame = next(ReplaySource([tmp_path / "take.csv"]).poses())
    assert rows_of(frame, ["absent"], hold_to_draw=True) == {}
    (row,) = rows_of(frame, [doodle.device], hold_to_draw=True).values()
    np.testing.assert_allclose(row[0][:3], doodle.position_m[0])


def test_a_bad_sample_is_passed_over(recognizer):
    frames = list(frames_of(played("punch")))
    bad = [(frames[50][0] + 1e-3, {"LHR-1": ((0.0,) * 7, True)})]  # no rotation
    live = LiveRecognition(recognizer, load_effort_model(), {"LHR-1": "left"})
    assert [each.detection.action for each in heard(live, frames[:51] + bad + frames[51:])] == [
        "punch"
    ]
