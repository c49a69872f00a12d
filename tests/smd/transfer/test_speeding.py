"""Speeding: a body's least time for a way, and the least change that gives it that time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from smd.geometry.easing import gaussian_smoothed
from smd.transfer.limits import Limits
from smd.transfer.speeding import STARTING_S, least_s, roundest, speeding, way_of_places

LIMITS = Limits()
ALONG_M_S2 = LIMITS.acceleration_m_s2 * np.sqrt(0.5)
"""Of the limit, along a path; as much is left across it."""

RATE_HZ = 60.0
CORNER_M = [[0.0, 0.0], [0.0, 2.0], [2.0, 2.0]]
CUSP_M = [[0.0, 0.0], [0.0, 2.0], [0.0, 0.5]]
ZIGZAG_M = [[0.0, 0.0], [0.3, 0.5], [-0.3, 1.0], [0.3, 1.5], [-0.3, 2.0], [0.0, 2.5]]
PATHS = {"corner": CORNER_M, "cusp": CUSP_M, "zigzag": ZIGZAG_M}


def along(corners_m, lasting_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times and places of a path that is drawn at an even speed."""
    corners_m = np.array(corners_m)
    time_s = np.linspace(0.0, lasting_s, max(round(RATE_HZ * lasting_s) + 1, 6))
    way_m = way_of_places(corners_m)
    gone_m = way_m[-1] * time_s / lasting_s
    return time_s, np.stack([np.interp(gone_m, way_m, axis) for axis in corners_m.T], axis=-1)


def circle(radius_m: float, turns: float = 1.0, places: int = 2001) -> np.ndarray:
    angle = np.linspace(0.0, 2.0 * np.pi * turns, places)
    return radius_m * np.stack([np.sin(angle), 1.0 - np.cos(angle)], axis=-1)


def speeds(time_s, place_m) -> np.ndarray:
    return np.linalg.norm(np.gradient(place_m, time_s, axis=0), axis=-1)


def pushes(time_s, place_m) -> np.ndarray:
    velocity = np.gradient(place_m, time_s, axis=0)
    return np.linalg.norm(np.gradient(velocity, time_s, axis=0), axis=-1)


def at_most(m_s: float, time_s) -> np.ndarray:
    return np.full(len(time_s), m_s)


@st.composite
def polylines(draw: st.DrawFn) -> np.ndarray:
    """Some corners, at least two of them 20 cm apart."""
    numbers = st.floats(-3.0, 3.0)
    corners_m = np.array(draw(st.lists(st.tuples(numbers, numbers), min_size=2, max_size=7)))
    assume(way_of_places(corners_m)[-1] > 0.2)
    return corners_m


@pytest.mark.parametrize("length_m", [0.2, 0.7, 2.0, 7.0, 20.0])
@pytest.mark.parametrize("top_m_s", [0.8, 2.0, 50.0])
def test_straight_ahead_from_rest_to_rest_the_least_time_is_a_trapezium_s(length_m, top_m_s):
    way = roundest(np.array([[0.0, 0.0], [0.6 * length_m, 0.8 * length_m]]), LIMITS)
    if top_m_s**2 / ALONG_M_S2 >= length_m:
        expected_s = 2.0 * np.sqrt(length_m / ALONG_M_S2)
    else:
        expected_s = length_m / top_m_s + top_m_s / ALONG_M_S2
    assert least_s(way, top_m_s, LIMITS) == pytest.approx(expected_s, rel=0.01)


@pytest.mark.parametrize("radius_m", [0.5, 1.0, 2.0, 4.0])
def test_a_circle_takes_as_long_as_its_bend_allows(radius_m):
    """Across: v² / r; the way up to this speed and down from it is along a trapezium."""
    exact = replace(LIMITS, detour=1e-6)
    way = roundest(circle(radius_m, turns=3.0), exact)
    top_m_s = np.sqrt(ALONG_M_S2 * radius_m)
    expected_s = 6.0 * np.pi * radius_m / top_m_s + top_m_s / ALONG_M_S2
    assert least_s(way, 50.0, exact) == pytest.approx(expected_s, rel=0.02)


@pytest.mark.parametrize("radius_m", [0.5, 1.0, 2.0])
def test_nobody_runs_round_a_circle_faster_than_it_bends(radius_m):
    lasting_s = 2.0 * np.pi * radius_m / (0.75 * np.sqrt(LIMITS.acceleration_m_s2 * radius_m))
    time_s = np.linspace(0.0, lasting_s + 2.0, round(RATE_HZ * lasting_s))
    place_m = circle(radius_m, places=len(time_s))
    _, gone_m = speeding(time_s, place_m, at_most(9.0, time_s), LIMITS)
    fastest = np.sqrt(LIMITS.acceleration_m_s2 * radius_m)
    assert speeds(time_s, gone_m).max() <= fastest * 1.02


@given(polylines(), st.floats(0.3, 6.0))
def test_there_and_back_again_take_equally_long(corners_m, top_m_s):
    _, place_m = along(corners_m, 5.0)
    # A cusp lies between two of the centimetres, one way or the other.
    there, back = (roundest(way_m, LIMITS) for way_m in (place_m, place_m[::-1]))
    assert least_s(there, top_m_s, LIMITS) == pytest.approx(
        least_s(back, top_m_s, LIMITS), rel=0.01
    )


@given(polylines(), st.floats(0.3, 6.0), st.floats(1.0, 3.0))
def test_who_may_do_more_never_needs_longer(corners_m, top_m_s, more):
    way = roundest(along(corners_m, 5.0)[1], LIMITS)
    needed_s = least_s(way, top_m_s, LIMITS)
    stronger = replace(LIMITS, acceleration_m_s2=more * LIMITS.acceleration_m_s2)
    assert least_s(way, top_m_s, stronger) <= needed_s + 1e-9
    assert least_s(way, more * top_m_s, LIMITS) <= needed_s + 1e-9
    assert needed_s >= way.length_m / top_m_s - 1e-9


@given(polylines(), st.floats(0.01, 0.3), st.floats(0.01, 0.5))
def test_a_rounded_path_keeps_its_ends_its_length_and_its_place(corners_m, detour, shortening):
    limits = replace(LIMITS, detour=detour, shortening=shortening)
    place_m = along(corners_m, 5.0)[1]
    whole_m = way_of_places(place_m)[-1]
    way = roundest(place_m, limits)
    at_m = way_of_places(place_m)
    drawn_m = np.stack([np.interp(way.gone_m, at_m, axis) for axis in place_m.T], axis=-1)
    off_m = np.sqrt(np.mean(np.sum((way.place_m - drawn_m) ** 2, axis=-1)))
    assert off_m <= detour * whole_m + 1e-3
    # Places 1 cm apart cut off corners a little themselves.
    assert way.length_m >= (1.0 - shortening) * way_of_places(drawn_m)[-1] - 0.02
    assert way.place_m[[0, -1]] == pytest.approx(place_m[[0, -1]], abs=1e-9)


def test_without_any_detour_a_path_stays_as_it_was_drawn():
    place_m = along(ZIGZAG_M, 5.0)[1]
    way = roundest(place_m, replace(LIMITS, detour=1e-9))
    at_m = way_of_places(place_m)
    drawn_m = np.stack([np.interp(way.gone_m, at_m, axis) for axis in place_m.T], axis=-1)
    assert way.place_m == pytest.approx(drawn_m, abs=1e-9)
    assert roundest(place_m, LIMITS).length_m < way.length_m - 0.1


@given(polylines(), st.floats(0.1, 12.0), st.floats(0.2, 8.0))
def test_ends_are_kept_and_time_never_goes_back(corners_m, lasting_s, top_m_s):
    time_s, place_m = along(corners_m, lasting_s)
    shown_s, gone_m = speeding(time_s, place_m, at_most(top_m_s, time_s), LIMITS)
    assert shown_s.shape == time_s.shape and gone_m.shape == place_m.shape
    assert np.isfinite(shown_s).all() and np.isfinite(gone_m).all()
    assert (np.diff(shown_s) >= 0.0).all()
    assert shown_s[[0, -1]] == pytest.approx(time_s[[0, -1]], abs=1e-9)
    assert gone_m[[0, -1]] == pytest.approx(place_m[[0, -1]], abs=1e-6)


@given(polylines(), st.floats(0.5, 8.0), st.floats(-3.0, 3.0))
def test_a_turned_path_is_gone_alike(corners_m, lasting_s, angle):
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    time_s, place_m = along(corners_m, lasting_s)
    top = at_most(3.137, time_s)
    one = speeding(time_s, place_m, top, LIMITS)
    other = speeding(time_s, place_m @ turn + [1.0, -2.0], top, LIMITS)
    # A path of whole centimetres may be cut into one step more.
    assert other[1] == pytest.approx(one[1] @ turn + [1.0, -2.0], abs=1e-3)
    assert other[0] == pytest.approx(one[0], abs=5e-3)


@pytest.mark.parametrize("name", PATHS)
def test_with_time_enough_neither_speed_nor_push_is_over_its_limit(name):
    time_s, place_m = along(PATHS[name], 9.0)
    _, gone_m = speeding(time_s, place_m, at_most(1.5, time_s), LIMITS)
    assert speeds(time_s, gone_m).max() <= 1.5
    assert pushes(time_s, gone_m).max() <= LIMITS.acceleration_m_s2


@pytest.mark.parametrize("lasting_s", [4.5, 9.0])
@pytest.mark.parametrize("name", PATHS)
def test_what_a_hand_drew_gently_is_not_pushed_harder_than_limits_say(name, lasting_s):
    time_s, place_m = along(PATHS[name], lasting_s)
    place_m = gaussian_smoothed(place_m, 0.2 * RATE_HZ)
    assert pushes(time_s, place_m).max() < LIMITS.acceleration_m_s2
    _, gone_m = speeding(time_s, place_m, at_most(9.0, time_s), LIMITS)
    assert pushes(time_s, gone_m).max() <= LIMITS.acceleration_m_s2


@pytest.mark.parametrize("name", PATHS)
def test_a_corner_is_pushed_through_less_than_it_was_drawn(name):
    time_s, place_m = along(PATHS[name], 3.0)
    _, gone_m = speeding(time_s, place_m, at_most(9.0, time_s), LIMITS)
    assert pushes(time_s, gone_m).max() < 0.3 * pushes(time_s, place_m).max()


def test_what_a_body_can_do_keeps_its_place_and_nearly_its_times():
    time_s = np.linspace(0.0, 5.0, 301)
    way = 0.5 - 0.5 * np.cos(np.pi * time_s / 5.0)
    place_m = np.stack([0.6 * way, 0.8 * way], axis=-1)
    shown_s, gone_m = speeding(time_s, place_m, at_most(3.0, time_s), LIMITS)
    assert np.abs(shown_s - time_s).max() <= 0.5 * STARTING_S
    shown_m = np.stack([np.interp(shown_s, time_s, axis) for axis in place_m.T], axis=-1)
    assert gone_m == pytest.approx(shown_m, abs=1e-3)


@pytest.mark.parametrize("corners_m", [[[0.0, 0.0], [60.0, 0.0]], 24.0 * np.array(ZIGZAG_M)])
def test_sixty_metres_in_a_second_are_gone_in_numbers(corners_m):
    time_s, place_m = along(corners_m, 1.0)
    shown_s, gone_m = speeding(time_s, place_m, at_most(4.0, time_s), LIMITS)
    assert np.isfinite(shown_s).all() and np.isfinite(gone_m).all()
    assert gone_m[[0, -1]] == pytest.approx(place_m[[0, -1]], abs=1e-6)
    # There is no way to be there in time but as fast as the mean asks.
    assert speeds(time_s, gone_m).max() < 3.0 * way_of_places(place_m)[-1]
    way = roundest(place_m, LIMITS)
    assert least_s(way, 4.0, LIMITS) > way.length_m / 4.0


def test_a_path_that_goes_nowhere_is_left_alone():
    time_s = np.linspace(0.0, 2.0, 121)
    place_m = np.tile([1.0, -2.0], (121, 1))
    shown_s, gone_m = speeding(time_s, place_m, at_most(4.0, time_s), LIMITS)
    assert (shown_s == time_s).all() and (gone_m == place_m).all()
    assert roundest(place_m, LIMITS) is None


def test_a_prop_that_waits_on_its_way_is_still_gone_with():
    time_s, place_m = along(CORNER_M, 4.0)
    held = np.minimum(np.arange(len(time_s)), 100)
    shown_s, gone_m = speeding(time_s, place_m[held], at_most(4.0, time_s), LIMITS)
    assert np.isfinite(shown_s).all() and np.isfinite(gone_m).all()
    assert gone_m[-1] == pytest.approx(place_m[100], abs=1e-6)
