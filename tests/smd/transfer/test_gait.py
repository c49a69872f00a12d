from __future__ import annotations

import numpy as np
import pytest

from smd.acting.legs import feet_of, legs_of
from smd.acting.standing import standing
from smd.transfer.gait import Gait, Passing, gait_of, phase_after

WALK = Gait(1.4, 1.0, (Passing(0.3, 3), Passing(0.8, 7)))
GALLOP = Gait(2.0, 0.5, (Passing(0.1, 3), Passing(0.3, 7)))
FLIGHT = Gait(3.0, 1.2, ())


def test_feet_pass_where_one_is_half_through_the_air(make_piece):
    piece = make_piece(
        frames=101,
        cyclic=True,
        travels=True,
        ahead_m=1.4,
        left_stands=(0.0, 0.6),
        right_stands=(0.5, 0.99),
    )
    left, right = piece.touching
    (first, second) = piece.gait.passings
    assert (first.foot, second.foot) == (right, left)
    assert first.phase == pytest.approx(0.245, abs=0.011)
    assert second.phase == pytest.approx(0.8, abs=0.011)
    assert piece.gait.stride_m == pytest.approx(1.4)


def test_a_stance_across_the_cycle_s_seam_is_one_stance(make_piece):
    piece = make_piece(frames=101, cyclic=True, travels=True, left_stands=(0.35, 0.75))
    (passing,) = piece.gait.passings
    assert passing.phase == pytest.approx(0.05, abs=0.011)


def test_a_walk_goes_by_half_cycles_and_an_uneven_gait_by_whole_ones():
    assert WALK.halves
    assert not GALLOP.halves
    for gait, unit in ((WALK, 0.5), (GALLOP, 1.0)):
        for distance in np.linspace(0.1, 30.0, 57):
            cycles = gait.cycles_for(distance, distance / 1.3)
            assert cycles >= unit
            assert cycles / unit == round(cycles / unit)


def test_at_its_own_speed_a_gait_keeps_its_stride():
    assert WALK.cycles_for(14.0, 10.0) == 10.0


@pytest.mark.parametrize("speed", [0.35, 0.9, 1.4, 1.6])
def test_the_stride_grows_with_the_root_of_the_speed(speed):
    cycles = WALK.cycles_for(500.0, 500.0 / speed)
    wanted = 1.4 * np.clip(np.sqrt(speed / 1.4), 0.75, 1.25)
    assert 500.0 / cycles == pytest.approx(wanted, rel=0.005)


@pytest.mark.parametrize("gait", [WALK, GALLOP])
def test_strides_keep_within_a_quarter_of_the_clips_wherever_a_number_of_cycles_does(gait):
    unit = 0.5 if gait.halves else 1.0
    for distance in np.linspace(0.3, 12.0, 118):
        for speed in (0.4, 1.0, 1.4, 2.5, 5.0):
            stride = distance / gait.cycles_for(distance, distance / speed) / gait.stride_m
            could = distance / gait.stride_m / (unit * np.arange(1, 50))
            if ((could >= 0.75) & (could <= 1.25)).any():
                assert 0.75 - 1e-9 <= stride <= 1.25 + 1e-9


def test_steps_come_no_faster_than_people_take_them_while_strides_can_stretch():
    for speed in np.linspace(1.4, 1.25 * 1.4 * 140.0 / 120.0, 9):
        cycles = WALK.cycles_for(500.0, 500.0 / speed)
        assert 60.0 * 2.0 * cycles / (500.0 / speed) <= 140.0 + 0.2
    assert 500.0 / WALK.cycles_for(500.0, 500.0 / 4.0) == pytest.approx(1.25 * 1.4, rel=0.005)


def test_the_shipped_walk_walks_and_the_run_flies(library):
    def gait(name):
        clip = library.clip(name)
        return gait_of(clip, standing(clip, legs_of(clip.skeleton, feet_of(clip))))

    assert not gait("walk").flies
    assert gait("run").flies
    assert gait("walk").most_steps_per_min == 140.0
    assert gait("run").most_steps_per_min == 270.0


def test_a_gait_that_goes_nowhere_keeps_its_own_time():
    assert WALK.cycles_for(0.0, 4.0) == 4.0


@pytest.mark.parametrize("phase", [0.3, 1.3, 5.3])
def test_a_gait_goes_on_from_another_with_the_same_foot(phase):
    assert phase_after(WALK, phase, GALLOP) == 0.1
    assert phase_after(WALK, phase + 0.5, GALLOP) == 0.3


def test_nothing_goes_on_from_a_foot_that_the_next_gait_has_not():
    assert phase_after(WALK, 0.3, FLIGHT) is None


def test_the_shipped_walk_and_run_are_halved_and_flight_never_stands(library):
    def gait(name):
        clip = library.clip(name)
        return gait_of(clip, standing(clip, ()))

    assert gait("walk").halves
    assert gait("run").halves
    assert gait("fly").passings == ()
