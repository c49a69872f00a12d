from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.waves import Wave


def test_a_wave_reaches_each_joint_later_by_the_part_of_its_length():
    turns = Wave("tail", "yaw", 10.0, wavelength=1.0).turns_deg(5, 101, 60.0, cyclic=True)
    for k in range(5):  # a joint a quarter of the chain on is a quarter of a period behind
        np.testing.assert_allclose(
            turns[25 * k : 100, k, 0], turns[: 100 - 25 * k, 0, 0], atol=1e-9
        )
    assert not turns[:, :, 1:].any()


def test_a_wave_in_a_cycle_ends_where_it_begins():
    turns = Wave("tail", "lean", 10.0, tip=30.0, per_cycle=2).turns_deg(4, 61, 60.0, cyclic=True)
    np.testing.assert_allclose(turns[0], turns[-1], atol=1e-9)
    assert np.abs(turns[:, -1, 1]).max() == pytest.approx(30.0, rel=0.02)


def test_a_wave_in_a_gesture_starts_and_ends_at_rest():
    turns = Wave("tail", "yaw", 10.0, per_cycle=3.5).turns_deg(4, 121, 60.0, cyclic=False)
    assert not turns[[0, -1]].any()


def test_a_cycle_takes_whole_periods():
    with pytest.raises(ValueError, match=r"a whole number in a cyclic clip, got 1\.5"):
        Wave("tail", "yaw", 10.0, per_cycle=1.5).turns_deg(4, 61, 60.0, cyclic=True)
