from __future__ import annotations

import functools

import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression
from threadpoolctl import threadpool_info, threadpool_limits

from laban import LabanError
from laban.description import DESCRIPTION_NAMES, FAMILIES
from laban.model import effort_of
from laban.model_file import effort_model_to_json
from laban.own import OwnMeasure
from laban.size import resized
from laban.training import entries_of, train, values_in

D = len(DESCRIPTION_NAMES)
SPEED = DESCRIPTION_NAMES.index("log_rms_speed")
ROUND = DESCRIPTION_NAMES.index("log_roundness")


@functools.cache
def speedy():
    """Takes whose poles are told by speed, and what is learned from them."""
    described, meant, performers = crowd()
    described[:, SPEED] += 4.0 * meant
    return described, meant, train(described, {"time": meant}, performers, trained_on="test")


def crowd(seed=0, *, people=6, takes=6):
    """Noise for descriptions, and poles in turn."""
    rng = np.random.default_rng(seed)
    performers = np.repeat([f"p{i}" for i in range(people)], takes)
    meant = np.tile([-1.0, 1.0], people * takes // 2)
    return rng.normal(size=(len(meant), D)), meant, performers


def test_what_tells_the_poles_apart_is_found():
    described, meant, training = speedy()
    assert training.alone["time"].accuracy > 0.95
    assert sum(training.model.alone.axes["time"].members.values()) == pytest.approx(1, abs=0.01)
    for description, pole in zip(described, meant, strict=True):
        assert effort_of(description, training.model).time * pole > 0.0


def test_labels_without_a_trace_are_told_no_better_than_by_chance():
    accuracies = []
    for seed in range(100, 104):
        described, meant, performers = crowd(seed, people=5, takes=8)
        training = train(described, {"time": meant}, performers, trained_on="test")
        accuracies.append(training.alone["time"].accuracy)
    # 160 takes: chance alone stays within 3 standard deviations of 0.04
    assert abs(np.mean(accuracies) - 0.5) < 0.12


def test_what_only_gives_a_performer_away_does_not_count():
    """Each performer has an entry of their own that tells their poles, as no other's does."""
    described, meant, performers = crowd()
    columns = [DESCRIPTION_NAMES.index(name) for name in FAMILIES["vigour"]]
    for i, name in enumerate(np.unique(performers)):
        mine = performers == name
        described[mine, columns[i % len(columns)]] += 5.0 * meant[mine] * (-1.0) ** i + 6.0
    training = train(described, {"time": meant}, performers, trained_on="test")
    assert training.alone["time"].accuracy < 0.75


def test_people_whose_middles_differ_are_told_against_their_own_takes():
    described, meant, performers = crowd(takes=8)
    middles = 4.0 * np.arange(6)[np.unique(performers, return_inverse=True)[1]]
    described[:, SPEED] = 0.3 * described[:, SPEED] + middles + 3.0 * meant
    training = train(described, {"time": meant}, performers, trained_on="test")
    assert training.alone["time"].accuracy < 0.75
    assert training.own["time"].accuracy > 0.9


def test_only_labelled_axes_are_trained_and_each_on_its_own_takes():
    described, meant, performers = crowd(people=5)
    described[:, SPEED] += 5.0 * meant
    half = np.arange(len(meant)) < 24
    labels = {
        "time": meant,
        "weight": np.where(half, meant, np.nan),
        "space": np.full(len(meant), np.nan),
    }
    model = train(described, labels, performers, trained_on="test").model
    assert tuple(model.axes) == ("time", "weight")
    assert model.axes["weight"].examples == (12, 0, 12)
    assert model.axes["weight"].performers == 4
    assert model.alone.states is None  # no take is sudden and light


def test_neutral_takes_calibrate_and_do_not_train():
    described, meant, performers = crowd(takes=9)
    meant = np.tile([-1.0, 0.0, 1.0], len(meant) // 3)
    described[:, SPEED] += 3.0 * meant
    training = train(described, {"time": meant}, performers, trained_on="test")
    poles = meant != 0
    without = train(described[poles], {"time": meant[poles]}, performers[poles], trained_on="")
    # the same direction but for the scale of the entries, which neutral takes share
    ours, theirs = (t.model.alone for t in (training, without))
    speed = [reader.entries.columns.tolist().index(SPEED) for reader in (ours, theirs)]
    assert all(
        np.argmax(np.abs(reader.axes["time"].classifier.weight)) == column
        for reader, column in zip((ours, theirs), speed, strict=True)
    )
    reading = training.alone["time"].reading
    assert abs(reading[meant == 0].mean()) < 0.15
    assert reading[meant > 0].mean() > 0.5
    assert reading[meant < 0].mean() < -0.5


def test_joint_states_are_trained_where_both_axes_have_poles():
    described, _, performers = crowd(people=4, takes=40)
    time, weight = np.tile([-1.0, -1, 1, 1], 40), np.tile([-1.0, 1, -1, 1], 40)
    described[:, SPEED] += 5.0 * time
    described[:, ROUND] += 5.0 * weight
    training = train(described, {"time": time, "weight": weight}, performers, trained_on="test")
    assert training.model.alone.states is not None
    assert training.model.alone.states.held_out_accuracy > 0.7
    chances = training.model.alone.chances(described[3])
    assert chances.sum() == pytest.approx(1.0)
    assert chances.argmax() == 3  # sudden and strong


def blas_threads() -> set[int]:
    libraries = [each for each in threadpool_info() if each["user_api"] == "blas"]
    if not libraries:
        pytest.skip("no BLAS whose threads can be counted, as Apple's")
    return {each["num_threads"] for each in libraries}


def test_training_reckons_with_one_thread_and_leaves_threads_as_they_were(monkeypatch):
    described, meant, performers = crowd(people=3)
    during, fit = set(), LogisticRegression.fit

    def watched(self, *arguments, **options):
        during.update(blas_threads())
        return fit(self, *arguments, **options)

    monkeypatch.setattr(LogisticRegression, "fit", watched)
    with threadpool_limits(limits=2, user_api="blas"):
        before = blas_threads()
        train(described, {"time": meant}, performers, trained_on="test")
        after = blas_threads()
    assert before == after == {2}
    assert during == {1}


def test_training_twice_gives_the_same_model():
    described, meant, performers = crowd(people=4)
    models = [
        train(described, {"flow": meant}, performers, trained_on="test").model for _ in range(2)
    ]
    assert effort_model_to_json(models[0]) == effort_model_to_json(models[1])


def test_the_unit_of_an_entry_that_has_no_size_does_not_matter():
    described, meant, performers = crowd(people=4)
    named = ("log_roundness", "log_flatness", "slow_share", "spectral_arc_length", "time_to_peak")
    columns = [DESCRIPTION_NAMES.index(name) for name in named]
    described[:, ROUND] += 2.0 * meant
    scale, shift = np.random.default_rng(1).uniform(0.1, 10.0, (2, len(columns)))
    other = described.copy()
    other[:, columns] = scale * described[:, columns] + shift
    a, b = (
        train(rows, {"time": meant}, performers, trained_on="").alone["time"].reading
        for rows in (described, other)
    )
    np.testing.assert_allclose(a, b, atol=1e-5)


def test_own_takes_are_read_against_themselves_and_a_little_of_a_typical_person():
    described, _, performers = crowd(people=3)
    whose = np.unique(performers, return_inverse=True)[1]
    entries = entries_of(described, whose, against=True)
    mine = described[whose == 1]
    mean = mine.mean(axis=0)
    size = entries.sizes.of(mean)
    as_usual = resized(mine, np.full(6, -size))[:, entries.columns]
    middle = resized(mean, -size)[entries.columns]
    expected = as_usual - (6.0 * middle + 2.0 * entries.typical) / 8.0
    np.testing.assert_allclose(values_in(entries, described, whose)[whose == 1], expected)
    np.testing.assert_allclose(entries.values(mine, OwnMeasure(mean, 6)), expected)


def test_what_is_unlike_all_that_was_learned_from_is_muted_and_keeps_its_sign():
    described, _, training = speedy()
    model = training.model
    assert model.alone.known(model.alone.entries.values(described[0])) > 0.5
    odd = 3.0 * np.random.default_rng(1).normal(size=D)
    readings = []
    for far in (0.0, 1.0, 3.0, 9.0):
        described_so = described[1] + far * np.where(np.arange(D) == SPEED, 0.0, odd)
        readings.append(effort_of(described_so, model).time)
    assert readings[0] > 0.5
    assert (np.diff(np.abs(readings)) < 0.0).all()
    assert abs(readings[-1]) < 0.1


def test_people_who_were_left_out_are_within_reach_in_19_of_20_takes():
    described, meant, performers = crowd(people=20, takes=20)
    model = train(described, {"time": meant}, performers, trained_on="test").model
    others = crowd(1, people=20, takes=20)[0]
    for reader in (model.alone,):
        known = np.array([reader.known(reader.entries.values(row)) for row in others])
        assert np.mean(known < 1.0) == pytest.approx(0.05, abs=0.04)


def test_too_few_performers_of_a_pole_are_said_so():
    described, meant, performers = crowd(people=4)
    meant[(meant > 0) & (performers > "p1")] = 0.0
    with pytest.raises(
        LabanError,
        match=r"time: expected 'sudden' takes of at least 3 performers, "
        r"got 2 \(p0, p1\)",
    ):
        train(described, {"time": meant}, performers, trained_on="test")


def test_one_class_only_is_said_so():
    described, meant, performers = crowd()
    with pytest.raises(LabanError, match="weight: expected 'light' takes of at least 3 performers"):
        train(described, {"weight": np.abs(meant)}, performers, trained_on="test")


def test_nothing_labelled_is_said_so():
    described, meant, performers = crowd()
    with pytest.raises(LabanError, match="at least one take with an Effort word"):
        train(described, {"time": np.nan * meant}, performers, trained_on="test")
