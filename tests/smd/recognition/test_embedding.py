from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.geometry.rotations import (
    IDENTITY_XYZW,
    multiply,
    normalized,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
)
from smd.recognition.embedding import (
    PoseSequence,
    embed_poses,
    extent_m,
    heading_frame,
    sample_poses,
    scaled,
    seen_from,
)
from smd.synthetic.person import STEADY
from smd.synthetic.takes import Take

UP = [0.0, 1.0, 0.0]


def random_poses(rng, n=20):
    return PoseSequence(rng.normal(size=(n, 3)), normalized(rng.normal(size=(n, 4))))


def moved(poses, by_m, turn_xyzw):
    return PoseSequence(
        rotate(turn_xyzw, poses.position_m) + by_m, multiply(turn_xyzw, poses.orientation_xyzw)
    )


def doodle(action):
    return Take(STEADY, np.random.default_rng(0)).play(action).exact_doodle()


@pytest.mark.parametrize("angle", [0.0, 1e-3, 0.5, 2.0, np.pi])
def test_two_orientations_are_apart_by_twice_the_sine_of_half_their_angle(angle):
    rng = np.random.default_rng(0)
    q, axis = normalized(rng.normal(size=4)), rng.normal(size=3)
    turned = -multiply(q, quaternion_about(axis, angle))
    points = embed_poses(
        PoseSequence(np.zeros((2, 3)), np.stack([q, turned])), metres_per_radian=0.3
    )
    apart = np.linalg.norm(points[1] - points[0])
    assert apart == pytest.approx(0.3 * 2.0 * np.sin(angle / 2.0), abs=1e-12)


def test_positions_and_orientations_add_in_squares():
    poses = PoseSequence(
        np.array([[0.0, 0, 0], [3.0, 0, 0]]), np.stack([IDENTITY_XYZW, [1.0, 0, 0, 0]])
    )
    points = embed_poses(poses, metres_per_radian=2.0)
    assert np.linalg.norm(points[1] - points[0]) == pytest.approx(5.0)


@pytest.mark.parametrize("seed", range(5))
def test_distances_do_not_depend_on_the_world(seed):
    rng = np.random.default_rng(seed)
    poses, turn = random_poses(rng), normalized(rng.normal(size=4))
    a, b = embed_poses(poses), embed_poses(moved(poses, rng.normal(size=3), turn))
    apart = [np.linalg.norm(p[:, None] - p[None], axis=-1) for p in (a, b)]
    np.testing.assert_allclose(*apart, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_in_the_heading_frame_a_turn_about_up_does_not_matter_and_others_do(seed):
    rng = np.random.default_rng(seed)
    small = quaternion_from_rotvec(0.3 * rng.normal(size=(20, 3)))
    poses = PoseSequence(rng.normal(size=(20, 3)), small)
    for axis, alike in ((UP, True), ([1.0, 0.0, 0.0], False)):
        other = moved(poses, rng.normal(size=3), quaternion_about(axis, 1.0))
        a, b = (embed_poses(seen_from(p, heading_frame(p))) for p in (poses, other))
        assert np.allclose(a, b, atol=1e-12) == alike


def test_the_heading_frame_faces_ahead_with_the_prop_and_stays_upright():
    turned = np.stack([quaternion_about(UP, a) for a in (0.2, 0.6)])
    frame = heading_frame(PoseSequence(np.zeros((2, 3)), turned))
    np.testing.assert_allclose(frame, quaternion_about(UP, 0.4), atol=1e-12)


def test_the_heading_of_a_full_turn_is_the_first():
    angles = np.linspace(0.0, 2.0 * np.pi, 50, endpoint=False) + 0.7
    turning = np.stack([quaternion_about(UP, a) for a in angles])
    frame = heading_frame(PoseSequence(np.zeros((50, 3)), turning))
    np.testing.assert_allclose(frame, quaternion_about(UP, 0.7), atol=1e-12)


def test_samples_are_even_in_time_and_hold_both_ends():
    time_s = np.array([5.0, 5.1, 7.0])
    uneven = Doodle(time_s, time_s[:, None] * [1.0, 0.0, 0.0], np.tile(IDENTITY_XYZW, (3, 1)))
    poses = sample_poses(uneven, 5)
    np.testing.assert_allclose(poses.position_m[:, 0], [5.0, 5.5, 6.0, 6.5, 7.0])
    assert poses.orientation_xyzw.shape == (5, 4)


def test_the_extent_is_free_of_place_and_grows_with_size():
    poses = random_poses(np.random.default_rng(0))
    extent = extent_m(poses)
    assert extent_m(moved(poses, [1.0, 2.0, 3.0], IDENTITY_XYZW)) == pytest.approx(extent)
    assert extent_m(scaled(poses, 3.0)) == pytest.approx(3.0 * extent)
    assert extent_m(PoseSequence(np.array([[1.0, 0, 0], [-1.0, 0, 0]]), poses[1])) == pytest.approx(
        1.0
    )
