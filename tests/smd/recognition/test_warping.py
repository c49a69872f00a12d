"""Warping many courses at once: each is as far from the nearest example as the plain table says."""

import numpy as np
import pytest

from smd.recognition import warping
from smd.recognition.warping import Templates
from tests.naive.warping import table_distance


def courses_at_random(rng, count, samples, numbers):
    return np.cumsum(rng.normal(scale=0.3, size=(count, samples, numbers)), axis=1)


def nearest_by_tables(examples, courses, action, band, factors=None):
    factors = factors or [np.ones(len(each)) for each in examples]
    return np.array(
        [
            min(
                factor * table_distance(course, example, band)
                for example, factor in zip(examples[index], factors[index], strict=True)
            )
            for course, index in zip(courses, action, strict=True)
        ]
    )


@pytest.mark.parametrize(("samples", "band"), [(4, 0.25), (9, 0.25), (12, 0.6), (8, 1.0)])
@pytest.mark.parametrize("cells", [1, 1000, 1 << 20])
def test_the_nearest_is_as_near_as_by_the_plain_table(samples, band, cells, monkeypatch):
    monkeypatch.setattr(warping, "CELLS", cells)
    rng = np.random.default_rng(samples)
    examples = tuple(courses_at_random(rng, count, samples, 3) for count in (3, 1, 4))
    courses = courses_at_random(rng, 14, samples, 3)
    action = rng.integers(0, 3, len(courses))  # as it comes, not sorted
    expected = nearest_by_tables(examples, courses, action, band)
    found = Templates(examples, band).nearest(courses, action, np.full(len(courses), np.inf))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("count", [2, 5, 12])
def test_a_course_is_as_far_among_many_as_alone(count):
    rng = np.random.default_rng(6)  # fewer courses than examples, as many, more
    examples = Templates((courses_at_random(rng, 5, 12, 3),), 0.25)
    courses, free = courses_at_random(rng, count, 12, 3), np.full(count, np.inf)
    together = examples.nearest(courses, np.zeros(count, int), free)
    alone = [examples.nearest(one[None], np.zeros(1, int), free[:1])[0] for one in courses]
    assert np.array_equal(together, alone)


def test_an_example_is_as_far_as_its_factor_says():
    rng = np.random.default_rng(5)
    examples = tuple(courses_at_random(rng, count, 8, 3) for count in (3, 1, 4))
    courses, action = courses_at_random(rng, 30, 8, 3), rng.integers(0, 3, 30)
    factors = tuple(rng.uniform(1.0, 3.0, len(each)) for each in examples)
    expected = nearest_by_tables(examples, courses, action, 0.25, factors)
    far = Templates(examples, 0.25, factors)
    found = far.nearest(courses, action, np.full(30, np.inf))
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    assert np.array_equal(far.nearest(courses, action, found), found)
    assert (found > Templates(examples, 0.25).nearest(courses, action, np.full(30, np.inf))).any()


def test_what_is_farther_than_wanted_is_infinite_and_the_rest_as_before():
    rng = np.random.default_rng(1)
    examples = Templates(tuple(courses_at_random(rng, 5, 8, 2) for _ in range(3)), 0.25)
    courses, action = courses_at_random(rng, 40, 8, 2), np.repeat([0, 1, 2, 0], 10)
    free = examples.nearest(courses, action, np.full(40, np.inf))
    for most in (free, np.nextafter(free, 0.0), np.full(40, np.median(free)), np.full(40, -1.0)):
        bound = examples.nearest(courses, action, most)
        assert np.array_equal(bound, np.where(free <= most, free, np.inf))


@pytest.mark.parametrize("band", [0.25, 0.6])
def test_no_example_is_nearer_than_the_box_around_them_says(band):
    rng = np.random.default_rng(4)
    own = tuple(courses_at_random(rng, count, 9, 2) for count in (1, 3))
    examples, action = Templates(own, band), np.repeat([0, 1], 20)
    courses = 0.5 * courses_at_random(rng, 40, 9, 2)
    least = examples.at_least(courses, action)
    far = examples.nearest(courses, action, np.full(40, np.inf))
    assert (least <= far).all()
    assert (least > 0.3 * far).any()  # it says something
    assert (examples.at_least(own[1], np.ones(3, int)) == 0.0).all()


@pytest.mark.parametrize("offset", [0.0, 1.0, 100.0])
def test_single_precision_decides_nothing(offset):
    # Far from the origin, the squares of single precision are off by more than the distances.
    rng = np.random.default_rng(2)
    course = courses_at_random(rng, 1, 8, 3) + offset
    examples = course + 1e-5 * rng.normal(size=(6, 8, 3))
    expected = nearest_by_tables((examples,), course, [0], 0.25)
    found = Templates((examples,), 0.25).nearest(course, np.array([0]), np.array([np.inf]))
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_an_example_is_no_distance_from_itself_and_nothing_from_nothing():
    rng = np.random.default_rng(3)
    own = courses_at_random(rng, 4, 8, 2)
    examples = Templates((own,), 0.25)
    assert np.array_equal(examples.nearest(own, np.zeros(4, int), np.zeros(4)), np.zeros(4))
    assert examples.nearest(own[:0], np.zeros(0, int), np.zeros(0)).shape == (0,)
    assert examples.at_least(own[:0], np.zeros(0, int)).shape == (0,)
