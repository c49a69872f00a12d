from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.feet import (
    FootPath,
    OnBall,
    Plant,
    Via,
    foot_path,
    other_foot,
    repeated,
)
from actions_library.authoring.humanoid import LEGS, humanoid_skeleton
from actions_library.authoring.legs import foot_shape
from smd.geometry.rotations import rotate

SHAPE = foot_shape(humanoid_skeleton(), LEGS["left"])
STEP = [
    Plant(-9.0, 0.4, left=0.1, ahead=0.0, yaw=5.0, leave_pitch=60.0, roll=0.3),
    Plant(
        *(0.8, 9.0),
        left=0.2,
        ahead=0.7,
        yaw=20.0,
        land_pitch=-20.0,
        flat=0.1,
        swing=(Via(0.4, 0.15, pitch=20.0), Via(0.8, 0.05, pitch=-10.0)),
    ),
]
TIME_S = np.linspace(0.0, 1.2, 12_001)


@pytest.fixture(scope="module")
def path() -> FootPath:
    return foot_path(STEP, SHAPE, 1.0, TIME_S)


def ball(path: FootPath) -> np.ndarray:
    return path.ankle_m + rotate(path.rotation_xyzw, SHAPE.ball)


def test_the_ball_is_still_while_the_foot_rolls_over_it(path):
    standing = path.toes_down & (TIME_S < 0.5)
    assert np.ptp(ball(path)[standing], axis=0).max() < 1e-12
    assert np.ptp(path.ankle_m[standing, 1]) > 0.05


def test_the_heel_is_still_and_on_the_ground_while_the_foot_rolls_down(path):
    rolling = (TIME_S > 0.8) & (TIME_S < 0.9)
    heel = path.ankle_m + rotate(path.rotation_xyzw, SHAPE.heel)
    assert np.ptp(heel[rolling], axis=0).max() < 1e-12
    np.testing.assert_allclose(heel[rolling, 1], 0.0, atol=1e-12)
    assert not path.toes_down[rolling].any()


def test_the_toes_stay_flat_while_the_heel_rises(path):
    standing = path.toes_down & (TIME_S < 0.5)
    front = rotate(path.rotation_xyzw[standing], [0.0, 0.0, 1.0])
    np.testing.assert_allclose(np.arcsin(-front[:, 1]), path.toes_up_rad[standing], atol=1e-9)


def test_the_foot_leaves_and_lands_without_a_jolt(path):
    velocity = np.diff(path.ankle_m, axis=0) / np.diff(TIME_S)[:, None]
    jumps = np.linalg.norm(np.diff(velocity, axis=0), axis=-1)
    assert jumps.max() < 0.02


def test_the_swing_goes_through_its_vias(path):
    for via, time_s in zip(STEP[1].swing, (0.56, 0.72), strict=True):
        ankle = path.ankle_m[np.searchsorted(TIME_S, time_s)]
        assert ankle[1] == pytest.approx(SHAPE.ankle_height + via.up, abs=1e-3)
        assert ankle[2] == pytest.approx(0.7 * via.at, abs=1e-2)


def test_a_foot_on_its_ball_turns_about_it():
    keys = (OnBall(0.2, 0.0), OnBall(0.5, 30.0, turn=40.0), OnBall(0.8, 0.0))
    path = foot_path([Plant(-9.0, 9.0, 0.1, 0.0, on_ball=keys)], SHAPE, 1.0, TIME_S)
    assert np.ptp(ball(path), axis=0).max() < 1e-12
    assert path.toes_down.all()
    assert path.sole_down[[0, -1]].all()
    assert not path.sole_down[5000]


def test_the_other_foot_s_path_is_the_mirror_image(path):
    mirror = np.array([-1.0, 1.0, 1.0])
    right = foot_path(
        [other_foot(plant) for plant in STEP],
        foot_shape(humanoid_skeleton(), LEGS["right"]),
        -1.0,
        TIME_S,
    )
    np.testing.assert_allclose(right.ankle_m * mirror, path.ankle_m, atol=1e-12)


def test_repeated_plants_go_on_before_and_after_the_cycle():
    plants = repeated([Plant(0.0, 0.6, left=0.1, ahead=0.2)], 1.0, left=0.0, ahead=1.4)
    assert [plant.land for plant in plants] == [-2.0, -1.0, 0.0, 1.0, 2.0]
    assert np.diff([plant.ahead for plant in plants]) == pytest.approx([1.4] * 4)
