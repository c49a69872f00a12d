"""Balance: the zero moment point of what is shifted comes to the feet, and no further."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from scipy.optimize import nnls

from smd.acting.balance import BESIDE_M, MOST_SHIFT_M, _off, balance_shift
from smd.acting.flight import GRAVITY_M_S2

RATE_HZ = 60.0
HEIGHT_M = 0.98
HIPS_M = 0.1
"""Half the distance between the feet."""

LASTING2 = HEIGHT_M / GRAVITY_M_S2
TIME_S = np.arange(361) / RATE_HZ
MIDDLE = slice(60, -60)
"""Frames that the ends do not reach: there nothing is shifted."""


def body(x_m=0.0, z_m=0.0, height_m=HEIGHT_M) -> np.ndarray:
    """Return a centre of mass over time ``(n, 3)``."""
    centre_m = np.zeros((len(TIME_S), 3))
    centre_m[:, 0], centre_m[:, 1], centre_m[:, 2] = x_m, height_m, z_m
    return centre_m


def feet(n: int = len(TIME_S)) -> np.ndarray:
    """Return heel and ball ``(n, 2, 2, 2)`` of two feet side by side, 25 cm long."""
    sole = [[[side * HIPS_M, -0.07], [side * HIPS_M, 0.18]] for side in (1.0, -1.0)]
    return np.tile(sole, (n, 1, 1, 1))


def shift(centre_m, soles_m=None, stands=None, flies=None) -> np.ndarray:
    n = len(centre_m)
    return balance_shift(
        centre_m,
        feet(n) if soles_m is None else soles_m,
        np.ones((n, 2), dtype=bool) if stands is None else stands,
        np.zeros(n, dtype=bool) if flies is None else flies,
        HEIGHT_M,
        RATE_HZ,
    )


def point_of(over_m) -> np.ndarray:
    """Return the zero moment point of a pendulum of constant height ``(n, 2)``."""
    push = np.zeros_like(over_m)
    push[1:-1] = (over_m[2:] - 2.0 * over_m[1:-1] + over_m[:-2]) * RATE_HZ**2
    return over_m - LASTING2 * push


def distance_to_hull(point, corners) -> float:
    """Return the distance to all means of some corners, the nearest of which has least squares."""
    heavy = 1e5  # that the weights add up to 1
    rows = np.vstack([np.transpose(corners), heavy * np.ones(len(corners))])
    share, _ = nnls(rows, np.append(point, heavy))
    return float(np.linalg.norm(share @ corners / share.sum() - point))


def test_who_stands_still_over_the_feet_is_left_there():
    for x_m, z_m in ((0.0, 0.0), (0.09, 0.15), (-0.05, -0.06)):
        assert shift(body(x_m, z_m)) == pytest.approx(np.zeros((len(TIME_S), 2)), abs=1e-12)


def test_who_stands_still_within_reach_of_the_feet_is_left_there_too():
    assert shift(body(HIPS_M + 0.9 * BESIDE_M)) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(shift(body(HIPS_M + 1.5 * BESIDE_M))[MIDDLE, 0]).min() > 0.3 * BESIDE_M


@pytest.mark.parametrize("off_m", [0.12, 0.16, 0.2])
def test_who_leans_off_the_feet_is_brought_back_as_far_as_is_beside_them(off_m):
    """The shift of a body at rest is where it is wanted, but for the ends' exponentials."""
    found = shift(body(HIPS_M + off_m))[120:-120]
    assert found[:, 0] == pytest.approx(BESIDE_M - off_m, abs=0.003)
    assert found[:, 1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("sway_m", [0.15, 0.2])  # more would be held back by what legs reach
@pytest.mark.parametrize("per_s", [2.0, 3.0, 4.0])
def test_the_zero_moment_point_of_a_swaying_body_comes_beside_the_feet(sway_m, per_s):
    """A linear inverted pendulum: x - h / g x'' sways (1 + h / g w²) times as far as x."""
    centre_m = body(sway_m * np.sin(per_s * TIME_S))
    before = np.abs(point_of(centre_m[:, [0, 2]])[MIDDLE, 0]).max() - HIPS_M
    assert before == pytest.approx((1.0 + LASTING2 * per_s**2) * sway_m - HIPS_M, rel=0.02)
    found = shift(centre_m)
    after = np.abs(point_of(centre_m[:, [0, 2]] + found)[MIDDLE, 0]).max() - HIPS_M
    assert before > BESIDE_M
    assert after < BESIDE_M + 0.02
    assert after > 0.5 * BESIDE_M  # and no further than that


def test_who_stands_on_one_foot_is_brought_over_it():
    stands = np.tile([True, False], (len(TIME_S), 1))
    found = shift(body(), stands=stands)[MIDDLE]
    assert found[:, 0] == pytest.approx(HIPS_M - BESIDE_M, abs=0.002)


def test_in_flight_nothing_pushes_it_about():
    """0.4 s in the air, during which the poses speed up evenly ahead."""
    flies = (TIME_S > 2.8) & (TIME_S < 3.2)
    centre_m = body(z_m=0.05 * np.sin(4.0 * (TIME_S - 3.0 + np.pi / 8.0)))
    stands = np.repeat(~flies[:, None], 2, axis=1)
    found = shift(centre_m, stands=stands, flies=flies)
    own, moved = (
        np.diff(over, 2) * RATE_HZ**2 for over in (centre_m[:, 2], centre_m[:, 2] + found[:, 1])
    )
    inside = flies[1:-1]
    assert np.abs(own[inside]).min() > 0.5
    assert np.abs(moved[inside]).max() < 0.05


@pytest.mark.parametrize("height_m", [0.2, 0.4, 0.54 * HEIGHT_M])
def test_who_sits_or_lies_rests_on_more_than_feet(height_m):
    assert shift(body(0.5, height_m=height_m)) == pytest.approx(0.0, abs=1e-12)
    assert np.abs(shift(body(0.5))).max() > 0.1


def test_it_is_moved_no_further_than_legs_reach():
    assert np.linalg.norm(shift(body(30.0, -40.0)), axis=-1).max() <= MOST_SHIFT_M
    wild = body(3.0 * np.sin(9.0 * TIME_S), 2.0 * np.cos(7.0 * TIME_S))
    assert np.linalg.norm(shift(wild), axis=-1).max() <= MOST_SHIFT_M


def test_without_feet_on_the_ground_or_too_few_frames_nothing_is_shifted():
    never = np.zeros((len(TIME_S), 2), dtype=bool)
    assert (shift(body(0.5), stands=never) == 0.0).all()
    assert (shift(body(0.5)[:4]) == 0.0).all()


def wandering(seed: int):
    """Return a body that sways at random over feet that step, and flies for a moment."""
    rng = np.random.default_rng(seed)
    waves = [
        sum(rng.normal(0.0, 0.1) * np.sin(rng.uniform(1, 6) * TIME_S + k) for k in range(3))
        for _ in range(2)
    ]
    centre_m = body(*waves, HEIGHT_M * (0.9 + 0.1 * np.sin(2.0 * TIME_S)))
    stands = np.stack([np.sin(5.0 * TIME_S) > -0.6, np.sin(5.0 * TIME_S) < 0.6], axis=-1)
    flies = (TIME_S > 4.0) & (TIME_S < 4.3)
    return centre_m, feet() + rng.normal(0.0, 0.02, feet().shape), stands & ~flies[:, None], flies


@pytest.mark.parametrize("seed", range(5))
def test_mirrored_bodies_are_shifted_to_the_other_side(seed):
    centre_m, soles_m, stands, flies = wandering(seed)
    found = shift(centre_m, soles_m, stands, flies)
    assert np.abs(found).max() > 0.01
    mirrored = shift(
        centre_m * [-1.0, 1.0, 1.0], soles_m[:, ::-1] * [-1.0, 1.0], stands[:, ::-1], flies
    )
    assert mirrored == pytest.approx(found * [-1.0, 1.0], abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_where_a_body_is_and_which_way_it_faces_changes_nothing(seed):
    centre_m, soles_m, stands, flies = wandering(seed)
    found = shift(centre_m, soles_m, stands, flies)
    angle = 0.4 + seed
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    moved_m = centre_m.copy()
    moved_m[:, [0, 2]] = centre_m[:, [0, 2]] @ turn + [3.0, -5.0]
    other = shift(moved_m, soles_m @ turn + [3.0, -5.0], stands, flies)
    assert other == pytest.approx(found @ turn, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_backwards_in_time_it_is_shifted_alike(seed):
    one = wandering(seed)
    found = shift(*one)
    assert shift(*(part[::-1] for part in one))[::-1] == pytest.approx(found, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_the_way_off_the_feet_is_the_way_to_their_hull(seed):
    rng = np.random.default_rng(seed)
    n = 60
    point_m = rng.normal(0.0, 0.25, (n, 2))
    soles_m = feet(n) + rng.normal(0.0, 0.1, (n, 2, 2, 2))
    stands = rng.random((n, 2)) < 0.6
    stands[np.arange(n), rng.integers(0, 2, n)] = True
    off_m = _off(point_m, soles_m, stands)
    for point, corners, held, off in zip(point_m, soles_m, stands, off_m, strict=True):
        hull = corners[held].reshape(-1, 2)
        assert np.linalg.norm(off) == pytest.approx(distance_to_hull(point, hull), abs=1e-6)
        assert distance_to_hull(point - off, hull) == pytest.approx(0.0, abs=1e-6)


def test_the_same_of_four_feet_and_of_feet_in_line():
    rng = np.random.default_rng(0)
    point_m = rng.normal(0.0, 0.3, (40, 2))
    four_m = rng.normal(0.0, 0.2, (40, 4, 2, 2))
    in_line_m = feet(40) * [0.0, 1.0]
    for soles_m in (four_m, in_line_m):
        off_m = _off(point_m, soles_m, np.ones(soles_m.shape[:2], dtype=bool))
        for point, corners, off in zip(point_m, soles_m.reshape(40, -1, 2), off_m, strict=True):
            assert np.linalg.norm(off) == pytest.approx(distance_to_hull(point, corners), abs=1e-6)


def test_nothing_between_the_feet_is_off_them():
    """Means of any two corners, the middle among them: there lines between corners cross."""
    soles_m = feet(1)
    corners = soles_m.reshape(-1, 2)
    for one, other in combinations(corners, 2):
        off_m = _off((0.5 * (one + other))[None], soles_m, np.ones((1, 2), dtype=bool))
        assert off_m == pytest.approx(np.zeros((1, 2)), abs=1e-12)
