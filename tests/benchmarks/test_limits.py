"""The form with limits is kept as it was."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library
from benchmarks.limits import LimitRecognizer, limits
from smd.formats import read_recording
from smd.score_file import read_score
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

RECORDINGS = Path(__file__).parents[2] / "recordings"


@pytest.fixture(scope="module")
def recognizer():
    return LimitRecognizer(load_library().actions)


@pytest.mark.parametrize("story", sorted(path.stem for path in RECORDINGS.glob("*.csv")))
def test_it_reads_the_shipped_stories(recognizer, story):
    recording = read_recording(RECORDINGS / f"{story}.csv")
    for part in read_score(RECORDINGS / f"{story}.score.json").performers:
        found = [span for doodle in recording.of(part.device) for span in recognizer.spot(doodle)]
        assert [span.action for span in found] == [phrase.action for phrase in part.phrases]
        for span, phrase in zip(found, part.phrases, strict=True):
            assert span.start_s == pytest.approx(phrase.start_s, abs=0.15)
            assert span.end_s == pytest.approx(phrase.end_s, abs=0.15)


def test_tolerance_moves_every_limit(recognizer):
    actions = load_library().actions
    half = LimitRecognizer(actions, tolerance=0.5)
    np.testing.assert_allclose(half.limit, 0.5 * recognizer.limit)
    rng = np.random.default_rng(4)
    take = Take(simulated_person(rng), rng).pause(0.6).play("wave").pause(0.6).doodle()
    assert [span.action for span in recognizer.spot(take)] == ["wave"]
    assert LimitRecognizer(actions, tolerance=0.01).spot(take) == []


def test_limits_are_wider_where_examples_are_less_alike():
    exemplars = [one.exemplar for one in load_library().actions if one.exemplar]
    apart = max(exemplars, key=lambda one: float((one.apart / one.scale).sum()))
    alike = min(exemplars, key=lambda one: float((one.apart / one.scale).sum()))
    first, second = limits([apart, alike])
    assert first > second > 0.0
