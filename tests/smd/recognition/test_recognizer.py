from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.errors import LearningError
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.recognition import Recognizer, learn_action
from smd.recognition.acceptance import Intent
from smd.recognition.action import Action
from smd.recognition.exemplar import Exemplar
from smd.recognition.pattern import Pattern
from smd.recognition.verification import TERMS
from smd.smoothing import smooth
from smd.synthetic.curves import straight_line
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take
from tests.naive.streaming import spans_as_they_become_final

NAMES = ("walk", "jump", "punch", "throw", "turn_left", "bow")


def take(rng, person, *actions):
    made = Take(person, rng, heading_rad=rng.uniform(-3.0, 3.0)).pause(0.5)
    for action in actions:
        made.play(action).pause(0.5)
    return made


@pytest.fixture(scope="module")
def player():
    rng = np.random.default_rng(11)
    return rng, simulated_person(rng)


@pytest.fixture(scope="module")
def actions(player):
    return [learn_action(n, [take(*player, n).doodle() for _ in range(3)]) for n in NAMES]


@pytest.fixture(scope="module")
def recognizer(actions):
    return Recognizer(actions)


@pytest.mark.parametrize("name", NAMES)
def test_a_gesture_learned_from_three_examples_is_ranked_first(player, recognizer, name):
    matches = recognizer.rank(take(*player, name).doodle())
    assert matches[0].action == name
    assert [m.distance for m in matches] == sorted(m.distance for m in matches)
    assert {m.action for m in matches} == {*NAMES, None}
    assert sum(m.confidence for m in matches) == pytest.approx(1.0)


def test_the_terms_of_a_match_add_up_to_its_distance(player, recognizer):
    for match in recognizer.rank(take(*player, "jump").doodle()):
        if match.action:
            assert tuple(name for name, _ in match.terms) == TERMS
            assert sum(value for _, value in match.terms) == pytest.approx(match.distance)


def test_actions_in_a_row_are_found_where_they_are(player, recognizer):
    made = take(*player, "walk", "punch", "bow", "throw", "turn_left", "jump")
    spans = recognizer.spot(made.doodle())
    assert [span.action for span in spans] == [phrase.action for phrase in made.phrases]
    for span, phrase in zip(spans, made.phrases, strict=True):
        assert abs(span.start_s - phrase.start_s) < 0.2
        assert abs(span.end_s - phrase.end_s) < 0.2
        assert 0.5 < span.confidence <= 1.0
        assert span.action not in dict(span.alternatives)
    ends = [time for span in spans for time in (span.start_s, span.end_s)]
    assert ends == sorted(ends)


def test_where_the_user_stands_does_not_matter(player, recognizer):
    doodle = take(*player, "walk", "throw").doodle()
    turn = quaternion_about([0.0, 1.0, 0.0], 1.3)
    elsewhere = replace(
        doodle,
        position_m=np.add(rotate(turn, doodle.position_m), [1.0, 2.0, 3.0]),
        orientation_xyzw=multiply(turn, doodle.orientation_xyzw),
    )
    a, b = (recognizer.spot(one) for one in (doodle, elsewhere))
    assert [span.action for span in a] == [span.action for span in b]
    assert [span.distance for span in a] == pytest.approx([s.distance for s in b], abs=1e-3)


def test_a_gesture_that_was_not_taught_is_none(player, actions):
    only_turning = Recognizer([a for a in actions if a.name in ("turn_left", "bow")])
    doodle = take(*player, "throw").doodle()
    assert only_turning.rank(doodle)[0].action is None
    assert only_turning.spot(doodle) == []


def test_a_lower_tolerance_rejects_more(player, actions):
    doodle = take(*player, "walk", "punch", "bow").doodle()
    assert Recognizer(actions, tolerance=0.05).spot(doodle) == []


def test_what_is_drawn_is_found_sooner_than_what_is_not_said_to_be_meant(player, actions):
    doodle = take(*player, "walk", "punch", "bow").doodle()
    drawn = replace(doodle, drawing=np.ones(len(doodle), bool))
    tight = Recognizer(actions, tolerance=0.2)
    assert (tight.intent_of(doodle), tight.intent_of(drawn)) == (Intent.FREE, Intent.DRAWN)
    assert len(tight.spot(drawn)) > len(tight.spot(doodle))
    forced = Recognizer(actions, tolerance=0.2, intent=Intent.DRAWN)
    assert [s.action for s in forced.spot(doodle)] == [s.action for s in tight.spot(drawn)]


@pytest.mark.parametrize("name", NAMES)
def test_a_gesture_without_rest_around_it_is_found(player, recognizer, name):
    """The hand comes from above and goes there again; it does not rest in between."""
    made = take(np.random.default_rng(3), player[1], name)
    (phrase,) = made.phrases
    doodle = made.doodle()
    inside = (doodle.time_s >= phrase.start_s) & (doodle.time_s <= phrase.end_s)
    gesture = doodle.position_m[inside]
    u = np.linspace(0.0, 1.0, 60)[:, None]
    way = np.array([0.05, 0.3, -0.05]) * u**2
    position = np.concatenate([gesture[0] + way[::-1], gesture, gesture[-1] + way])
    q = doodle.orientation_xyzw[inside]
    orientation = np.concatenate([np.tile(q[0], (60, 1)), q, np.tile(q[-1], (60, 1))])
    step_s = doodle.duration_s / (len(doodle) - 1)
    moving = Doodle(step_s * np.arange(len(position)), position, orientation)
    spans = recognizer.spot(moving)
    assert [span.action for span in spans] == [name]
    assert abs(spans[0].start_s - 60 * step_s) < 0.25
    assert abs(spans[0].end_s - step_s * (60 + len(gesture))) < 0.25


def test_stillness_is_no_action(recognizer):
    still = straight_line(length_m=0.0, duration_s=1.0)
    assert recognizer.spot(still) == []
    (match,) = recognizer.rank(still)
    assert (match.action, match.confidence) == (None, 1.0)


def test_without_actions_nothing_is_found(player):
    doodle = take(*player, "walk").doodle()
    assert Recognizer([]).spot(doodle) == []
    assert Recognizer([]).rank(doodle)[0].action is None


def test_an_action_written_by_hand_is_found_beside_learned_ones(player, actions):
    turn = Action("swivel", Pattern.parse("(R_Y|R_X_Y|R_N_X_Y|R_Y_Z|R_Y_N_Z)+"))
    others = [action for action in actions if action.name != "turn_left"]
    spans = Recognizer([*others, turn]).spot(take(*player, "walk", "turn_left", "bow").doodle())
    assert [span.action for span in spans] == ["walk", "swivel", "bow"]


def test_one_example_is_enough_and_none_is_not(player):
    action = learn_action("jump", [take(*player, "jump").doodle()])
    assert len(action.exemplar) == 1
    assert Recognizer([action]).rank(take(*player, "jump").doodle())[0].action == "jump"
    with pytest.raises(LearningError):
        learn_action("jump", [])


def test_an_exemplar_survives_its_arrays(actions):
    for action in actions:
        again = Exemplar.from_arrays(action.exemplar.to_arrays())
        for key, array in action.exemplar.to_arrays().items():
            assert np.array_equal(array, again.to_arrays()[key])
        assert np.array_equal(action.exemplar.scale, again.scale)


def test_its_stream_finds_what_it_spots(player, recognizer):
    doodle = take(*player, "bow", "jump", "turn_left").pause(1.0).doodle()
    stream = recognizer.stream()
    spans = []
    for sample in zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True):
        spans += stream.push(*sample)
    spans += stream.finish()
    offline = recognizer.spot(doodle)
    assert [span.action for span in spans] == [span.action for span in offline]
    for ours, theirs in zip(spans, offline, strict=True):
        assert ours.start_s == pytest.approx(theirs.start_s, abs=0.05)
        assert ours.end_s == pytest.approx(theirs.end_s, abs=0.05)


def test_its_stream_weighs_each_stretch_once_and_says_the_same(player, recognizer):
    """What it remembers does not matter: the oracle weighs everything again at every look."""
    doodle = take(*player, "punch", "walk", "bow").doodle()
    stream = recognizer.stream()
    samples = zip(doodle.time_s, doodle.position_m, doodle.orientation_xyzw, strict=True)
    spans = [span for sample in samples for span in stream.push(*sample)]
    told = [(span.action, span.start_s, span.end_s) for span in spans]
    assert len(told) >= 2  # the last may not be final yet
    assert [action for action, _, _ in told] == ["punch", "walk", "bow"][: len(told)]
    assert told == spans_as_they_become_final(doodle, recognizer)[: len(told)]


def test_no_alternative_is_nearer_than_the_action(player, recognizer):
    doodle = take(*player, "throw", "jump").doodle()
    spans = recognizer.spot(doodle)
    assert [span.action for span in spans] == ["throw", "jump"]
    assert any(span.alternatives for span in spans)
    for span in spans:
        assert all(distance >= span.distance for _, distance in span.alternatives)


def test_stretches_are_weighed_as_their_spans_are_named(player, recognizer):
    doodle = take(*player, "walk", "punch", "bow").doodle()
    motion = smooth(doodle)
    runs = recognizer.runs_of(doodle, motion)
    spans = recognizer.spot_runs(motion, runs)
    weighed = recognizer.weigh(motion, runs, [(span.start_s, span.end_s) for span in spans])
    for span, (best, *_) in zip(spans, weighed, strict=True):
        assert (best.action, best.distance) == (span.action, pytest.approx(span.distance))
        assert best.distance <= best.most < np.inf
    assert recognizer.weigh(motion, runs, []) == []
