from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from actions_library.authoring.actions import HUMANOID_ACTIONS
from smd.errors import DoodleError
from smd.formats import read_recording
from smd.recognition.bank import compile_library
from smd.recognition.streaming import HORIZON_S, RecognitionStream
from smd.recognition.token_spotter import TokenSpotter, recognize
from smd.recognition.tokenizer import tokenize
from smd.smoothing import smooth
from smd.synthetic.efforts import ACTIONS
from smd.synthetic.person import STEADY, simulated_person
from smd.synthetic.takes import Take
from tests.naive.streaming import spans_as_they_become_final

RECORDINGS = Path(__file__).parents[3] / "recordings"
BANK = compile_library({a.name: a.pattern for a in HUMANOID_ACTIONS if a.pattern})


SPOTTER = TokenSpotter(BANK)


def offline(doodle):
    return recognize(tokenize(smooth(doodle)), BANK)


def samples(doodle):
    drawing = [None] * len(doodle) if doodle.drawing is None else doodle.drawing.tolist()
    return zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, drawing, strict=True)


def streamed(doodle, **how):
    """Return the spans and the time at which each became final."""
    stream = RecognitionStream(SPOTTER, **how)
    found = [(span, t) for t, p, q, on in samples(doodle) for span in stream.push(t, p, q, on)]
    return found + [(span, np.inf) for span in stream.finish()]


def told(spans):
    return [(span.action, span.start_s, span.end_s) for span in spans]


def assert_same(ours, theirs):
    assert [action for action, _, _ in ours] == [action for action, _, _ in theirs]
    for (_, *a), (_, *b) in zip(ours, theirs, strict=True):
        assert a == pytest.approx(b, abs=1e-6)


def row(seed, actions=ACTIONS, person=None, pause_s=(0.4, 1.2)):
    rng = np.random.default_rng(seed)
    take = Take(person or simulated_person(rng), rng).pause(0.6)
    for action in rng.permutation(list(actions)):
        take.play(str(action)).pause(float(rng.uniform(*pause_s)))
    return take.doodle()


def test_where_nothing_says_what_is_drawn_all_movement_counts():
    doodle = row(3, ACTIONS[:3])
    free, drawn = (
        told(span for span, _ in streamed(replace(doodle, drawing=mark)))
        for mark in (None, np.ones(len(doodle), bool))
    )
    assert free == drawn != []
    assert streamed(replace(doodle, drawing=np.zeros(len(doodle), bool))) == []


@pytest.mark.parametrize("seed", range(6))
def test_it_says_what_the_offline_pass_says_when_it_must_decide(seed):
    """All it forgets does not matter: the oracle tokenizes everything again and forgets nothing."""
    doodle = row([3, seed], list(ACTIONS)[seed % 3 :: 2])
    ours = told(span for span, _ in streamed(doodle))
    assert_same(ours, spans_as_they_become_final(doodle, SPOTTER))


@pytest.mark.parametrize("seed", range(6))
def test_without_a_horizon_it_says_what_the_offline_pass_says_of_all(seed):
    doodle = row([4, seed])
    final = streamed(doodle, horizon_s=np.inf)
    assert {t for _, t in final} <= {np.inf}
    assert_same(told(span for span, _ in final), told(offline(doodle)))


@pytest.mark.parametrize("seed", range(4))
def test_gestures_without_a_rest_inside_are_read_as_offline(seed):
    """No gesture of these has a part that is an action and half a second of something else."""
    actions = [a for a in ACTIONS if a not in ("bow", "run", "punch")]
    doodle = row([5, seed], actions, STEADY, pause_s=(0.6, 1.2))
    assert_same(told(span for span, _ in streamed(doodle)), told(offline(doodle)))


@pytest.mark.parametrize("name", ["duel", "postman", "fledgling"])
def test_stories_are_read_as_offline(name):
    for doodle in read_recording(RECORDINGS / f"{name}.csv").doodles:
        assert_same(told(span for span, _ in streamed(doodle)), told(offline(doodle)))


@pytest.mark.parametrize("horizon_s", [HORIZON_S, 1.0])
def test_a_span_is_final_within_the_horizon_and_later_spans_follow_it(horizon_s):
    doodle = row([6, 0])
    found = streamed(doodle, horizon_s=horizon_s)
    assert sum(t < np.inf for _, t in found) >= 9
    for span, t in found:
        assert t == np.inf or t - span.end_s <= horizon_s
    ends = [s for span, _ in found for s in (span.start_s, span.end_s)]
    assert ends == sorted(ends)


def pausing(action, pause_s):
    take = Take(STEADY, np.random.default_rng(0)).pause(0.6)
    return take.play(action).pause(pause_s).play(action).pause(0.6).doodle()


def test_a_pause_that_ends_as_a_span_falls_due_parts_it():
    """The difference: what begins within the horizon, but is too slow yet to be movement."""
    for pause_s, whole, as_it_comes in ((0.0, 1, 1), (0.25, 1, 2), (0.6, 2, 2)):
        doodle = pausing("turn_left", pause_s)
        assert [span.action for span in offline(doodle)] == ["turn_left"] * whole
        assert [span.action for span, _ in streamed(doodle)] == ["turn_left"] * as_it_comes
    later = streamed(pausing("turn_left", 0.25), horizon_s=1.0)
    assert [span.action for span, _ in later] == ["turn_left"]


def test_what_was_not_drawn_is_nothing():
    doodle = row([7, 0])
    stream = RecognitionStream(SPOTTER)
    assert not [s for t, p, q, _ in samples(doodle) for s in stream.push(t, p, q, False)]
    assert stream.finish() == []


@pytest.mark.long
def test_a_long_stream_does_not_grow():
    doodle = row([8, 0])
    stream = RecognitionStream(SPOTTER)
    found = 0
    for lap in range(6):
        shift_s = lap * (doodle.duration_s + 0.02)
        for t, p, q, on in samples(doodle):
            found += len(stream.push(t + shift_s, p, q, on))
    assert found > 5 * len(ACTIONS)
    assert len(stream._arrays[0]) < 60 * 8
    assert len(stream._given) < 200 * 8


def test_a_bad_sample_does_not_stop_it():
    doodle = row([9, 0], ["walk"])
    stream = RecognitionStream(SPOTTER)
    for i, (t, p, q, on) in enumerate(samples(doodle)):
        stream.push(t, p, q, on)
        if i % 50 == 0:
            with pytest.raises(DoodleError):
                stream.push(t, p, q, on)
    assert [span.action for span in stream.finish()] in (["walk"], [])


def test_nothing_comes_of_nothing():
    assert RecognitionStream(SPOTTER).finish() == []
