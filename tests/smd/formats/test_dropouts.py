from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from smd.doodle import Dropout
from smd.formats.dropouts import Tracking, find_dropouts
from smd.geometry.rotations import quaternion_about

RATE_HZ = 90.0


def sway(n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A hand that swings to and fro at up to 1 m/s and turns."""
    t = np.arange(n) / RATE_HZ
    position = np.stack([0.2 * np.sin(5 * t), 1.0 + 0.05 * np.cos(3 * t), 0.1 * t], axis=1)
    return t, position, quaternion_about([0, 1, 0], np.sin(2 * t))


def found(t, position, q, valid=None) -> Tracking:
    return find_dropouts("prop", t, position, q, np.ones(len(t), bool) if valid is None else valid)


def test_a_whole_recording_is_one_stretch_without_dropouts():
    t, position, q = sway(400)
    tracking = found(t, position, q)
    assert tracking.dropouts == ()
    assert_array_equal(tracking.stretches[0], np.arange(400))


@pytest.mark.parametrize(("lost", "bridged"), [(12, True), (21, True), (22, False), (60, False)])
def test_missing_rows_are_a_gap_bridged_up_to_a_quarter_of_a_second(lost, bridged):
    t, position, q = sway(400)
    keep = np.r_[0:100, 100 + lost : 400]
    tracking = found(t[keep], position[keep], q[keep])
    assert tracking.dropouts == (Dropout("prop", t[99], t[100 + lost], "gap", bridged),)
    assert len(tracking.stretches) == (1 if bridged else 2)


@pytest.mark.parametrize(("lost", "bridged"), [(1, True), (20, True), (40, False)])
def test_poses_that_are_no_numbers_are_left_out(lost, bridged):
    t, position, q = sway(400)
    position[100 : 100 + lost] = np.nan
    tracking = found(t, position, q, ~np.isnan(position[:, 0]))
    assert tracking.dropouts == (Dropout("prop", t[99], t[100 + lost], "invalid", bridged),)
    assert_array_equal(np.concatenate(tracking.stretches), np.r_[0:100, 100 + lost : 400])


@pytest.mark.parametrize(("lost", "bridged"), [(15, True), (40, False)])
def test_rows_frozen_while_the_hand_moves_on_are_lost_but_for_the_first(lost, bridged):
    t, position, q = sway(400)
    position[100 : 101 + lost], q[100 : 101 + lost] = position[100], q[100]
    tracking = found(t, position, q)
    assert tracking.dropouts == (Dropout("prop", t[100], t[101 + lost], "frozen", bridged),)
    assert_array_equal(np.concatenate(tracking.stretches), np.r_[0:101, 101 + lost : 400])


def test_a_jump_to_a_stand_in_pose_is_lost_with_its_first_row():
    t, position, q = sway(400)
    position[100:103], q[100:103] = [-1.7, 1.6, 6.6], [0, 0, 0, 1]
    tracking = found(t, position, q)
    assert tracking.dropouts == (Dropout("prop", t[99], t[103], "frozen", True),)


@pytest.mark.parametrize("repeats", [2, 3])
def test_a_slow_tracker_that_repeats_rows_has_lost_nothing(repeats):
    t, position, q = sway(400)
    held = np.arange(400) // repeats * repeats
    assert found(t, position[held], q[held]).dropouts == ()


def test_thirty_minutes_of_stillness_are_not_a_loss():
    t = np.arange(30 * 60 * 30) / 30.0
    tracking = found(t, np.ones((len(t), 3)), np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1)))
    assert tracking.dropouts == ()
    assert len(tracking.stretches[0]) == len(t)


@pytest.mark.parametrize("speed_m_s", [0.3, 1.0, 3.0])
def test_strokes_that_stop_and_start_at_once_around_an_exact_pause_are_not_a_loss(speed_m_s):
    t = np.arange(300) / RATE_HZ
    along = speed_m_s * (np.clip(t, 0, 1) + np.clip(t - 2, 0, None))
    q = np.tile([0.0, 0.0, 0.0, 1.0], (300, 1))
    assert found(t, along[:, None] * [1.0, 0.0, 0.0], q).dropouts == ()


def rest_then_go(n: int, speed_m_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A prop that lies still for half a second and then moves at once."""
    t = np.arange(n) / RATE_HZ
    along = speed_m_s * np.clip(t - 0.5, 0.0, None)
    return t, along[:, None] * [1.0, 0.0, 0.0], np.tile([0.0, 0.0, 0.0, 1.0], (n, 1))


def test_a_slow_tracker_that_rests_has_lost_nothing():
    t, position, q = rest_then_go(200, 1.0)
    held = np.arange(200) // 2 * 2
    assert found(t, position[held], q).dropouts == ()


def test_stamps_that_jitter_do_not_make_jumps():
    t, position, q = rest_then_go(200, 0.8)
    moved = np.flatnonzero(position[:, 0])[0]
    t[moved - 1] += 0.008  # the next stamp comes 3 ms later, its pose a whole step
    assert found(t, position, q).dropouts == ()


def test_a_glimpse_between_two_losses_counts_as_lost():
    t, position, q = sway(400)
    keep = np.r_[0:100, 150:155, 200:400]
    tracking = found(t[keep], position[keep], q[keep])
    assert [len(stretch) for stretch in tracking.stretches] == [100, 200]
    assert tracking.dropouts == (Dropout("prop", t[99], t[200], "gap", False),)


def test_losses_at_the_ends_are_reported_and_split_nothing():
    t, position, q = sway(400)
    valid = np.ones(400, bool)
    valid[:10] = valid[-20:] = False
    tracking = found(t, position, q, valid)
    assert tracking.dropouts == (
        Dropout("prop", t[0], t[10], "invalid", False),
        Dropout("prop", t[379], t[399], "invalid", False),
    )
    assert_array_equal(tracking.stretches[0], np.arange(10, 380))
