from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.mass import (
    GRAVITY_M_S2,
    SEGMENTS,
    SIDES,
    centre_of_mass,
    zero_moment_point,
)


def test_the_segments_are_the_whole_body():
    shares = sum(share * (len(SIDES) if "{side}" in a + b else 1) for a, b, share, _ in SEGMENTS)
    assert shares == pytest.approx(1.0, abs=1e-3)


def test_the_mass_centre_goes_along_and_lies_in_the_middle_of_an_upright_body():
    skeleton = humanoid_skeleton()
    upright = skeleton.world_from_bind[None, :, :3, 3]
    moved = centre_of_mass(skeleton, upright + np.array([1.0, 2.0, 3.0]))
    centre = centre_of_mass(skeleton, upright)
    np.testing.assert_allclose(moved - centre, [[1.0, 2.0, 3.0]])
    assert centre[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert 0.54 < centre[0, 1] / 1.75 < 0.60  # men: 0.57 of their height


def test_the_force_of_the_ground_points_from_the_zero_moment_point_to_the_mass():
    rng = np.random.default_rng(1)
    centre, acceleration = rng.normal(size=(2, 50, 3)) + np.array(
        [[[0.0, 3.0, 0.0]], [[0.0, 0.0, 0.0]]]
    )
    at = zero_moment_point(centre, acceleration)
    arm = centre - np.column_stack([at[:, 0], np.zeros(50), at[:, 1]])
    force = acceleration + np.array([0.0, GRAVITY_M_S2, 0.0])
    np.testing.assert_allclose(np.cross(arm, force), 0.0, atol=1e-9)
