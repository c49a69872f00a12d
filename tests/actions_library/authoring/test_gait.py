from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.dog.skeleton import dog_rig
from actions_library.authoring.gait import (
    LATERAL_WALK,
    ROTARY_GALLOP,
    TROT,
    GaitDiagram,
    Step,
    gait_plants,
    metachronal,
)
from tests.naive.ant import ant_legs, ant_rig


def feet_down(gait: GaitDiagram, time: float) -> set[str]:
    """Which feet are down at a time in cycles, by phases and duty alone."""
    return {leg for leg, at in gait.phase.items() if (time - at) % 1.0 < gait.step_of(leg).duty}


def standing(rig, gait: GaitDiagram, time: float) -> set[str]:
    """Which feet are down by the plants."""
    at = time * gait.period_s
    return {
        leg
        for leg, plants in gait_plants(rig, gait).items()
        if any(plant.land <= at < plant.leave for plant in plants)
    }


@pytest.mark.parametrize(
    ("phase", "duty"), [(LATERAL_WALK, 0.62), (TROT, 0.42), (ROTARY_GALLOP, 0.2)]
)
def test_plants_stand_when_the_gait_diagram_says(phase, duty):
    rig, gait = dog_rig(), GaitDiagram(0.5, 0.8, phase, Step(duty=duty))
    for time in np.arange(0.003, 1.0, 0.01):
        assert standing(rig, gait, time) == feet_down(gait, time)


def test_a_lateral_walk_lands_left_hind_left_fore_right_hind_right_fore():
    # Hildebrand 1965: in the lateral sequence a hind foot is followed by the fore foot of its side
    order = sorted(LATERAL_WALK, key=LATERAL_WALK.__getitem__)
    assert order == ["left_hind", "left_fore", "right_hind", "right_fore"]


def test_a_walk_is_never_in_the_air_and_a_gallop_is_twice():
    times = np.arange(0.003, 1.0, 0.01)
    walk = GaitDiagram(1.0, 0.6, LATERAL_WALK, Step(duty=0.62))
    gallop = GaitDiagram(0.45, 1.9, ROTARY_GALLOP, Step(duty=0.2))
    assert min(len(feet_down(walk, t)) for t in times) >= 2
    flying = np.array([not feet_down(gallop, t) for t in times])
    assert np.count_nonzero(flying & ~np.roll(flying, 1)) == 2


def test_in_a_trot_diagonal_feet_are_down_together():
    gait = GaitDiagram(0.5, 1.0, TROT, Step(duty=0.42))
    for time in np.arange(0.003, 1.0, 0.01):
        assert feet_down(gait, time) in (
            set(),
            {"left_hind", "right_fore"},
            {"right_hind", "left_fore"},
        )


def test_a_stand_is_as_far_ahead_of_rest_when_it_begins_as_behind_when_it_ends():
    rig = dog_rig()
    gait = GaitDiagram(0.5, 0.8, LATERAL_WALK, Step(duty=0.6))
    speed = gait.stride_m / gait.period_s
    for name, plants in gait_plants(rig, gait).items():
        rest = rig.skeleton.world_from_bind[rig.skeleton.index(rig.leg(name).foot), 2, 3]
        for plant in plants:
            ends = plant.ahead - speed * np.array([plant.land, plant.leave]) - rest
            np.testing.assert_allclose(ends, [0.24, -0.24], atol=1e-9)


def test_a_wave_of_steps_over_three_pairs_half_a_cycle_apart_stands_on_tripods():
    # With each pair half a cycle after the one behind it, an insect stands on alternating tripods.
    phase = metachronal(ant_legs(), 0.5)
    gait = GaitDiagram(0.4, 0.06, phase, Step(duty=0.5))
    for time in np.arange(0.003, 1.0, 0.01):
        down = standing(ant_rig(), gait, time)
        assert down in (
            {"left_hind", "right_middle", "left_fore"},
            {"right_hind", "left_middle", "right_fore"},
        )
