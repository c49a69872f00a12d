from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smd.doodle import Doodle
from smd.errors import LearningError
from smd.recognition.alphabet import DIRECTIONS
from smd.recognition.automaton import compile_automaton, edit_distance
from smd.recognition.generalization import generalized, pattern_of, ways_of
from smd.recognition.learning import doodle_runs, learn_pattern, without_rest
from smd.recognition.pattern import Pattern
from smd.recognition.progressive_alignment import WeightedToken
from smd.recognition.tokens import STILL, Token
from smd.synthetic.efforts import ACTIONS
from smd.synthetic.person import STEADY, simulated_person
from smd.synthetic.strokes import progress
from smd.synthetic.takes import Take
from tests.naive.learning_by_index import learned_by_index

HEIGHT_M = 0.175
NEAR = tuple(map(Token.parse, ("T_Z", "T_Y_Z", "T_X_Z", "T_X_Y_Z", "T_Z/R_Y", "STILL")))
MOVING = tuple(token for token in NEAR if token != STILL)


def played(action, count, seed=0):
    rng = np.random.default_rng(seed)
    takes = (
        Take(simulated_person(rng), rng, heading_rad=rng.uniform(-3.0, 3.0)) for _ in range(count)
    )
    return [take.pause(0.2).play(action).pause(0.3).doodle() for take in takes]


def steady(*actions):
    take = Take(STEADY, np.random.default_rng(0)).pause(0.3)
    for action in actions:
        take.play(action).pause(0.3)
    return take.exact_doodle()


def sequence_of(doodle):
    return tuple(run.token for run in without_rest(doodle_runs(doodle, HEIGHT_M)))


def distance(pattern, word):
    return edit_distance(compile_automaton(pattern), word)


def one_way(groups):
    return pattern_of([groups])


def random_word(rng, length):
    places = rng.integers(0, 27, (length, 2))
    word = [Token(DIRECTIONS[t], DIRECTIONS[r]) for t, r in places]
    return tuple(b for a, b in zip([None, *word], word, strict=False) if a != b)


@pytest.mark.parametrize("action", ACTIONS)
@pytest.mark.parametrize("count", [1, 2, 3, 10])
def test_every_example_and_their_average_is_accepted(action, count):
    doodles = played(action, count)
    learned = learn_pattern(doodles)
    assert learned.sequences == tuple(map(sequence_of, doodles))
    assert [distance(learned.pattern, word) for word in learned.sequences] == [0] * count
    assert bool(learned.average_sequence) == (count > 1)
    if count > 1:
        assert distance(learned.pattern, learned.average_sequence) == 0


strokes = st.builds(WeightedToken, st.sampled_from(NEAR), st.floats(0.02, 1.0))
anchor = st.builds(WeightedToken, st.sampled_from(MOVING), st.just(1.0))
examples = st.lists(
    st.tuples(st.lists(strokes, max_size=4), anchor, st.lists(strokes, max_size=4)).map(
        lambda parts: [*parts[0], parts[1], *parts[2]]
    ),
    min_size=1,
    max_size=8,
)


def merged_tokens(sequence):
    word = [stroke.token for stroke in sequence]
    return tuple(b for a, b in zip([None, *word], word, strict=False) if a != b)


@settings(max_examples=200, deadline=None)
@given(examples)
def test_whatever_the_examples_all_are_accepted(given):
    pattern = pattern_of(ways_of(given))
    assert [distance(pattern, merged_tokens(word)) for word in given] == [0] * len(given)


@settings(max_examples=100, deadline=None)
@given(examples)
def test_there_are_several_ways_only_where_no_place_is_shared(given):
    ways = ways_of(given)
    assert 1 <= len(ways) <= len(given)
    assert (len(ways) == 1) == bool(generalized(given))


@pytest.mark.parametrize("count", [3, 10])
@pytest.mark.long
def test_more_examples_do_not_make_it_accept_everything(count):
    """Bound: 3 % of random strings of a pattern's own tokens, 1 % of other gestures."""
    learned = {action: learn_pattern(played(action, count)) for action in ACTIONS}
    rng = np.random.default_rng(7)
    by_chance, strangers = [], []
    for action, one in learned.items():
        tokens = one.pattern.tokens()
        if len(tokens) > 2:
            for _ in range(100):
                word = [tokens[i] for i in rng.integers(0, len(tokens), rng.integers(4, 12))]
                by_chance.append(distance(one.pattern, tuple(word)) == 0)
        for other in ACTIONS:
            if other != action:
                words = map(sequence_of, played(other, 2, seed=99))
                strangers += [distance(one.pattern, word) == 0 for word in words]
    assert np.mean(by_chance) < 0.03
    assert np.mean(strangers) < 0.01


def test_ten_examples_do_not_accept_strings_of_any_tokens():
    learned = learn_pattern(played("throw", 10))
    rng = np.random.default_rng(3)
    words = [random_word(rng, n) for n in rng.integers(1, 10, 500)]
    assert not any(distance(learned.pattern, word) == 0 for word in words)


@pytest.mark.parametrize("action", ["throw", "jump", "punch", "bow", "turn_left"])
def test_new_people_are_within_an_edit_of_what_three_examples_say(action):
    learned = learn_pattern(played(action, 3))
    edits = [distance(learned.pattern, sequence_of(d)) for d in played(action, 20, seed=50)]
    assert np.mean(edits) < 1.0


@pytest.mark.parametrize(
    ("action", "pattern"),
    [
        ("walk", "T_Z+"),
        ("turn_right", "R_N_Y+"),
        ("punch", "T_Z+ T_N_Z+"),
        ("bow", "R_X+ STILL* R_N_X+"),
    ],
)
def test_one_steady_example_says_what_it_is(action, pattern):
    assert str(learn_pattern([steady(action)]).pattern) == pattern


def test_it_prints_itself_and_what_it_was_learned_from():
    three = learn_pattern([steady("punch")] * 3, names=["a.csv", "b.csv", "c.csv"])
    assert str(three) == (
        "T_Z+ T_N_Z+  learned from 3 examples (a.csv, b.csv, c.csv) and their average"
    )
    assert str(learn_pattern([steady("punch")])) == "T_Z+ T_N_Z+  learned from example 1"
    assert Pattern.parse(str(three.pattern)) == three.pattern
    assert three.mandatory == ({Token.parse("T_Z")}, {Token.parse("T_N_Z")})


def test_rest_around_the_gesture_is_no_part_of_it():
    learned = learn_pattern([steady("punch")])
    (begins, ends), whole = learned.spans_s[0], steady("punch")
    assert 0.25 < begins < 0.4
    assert whole.duration_s - 0.4 < ends < whole.duration_s - 0.2
    assert STILL not in (learned.sequences[0][0], learned.sequences[0][-1])


def test_where_the_trigger_is_not_held_nothing_is_learned():
    both = steady("bow", "punch")
    begins = learn_pattern([steady("bow")]).spans_s[0][1] + 0.2
    learned = learn_pattern([replace(both, drawing=both.time_s > begins)])
    assert str(learned.pattern) == "T_Z+ T_N_Z+"


def test_a_small_wobble_that_one_example_has_is_optional():
    main = [WeightedToken(Token.parse("T_Z"), 1.0), WeightedToken(Token.parse("T_N_Z"), 0.9)]
    wobble = WeightedToken(Token.parse("T_X"), 0.1)
    groups = generalized([main, [main[0], wobble, main[1]], main])
    assert str(one_way(groups)) == "T_Z+ T_X* T_N_Z+"


def test_a_quick_movement_that_three_examples_share_is_mandatory():
    main = [WeightedToken(Token.parse("T_Z"), 1.0), WeightedToken(Token.parse("T_X"), 0.05)]
    assert str(one_way(generalized([main] * 2))) == "T_Z+ T_X*"
    assert str(one_way(generalized([main] * 3))) == "T_Z+ T_X+"


def test_one_token_too_many_shifts_nothing_here_and_everything_where_paired_by_index():
    names = [["T_Z", "T_N_Z", "T_Y"], ["T_X", "T_Z", "T_N_Z", "T_Y"]]
    words = [tuple(map(Token.parse, each)) for each in names]
    ours = one_way(generalized([[WeightedToken(token, 1.0) for token in word] for word in words]))
    paper = learned_by_index(words, [[True] * len(word) for word in words])
    assert str(ours) == "T_X* T_Z+ T_N_Z+ T_Y+"
    assert str(paper) == "(T_Z|T_X)+ (T_N_Z|T_Z)+ (T_Y|T_N_Z)+ T_Y*"
    for pattern in (ours, paper):
        assert [distance(pattern, word) for word in words] == [0, 0]


def test_alternatives_at_one_place_are_a_choice():
    ways = [[WeightedToken(Token.parse(name), 1.0)] for name in ("T_Z", "T_Y_Z", "T_X_Z")]
    assert str(one_way(generalized(ways))) == "(T_Z|T_Y_Z|T_X_Z)+"


def straight(direction):
    stroke = progress(np.clip(np.arange(120) / 60.0 - 0.5, 0.0, 1.0))[:, None]
    upright = np.tile([0.0, 0.0, 0.0, 1.0], (120, 1))
    return Doodle(np.arange(120) / 60.0, 0.3 * stroke * np.asarray(direction), upright)


def test_a_hundred_examples_are_learned():
    learned = learn_pattern(played("throw", 100))
    assert all(distance(learned.pattern, word) == 0 for word in learned.sequences)
    assert learned.ways == 1


def test_examples_that_share_in_turn_but_not_all_are_a_choice_of_ways():
    names = ["T_Z T_X", "T_X T_N_Y", "T_N_Y T_Z"]
    given = [[WeightedToken(Token.parse(name), 1.0) for name in each.split()] for each in names]
    pattern = pattern_of(ways_of(given))
    assert len(ways_of(given)) == 2
    assert [distance(pattern, merged_tokens(word)) for word in given] == [0, 0, 0]


def test_an_example_that_has_nothing_in_common_is_named():
    doodles = [steady("punch"), steady("turn_left"), steady("punch")]
    message = (
        "b.csv: expected a movement that another example has, got mainly R_Y "
        "where the others have mainly T_N?_?Z"
    )
    with pytest.raises(LearningError, match=message) as caught:
        learn_pattern(doodles, names=["a.csv", "b.csv", "c.csv"])
    assert caught.value.example == 1


def test_an_average_of_three_directions_does_not_bridge_them():
    """It goes aslant, so that each example is like it, and none is like another."""
    doodles = [straight(direction) for direction in np.eye(3)]
    with pytest.raises(LearningError, match=r"example \d: expected a movement that another"):
        learn_pattern(doodles)


def test_an_example_that_is_all_stillness_is_named():
    still = Take(STEADY, np.random.default_rng(0)).pause(2.0).exact_doodle()
    with pytest.raises(LearningError, match=r"example 2: expected a gesture, got 2.0 s of still"):
        learn_pattern([steady("punch"), still])


def test_an_example_that_is_too_short_is_named():
    short = Doodle([0.0, 0.01], np.zeros((2, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)))
    with pytest.raises(LearningError, match=r"example 1: device 'prop'.* at least 0.067 s") as no:
        learn_pattern([short])
    assert no.value.example == 0


def test_no_examples_and_names_that_do_not_fit_are_refused():
    with pytest.raises(LearningError, match="at least one example, got none"):
        learn_pattern([])
    with pytest.raises(LearningError, match="names: expected 1, one an example, got 2"):
        learn_pattern([steady("punch")], names=["a", "b"])
