from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.transfer.scene import scene_scale


def doodle(device: str, start: tuple[float, float, float]) -> Doodle:
    rng = np.random.default_rng(len(device))
    steps = rng.normal(size=(20, 3)) * 0.01
    steps[0] = 0.0
    q = np.tile([0.0, 0.6, 0.0, 0.8], (20, 1))
    return Doodle(np.arange(20) / 60.0, np.array(start) + np.cumsum(steps, axis=0), q, device)


def recording() -> Recording:
    return Recording((doodle("fox", (0.3, 0.8, 0.1)), doodle("wolf", (-0.5, 0.9, 0.4))))


def test_places_are_ten_times_as_far_apart_and_times_and_turns_as_they_were():
    take = recording()
    stage = scene_scale(take, 1.75, 0.175)
    placed = stage.placed_doodle(take.doodles[0])
    assert np.diff(placed.position_m, axis=0) == pytest.approx(
        10.0 * np.diff(take.doodles[0].position_m, axis=0)
    )
    assert (placed.time_s == take.doodles[0].time_s).all()
    assert (placed.orientation_xyzw == take.doodles[0].orientation_xyzw).all()


def test_performers_keep_their_places_beside_each_other_around_the_middle():
    take = recording()
    stage = scene_scale(take, 1.75, 0.175)
    fox, wolf = (stage.placed(d.position_m[0]) for d in take.doodles)
    assert wolf - fox == pytest.approx([-8.0, 1.0, 3.0])
    assert (fox + wolf)[[0, 2]] == pytest.approx([0.0, 0.0])


def test_the_ground_is_the_lowest_point_that_any_device_reached():
    take = recording()
    stage = scene_scale(take, 1.75, 0.175)
    heights = [stage.placed(d.position_m)[:, 1].min() for d in take.doodles]
    assert min(heights) == pytest.approx(0.0)


@pytest.mark.parametrize("height_m", [0.0, -1.0, float("nan")])
def test_a_character_without_height_gives_no_scale(height_m):
    with pytest.raises(TransferError, match="character: expected a height above zero, found"):
        scene_scale(recording(), height_m, 0.175)
