from __future__ import annotations

import numpy as np
import pytest

from smd.acting.move import Move, Placement
from smd.geometry.easing import smootherstep
from smd.transfer.pacing import paced
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Piece
from smd.transfer.travelling import along_path, leap

AT = Placement(np.array([3.0, -2.0]), 0.0)


@pytest.fixture(scope="module")
def walk(make_piece):
    return make_piece(
        "walk",
        frames=61,
        ahead_m=1.4,
        cyclic=True,
        travels=True,
        left_stands=(0.0, 0.6),
        right_stands=(0.5, 0.98),
    )


@pytest.fixture(scope="module")
def jump(make_piece):
    return make_piece("jump", frames=101, ahead_m=1.2, travels=True, stages=(0.1, 0.4, 0.7, 0.8))


@pytest.fixture(scope="module")
def bent_path() -> GroundPath:
    time_s = np.linspace(0.0, 8.0, 481)
    place = np.stack([2.0 * np.cos(0.5 * time_s), 2.0 * np.sin(0.5 * time_s)], axis=-1)
    return GroundPath(time_s, place, 0.3 * np.sin(time_s))


@pytest.mark.parametrize("seconds", [0.4, 1.0, 3.7])
def test_a_gait_goes_exactly_as_far_as_the_prop_did(walk, bent_path, seconds):
    move = along_path(walk, bent_path, 1.0, 1.0 + seconds, AT)
    went = move.end.position_m - AT.position_m
    assert went == pytest.approx(bent_path.at(1.0 + seconds) - bent_path.at(1.0), abs=1e-9)
    assert move.time_s[[0, -1]] == pytest.approx([1.0, 1.0 + seconds])


def test_a_gait_passes_the_places_of_its_path(walk, bent_path):
    move = along_path(walk, bent_path, 1.0, 5.0, AT)
    places = move.root_m - AT.position_m + bent_path.at(1.0)
    assert np.hypot(*places.T) == pytest.approx(np.full(len(places), 2.0), abs=1e-3)


def test_a_gait_goes_by_distance(walk, bent_path):
    move = along_path(walk, bent_path, 1.0, 5.0, AT)
    way = np.linalg.norm(np.diff(move.root_m, axis=0), axis=-1)
    frames = np.diff(move.frame)
    assert frames == pytest.approx(way * (frames.sum() / way.sum()), abs=1e-9)


def test_a_gait_begins_and_ends_where_its_feet_pass(walk, bent_path):
    for end_s in (1.5, 2.2, 3.1, 6.0):
        move = along_path(walk, bent_path, 1.0, end_s, AT)
        phases = [p.phase for p in walk.gait.passings]
        assert move.frame[0] / 60.0 == pytest.approx(phases[0])
        assert min(abs((move.frame[-1] / 60.0 - p + 0.5) % 1.0 - 0.5) for p in phases) < 0.02


def test_a_gait_cut_in_full_motion_begins_and_ends_at_rest(walk, straight_path):
    move = along_path(walk, straight_path, 2.0, 6.0, AT)
    speed = np.linalg.norm(np.diff(move.root_m, axis=0), axis=-1) * 120.0
    assert speed[[0, -1]].max() < 0.02
    assert speed.max() < 1.12
    assert move.presence[[0, -1]].tolist() == [0.0, 0.0]
    assert (move.presence[60:-60] > 0.999).all()


def test_a_gait_between_gaits_keeps_its_pace(walk, straight_path):
    move = along_path(walk, straight_path, 2.0, 6.0, AT, from_gait=True, into_gait=True)
    speed = np.linalg.norm(np.diff(move.root_m, axis=0), axis=-1) * 120.0
    assert speed == pytest.approx(np.ones(len(speed)), abs=1e-6)
    assert (move.presence > 0.999).all()


def test_a_pause_on_the_way_is_stood_through(walk):
    time_s = np.linspace(0.0, 6.0, 361)
    way = np.clip(time_s, 0.0, 2.0) + np.clip(time_s - 4.0, 0.0, 2.0)
    path = GroundPath(time_s, np.stack([0.0 * way, way], axis=-1), 0.0 * way)
    move = along_path(walk, path, 0.0, 6.0, AT)
    assert move.presence_at(np.array([3.0])) == pytest.approx(0.0, abs=1e-6)
    assert np.diff(move.frame_at(np.array([2.5, 3.5]))) == pytest.approx(0.0, abs=1e-6)


def test_a_walk_that_goes_nowhere_is_walked_on_the_spot(walk):
    time_s = np.linspace(0.0, 6.0, 361)
    path = GroundPath(time_s, np.zeros((361, 2)), np.zeros(361))
    move = along_path(walk, path, 0.0, 6.0, AT)
    assert (move.root_m == AT.position_m).all()
    assert move.frame[-1] - move.frame[0] == pytest.approx(360.0)
    assert (move.presence == 1.0).all()


def test_flight_goes_by_time_and_takes_off_and_lands(make_piece, bent_path):
    fly = make_piece(
        "fly",
        frames=61,
        ahead_m=3.0,
        cyclic=True,
        travels=True,
        left_stands=(2.0, 3.0),
        right_stands=(2.0, 3.0),
    )
    move = along_path(fly, bent_path, 1.0, 4.2, AT)
    assert move.frame == pytest.approx(np.linspace(0.0, 180.0, len(move.frame)))
    assert move.presence[[0, -1]].tolist() == [0.0, 0.0]
    assert move.presence_at(np.array([1.6, 2.5, 3.6])) == pytest.approx(np.ones(3))


def jumped(jump: Piece, path: GroundPath, end_s: float, at: Placement) -> Move[Piece]:
    """Return a jump from 1 s on."""
    return leap(jump, path, paced(jump.clip, jump.near, 1.0, end_s, 0.0), end_s, at)


@pytest.mark.parametrize("seconds", [0.3, 1.0, 2.5])
def test_a_jump_moves_only_in_its_execution(jump, bent_path, seconds):
    move = jumped(jump, bent_path, 1.0 + seconds, AT)
    phase = move.frame / jump.last_frame
    assert (move.root_m[phase < 0.4] == move.root_m[0]).all()
    assert move.root_m[phase > 0.7] == pytest.approx(
        np.broadcast_to(move.root_m[-1], move.root_m[phase > 0.7].shape)
    )
    went = move.end.position_m - AT.position_m
    assert went == pytest.approx(bent_path.at(1.0 + seconds) - bent_path.at(1.0), abs=1e-9)


def test_a_jump_follows_its_path_re_timed_as_its_clip_travels(jump, bent_path):
    move = jumped(jump, bent_path, 3.0, AT)
    places = move.root_m - AT.position_m + bent_path.at(1.0)
    assert np.hypot(*places.T) == pytest.approx(np.full(len(places), 2.0), abs=1e-3)
    flying = (move.time_s > 1.81) & (move.time_s < 2.39)
    speed = np.linalg.norm(np.diff(move.root_m[flying], axis=0), axis=-1)
    assert speed == pytest.approx(np.full(len(speed), speed.mean()), rel=1e-2)


def test_a_jump_turns_in_the_air_as_the_prop_did(jump, straight_path):
    move = jumped(jump, straight_path, 3.0, Placement(np.zeros(2), 0.1))
    assert move.heading_at(np.array([1.0, 1.8])) == pytest.approx([0.1, 0.1])
    assert move.heading_at(np.array([2.4, 3.0])) == pytest.approx([0.3, 0.3])


def test_a_planned_flight_goes_as_its_path_does_and_gets_upright_slowly(make_piece):
    fly = make_piece(
        "fly",
        cyclic=True,
        travels=True,
        ahead_m=2.0,
        left_stands=(2.0, 3.0),
        right_stands=(2.0, 3.0),
    )
    time_s = np.linspace(0.0, 8.0, 961)
    way_m = 5.0 * smootherstep((time_s - 1.0) / 6.0)  # from rest to rest
    path = GroundPath(time_s, np.stack([0.0 * way_m, way_m], axis=-1), 0.0 * time_s)
    planned = along_path(fly, path, 1.0, 7.0, AT, standing_s=0.4)
    drawn = along_path(fly, path, 1.0, 7.0, AT)
    hurry = [np.abs(np.diff(move.root_m[:, 1], n=2)).max() for move in (planned, drawn)]
    at_s = planned.time_s
    went_m = planned.root_m[:, 1] - planned.root_m[0, 1]
    np.testing.assert_allclose(went_m, np.interp(at_s, time_s, way_m), atol=0.02)
    assert hurry[0] < hurry[1]
    standing_s = [(1.0 - move.presence).sum() / 120.0 for move in (planned, drawn)]
    assert standing_s[0] == pytest.approx(1.1, abs=0.02)  # half of it at either end
    assert standing_s[1] == pytest.approx(0.6, abs=0.02)
