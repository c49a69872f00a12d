from __future__ import annotations

import numpy as np
import pytest

from exporters.viewpoint import fitted


def seen(viewpoint, points: np.ndarray, aspect: float) -> np.ndarray:
    """Return where points are in the picture: (-1, 1) from edge to edge."""
    back = viewpoint.eye_m - viewpoint.target_m
    back /= np.linalg.norm(back)
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    frame = np.stack([right, np.cross(back, right), back])
    x, y, z = frame @ (points - viewpoint.eye_m).T
    assert (z < 0).all()
    tangent = np.tan(0.5 * viewpoint.view_angle_rad)
    return np.stack([x / -z / tangent / aspect, y / -z / tangent], axis=-1)


@pytest.mark.parametrize("seed", range(20))
def test_all_points_are_in_the_picture_and_touch_its_margin_on_both_sides(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(50, 3)) * rng.uniform(0.2, 3.0, 3) + rng.normal(size=3)
    aspect = rng.uniform(0.5, 2.0)
    away = [rng.normal(), rng.uniform(0.0, 0.5), rng.normal()]
    at = seen(fitted(points, away, aspect=aspect, fill=0.9), points, aspect)
    np.testing.assert_allclose(np.abs(at).max(), 0.9, rtol=1e-9)
    across = int(np.argmax(np.abs(at).max(axis=0)))
    np.testing.assert_allclose([at[:, across].min(), at[:, across].max()], [-0.9, 0.9], rtol=1e-9)


def test_width_is_that_of_a_ruler_at_the_target():
    points = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]])
    assert fitted(points, [0, 0, 1], aspect=1.0, fill=0.8).width_m == pytest.approx(2.5)


def test_a_single_point_is_seen_from_a_distance():
    viewpoint = fitted([[1.0, 2.0, 3.0]], [1.0, 0.2, 1.0], aspect=1.0)
    assert np.linalg.norm(viewpoint.eye_m - [1.0, 2.0, 3.0]) > 0.1
