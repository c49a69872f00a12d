"""What no span explains is suggested, with what kept the likeliest actions out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.geometry.rotations import multiply, quaternion_about
from smd.recognition import Recognizer, learn_action
from smd.recognition.reasons import TURNED, WITHIN, reason_of
from smd.recognition.suggestions import (
    LONGEST_S,
    MEANT,
    MOST_SUGGESTED,
    SHORTEST_S,
    Understood,
    stretches,
    suggestions,
)
from smd.recognition.tokens import STILL
from smd.recognition.traits import traits_of_parts
from smd.smoothing import smooth
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

NAMES = ("walk", "punch", "bow", "turn_left")


def take(seed: int, *actions: str) -> Take:
    rng = np.random.default_rng(seed)
    made = Take(simulated_person(rng), rng).pause(0.6)
    for action in actions:
        made.play(action).pause(0.6)
    return made


@pytest.fixture(scope="module")
def actions():
    return [learn_action(n, [take(i, n).doodle() for i in (1, 2, 3)]) for n in NAMES]


@pytest.fixture(scope="module")
def recognizer(actions):
    return Recognizer(actions)


def understood(recognizer: Recognizer, doodle: Doodle) -> Understood:
    motion = smooth(doodle)
    runs = recognizer.runs_of(doodle, motion)
    return Understood(motion, runs, recognizer.spot_runs(motion, runs))


def kept_out(recognizer, actions, doodle: Doodle, name: str) -> str:
    """Return the reason where the doodle's movement costs a little more than it may."""
    whole = understood(recognizer, doodle)
    moving = [run for run in whole.runs if run.token != STILL]
    span_s = moving[0].start_s, moving[-1].end_s
    (matches,) = recognizer.weigh(whole.motion, whole.runs, [span_s])
    match = next(match for match in matches if match.action == name)
    action = next(action for action in actions if action.name == name)
    measures = traits_of_parts(whole.motion, [span_s]).measures[0]
    return reason_of(replace(match, most=0.9 * match.distance), action, measures)


def test_what_is_recognised_is_not_suggested(recognizer, actions):
    made = take(4, "walk", "punch", "bow")
    whole = understood(recognizer, made.doodle())
    assert len(whole.detections) == 3
    assert suggestions(recognizer, actions, [whole]) == []


def test_a_gesture_that_was_left_out_is_suggested_where_it_is(recognizer, actions):
    made = take(4, "walk", "punch", "bow")
    whole = understood(recognizer, made.doodle())
    without = replace(whole, detections=[whole.detections[0], whole.detections[2]])
    (one,) = suggestions(recognizer, actions, [without])
    punch = made.phrases[1]
    assert one.start_s == pytest.approx(punch.start_s, abs=0.2)
    assert one.end_s == pytest.approx(punch.end_s, abs=0.2)
    best = one.likeliest[0]
    assert (best.action, best.reason) == ("punch", "would pass by itself")
    assert best.cost <= best.most
    assert all(other.cost >= best.cost for other in one.likeliest[1:])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda doodle: replace(doodle, time_s=4.0 * doodle.time_s), "too slow"),
        (lambda doodle: replace(doodle, time_s=0.25 * doodle.time_s), "too quick"),
        (lambda doodle: replace(doodle, position_m=6.0 * doodle.position_m), "too large"),
        (lambda doodle: replace(doodle, position_m=0.2 * doodle.position_m), "too small"),
    ],
)
def test_the_reason_names_what_was_changed(recognizer, actions, change, said):
    doodle = change(take(4, "walk").doodle())
    assert said in kept_out(recognizer, actions, doodle, "walk")
    assert said not in kept_out(recognizer, actions, take(4, "walk").doodle(), "walk")


def test_a_prop_that_is_held_otherwise_is_told_so(recognizer, actions):
    doodle = take(4, "walk").doodle()
    rolled = multiply(doodle.orientation_xyzw, quaternion_about([0.0, 0.0, 1.0], 2.0))
    assert kept_out(recognizer, actions, doodle, "walk") == WITHIN
    turned = replace(doodle, orientation_xyzw=rolled)
    assert TURNED in kept_out(recognizer, actions, turned, "walk")


def test_idle_trembling_and_stillness_suggest_nothing(recognizer, actions):
    rng = np.random.default_rng(0)
    time_s = np.arange(0.0, 10.0, 1.0 / 60.0)
    position_m = 0.0005 * rng.standard_normal((len(time_s), 3))
    upright = np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1))
    for moved in (position_m, np.zeros_like(position_m)):
        doodle = Doodle(time_s, moved, upright)
        assert suggestions(recognizer, actions, [understood(recognizer, doodle)]) == []


def waving(seconds: float) -> Doodle:
    """A prop that goes up and down without ever resting."""
    time_s = np.arange(0.0, seconds, 1.0 / 60.0)
    # The two frequencies have no common period: the prop is never quite at rest.
    position_m = 0.2 * np.stack(
        [np.sin(2.1 * time_s), np.sin(5.3 * time_s), np.sin(3.7 * time_s)], axis=1
    )
    return Doodle(time_s, position_m, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)))


def test_movement_without_rest_is_cut_into_pieces_like_gestures(recognizer):
    whole = replace(understood(recognizer, waving(20.0)), detections=())
    found = list(stretches(whole))
    assert len(found) >= 20.0 / LONGEST_S
    for movement, (start_s, end_s) in found:
        assert movement >= MEANT
        assert SHORTEST_S <= end_s - start_s <= LONGEST_S
    ends = [time_s for _, span_s in found for time_s in span_s]
    assert ends == sorted(ends)


def test_there_are_never_more_than_a_person_would_read(recognizer, actions):
    whole = replace(understood(recognizer, waving(200.0)), detections=())
    found = suggestions(recognizer, actions, [whole])
    assert len(found) <= MOST_SUGGESTED


def test_without_examples_tokens_say_what_is_likely(actions):
    by_hand = [replace(action, exemplar=None) for action in actions]
    plain = Recognizer(by_hand)
    whole = replace(understood(plain, take(4, "punch").doodle()), detections=())
    (one,) = suggestions(plain, by_hand, [whole])
    assert one.likeliest[0].action == "punch"
