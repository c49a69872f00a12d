from __future__ import annotations

import numpy as np
import pytest

from smd.acting.move import Placement
from smd.transfer.in_place import (
    facing,
    gesture,
    idling,
    turn,
    turn_passes,
    turns,
    whole_cycles,
)
from smd.transfer.pacing import Pacing, paced
from smd.transfer.repertoire import Piece

AT = Placement(np.array([3.0, -2.0]), 0.5)


def within(piece: Piece, start_s: float, end_s: float) -> Pacing:
    return paced(piece.clip, piece.near, start_s, end_s, pause_s=0.0)


def test_a_gesture_lasts_exactly_its_span_and_plays_its_clip_once(make_piece):
    piece = make_piece(frames=91)
    move = gesture(piece, within(piece, 2.0, 3.3), AT)
    assert move.time_s[[0, -1]].tolist() == [2.0, 3.3]
    assert move.frame[[0, -1]].tolist() == [0.0, 90.0]
    assert np.diff(move.frame) == pytest.approx(np.full(len(move.frame) - 1, move.frame[1]))


def test_a_gesture_stays_and_keeps_its_heading(make_piece):
    piece = make_piece()
    move = gesture(piece, within(piece, 0.0, 1.0), AT)
    assert (move.root_m == AT.position_m).all()
    assert (move.heading_rad == 0.5).all()


def test_a_step_that_a_gesture_takes_is_taken_where_the_character_faces(make_piece):
    piece = make_piece(ahead_m=0.4)
    move = gesture(piece, within(piece, 0.0, 1.0), AT)
    step = move.end.position_m - AT.position_m
    assert step == pytest.approx(0.4 * np.array([np.sin(0.5), np.cos(0.5)]))


@pytest.mark.parametrize(("duration_s", "cycles"), [(0.3, 1), (1.0, 1), (2.4, 2), (2.6, 3)])
def test_a_cyclic_gesture_repeats_as_often_as_its_time_allows(make_piece, duration_s, cycles):
    piece = make_piece(frames=61, cyclic=True)
    move = gesture(piece, whole_cycles(piece, 0.0, duration_s), AT)
    assert move.frame[-1] == pytest.approx(60.0 * cycles)


def test_a_turn_goes_as_far_as_it_is_told_on_the_clip_s_own_course(make_piece):
    piece = make_piece(turn_rad=1.6, stages=(0.2, 0.4, 0.8, 0.9))
    assert turns(piece)
    move = turn(piece, within(piece, 1.0, 2.0), AT, 1.2)
    assert move.heading_at(np.array([1.0, 1.4, 1.6, 1.8, 2.0])) - 0.5 == pytest.approx(
        [0.0, 0.0, 0.6, 1.2, 1.2], abs=1e-9
    )


@pytest.mark.parametrize("prop_rad", [0.4, 1.6, 2.3, 3.1, 6.2, -1.0, 0.0, 0.1])
def test_passes_add_up_to_the_prop_s_turn_or_else_to_the_clip_s(make_piece, prop_rad):
    passes = turn_passes(make_piece(turn_rad=1.6), prop_rad)
    assert sum(passes) == pytest.approx(prop_rad if prop_rad > np.radians(15.0) else 1.6)
    assert max(passes) <= 1.5 * 1.6 + 1e-9


def test_a_clip_that_hardly_turns_is_no_turn(make_piece):
    assert not turns(make_piece(turn_rad=0.2))


def test_idling_stays_and_faces_the_next_phrase_before_it_begins(make_piece):
    move = idling(make_piece(cyclic=True), 1.0, 5.0, AT, facing(1.0, 1.0, 5.0), clock_s=0.0)
    assert (move.root_m == AT.position_m).all()
    assert move.heading_at(np.array([1.0, 4.0])) == pytest.approx([0.5, 0.5])
    assert move.heading_at(np.array([4.76, 5.0])) == pytest.approx([1.5, 1.5])


def test_idling_goes_on_all_the_while(make_piece):
    move = idling(make_piece(cyclic=True), 1.0, 5.0, AT, facing(0.0, 1.0, 5.0), clock_s=-2.0)
    assert move.frame[[0, -1]] == pytest.approx([180.0, 420.0])


def test_idling_for_no_time_at_all_is_finite(make_piece):
    move = idling(make_piece(cyclic=True), 1.0, 1.0, AT, facing(0.4, 1.0, 1.0), clock_s=1.0)
    for values in (move.root_m, move.heading_rad, move.frame, move.presence):
        assert np.isfinite(values).all()
