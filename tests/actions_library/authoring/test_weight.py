from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.authoring.curves import eased
from actions_library.authoring.mass import GRAVITY_M_S2, zero_moment_point
from actions_library.authoring.support import support_of
from actions_library.authoring.weight import (
    BEYOND_M,
    FOLLOWS,
    STEADIEST_M_S2,
    CarriedBody,
    shift_of_hips,
)

RATE_HZ, HEIGHT_M = 60.0, 0.95
SOLE = np.array([[0.05, 0.0, -0.1], [-0.05, 0.0, -0.1], [-0.05, 0.0, 0.15], [0.05, 0.0, 0.15]])
BOTH = np.concatenate([SOLE - [0.12, 0.0, 0.0], SOLE + np.array([0.12, 0.0, 0.0])])


def body(left_m: np.ndarray, *, up_m: np.ndarray | float = HEIGHT_M) -> CarriedBody:
    """A mass that goes to the left and up, over two feet that stay."""
    frames = len(left_m)
    centre = np.column_stack([left_m, np.broadcast_to(up_m, frames), np.zeros(frames)])
    return CarriedBody(
        centre_m=centre,
        support=support_of(np.broadcast_to(BOTH, (frames, *BOTH.shape))),
        free=np.zeros(frames, dtype=bool),
        room_m=np.full(frames, np.inf),
        rate_hz=RATE_HZ,
        cyclic=False,
    )


def second(path_m: np.ndarray) -> np.ndarray:
    return np.gradient(np.gradient(path_m, 1 / RATE_HZ, axis=0), 1 / RATE_HZ, axis=0)


def outside_m(carried: CarriedBody, shift: np.ndarray) -> np.ndarray:
    """Distance of the zero moment point from the feet once the mass has followed the hips."""
    centre = carried.centre_m + FOLLOWS * shift
    moment = zero_moment_point(centre, second(centre))
    return np.linalg.norm(carried.support.nearest_m(moment) - moment, axis=1)


def jerked(*, by_m: float = 0.24, in_s: float = 0.25) -> CarriedBody:
    """From over one foot to over the other, faster than a body can."""
    time_s = np.arange(121) / RATE_HZ
    return body(by_m * (eased((time_s - 0.8) / in_s) - 0.5))


def test_what_is_carried_is_not_moved():
    slow = 0.05 * np.sin(np.pi * np.arange(121) / 60.0)
    np.testing.assert_allclose(shift_of_hips(body(slow)), 0.0, atol=1e-12)


def test_a_jerk_is_brought_down_to_what_the_ground_can_push():
    carried = jerked()
    still = np.zeros_like(carried.centre_m)
    assert outside_m(carried, still).max() > 8.0 * BEYOND_M
    moved = shift_of_hips(carried)
    assert outside_m(carried, moved).max() < 2.5 * BEYOND_M
    after = second(carried.centre_m + FOLLOWS * moved)
    assert np.abs(after[:, 0]).max() < 1.1 * STEADIEST_M_S2


def test_the_mass_starts_before_it_was_meant_to_and_arrives_after():
    carried = jerked()
    path = carried.centre_m[:, 0] + FOLLOWS * shift_of_hips(carried)[:, 0]
    assert path[45] > carried.centre_m[45, 0] + 0.005  # 0.05 s before it starts
    assert path[66] < carried.centre_m[66, 0] - 0.005  # 0.05 s after it was there


def test_the_ends_of_a_clip_are_where_they_were():
    moved = shift_of_hips(jerked())
    np.testing.assert_array_equal(moved[[0, 1, -2, -1]], 0.0)


@pytest.mark.parametrize("turn", [0.7, 2.0, -1.3])
def test_the_shift_turns_and_mirrors_with_the_world(turn):
    sine, cosine = np.sin(turn), np.cos(turn)
    turned = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
    for world in (turned, np.diag([-1.0, 1.0, 1.0])):
        carried = jerked()
        seen = replace(
            carried,
            centre_m=carried.centre_m @ world.T,
            support=support_of(np.broadcast_to(BOTH @ world.T, (121, *BOTH.shape))),
        )
        expected = shift_of_hips(carried) @ world.T
        # shrinking an area about the middle of its box does not turn with it: 2 cm
        np.testing.assert_allclose(shift_of_hips(seen), expected, atol=0.02)


def test_who_rests_on_more_than_soles_is_asked_for_a_steady_mass_alone():
    carried = jerked(by_m=0.24, in_s=0.5)  # 5.5 m/s², too much for the soles alone
    propped = replace(carried, free=np.ones(121, dtype=bool))
    assert np.abs(shift_of_hips(carried)).max() > 1e-3
    np.testing.assert_allclose(shift_of_hips(propped), 0.0, atol=1e-12)


def test_in_the_air_the_mass_falls_freely():
    time_s = np.arange(121) / RATE_HZ
    floats = body(np.zeros(121), up_m=HEIGHT_M + 0.3 * np.sin(np.pi * time_s / 2.0) ** 2)
    away = (time_s > 0.8) & (time_s < 1.2)
    points = np.broadcast_to(BOTH, (121, *BOTH.shape)).copy()
    points[away] += [0.0, 0.5, 0.0]
    flown = replace(floats, support=support_of(points))
    after = second(flown.centre_m + FOLLOWS * shift_of_hips(flown))
    inner = (time_s > 0.9) & (time_s < 1.1)
    np.testing.assert_allclose(after[inner, 1], -GRAVITY_M_S2, atol=0.15)
    np.testing.assert_allclose(after[inner, 0], 0.0, atol=1e-9)


def test_hips_sink_where_a_leg_is_too_short():
    room = np.full(121, 0.10)
    room[50:70] = -0.03
    moved = shift_of_hips(replace(body(np.zeros(121)), room_m=room))
    assert moved[50:70, 1].max() < -0.027
    assert moved[:, 1].max() < 0.01
    assert np.abs(second(moved[:, 1])).max() < 15.0


def test_a_cycle_is_moved_alike_at_both_ends_wherever_it_begins():
    phase = 2.0 * np.pi * np.arange(61) / 60.0
    sway = replace(body(0.1 * np.sin(phase)), cyclic=True)
    moved = shift_of_hips(sway)
    np.testing.assert_array_equal(moved[0], moved[-1])
    assert np.abs(moved).max() > 1e-3
    later = replace(sway, centre_m=np.roll(sway.centre_m[:-1], -20, axis=0)[np.r_[:60, 0]])
    np.testing.assert_allclose(shift_of_hips(later)[:40], moved[20:60], atol=1e-9)
