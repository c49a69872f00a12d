from __future__ import annotations

import numpy as np
import pytest

from smd.errors import DoodleError
from smd.recognition.alignment import align, distance, distance_table, distances, pair_distances
from tests.naive.warping import every_path, table_distance

BANDS = (None, 0.0, 0.1, 0.3, 1.0)


def courses(seed, most=12):
    rng = np.random.default_rng(seed)
    n, m = rng.integers(1, most, 2)
    d = int(rng.choice([1, 2, 6]))
    return rng.normal(size=(n, d)), rng.normal(size=(m, d))


def along(path, a, b):
    squares = ((a[path[:, 0]] - b[path[:, 1]]) ** 2).sum()
    return np.sqrt(squares / max(len(a), len(b)))


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("band", BANDS)
def test_the_distance_is_that_of_the_plain_table(seed, band):
    a, b = courses(seed)
    assert distance(a, b, band=band) == pytest.approx(table_distance(a, b, band), rel=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_no_path_at_all_is_nearer(seed):
    a, b = courses(seed, most=6)
    best = min(along(np.array(path), a, b) for path in every_path(len(a), len(b)))
    assert distance(a, b) == pytest.approx(best, rel=1e-12)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("band", BANDS)
def test_the_path_has_the_distance_and_is_a_pairing(seed, band):
    a, b = courses(seed)
    found = align(a, b, band=band)
    assert found.distance == pytest.approx(distance(a, b, band=band), rel=1e-12)
    assert along(found.path, a, b) == pytest.approx(found.distance, rel=1e-12)
    assert found.path[0].tolist() == [0, 0]
    assert found.path[-1].tolist() == [len(a) - 1, len(b) - 1]
    assert {tuple(step) for step in np.diff(found.path, axis=0)} <= {(0, 1), (1, 0), (1, 1)}


@pytest.mark.parametrize("seed", range(10))
def test_the_distance_does_not_depend_on_the_order_of_the_two(seed):
    a, b = courses(seed)
    assert distance(a, b) == pytest.approx(distance(b, a), rel=1e-12)


def test_a_course_that_lingers_is_the_same_course():
    a = np.random.default_rng(1).normal(size=(20, 3))
    assert distance(a, np.repeat(a, 3, axis=0)) == 0.0


def test_a_constant_offset_is_the_distance():
    a = np.zeros((30, 2))
    assert distance(a, np.add(a, [3.0, 4.0])) == pytest.approx(5.0)


def test_several_at_once_are_as_one_by_one():
    rng = np.random.default_rng(2)
    a, others = rng.normal(size=(9, 4)), [rng.normal(size=(n, 4)) for n in (1, 5, 20)]
    assert distances(a, others).tolist() == [distance(a, b) for b in others]
    assert distances(a, []).shape == (0,)


def test_read_only_and_strided_arrays_are_read():
    a = np.random.default_rng(3).normal(size=(8, 6))
    a.flags.writeable = False
    assert distance(a[::2, ::3], a[::2, ::3]) == 0.0
    with pytest.raises(ValueError, match="read-only"):
        align(a, a).path[0] = 1


@pytest.mark.parametrize(
    ("a", "b", "band", "message"),
    [
        (np.zeros(3), np.zeros((3, 1)), None, r"a: expected shape \(any, any\)"),
        (np.zeros((2, 2)), np.zeros((0, 2)), None, r"b: expected shape .* got \(0, 2\)"),
        (np.zeros((2, 2)), np.zeros((2, 3)), None, "b: expected 2 numbers a sample as in a, got 3"),
        (np.full((2, 2), np.nan), np.zeros((2, 2)), None, r"a: .* finite .* index \(0, 0\)"),
        (np.zeros((2, 2)), np.zeros((2, 2)), 1.5, r"band: expected a share in \[0, 1\], got 1.5"),
    ],
)
def test_what_does_not_fit_is_refused(a, b, band, message):
    with pytest.raises(DoodleError, match=message):
        distance(a, b, band=band)


def test_pairs_are_as_far_as_in_the_table():
    rng = np.random.default_rng(5)
    a, b = rng.normal(size=(6, 20, 3)), rng.normal(size=(5, 20, 3))
    b.flags.writeable = False
    table = distance_table(a, b, band=0.25)
    i, j = np.array([5, 0, 3, 3]), np.array([4, 1, 1, 0])
    assert np.array_equal(pair_distances(a[i], b[j], band=0.25), table[i, j])
    assert pair_distances(a[:0], b[:0]).shape == (0,)
