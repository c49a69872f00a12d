"""Own examples stand beside others', and each take is judged by a library that never saw it."""

from dataclasses import replace

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.errors import LearningError
from smd.recognition import Recognizer, learn_action
from smd.recognition.acceptance import PLAINLY
from smd.recognition.action import Action
from smd.recognition.matching import Match
from smd.recognition.pattern import Pattern
from smd.recognition.rehearsal import Likeness, add_examples, gains, likeness
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take

ACTIONS = ("punch", "bow", "wave", "jump")


def performed(action, seed, person=7, size=1.0, pace=1.0):
    take = Take(simulated_person(np.random.default_rng(person)), np.random.default_rng(seed))
    return take.pause(0.4).play(action, size=size, pace=pace).pause(0.4).doodle()


def strange(action, seed):
    """A take of somebody who draws far larger and slower than others."""
    return performed(action, seed, person=99, size=2.2, pace=0.5)


@pytest.fixture(scope="module")
def of_others():
    return [
        learn_action(name, [performed(name, seed, person=seed) for seed in range(5)], own=False)
        for name in ACTIONS
    ]


def test_the_pattern_and_what_was_there_stay(of_others):
    punch = of_others[0]
    extended = add_examples(punch, [strange("punch", 1), strange("punch", 2)], names=["a", "b"])
    assert extended.pattern == punch.pattern
    assert extended.learned_from == (*punch.learned_from, "a", "b")
    assert extended.exemplar.own.tolist() == [False] * 5 + [True] * 2
    assert np.array_equal(extended.exemplar.measures[:5], punch.exemplar.measures)
    assert replace(extended, learned_from=punch.learned_from) == punch  # all but its examples


def test_examples_added_one_by_one_are_those_added_at_once(of_others):
    takes = [strange("punch", seed) for seed in (1, 2, 3)]
    at_once = add_examples(of_others[0], takes)
    one_by_one = of_others[0]
    for take in takes:
        one_by_one = add_examples(one_by_one, [take])
    assert one_by_one.exemplar.ownership == at_once.exemplar.ownership == (5, 6, 7)
    for name, array in at_once.exemplar.to_arrays().items():
        assert np.array_equal(array, one_by_one.exemplar.to_arrays()[name]), name
    assert add_examples(of_others[0], []) is of_others[0]


@pytest.mark.parametrize("seed", range(3))
def test_the_next_take_of_the_same_person_costs_less(of_others, seed):
    takes = {name: [strange(name, 10 + seed), strange(name, 20 + seed)] for name in ACTIONS}
    for gain in gains(of_others, takes):
        for before, after in zip(gain.before, gain.after, strict=True):
            assert after.place <= before.place
            assert after.share() < before.share()


def test_a_take_is_judged_with_all_others_added_and_itself_left_out(of_others):
    punches, bow = [strange("punch", seed) for seed in (1, 2, 3)], strange("bow", 1)
    gain_of = {one.action: one for one in gains(of_others, {"punch": punches, "bow": [bow]})}
    assert set(gain_of) == {"punch", "bow"}
    extended = {action.name: action for action in of_others}
    extended["punch"] = add_examples(extended["punch"], [punches[0], punches[2]])
    extended["bow"] = add_examples(extended["bow"], [bow])
    expected = Recognizer(list(extended.values())).rank(punches[1])
    assert gain_of["punch"].after[1].matches == tuple(expected)
    assert gain_of["punch"].before[1] == likeness(Recognizer(of_others), "punch", punches[1])
    assert gain_of["bow"].after == ()  # one take says nothing of itself


def test_a_take_that_is_there_already_is_refused(of_others):
    take = strange("punch", 1)
    extended = add_examples(of_others[0], [take])
    with pytest.raises(LearningError, match="again: expected a new take"):
        add_examples(extended, [take], names=["again"])
    with pytest.raises(LearningError, match="example 2: expected a new take"):
        add_examples(of_others[0], [take, take])


def test_stillness_and_what_nobody_draws_are_refused(of_others):
    doodle = performed("bow", 3)
    still = Doodle(doodle.time_s, 0.0 * doodle.position_m, [[0.0, 0.0, 0.0, 1.0]] * len(doodle))
    with pytest.raises(LearningError, match=r"rest\.csv: expected a gesture, got 2\.\d s of still"):
        add_examples(of_others[0], [still], names=["rest.csv"])
    assert likeness(Recognizer(of_others), "punch", still).is_still
    with pytest.raises(LearningError, match="'idle'"):
        add_examples(Action("idle", None), [doodle])


def test_an_action_without_examples_is_widened_to_what_was_drawn():
    walk = Action("walk", Pattern.parse("T_Z+"))
    take = performed("bow", 3)
    widened = add_examples(walk, [take], names=["bow.csv"])
    assert (widened.exemplar, widened.learned_from) == (None, ("bow.csv",))
    assert str(widened.pattern).startswith("T_Z+|")
    cost = {
        match.action: match.distance
        for action in (walk, widened)
        for match in Recognizer([replace(action, name=str(action.pattern))]).rank(take)
    }
    assert cost[str(widened.pattern)] < cost["T_Z+"]
    again = add_examples(widened, [take])
    assert again.pattern == widened.pattern  # accepts it already


def ranked(**costs):
    """Matches of actions that all may cost what none does."""
    most = costs["none"]
    named = [
        Match(name, cost, 0.0, most) if name != "none" else Match(None, cost, 0.0)
        for name, cost in costs.items()
    ]
    return tuple(sorted(named, key=lambda match: match.distance))


@pytest.mark.parametrize(
    ("costs", "is_another"),
    [
        ({"punch": 5.0, "wave": 9.0, "none": 10.0}, False),
        ({"punch": 5.0, "wave": 4.9, "none": 10.0}, False),  # hardly worse
        ({"punch": 5.0, "wave": 5.0 / PLAINLY + 1e-9, "none": 10.0}, False),
        ({"punch": 5.0, "wave": 5.0 / PLAINLY - 1e-9, "none": 10.0}, True),
        ({"punch": 50.0, "wave": 11.0, "none": 10.0}, False),  # like nothing that is known
    ],
)
def test_another_action_is_plainly_meant_where_it_passes_and_costs_far_less(costs, is_another):
    looks = Likeness("punch", ranked(**costs))
    assert looks.is_another == is_another
    assert looks.share() == pytest.approx(costs["punch"] / 10.0)
    assert not Likeness("punch", (Match(None, 0.0, 1.0),)).is_another
