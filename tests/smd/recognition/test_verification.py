"""Verification: what is left out to save time changes no sum that is of interest."""

import numpy as np
import pytest

from smd.recognition import verification as module
from smd.recognition.exemplar import BAND, exemplar_of, faced
from smd.recognition.traits import COURSES, SAMPLES, Traits
from smd.recognition.verification import (
    GLANCE,
    GLIMPSE,
    GLIMPSE_COURSES,
    GLIMPSE_ROOM,
    WEIGHTS,
    Verification,
)
from tests.naive.warping import table_distance

WIDTHS = (12, 12, 6, 6)


def traits_at_random(rng, count, like=None, noise=1.0):
    """Smooth courses; near those of one gesture where that is given."""
    courses = []
    for i, width in enumerate(WIDTHS):
        own = np.cumsum(rng.normal(scale=0.15, size=(count, SAMPLES, width)), axis=1)
        courses.append(own if like is None else like.courses[i] + noise * own)
    measures = rng.normal(scale=0.3, size=(count, 4))
    return Traits(tuple(courses), measures if like is None else like.measures + noise * measures)


def one(traits, i):
    return Traits(tuple(course[i] for course in traits.courses), traits.measures[i])


@pytest.fixture(scope="module")
def problem():
    rng = np.random.default_rng(17)
    typical = traits_at_random(rng, 3)
    exemplars = []
    for i, count in enumerate((3, 1, 2)):
        examples = traits_at_random(rng, count, one(typical, i), noise=0.2)
        own = [0] if count == 3 else False  # one of three is the performer's own
        exemplars.append(exemplar_of([one(examples, j) for j in range(count)], own=own))
    gestures = [traits_at_random(rng, 2, one(typical, i), noise=0.3) for i in range(3)]
    stacked = Traits(
        tuple(np.concatenate([g.courses[i] for g in gestures]) for i in range(len(WIDTHS))),
        np.concatenate([g.measures for g in gestures]),
    )
    gesture, action = (each.ravel() for each in np.meshgrid(range(6), range(3), indexing="ij"))
    wrong = rng.uniform(0.0, 1.0, len(action))
    return Verification(tuple(exemplars)), stacked, action, gesture, wrong


def naive_terms(verification, gestures, action, gesture, wrong, every):
    rows = []
    for a, g, share in zip(action, gesture, wrong, strict=True):
        exemplar = verification.exemplars[a]
        row = [WEIGHTS[0] * share]
        for i, name in enumerate(COURSES):
            course = gestures.courses[i][g]
            if name == "shape_heading":
                course = faced(course[None], exemplar.central)[0]
            near = min(
                factor * table_distance(course[::every], example[::every], BAND)
                for example, factor in zip(exemplar.courses[name], exemplar.factor, strict=True)
            )
            row.append(WEIGHTS[1 + i] * near / exemplar.scale[i])
        z = (gestures.measures[g] - exemplar.centre) / exemplar.spread
        rows.append([*row, *(WEIGHTS[5:] * 2.5 * np.log(1.0 + z**2 / 4.0))])
    return np.array(rows)


@pytest.mark.parametrize("every", [1, GLANCE])
def test_the_terms_are_those_of_the_plain_formula_and_bounds_drop_only_what_is_above(
    problem, every, monkeypatch
):
    verification, gestures, action, gesture, wrong = problem
    expected = naive_terms(*problem, every)
    total = expected.sum(axis=1)
    mixed = np.random.default_rng(1).permutation(len(action))
    for pairs, most in ((4096, np.full(len(total), np.inf)), (4, 1.0001 * total), (7, 0.9 * total)):
        monkeypatch.setattr(module, "PAIRS", pairs)
        most = np.where(np.arange(len(total)) % 2, most, np.median(total))
        found = verification.terms(
            gestures,
            action[mixed],
            gesture[mixed],
            wrong=wrong[mixed],
            most=most[mixed],
            every=every,
        )
        within = (total <= most)[mixed]
        np.testing.assert_allclose(found[within], expected[mixed][within], rtol=1e-9)
        assert (found[~within].sum(axis=1) > most[mixed][~within]).all()


def test_measures_alone_cost_what_they_cost_among_the_terms(problem):
    verification, gestures, action, gesture, _ = problem
    expected = naive_terms(*problem, 1)[:, 5:].sum(axis=1)
    found = verification.measured(gestures.measures)
    np.testing.assert_allclose(found[gesture, action], expected, rtol=1e-9)


def test_what_is_promising_at_a_glimpse_follows_from_the_plain_formula(problem, monkeypatch):
    verification, gestures, action, gesture, _ = problem
    seen = Traits(tuple(c[:, ::GLIMPSE] for c in gestures.courses), gestures.measures)
    expected = verification.measured(gestures.measures)[gesture, action]
    for name in GLIMPSE_COURSES:
        i = COURSES.index(name)
        for pair, (a, g) in enumerate(zip(action, gesture, strict=True)):
            exemplar, course = verification.exemplars[a], seen.courses[i][g]
            if name == "shape_heading":
                course = faced(course[None], exemplar.central[::GLIMPSE])[0]
            near = min(
                factor * table_distance(course, example[::GLIMPSE], BAND)
                for example, factor in zip(exemplar.courses[name], exemplar.factor, strict=True)
            )
            expected[pair] += WEIGHTS[1 + i] * near / exemplar.scale[i]
    mixed = np.random.default_rng(1).permutation(len(action))
    for pairs, share in ((4096, 1.001), (4, 0.999), (7, 1.001), (5, np.inf), (5, 0.0)):
        monkeypatch.setattr(module, "PAIRS", pairs)
        most = np.where(np.arange(len(action)) % 2, share, 1.001) * expected / GLIMPSE_ROOM
        found = verification.promising(seen, action[mixed], gesture[mixed], most[mixed])
        np.testing.assert_array_equal(found, (GLIMPSE_ROOM * most >= expected)[mixed])
