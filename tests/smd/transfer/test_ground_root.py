from __future__ import annotations

import numpy as np
import pytest

from smd.geometry.rotations import quaternion_about, rotate
from smd.transfer.ground_root import executed, turned


@pytest.mark.parametrize("angle_rad", [-2.5, 0.0, 0.4, 3.0])
def test_turning_over_the_ground_is_turning_about_y(angle_rad):
    place = np.random.default_rng(1).normal(size=(7, 3))
    about = np.broadcast_to(quaternion_about([0.0, 1.0, 0.0], angle_rad), (7, 4))
    assert turned(place[:, [0, 2]], angle_rad) == pytest.approx(
        rotate(about, place)[:, [0, 2]], abs=1e-12
    )


def test_a_ground_root_is_seen_from_its_first_frame(make_piece):
    root = make_piece(ahead_m=2.0, turn_rad=3.5 * np.pi).root
    assert root.position_m[0].tolist() == [0.0, 0.0]
    assert root.position_m[-1] == pytest.approx([0.0, 2.0])
    assert root.turn_rad == pytest.approx(3.5 * np.pi)
    assert root.position_at(np.array([30.0]))[0] == pytest.approx([0.0, 1.0])


def test_travel_is_done_in_the_execution_alone(make_piece):
    piece = make_piece(ahead_m=1.0, frames=101, stages=(0.1, 0.4, 0.7, 0.9))
    share = executed(piece.clip, piece.root)
    assert (share[:41] == 0.0).all()
    assert (share[70:] == 1.0).all()
    assert share[40:71] == pytest.approx(np.linspace(0.0, 1.0, 31))


def test_a_clip_without_travel_executes_evenly(make_piece):
    piece = make_piece(ahead_m=0.0, frames=101, stages=(0.1, 0.4, 0.7, 0.9))
    share = executed(piece.clip, piece.root)
    assert share[[40, 55, 70]] == pytest.approx([0.0, 0.5, 1.0])


def test_a_clip_without_execution_travels_all_the_time(make_piece):
    piece = make_piece(ahead_m=0.0, frames=101, stages=(0.0, 0.0, 0.0, 1.0))
    assert executed(piece.clip, piece.root)[[0, 50, 100]] == pytest.approx([0.0, 0.5, 1.0])
