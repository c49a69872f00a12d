"""Background: the plain quantile of all costs, kept with the examples."""

import numpy as np
import pytest

from smd.recognition.acceptance import OTHERS_MARGIN, OWN_MARGIN, Intent, accepted_cost
from smd.recognition.background import (
    OWN_LENGTHS,
    QUANTILE,
    background,
    background_of,
    made_up_movement,
    weighed,
)
from smd.recognition.exemplar import Exemplar, exemplar_of
from smd.recognition.traits import traits_of
from smd.recognition.verification import GLANCE, Verification
from smd.smoothing import smooth
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take


def exemplar(action, seed, count=3):
    rng = np.random.default_rng(seed)
    takes = []
    for _ in range(count):
        take = Take(simulated_person(rng), rng).pause(0.5).play(action).pause(0.5)
        (phrase,) = take.phrases
        takes.append(traits_of(smooth(take.doodle()).between(phrase.start_s, phrase.end_s)))
    return exemplar_of(takes)


@pytest.mark.parametrize(("action", "seed"), [("punch", 1), ("walk", 2), ("bow", 3)])
def test_it_is_the_plain_quantile_of_all_costs(action, seed):
    one = exemplar(action, seed)
    traits, duration_s = background()
    times = duration_s / one.duration_s
    own = np.flatnonzero((times >= OWN_LENGTHS[0]) & (times <= OWN_LENGTHS[1]))
    terms = Verification((one,)).terms(
        traits,
        np.zeros(len(own), int),
        own,
        wrong=np.zeros(len(own)),
        most=np.full(len(own), np.inf),
        every=GLANCE,
    )
    expected = np.log(np.quantile(terms.sum(axis=1), QUANTILE))
    assert len(own) > 300
    assert background_of(one) == pytest.approx(expected, abs=1e-9)


def test_it_is_kept_with_the_examples():
    one = weighed(exemplar("punch", 4))
    assert one.background == background_of(one)
    again = Exemplar.from_arrays(one.to_arrays())
    assert again.background == one.background
    assert weighed(again) is again


def test_an_action_longer_than_all_background_is_held_against_the_longest():
    one = exemplar("walk", 5)
    measures = one.measures + np.array([4.0, 0.0, 0.0, 0.0])
    longer = Exemplar(one.courses, measures, one.apart, one.own)
    assert np.isfinite(background_of(longer))


def test_made_up_movement_depends_on_its_seed_alone():
    a, b = (made_up_movement(np.random.default_rng(7), duration_s=5.0) for _ in range(2))
    other = made_up_movement(np.random.default_rng(8), duration_s=5.0)
    assert np.array_equal(a.position_m, b.position_m)
    assert not np.array_equal(a.position_m, other.position_m)


@pytest.mark.parametrize("seed", range(5))
def test_made_up_movement_moves_as_hands_can(seed):
    motion = smooth(made_up_movement(np.random.default_rng(seed), duration_s=30.0))
    speed_m_s = np.linalg.norm(motion.velocity_m_s, axis=1)
    assert 0.01 < np.median(speed_m_s) < 2.0
    assert speed_m_s.max() < 12.0


def test_what_an_action_may_cost_follows_background_intent_and_tolerance():
    usual, own = np.array([8.0, 16.0]), np.array([True, False])
    drawn, free = (accepted_cost(np.log(usual), own, intent) for intent in Intent)
    assert (drawn > free).all()
    assert drawn[1] / usual[1] > drawn[0] / usual[0]  # another's way is not quite one's own
    margin = [OWN_MARGIN[Intent.FREE], OTHERS_MARGIN[Intent.FREE]]
    np.testing.assert_allclose(free, usual * np.exp(-np.array(margin)))
    half = accepted_cost(np.log(usual), own, Intent.FREE, tolerance=0.5)
    np.testing.assert_allclose(half, 0.5 * free)
