from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.geometry.rotations import multiply, quaternion_about, rotate
from smd.transfer.path import front_over_ground, ground_path
from smd.transfer.scene import SceneScale

STAGE = SceneScale(10.0, np.zeros(3))
UP, LEFT, AHEAD = [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]


def stroke(seed: int = 0, start_s: float = 0.0, seconds: float = 3.0) -> Doodle:
    rng = np.random.default_rng(seed)
    time_s = start_s + np.arange(round(seconds * 90)) / 90.0
    place = sum(
        0.1 * rng.normal(size=3) * np.sin(w * time_s + rng.uniform(0, 6))[:, None]
        for w in (0.7, 1.5)
    )
    yaw = 0.8 * np.sin(1.2 * time_s) + rng.uniform(-3, 3)
    pitch = 0.2 * np.sin(0.9 * time_s)
    q = multiply(quaternion_about(UP, yaw), quaternion_about(LEFT, pitch))
    return Doodle(time_s, place, q)


def turned(doodle: Doodle, angle_rad: float) -> Doodle:
    about = quaternion_about(UP, angle_rad)
    return Doodle(
        doodle.time_s,
        rotate(np.broadcast_to(about, (len(doodle), 4)), doodle.position_m),
        multiply(about, doodle.orientation_xyzw),
    )


@pytest.mark.parametrize("seed", range(5))
def test_a_path_turns_with_the_world(seed):
    angle = 1.3
    path, other = (ground_path([d], STAGE) for d in (stroke(seed), turned(stroke(seed), angle)))
    sine, cosine = np.sin(angle), np.cos(angle)
    matrix = np.array([[cosine, sine], [-sine, cosine]])
    assert other.position_m == pytest.approx(path.position_m @ matrix.T, abs=1e-9)
    difference = other.heading_rad - path.heading_rad - angle
    assert difference - 2 * np.pi * np.round(difference / (2 * np.pi)) == pytest.approx(
        np.zeros(len(difference)), abs=1e-9
    )


def test_a_path_is_the_doodle_seen_from_above_at_stage_scale():
    doodle = stroke()
    path = ground_path([doodle], STAGE)
    at = np.linspace(0.5, 2.5, 40)
    wanted = [10.0 * np.interp(at, doodle.time_s, doodle.position_m[:, axis]) for axis in (0, 2)]
    assert path.at(at) == pytest.approx(np.stack(wanted, axis=-1), abs=0.01)


def test_raising_the_prop_changes_nothing():
    doodle = stroke()
    lifted = doodle.position_m + np.sin(doodle.time_s)[:, None] * UP
    raised = Doodle(doodle.time_s, lifted, doodle.orientation_xyzw)
    assert ground_path([raised], STAGE).position_m == pytest.approx(
        ground_path([doodle], STAGE).position_m, abs=1e-12
    )


@pytest.mark.parametrize("pitch_deg", [-85, -60, -20, 0, 35, 80, 90, 100, 115])
@pytest.mark.parametrize("yaw_rad", [-2.0, 0.0, 1.1])
def test_a_pitched_prop_faces_where_it_would_face_when_level(pitch_deg, yaw_rad):
    q = multiply(quaternion_about(UP, yaw_rad), quaternion_about(LEFT, np.radians(pitch_deg)))
    x, z = front_over_ground(q)
    assert np.arctan2(x, z) == pytest.approx(yaw_rad, abs=1e-9)


@pytest.mark.parametrize("roll_deg", [-80, -30, 45])
def test_a_rolled_prop_faces_where_it_would_face_when_level(roll_deg):
    q = multiply(quaternion_about(UP, 0.7), quaternion_about(AHEAD, np.radians(roll_deg)))
    x, z = front_over_ground(q)
    assert np.arctan2(x, z) == pytest.approx(0.7, abs=1e-9)


def test_the_heading_of_a_prop_that_nods_through_the_vertical_stays():
    time_s = np.arange(300) / 90.0
    nod = quaternion_about(LEFT, np.radians(110.0) * np.sin(np.pi * time_s / 3.3) ** 2)
    q = multiply(np.broadcast_to(quaternion_about(UP, 0.4), nod.shape), nod)
    path = ground_path([Doodle(time_s, np.zeros((300, 3)), q)], STAGE)
    assert path.heading_rad == pytest.approx(np.full(len(path.heading_rad), 0.4), abs=1e-6)


def test_a_whole_turn_is_counted():
    time_s = np.arange(360) / 90.0
    q = quaternion_about(UP, 2.0 * np.pi * time_s / time_s[-1] + 3.0)
    path = ground_path([Doodle(time_s, np.zeros((360, 3)), q)], STAGE)
    assert path.heading_rad[-1] - path.heading_rad[0] == pytest.approx(2.0 * np.pi, abs=1e-2)


def test_where_tracking_was_lost_the_path_stays_and_goes_on_from_there():
    first, second = stroke(1), stroke(2, start_s=5.0)
    path = ground_path([first, second], STAGE)
    assert path.at(5.0) == pytest.approx(path.at(first.time_s[-1]), abs=0.02)
    alone = ground_path([second], STAGE)
    assert path.at(7.0) - path.at(5.0) == pytest.approx(alone.at(7.0) - alone.at(5.0), abs=1e-9)
    gap = path.heading_rad[np.searchsorted(path.time_s, 4.0)] - path.heading_at(first.time_s[-1])
    assert abs(gap) <= np.pi + 1e-6


def test_a_doodle_of_one_sample_is_a_place_to_stand():
    path = ground_path([Doodle([2.0], [[0.1, 0.5, 0.2]], [[0.0, 0.0, 0.0, 1.0]])], STAGE)
    assert path.at([0.0, 2.0, 9.0]).tolist() == [[1.0, 2.0]] * 3
    assert path.heading_at(3.0) == 0.0
