from __future__ import annotations

import numpy as np
import pytest
from sklearn.naive_bayes import GaussianNB

from benchmarks.papers_effort import fit_naive_bayes, fit_papers_method, relevance


def examples(seed: int, n: int = 60, d: int = 7) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    high = rng.random(n) < 0.4
    spread = np.where(high[:, None], rng.uniform(0.5, 3.0, d), rng.uniform(0.5, 3.0, d))
    return rng.normal(high[:, None] * rng.normal(size=d), spread), high


@pytest.mark.parametrize("seed", range(5))
def test_log_odds_are_those_of_scikit_learn(seed):
    features, high = examples(seed)
    asked = np.random.default_rng(seed + 100).normal(0.0, 4.0, (20, features.shape[1]))
    theirs = GaussianNB().fit(features, high).predict_log_proba(asked)
    ours = fit_naive_bayes(features, high).log_odds(asked)
    np.testing.assert_allclose(ours, theirs[:, 1] - theirs[:, 0], rtol=1e-7, atol=1e-7)


def test_log_odds_are_the_prior_and_a_term_per_feature():
    features, high = examples(0)
    bayes = fit_naive_bayes(features, high)
    terms = bayes.log_odds_terms(features)
    np.testing.assert_allclose(
        bayes.log_odds(features), terms.sum(axis=1) + np.log(high.mean() / (~high).mean())
    )


def test_some_features_give_the_classifier_of_these_features():
    features, high = examples(1)
    chosen = np.array([4, 1])
    part = fit_naive_bayes(features, high).only(chosen)
    alone = fit_naive_bayes(features[:, chosen], high)
    np.testing.assert_allclose(part.mean, alone.mean)
    np.testing.assert_allclose(part.variance, alone.variance, rtol=1e-7)


def test_products_that_would_underflow_are_told_apart():
    features = np.repeat([[0.0], [1e-3], [900.0], [901.0]], 50, axis=1)
    bayes = fit_naive_bayes(features, np.array([False, False, True, True]))
    assert np.isfinite(bayes.log_odds(np.full((1, 50), 450.0))).all()


@pytest.mark.parametrize("seed", range(3))
def test_relevance_is_equations_2_to_5(seed):
    features, high = examples(seed)
    classes = [features[~high], features[high]]
    for f in range(features.shape[1]):
        total = sum(x for c in classes for x in c[:, f]) / len(features)
        means = [sum(c[:, f]) / len(c) for c in classes]
        between = sum(len(c) * (m - total) ** 2 for c, m in zip(classes, means, strict=True))
        within = sum((x - m) ** 2 for c, m in zip(classes, means, strict=True) for x in c[:, f])
        assert relevance(features, high)[f] == pytest.approx(between / within)


def test_a_feature_that_never_changes_is_not_relevant():
    features, high = examples(0)
    features[:, 2] = 5.0
    assert relevance(features, high)[2] == 0.0


def test_the_papers_method_takes_the_fewest_features_that_tell_the_poles():
    rng = np.random.default_rng(0)
    high = np.tile([False, True], 60)
    features = rng.normal(size=(120, 50))
    features[:, 7] += 6.0 * high
    features[:, 31] += 2.0 * high
    people = np.repeat(np.arange(6), 20)
    fitted = fit_papers_method(features, high, [people == p for p in range(6)])
    assert fitted.columns[:2].tolist() == [7, 31][: len(fitted.columns)]
    assert len(fitted.columns) < 10
    theirs = GaussianNB().fit(features[:, fitted.columns], high)
    np.testing.assert_array_equal(
        fitted.log_odds(features) > 0, theirs.predict(features[:, fitted.columns])
    )


def test_what_is_left_out_chooses_how_many():
    """A feature that is right about everybody but the ones who are left out is not enough."""
    rng = np.random.default_rng(1)
    high = np.tile([False, True], 60)
    people = np.repeat(np.arange(6), 20)
    features = rng.normal(0.0, 0.1, (120, 50))
    features[:, :6] += 10.0 * (people[:, None] == np.arange(6)) * high[:, None]
    features[:, 6] += 0.15 * high
    fitted = fit_papers_method(features, high, [people == p for p in range(6)])
    assert 6 in fitted.columns
