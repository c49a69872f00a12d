from __future__ import annotations

import numpy as np
import pytest
from sklearn.naive_bayes import GaussianNB

from laban.committee import COUNT, ENTRY_NAMES, MEMBERS, PAIRS, convened, folds, temperature
from laban.linear import fit_shared_variance

SPEED = ENTRY_NAMES.index("log_rms_speed")
ROUND = ENTRY_NAMES.index("log_roundness")
EXTENT = ENTRY_NAMES.index("log_speed_over_extent")


def crowd(seed=0, *, people=6, takes=6):
    """Noise for entries and products, poles in turn, and whose takes they are."""
    rng = np.random.default_rng(seed)
    whose = np.repeat(np.arange(people), takes)
    return (
        seen(rng.normal(size=(len(whose), len(ENTRY_NAMES)))),
        np.tile([-1.0, 1.0], len(whose) // 2),
        whose,
    )


def seen(entries):
    """Return entries with their products."""
    return np.concatenate([entries, entries[:, PAIRS[:, 0]] * entries[:, PAIRS[:, 1]]], axis=1)


@pytest.mark.parametrize("seed", range(10))
def test_the_temperature_is_that_of_the_greatest_likelihood(seed):
    rng = np.random.default_rng(seed)
    goal = rng.choice([-1.0, 0.0, 1.0], 70)
    odds = rng.normal(3.0 * goal, 10.0)

    def loss(factor):
        """Count by count, neutral takes half for each pole, one more of each at even odds."""
        total = np.log1p(np.exp(-0.5 * factor)) + np.log1p(np.exp(0.5 * factor))
        for o, g in zip(factor * odds, goal, strict=True):
            total += 0.5 * (1 + g) * np.log1p(np.exp(-o)) + 0.5 * (1 - g) * np.log1p(np.exp(o))
        return total

    factor, least = temperature(odds, goal)
    assert least == pytest.approx(loss(factor))
    assert all(loss(other) >= least - 1e-9 for other in np.geomspace(0.02, 10.0, 125))


def test_log_odds_that_were_too_sure_are_made_as_sure_as_they_are_right():
    rng = np.random.default_rng(0)
    chance = rng.uniform(0.05, 0.95, 20_000)
    goal = np.where(rng.random(len(chance)) < chance, 1.0, -1.0)
    factor, _ = temperature(8.0 * np.log(chance / (1.0 - chance)), goal)
    assert factor == pytest.approx(1.0 / 8.0, rel=0.06)


def test_few_takes_leave_room_for_doubt():
    """Four takes, all told right, against a hundred."""
    odds, goal = np.array([-0.6, -0.3, 0.3, 0.6]), np.array([-1.0, -1.0, 1.0, 1.0])
    assert temperature(odds, goal)[0] < temperature(np.tile(odds, 25), np.tile(goal, 25))[0]


def test_misleading_log_odds_are_hardly_followed():
    assert temperature(np.linspace(-9, 9, 80), np.repeat([1.0, -1.0], 40))[0] == pytest.approx(0.02)


@pytest.mark.parametrize(("column", "family"), [(SPEED, "vigour"), (ROUND, "geometry")])
def test_the_family_that_tells_the_poles_apart_is_heard(column, family):
    entries, goal, whose = crowd()
    entries[:, column] += 4.0 * goal
    committee = convened(entries, goal, whose)
    others = {name for name in MEMBERS if family not in name and "everything" not in name}
    assert sum(committee.shares.get(name, 0.0) for name in others) < 0.05
    assert sum(committee.shares.values()) == pytest.approx(1.0)
    assert np.argmax(np.abs(committee.classifier.weight)) == column


def test_a_committee_is_what_its_members_say_times_their_shares():
    entries, goal, whose = crowd(1)
    entries[:, SPEED] += goal
    committee = convened(entries, goal, whose)
    assert len(committee.shares) > 1
    out = folds(whose)
    total, held_out = np.zeros(len(goal)), np.zeros(len(goal))
    for name, share in committee.shares.items():
        member = MEMBERS[name]
        odds = np.zeros(len(goal))
        for left in out:
            odds[left] = member.learned(entries[~left], goal[~left]).log_odds(entries[left])
        factor, _ = temperature(odds, goal)
        held_out += share * factor * odds
        total += share * factor * member.learned(entries, goal).log_odds(entries)
    sure, _ = temperature(held_out, goal)
    np.testing.assert_allclose(committee.classifier.log_odds(entries), sure * total, atol=1e-9)


def test_products_are_asked_where_there_are_takes_enough():
    """The poles are told by the sign of a product of two entries alone."""
    entries, goal, whose = crowd(people=8, takes=60)
    base = entries[:, : len(ENTRY_NAMES)]
    base[:, SPEED] = goal * np.sign(base[:, EXTENT]) * np.abs(base[:, SPEED])
    committee = convened(seen(base), goal, whose)
    assert next(iter(committee.shares)) == "products"
    few = convened(seen(base)[: COUNT - 1], goal[: COUNT - 1], whose[: COUNT - 1])
    assert "products" not in few.shares


def test_of_one_pole_nothing_is_learned():
    entries, goal, _ = crowd()
    learned = MEMBERS["vigour"].learned(entries, np.abs(goal))
    assert not learned.weight.any()
    assert learned.bias == 0.0


def test_naive_bayes_of_shared_variance_decides_as_gaussians_of_one_width():
    rng = np.random.default_rng(0)
    high = np.tile([False, True], 200)
    features = rng.normal(size=(400, 3)) * [1.0, 2.0, 0.1] + np.outer(high, [1.0, 1.0, 0.1])
    ours = fit_shared_variance(features, high)
    wide = GaussianNB().fit(features, high)
    wide.var_[:] = wide.var_.mean(axis=0)
    odds = np.diff(wide.predict_log_proba(features), axis=1)[:, 0]
    np.testing.assert_allclose(3.0 * ours.log_odds(features), odds, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("people", [4, 12, 13, 48])
def test_folds_leave_everybody_out_once_and_nobody_in_part(people):
    whose = np.random.default_rng(0).permutation(np.repeat(np.arange(people), 3))
    out = np.array(folds(whose))
    assert (out.sum(axis=0) == 1).all()
    for person in range(people):
        assert len(np.unique(out[:, whose == person], axis=1).T) == 1
    assert len(out) == (people if people <= 12 else 5)
