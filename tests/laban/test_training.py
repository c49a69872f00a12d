from __future__ import annotations

import numpy as np
import pytest

from laban import FEATURES, LabanError
from laban.features import FEATURE_NAMES
from laban.model import effort_model_to_json
from laban.training import train

D = len(FEATURES)


def crowd(seed=0, *, people=8, takes=6):
    """Noise for features, and poles in turn."""
    rng = np.random.default_rng(seed)
    performers = np.repeat([f"p{i}" for i in range(people)], takes)
    meant = np.tile([-1.0, 1.0], people * takes // 2)
    return rng.lognormal(size=(len(meant), D)), meant, performers


def test_the_features_that_tell_the_poles_apart_are_chosen():
    features, meant, performers = crowd()
    for column, gain in ((3, 6.0), (17, 4.0)):
        features[:, column] += gain * (meant > 0)
    training = train(features, {"time": meant}, performers, trained_on="test")
    chosen = training.model.axes["time"].columns
    assert {3, 17} & set(chosen[:2])
    assert len(chosen) < 10
    assert training.reports["time"].accuracy > 0.85


def test_labels_without_a_trace_in_the_features_are_told_no_better_than_by_chance():
    accuracies = []
    for seed in range(6):
        features, meant, performers = crowd(seed)
        report = train(features, {"time": meant}, performers, trained_on="test").reports["time"]
        accuracies.append(report.accuracy)
    # 288 takes: chance alone stays within 3 standard deviations of 0.03
    assert abs(np.mean(accuracies) - 0.5) < 0.09


def test_what_only_gives_a_performer_away_does_not_count():
    """Each performer has a feature of their own that tells their poles, as no other's does."""
    features, meant, performers = crowd()
    for i, name in enumerate(np.unique(performers)):
        own = performers == name
        features[own, i] += 5.0 * meant[own] * (-1.0) ** i + 6.0
    report = train(features, {"time": meant}, performers, trained_on="test").reports["time"]
    assert report.accuracy < 0.75


def test_only_labelled_axes_are_trained_and_each_on_its_own_takes():
    features, meant, performers = crowd()
    features[:, 5] += 5.0 * (meant > 0)
    half = np.arange(len(meant)) < 24
    labels = {
        "time": meant,
        "weight": np.where(half, meant, np.nan),
        "space": np.full(len(meant), np.nan),
    }
    model = train(features, labels, performers, trained_on="test").model
    assert tuple(model.axes) == ("time", "weight")
    assert model.axes["weight"].examples == (12, 0, 12)
    assert model.axes["weight"].performers == 4


def test_neutral_takes_calibrate_and_do_not_train():
    features, meant, performers = crowd(takes=9)
    meant = np.tile([-1.0, 0.0, 1.0], len(meant) // 3)
    features[:, 5] = 10.0 + 3.0 * meant + features[:, 5]
    with_neutral = train(features, {"time": meant}, performers, trained_on="test")
    poles = meant != 0
    without = train(features[poles], {"time": meant[poles]}, performers[poles], trained_on="test")
    ours, theirs = with_neutral.model.axes["time"], without.model.axes["time"]
    np.testing.assert_array_equal(ours.columns, theirs.columns)
    np.testing.assert_array_equal(ours.bayes.mean, theirs.bayes.mean)
    reading = with_neutral.reports["time"].reading
    assert abs(reading[meant == 0].mean()) < 0.15
    assert reading[meant > 0].mean() > 0.5
    assert reading[meant < 0].mean() < -0.5


def test_training_twice_gives_the_same_model():
    features, meant, performers = crowd()
    models = [
        train(features, {"flow": meant}, performers, trained_on="test").model for _ in range(2)
    ]
    assert effort_model_to_json(models[0]) == effort_model_to_json(models[1])


def test_the_unit_of_a_feature_does_not_matter():
    features, meant, performers = crowd()
    features[:, 5] += 5.0 * (meant > 0)
    scaled = features.copy()
    scaled[:, 5] *= 1000.0
    a, b = (train(x, {"time": meant}, performers, trained_on="") for x in (features, scaled))
    assert FEATURE_NAMES[a.model.axes["time"].columns[0]] == FEATURE_NAMES[5]
    np.testing.assert_allclose(a.reports["time"].reading, b.reports["time"].reading, atol=1e-3)


def test_too_few_performers_of_a_pole_are_said_so():
    features, meant, performers = crowd(people=4)
    meant[(meant > 0) & (performers > "p1")] = 0.0
    with pytest.raises(
        LabanError,
        match=r"time: expected 'sudden' takes of at least 3 performers, "
        r"got 2 \(p0, p1\)",
    ):
        train(features, {"time": meant}, performers, trained_on="test")


def test_one_class_only_is_said_so():
    features, meant, performers = crowd()
    with pytest.raises(LabanError, match="weight: expected 'light' takes of at least 3 performers"):
        train(features, {"weight": np.abs(meant)}, performers, trained_on="test")


def test_nothing_labelled_is_said_so():
    features, meant, performers = crowd()
    with pytest.raises(LabanError, match="at least one take with an Effort word"):
        train(features, {"time": np.nan * meant}, performers, trained_on="test")
