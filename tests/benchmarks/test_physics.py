"""Physics is held against closed forms: a throw, a push, a pendulum, a body that stands."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.mass import centre_of_mass as centre_by_name
from actions_library.folder import load_library
from benchmarks.physics import (
    RATE_HZ,
    Mechanics,
    anatomy_of,
    centre_of_mass,
    mechanics_of,
    outside_m,
    pops_m,
    zero_moment_point_m,
)
from smd.character.kinematics import forward_kinematics
from smd.geometry.rotations import quaternion_about, rotate

G = 9.81
SKELETON = humanoid_skeleton()
ANATOMY = anatomy_of(SKELETON)
_, STANDING = forward_kinematics(SKELETON, SKELETON.rest_rotation_xyzw, SKELETON.rest_translation_m)
CENTRE = centre_of_mass(STANDING[None], ANATOMY)[0]
MIDDLE = slice(12, -12)
"""Frames that the filter's ends do not reach."""


def moved(way_m, rate_hz=RATE_HZ) -> Mechanics:
    """Return the mechanics of a body that is moved as a whole, without a joint turning."""
    way_m = np.asarray(way_m, dtype=np.float64)
    return mechanics_of(STANDING + way_m[:, None], np.arange(len(way_m)) / rate_hz, ANATOMY)


def along(axis: int, value) -> np.ndarray:
    way = np.zeros((len(value), 3))
    way[:, axis] = value
    return way


def test_the_anatomy_that_roles_find_is_the_one_that_names_say():
    assert {name: SKELETON.index(name) for name in ANATOMY.joint} == ANATOMY.joint
    assert ANATOMY.root == 0


def test_the_mass_centre_is_that_of_the_clips():
    clip = load_library().clip("slash")
    _, place = forward_kinematics(SKELETON, clip.rotation_xyzw, clip.translation_m)
    np.testing.assert_allclose(
        centre_of_mass(place, ANATOMY), centre_by_name(SKELETON, place), atol=1e-12
    )


def test_a_body_that_stands_is_over_its_feet_and_still():
    found = moved(np.zeros((60, 3)))
    inside = found.outside_m[3:-3]
    assert np.all(inside == 0.0)
    assert np.abs(found.acceleration_m_s2).max() < 1e-9
    assert not found.flies.any()
    assert found.upright.all()
    assert np.isnan(found.outside_m[[0, 1, 2, -3, -2, -1]]).all()


@pytest.mark.parametrize(("lifted_m", "bears"), [(0.02, True), (0.04, False), (0.3, False)])
def test_a_lifted_foot_does_not_bear(lifted_m, bears):
    place = np.repeat(STANDING[None], 60, axis=0)
    left = [SKELETON.index(f"left_{joint}") for joint in ("foot", "toes")]
    place[20:, left, 1] += lifted_m
    found = mechanics_of(place, np.arange(60) / RATE_HZ, ANATOMY)
    # The mass centre is between the feet: off the right sole by its distance less half a sole.
    off = abs(STANDING[SKELETON.index("right_foot"), 0]) - 0.045
    np.testing.assert_allclose(found.outside_m[35:50], 0.0 if bears else off, atol=0.01)


@pytest.mark.parametrize("gravity_m_s2", [G, 0.5 * G, 2.0 * G])
def test_a_thrown_body_falls_as_fast_as_it_was_thrown(gravity_m_s2):
    time_s = np.arange(0.0, 3.0, 1.0 / RATE_HZ)
    flown_s = np.clip(time_s - 1.0, 0.0, 1.0)
    found = moved(along(1, 0.5 * gravity_m_s2 * flown_s * (1.0 - flown_s)))
    assert found.falls_g(np.ones(len(found.flies), dtype=bool)) == pytest.approx(
        [gravity_m_s2 / G], rel=1e-6
    )
    middle = np.argmin(np.abs(found.time_s - 1.5))
    assert found.acceleration_m_s2[middle, 1] == pytest.approx(-gravity_m_s2, rel=0.02)
    assert np.isnan(found.outside_m[middle])
    assert not len(found.falls_g(np.zeros(len(found.flies), dtype=bool)))


def test_who_lies_with_lifted_feet_does_not_fly():
    time_s = np.arange(0.0, 3.0, 1.0 / RATE_HZ)
    back = quaternion_about([1.0, 0.0, 0.0], -0.5 * np.pi)
    lying = rotate(back, STANDING) + np.array([0.0, 0.1, 0.0])
    lifted = 0.4 * np.clip(time_s - 1.0, 0.0, 1.0)
    found = mechanics_of(lying + along(1, lifted)[:, None], time_s, ANATOMY)
    assert not found.flies.any()
    assert not found.upright[:24].any()
    assert moved(along(1, lifted)).flies[-1]


@pytest.mark.parametrize("acceleration_m_s2", [0.5, 2.0, 6.0])
def test_a_body_that_speeds_up_needs_feet_as_far_behind_it(acceleration_m_s2):
    time_s = np.arange(0.0, 2.5, 1.0 / RATE_HZ)
    found = moved(along(2, 0.5 * acceleration_m_s2 * time_s**2))
    np.testing.assert_allclose(found.level_m_s2[MIDDLE], acceleration_m_s2, rtol=1e-3)
    np.testing.assert_allclose(found.carried_m_s2, found.level_m_s2, atol=1e-9)
    point = zero_moment_point_m(found.centre_m, found.acceleration_m_s2)[MIDDLE, 1]
    lag = CENTRE[1] * acceleration_m_s2 / G
    np.testing.assert_allclose(found.centre_m[MIDDLE, 2] - point, lag, rtol=1e-3)
    # 0.06 m behind the ankle ends the sole.
    heel = STANDING[SKELETON.index("left_foot"), 2] - 0.06 - CENTRE[2]
    np.testing.assert_allclose(found.outside_m[MIDDLE], max(0.0, lag + heel), atol=2e-3)
    steady = along(2, acceleration_m_s2 * time_s)
    assert moved(steady).level_m_s2[MIDDLE].max() < 1e-5
    np.testing.assert_allclose(moved(steady).root_m_s, acceleration_m_s2)


def test_a_linear_inverted_pendulum_turns_about_the_place_it_stands_on():
    height_m, at = 1.1, np.array([0.3, -0.2])
    rate = np.sqrt(G / height_m)
    time_s = np.linspace(0.0, 1.0, 50)
    off = np.stack([0.1 * np.cosh(rate * time_s), 0.05 * np.sinh(rate * time_s)], axis=-1)
    centre = np.column_stack([at[0] + off[:, 0], np.full(50, height_m), at[1] + off[:, 1]])
    acceleration = np.column_stack([rate**2 * off[:, 0], np.zeros(50), rate**2 * off[:, 1]])
    np.testing.assert_allclose(
        zero_moment_point_m(centre, acceleration), np.broadcast_to(at, (50, 2)), atol=1e-12
    )


def test_a_body_that_falls_freely_does_not_divide_by_its_weight():
    point = zero_moment_point_m(np.array([0.0, 1.0, 0.0]), np.array([3.0, -G, 0.0]))
    np.testing.assert_allclose(point, [-3.0, 0.0])


def hull_distance_m(point, corners) -> float:
    """Return the distance from a hull as Qhull has it, its edges one after the other."""
    hull = ConvexHull(corners)
    if (hull.equations[:, :2] @ point + hull.equations[:, 2]).max() <= 0.0:
        return 0.0
    ring = corners[hull.vertices]
    best = np.inf
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        best = min(best, float(np.linalg.norm(point - a - share * (b - a))))
    return best


@pytest.mark.parametrize("seed", range(20))
def test_the_distance_from_a_hull_is_qhulls(seed):
    rng = np.random.default_rng(seed)
    points, corners = rng.normal(0.0, 1.0, (40, 2)), rng.normal(0.0, 0.8, (40, 8, 2))
    bears = rng.random((40, 8)) < 0.5
    bears[:, :3] = True
    expected = [hull_distance_m(p, c[on]) for p, c, on in zip(points, corners, bears, strict=True)]
    found = outside_m(points, corners, bears)
    np.testing.assert_allclose(found, expected, atol=1e-9)
    assert 0.0 in expected
    assert max(expected) > 0.5


def test_one_corner_and_a_line_of_them_are_hulls_too():
    corners = np.array([[[0.0, 0.0], [1.0, 0.0], [5.0, 5.0]]])
    point = np.array([[0.5, 2.0]])
    assert outside_m(point, corners, np.array([[True, True, False]])) == pytest.approx(2.0)
    assert outside_m(point, corners, np.array([[False, True, False]])) == pytest.approx(
        np.hypot(0.5, 2.0)
    )


def test_a_body_put_elsewhere_pops_by_that_far():
    time_s = np.arange(40) / RATE_HZ
    smooth = along(0, 1.5 * time_s + 0.5 * 4.0 * time_s**2)
    assert moved(smooth).pop_m.max() < 1e-9
    put = smooth + along(2, 0.3 * (time_s > 0.7))
    assert pops_m(STANDING + put[:, None]).max() == pytest.approx(0.3)
    turned = STANDING + smooth[:, None]
    at = turned[20:, :1] * [1.0, 0.0, 1.0]
    turned[20:] = at + rotate(quaternion_about([0.0, 1.0, 0.0], np.pi), turned[20:] - at)
    trunk = turned[:, ANATOMY.trunk]
    assert pops_m(trunk).max() > 0.1  # shoulders change sides


def test_a_sudden_change_of_speed_pops_by_half_of_what_it_makes_in_a_frame():
    time_s = np.arange(40) / RATE_HZ
    struck = along(2, 3.0 * np.maximum(time_s - 0.5, 0.0))
    assert moved(struck).pop_m.max() == pytest.approx(0.5 * 3.0 / RATE_HZ)


def test_figures_depend_neither_on_the_rate_nor_on_where_a_body_moves():
    def wobbling(rate_hz):
        time_s = np.arange(0.0, 4.0, 1.0 / rate_hz)
        return STANDING + along(2, 0.2 * np.sin(4.0 * time_s))[:, None], time_s

    slow, fast = (mechanics_of(*wobbling(rate_hz), ANATOMY) for rate_hz in (24.0, 120.0))
    np.testing.assert_allclose(slow.level_m_s2[:90], fast.level_m_s2[:90], atol=0.05)
    place, time_s = wobbling(24.0)
    turn = quaternion_about([0.0, 1.0, 0.0], 1.1)
    elsewhere = rotate(turn, place) + np.array([3.0, 0.0, -2.0])
    away = mechanics_of(elsewhere, time_s, ANATOMY)
    np.testing.assert_allclose(away.level_m_s2, slow.level_m_s2, atol=1e-9)
    np.testing.assert_allclose(away.outside_m, slow.outside_m, atol=1e-9)
    np.testing.assert_allclose(away.pop_m, slow.pop_m, atol=1e-9)


def test_too_short_a_movement_is_not_measured():
    assert moved(np.zeros((15, 3))) is None
