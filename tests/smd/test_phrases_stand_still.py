"""A phrase's Effort stands still: whatever else is in the take, and while it is played."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import AXES, load_effort_model
from smd.capture.live import LiveRecognition
from smd.doodle import Recording
from smd.formats import read_recording
from smd.pipeline import parse
from smd.recognition import Recognizer

RECORDINGS = Path(__file__).parents[2] / "recordings"
STORIES = ("duel", "fledgling", "postman")
MOST_CHANGE = 0.2


@pytest.fixture(scope="module")
def library():
    return load_library()


@pytest.fixture(scope="module", params=STORIES)
def told(request, library):
    """A story, and its phrases by device."""
    recording = read_recording(RECORDINGS / f"{request.param}.csv")
    return recording, phrases_of(recording, library)


def phrases_of(recording, library):
    return {part.device: part.phrases for part in parse(recording, library).performers}


def values(effort):
    return np.array([getattr(effort, axis) for axis in AXES], dtype=np.float64)


def cut(recording, kept_s):
    """Return what each device drew between two times of its own."""
    doodles = []
    for doodle in recording.doodles:
        start_s, end_s = kept_s[doodle.device]
        kept = (doodle.time_s >= start_s) & (doodle.time_s <= end_s)
        doodles.append(
            replace(
                doodle,
                time_s=doodle.time_s[kept],
                position_m=doodle.position_m[kept],
                orientation_xyzw=doodle.orientation_xyzw[kept],
                drawing=None if doodle.drawing is None else doodle.drawing[kept],
            )
        )
    return Recording(tuple(doodles))


def same(phrases, phrase):
    """Return the phrase that is the same one in another reading of the story, or None."""
    middle_s = 0.5 * (phrase.start_s + phrase.end_s)
    found = [p for p in phrases if p.start_s < middle_s < p.end_s and p.action == phrase.action]
    return found[0] if found else None


@pytest.mark.parametrize("share", [0.3, 0.6])
def test_cutting_other_phrases_away_moves_a_reading_little(share, told, library):
    """Each performer's part is cut in a pause; both sides are read alone."""
    recording, whole = told
    pauses = {}
    for device, phrases in whole.items():
        i = round(share * len(phrases))
        pauses[device] = 0.5 * (phrases[i - 1].end_s + phrases[i].start_s)
    compared = 0
    for first in (True, False):
        kept_s = {d: (-np.inf, s) if first else (s, np.inf) for d, s in pauses.items()}
        part = phrases_of(cut(recording, kept_s), library)
        for device, phrases in whole.items():
            for phrase in phrases:
                again = same(part[device], phrase)
                if again is None:
                    continue
                compared += 1
                change = np.abs(values(again.effort) - values(phrase.effort)).max()
                assert change <= MOST_CHANGE, (device, phrase.action, phrase.start_s)
    assert compared == sum(map(len, whole.values()))


def test_what_is_printed_while_playing_is_what_is_read_in_the_end(told, library):
    recording, whole = told
    live = LiveRecognition(
        Recognizer(library), load_effort_model(), {device: device for device in whole}
    )
    decided = []
    frames = sorted(
        (float(time_s), doodle.device, tuple(map(float, pose)), drawing)
        for doodle in recording.doodles
        for time_s, pose, drawing in zip(
            doodle.time_s,
            np.concatenate([doodle.position_m, doodle.orientation_xyzw], axis=1),
            [None] * len(doodle.time_s) if doodle.drawing is None else doodle.drawing.tolist(),
            strict=True,
        )
    )
    for time_s, device, pose, drawing in frames:
        decided += live.push(time_s, {device: (pose, drawing)})
    decided += live.finish()
    compared = 0
    for device, span, effort in decided:
        phrase = same(whole[device], span)
        if phrase is None:
            continue
        compared += 1
        change = np.abs(values(phrase.effort) - values(effort)).max()
        assert change <= MOST_CHANGE, (device, span.action, span.start_s)
    assert compared >= 0.9 * sum(map(len, whole.values()))
