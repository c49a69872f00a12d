"""Spans are held against truth by hand."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.composed import Annotation, Session, Teaching
from benchmarks.tally import Named, Tally, f1_gain_interval, f1_interval, tally
from smd.doodle import Doodle

GESTURES = (
    Annotation("a", 1.0, 2.0),
    Annotation(None, 4.0, 5.0),
    Annotation("b", 7.0, 8.0),
    Annotation("a", 10.0, 11.0),
)


def session() -> Session:
    time_s = np.arange(0.0, 12.0001, 1.0 / 60.0)
    free = Doodle(time_s, np.zeros((len(time_s), 3)), np.tile([0, 0, 0, 1.0], (len(time_s), 1)))
    return Session(1, Teaching(own=1), {}, free, np.zeros(len(time_s), bool), GESTURES)


@pytest.mark.parametrize(
    ("spans", "hits", "false", "left"),
    [
        ([], 0, 0, 1),
        ([("a", 1.0, 2.0), ("b", 7.0, 8.0), ("a", 10.0, 11.0)], 3, 0, 1),
        ([("b", 1.0, 2.0)], 0, 1, 1),  # the wrong name
        ([("a", 1.0, 1.4), ("a", 1.5, 2.0)], 1, 1, 1),  # twice the same
        ([("a", 4.0, 5.0)], 0, 1, 0),  # of a class that the library does not hold
        ([("a", 0.0, 0.2)], 1, 0, 1),  # beside the take, nearer to it than to any other
        ([("a", 2.0, 3.9)], 1, 0, 1),  # its middle is before 3.0, half-way to the next take
        ([("a", 2.0, 4.1)], 0, 1, 0),
        ([("a", 9.0, 12.0), ("b", 6.0, 9.1)], 2, 0, 1),  # in any order
    ],
)
def test_a_span_counts_by_its_middle_and_its_name(spans, hits, false, left):
    counts = tally([Named(*span) for span in spans], session())
    assert (counts.known, counts.others) == (3, 1)
    assert (counts.hits, counts.false, counts.left) == (hits, false, left)
    assert counts.minutes == pytest.approx(0.2)


def test_hits_say_how_far_off_they_begin_and_end():
    counts = tally([Named("a", 0.9, 2.2), Named("b", 7.5, 7.9), Named("b", 1.0, 2.0)], session())
    np.testing.assert_allclose(counts.off_s, [(-0.1, 0.2), (0.5, -0.1)])


def test_shares_are_those_of_the_counts_added_up():
    whole = Tally(known=8, hits=3, others=2, left=1, false=2, minutes=1.0)
    whole += Tally(known=2, hits=1, others=2, left=2, false=0, minutes=1.0)
    assert whole.recall == pytest.approx(0.4)
    assert whole.precision == pytest.approx(4 / 6)
    assert whole.f1 == pytest.approx(2 * 0.4 * (4 / 6) / (0.4 + 4 / 6))
    assert whole.false_a_minute == pytest.approx(1.0)
    assert whole.left_alone == pytest.approx(0.75)


def test_nothing_found_is_nothing_reached():
    assert (Tally().recall, Tally().precision, Tally().f1, Tally().left_alone) == (0, 0, 0, 0)


def test_people_who_are_all_alike_leave_no_doubt():
    alike = Tally(known=4, hits=2, false=2)
    low, high = f1_interval([alike] * 5)
    assert low == high == pytest.approx(alike.f1)
    low, high = f1_interval([alike, Tally(known=4, hits=4), Tally(known=4, false=1)])
    assert low < alike.f1 < high


def test_a_gain_is_told_of_the_same_people():
    low, high = (Tally(known=9, hits=hits) for hits in (2, 8))
    assert f1_gain_interval([low, high, low], [low, high, low]) == (0.0, 0.0)
    least, most = f1_gain_interval([high] * 3, [low, high, low])
    assert 0.0 <= least < most <= high.f1 - low.f1
