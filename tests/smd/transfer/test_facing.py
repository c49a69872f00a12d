from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.geometry.rotations import heading_rad, quaternion_about
from smd.pipeline import animate
from smd.score import Part, Phrase, Score
from smd.transfer.facing import STILL_M_S, by_path, held, tangents
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Repertoire
from smd.transfer.timeline import Span

TIME_S = np.linspace(0.0, 8.0, 481)


def walked(make_piece, position_m, name="walk", **how):
    """What a performer that travels all along a path faces, while its prop faces backwards."""
    piece = make_piece(name, ahead_m=1.4, travels=True, cyclic=True, **how)
    path = GroundPath(TIME_S, position_m, np.full(len(TIME_S), np.pi))
    spans = [Span(0.0, 8.0, Phrase(name, 0.0, 8.0))]
    return by_path(path, spans, Repertoire({name: piece}, ())).heading_rad


def apart_rad(a, b):
    return np.abs(np.angle(np.exp(1j * (np.asarray(a) - b))))


@pytest.mark.parametrize("angle_rad", np.linspace(-3.0, 3.0, 7))
def test_along_a_straight_line_it_faces_ahead(make_piece, angle_rad):
    way = TIME_S[:, None] * [np.sin(angle_rad), np.cos(angle_rad)]
    assert apart_rad(walked(make_piece, way)[60:], angle_rad).max() < 1e-9


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_round_a_circle_it_faces_along_the_tangent(make_piece, sense):
    turned = sense * TIME_S
    circle = 1.5 * np.stack([1.0 - np.cos(turned), np.sin(turned)], axis=-1) * [1.0, 1.0]
    # d/dt of it is (sin, cos): the heading is the angle itself, more than a whole turn of it.
    heading = walked(make_piece, circle * [sense, sense])
    error = heading[60:-60] - turned[60:-60]
    assert np.abs(error - 2.0 * np.pi * np.round(error / (2.0 * np.pi))).max() < 0.01
    assert np.ptp(heading[60:-60]) == pytest.approx(np.ptp(turned[60:-60]), abs=0.02)


def test_through_a_stop_it_holds(make_piece):
    way = np.where(TIME_S < 3.0, TIME_S, np.where(TIME_S < 5.0, 3.0, TIME_S - 2.0))
    rng = np.random.default_rng(1)
    tremor = rng.normal(0.0, 0.001, (len(TIME_S), 2)) * (np.abs(TIME_S - 4.0) < 0.9)[:, None]
    heading = walked(make_piece, way[:, None] * [1.0, 0.0] + tremor)
    assert apart_rad(heading[60:], 0.5 * np.pi).max() < 1e-6


def test_at_a_cusp_it_turns_round_once_and_smoothly(make_piece):
    way = np.abs(TIME_S - 4.0)
    heading = walked(make_piece, way[:, None] * [0.0, -1.0])[120:]
    assert abs(heading[-1] - heading[0]) == pytest.approx(np.pi, abs=1e-6)
    step = np.diff(heading) * np.sign(heading[-1] - heading[0])
    assert step.min() > -1e-9
    assert step.max() * 60.0 < 9.0


def test_it_turns_to_where_the_path_goes_on_before_it_does():
    known = (TIME_S < 2.0) | (TIME_S > 5.0)
    heading = held(TIME_S, np.where(TIME_S > 3.0, 1.0, 0.0), known, first_rad=0.0)
    assert heading[TIME_S < 4.0] == pytest.approx(0.0, abs=1e-3)
    assert heading[TIME_S > 5.0] == pytest.approx(1.0, abs=0.06)


def test_where_nothing_travels_it_faces_as_the_prop_did_at_first(make_piece):
    piece = make_piece("wave")
    path = GroundPath(TIME_S, TIME_S[:, None] * [1.0, 0.0], 0.3 + 0.1 * TIME_S)
    spans = [Span(0.0, 8.0, Phrase("wave", 0.0, 8.0))]
    turned = by_path(path, spans, Repertoire({"wave": piece}, ()))
    assert turned.heading_rad == pytest.approx(0.3)
    assert (turned.position_m == path.position_m).all()


def test_a_path_slower_than_a_tremor_has_no_direction():
    path = GroundPath(TIME_S, TIME_S[:, None] * [0.9 * STILL_M_S, 0.0], 0.0 * TIME_S)
    assert not tangents(path)[1].any()


def test_clips_that_go_backwards_or_aside_are_turned_to_do_so(library):
    from smd.transfer.repertoire import piece_of

    own = [
        piece_of(library.clip(name), travels=True, legs=()).direction_rad
        for name in ("walk", "side_step_left", "side_step_right", "walk_backward")
    ]
    assert own[:3] == pytest.approx([0.0, 0.5 * np.pi, -0.5 * np.pi], abs=0.05)
    assert abs(own[3]) == pytest.approx(np.pi, abs=0.05)


@pytest.mark.parametrize(("heading", "expected"), [("prop", np.pi), ("path", 0.0)])
def test_animate_faces_by_the_prop_or_by_the_path(library, heading, expected):
    way = np.clip((TIME_S - 1.0) / 5.0, 0.0, 1.0)
    place = np.stack([0.0 * way, 0.8 + 0.0 * way, 0.8 * way], axis=-1)
    backwards = np.tile(quaternion_about([0.0, 1.0, 0.0], np.pi), (len(way), 1))
    recording = Recording((Doodle(TIME_S, place, backwards, "fox"),))
    score = Score((Part("fox", (Phrase("walk", 1.0, 6.0),)),))
    (actor,) = animate(score, recording, library, heading=heading).actors
    rows = slice(2 * 24, 5 * 24)
    assert apart_rad(heading_rad(actor.poses.rotation_xyzw[rows, 0]), expected).max() < 0.02


def test_a_heading_that_is_none_is_refused(library):
    doodle = Doodle([0.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0, 1.0]], "fox")
    with pytest.raises(TransferError, match=r"heading: expected prop or path, got 'camera'"):
        animate(Score((Part("fox"),)), Recording((doodle,)), library, heading="camera")
