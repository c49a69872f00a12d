"""A fold that travels along a body: closed forms of its stride and height."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import j0

from actions_library.authoring.fold import Fold

LENGTH_M = 1.0


def test_a_body_that_keeps_its_length_gets_ahead_by_what_its_arch_takes_up():
    # the mean of cos(a sin x) over a period is the Bessel function J0(a)
    for angle_deg in (20.0, 45.0, 70.0):
        fold = Fold(angle_deg, 0.0, 0.5, 0.8, LENGTH_M)
        extent_m = 0.5 * LENGTH_M / 0.8
        exact_m = extent_m * (1.0 - j0(np.radians(angle_deg)))
        assert fold.stride_m == pytest.approx(exact_m, rel=0.02)  # its ends are softened


def test_a_body_that_only_shortens_gets_ahead_by_what_it_shortens_and_does_not_rise():
    fold = Fold(0.0, 0.4, 0.5, 0.8, LENGTH_M)
    exact_m = 0.5 * 0.4 * (0.5 * LENGTH_M / 0.8)  # half of the crest's, over the fold's extent
    assert fold.stride_m == pytest.approx(exact_m, rel=0.05)  # its ends are softened
    assert fold.height_m == pytest.approx(0.0, abs=1e-12)


def test_neighbours_stay_as_far_apart_as_the_body_is_long_there():
    fold = Fold(50.0, 0.0, 0.5, 0.8, LENGTH_M)
    along = np.linspace(0.0, 1.0, 2001)
    for cycle in (0.3, 0.7, 1.1):
        ahead, up = fold.moved_m(cycle - fold.lag * along)
        step = np.hypot(np.diff(along + ahead), np.diff(up))
        np.testing.assert_allclose(step, 1.0 / 2000, rtol=2e-3)


def test_a_place_stands_still_outside_the_fold_and_is_a_stride_ahead_after_it():
    fold = Fold(40.0, 0.2, 0.4, 0.8, LENGTH_M)
    before, up_before = fold.moved_m(np.linspace(-0.3, -0.1, 20))
    after, up_after = fold.moved_m(np.linspace(0.5, 0.9, 20))
    np.testing.assert_allclose(before, 0.0, atol=1e-9)
    np.testing.assert_allclose(after, fold.stride_m, atol=1e-9)
    np.testing.assert_allclose([up_before, up_after], 0.0, atol=1e-9)


def test_each_cycle_goes_on_from_the_one_before():
    fold = Fold(40.0, 0.2, 0.4, 0.8, LENGTH_M)
    phase = np.linspace(-1.0, 1.0, 101)
    ahead, up = fold.moved_m(phase)
    later, up_later = fold.moved_m(phase + 1.0)
    np.testing.assert_allclose(later - ahead, fold.stride_m, atol=1e-9)
    np.testing.assert_allclose(up_later, up, atol=1e-9)


def test_the_whole_body_travels_evenly_when_one_fold_leaves_as_the_next_begins():
    fold = Fold(40.0, 0.2, 0.4, 1.0, LENGTH_M)
    along = (np.arange(400) + 0.5) / 400
    cycles = np.linspace(0.0, 1.0, 101)
    mean_m = fold.moved_m(cycles[:, None] - fold.lag * along)[0].mean(axis=1)
    np.testing.assert_allclose(np.diff(mean_m), fold.stride_m / 100, rtol=1e-2)


def test_folds_that_overlap_are_refused():
    with pytest.raises(ValueError, match="part: expected at most"):
        Fold(40.0, 0.2, 0.8, 0.8, LENGTH_M)
