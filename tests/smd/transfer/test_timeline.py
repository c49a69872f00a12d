from __future__ import annotations

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from smd.score import Part, Phrase
from smd.transfer.timeline import SHORTEST_IDLE_S, timeline


@st.composite
def parts(draw: st.DrawFn) -> Part:
    cuts = sorted(draw(st.lists(st.integers(0, 30_000), unique=True, max_size=12)))
    phrases = [
        Phrase("walk", a / 1000, b / 1000) for a, b in zip(cuts[::2], cuts[1::2], strict=False)
    ]
    return Part("fox", tuple(phrases))


@given(parts())
def test_spans_cover_the_whole_time_one_after_the_other(part):
    spans = timeline(part.phrases, 0.0, 30.0)
    assert spans[0].start_s == 0.0
    assert spans[-1].end_s == 30.0
    assert all(a.end_s == b.start_s for a, b in pairwise(spans))
    assert all(span.end_s > span.start_s for span in spans)


@given(parts())
def test_every_phrase_has_its_span_to_its_very_end(part):
    spans = [span for span in timeline(part.phrases, 0.0, 30.0) if span.phrase is not None]
    assert [span.phrase for span in spans] == list(part.phrases)
    for span in spans:
        assert span.end_s == span.phrase.end_s
        assert 0.0 <= span.phrase.start_s - span.start_s < SHORTEST_IDLE_S


@given(parts())
def test_no_idling_before_a_phrase_is_too_short_to_come_to_rest(part):
    spans = timeline(part.phrases, 0.0, 30.0)
    for span in spans[:-1]:
        if span.phrase is None:
            assert span.end_s - span.start_s >= SHORTEST_IDLE_S


def test_without_phrases_all_is_idling():
    (span,) = timeline((), 1.0, 4.0)
    assert (span.start_s, span.end_s, span.phrase) == (1.0, 4.0, None)


def test_a_phrase_ends_with_the_performance():
    (span,) = timeline((Phrase("walk", 0.0, 2.02),), 0.0, 2.0)
    assert span.end_s == 2.0
