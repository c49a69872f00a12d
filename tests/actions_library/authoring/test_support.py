from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.soles import ON_GROUND_M
from actions_library.authoring.support import support_of


def nearest_by_shares(points: np.ndarray, to: np.ndarray) -> np.ndarray:
    """The nearest mean of points, with shares of at least 0, by least squares."""
    from scipy.optimize import nnls

    firm = 1e4  # the shares add up to 1
    matrix = np.vstack([points.T, np.full(len(points), firm)])
    shares, _ = nnls(matrix, np.append(to, firm))
    return points.T @ shares / shares.sum()


@pytest.mark.parametrize("seed", range(20))
def test_the_nearest_place_is_the_nearest_mean_of_what_touches_the_ground(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 12))
    points = np.column_stack(
        [rng.normal(size=count), rng.uniform(0.0, 2.0 * ON_GROUND_M, count), rng.normal(size=count)]
    )
    points[0, 1] = 0.0
    low = points[points[:, 1] < ON_GROUND_M][:, [0, 2]]
    to = 1.5 * rng.normal(size=(40, 2))
    support = support_of(np.broadcast_to(points, (40, count, 3)))
    expected = np.array([nearest_by_shares(low, place) for place in to])
    np.testing.assert_allclose(support.nearest_m(to), expected, atol=1e-5)
    assert support.carries.all()


def test_frames_may_touch_with_different_points():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1.0]])
    up = square + np.array([0.0, 1.0, 0.0])
    points = np.stack([square, np.vstack([square[:2], up[2:]]), up])
    support = support_of(points)
    np.testing.assert_array_equal(support.carries, [True, True, False])
    at = np.full((3, 2), 0.75)
    np.testing.assert_allclose(support.nearest_m(at), [[0.75, 0.75], [0.75, 0.0], [0.75, 0.75]])


def test_an_area_shrinks_about_its_middle():
    corners = np.array([[[0, 0, 0], [2, 0, 0], [2, 0, 1], [0, 0, 1.0]]])
    small = support_of(corners).shrunk(0.5)
    np.testing.assert_allclose(small.nearest_m(np.array([[9.0, -9.0]])), [[1.5, 0.25]])
