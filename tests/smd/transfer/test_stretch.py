"""Stretch: a take is longer by a factor and otherwise the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from laban import Effort
from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.score import Part, Phrase, Score
from smd.transfer.stretch import AUTO, FACTORS, LEAST, MOST, factors, stretched


def take(start_s: float = 3.0) -> tuple[Score, Recording]:
    """Two devices, one of which begins later and is lost for a while."""
    time_s = start_s + np.arange(241) / 60.0
    place = np.stack([0.1 * time_s, 0.0 * time_s, np.sin(time_s)], axis=-1)
    q = np.tile([0.0, 0.0, 0.0, 1.0], (241, 1))
    pieces = [
        Doodle(time_s[rows], place[rows], q[rows], device)
        for device, rows in (
            ("fox", slice(0, 241)),
            ("owl", slice(30, 90)),
            ("owl", slice(120, 241)),
        )
    ]
    fox = Part("fox", (Phrase("walk", start_s, start_s + 1.5, Effort(time=0.5)),))
    owl = Part("owl", (Phrase("punch", start_s + 2.0, start_s + 3.25),))
    return Score((fox, owl), warnings=("said before",)), Recording(tuple(pieces), source="two")


@pytest.mark.parametrize("stretch", [1, 1.0, "1", "0.1", 20, "2.5", 1e1])
def test_a_number_is_tried_alone(stretch):
    assert factors(stretch) == (float(stretch),)


def test_auto_begins_with_the_recording_s_time_and_grows():
    tried = factors(AUTO)
    assert tried == FACTORS
    assert tried[0] == 1.0
    assert (np.diff(tried) > 0.0).all()
    assert tried[0] >= LEAST and tried[-1] <= MOST


@pytest.mark.parametrize(
    "stretch",
    ["x", "", "AUTO", "1,5", "nan", float("nan"), "inf", 0, 0.0, -1, "-2", 0.09, 20.1, None, [1]],
)
def test_what_is_no_factor_is_refused_in_a_line(stretch):
    with pytest.raises(
        TransferError, match=r"stretch: expected 'auto' or a number from 0\.1"
    ) as no:
        factors(stretch)
    assert "\n" not in str(no.value)
    assert repr(stretch) in str(no.value)


def test_a_factor_of_one_changes_nothing():
    score, recording = take()
    assert stretched(score, recording, 1.0) == (score, recording)


@given(st.floats(LEAST, MOST), st.floats(-100.0, 1000.0))
def test_it_begins_when_it_did_and_lasts_as_much_longer(factor, start_s):
    score, recording = take(start_s)
    slow_score, slow = stretched(score, recording, factor)
    first_s, last_s = start_s, start_s + 4.0
    assert slow.doodles[0].time_s[0] == first_s
    assert slow.doodles[0].time_s[-1] == pytest.approx(first_s + factor * (last_s - first_s))
    for one, other in zip(recording.doodles, slow.doodles, strict=True):
        assert other.time_s - start_s == pytest.approx(factor * (one.time_s - start_s), abs=1e-9)
        assert (other.position_m == one.position_m).all()
        assert (other.orientation_xyzw == one.orientation_xyzw).all()
        assert other.device == one.device
    for one, other in zip(score.performers, slow_score.performers, strict=True):
        for was, now in zip(one.phrases, other.phrases, strict=True):
            assert (now.action, now.effort) == (was.action, was.effort)
            assert now.start_s - start_s == pytest.approx(factor * (was.start_s - start_s))
            assert now.end_s - start_s == pytest.approx(factor * (was.end_s - start_s))
    assert slow_score.warnings == score.warnings


@pytest.mark.parametrize("factor", [0.25, 1.3, 8.0])
def test_there_and_back_again_gives_the_take_that_was(factor):
    score, recording = take()
    there = stretched(score, recording, factor)
    back_score, back = stretched(*there, 1.0 / factor)
    for one, other in zip(recording.doodles, back.doodles, strict=True):
        assert other.time_s == pytest.approx(one.time_s, abs=1e-9)
    for part, again in zip(score.performers, back_score.performers, strict=True):
        expected = [time for one in part.phrases for time in (one.start_s, one.end_s)]
        found = [time for one in again.phrases for time in (one.start_s, one.end_s)]
        assert found == pytest.approx(expected, abs=1e-9)


def test_a_phrase_shows_the_same_of_the_recording_however_long_it_lasts():
    score, recording = take()
    slow_score, slow = stretched(score, recording, 2.75)
    (phrase,), (later,) = (one.performers[1].phrases for one in (score, slow_score))
    seen, still = (
        np.interp([p.start_s, p.end_s], doodle.time_s, doodle.position_m[:, 2])
        for p, doodle in ((phrase, recording.doodles[2]), (later, slow.doodles[2]))
    )
    assert still == pytest.approx(seen)


def test_a_part_without_phrases_stays_one():
    score, recording = take()
    empty = replace(score, performers=(Part("fox"), Part("owl")))
    assert [part.phrases for part in stretched(empty, recording, 3.0)[0].performers] == [(), ()]
