from __future__ import annotations

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.character.kinematics import forward_kinematics
from smd.character.stages import landing_frame, stage_end_frames, turning_frames

RATE_HZ = 60.0


def eased(u: np.ndarray) -> np.ndarray:
    u = np.clip(u, 0.0, 1.0)
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


def stroke(*legs: tuple[float, float, float]) -> np.ndarray:
    """One joint that goes along +Z in minimum-jerk legs: start, end (s) and way (m)."""
    t = np.arange(int(legs[-1][1] * RATE_HZ) + 31) / RATE_HZ
    z = sum(way * eased((t - a) / (b - a)) for a, b, way in legs)
    place = np.zeros((len(t), 1, 3))
    place[:, 0, 2] = z
    return place


def standing(place: np.ndarray) -> np.ndarray:
    """Return contacts of one joint that touches all the while."""
    return np.ones((len(place), 1), dtype=bool)


def stages(place: np.ndarray) -> np.ndarray:
    return stage_end_frames(place, RATE_HZ, cyclic=False, touches=standing(place))


def test_back_ahead_and_home_is_anticipation_execution_and_transition():
    place = stroke((0.2, 0.6, -0.3), (0.6, 0.9, 1.0), (1.2, 2.0, -0.7))
    prepared, anticipated, executed, followed, last = stage_end_frames(
        place, RATE_HZ, cyclic=False, touches=standing(place)
    )
    assert prepared <= 12
    assert anticipated == pytest.approx(36, abs=2)
    assert 46 <= executed <= 54
    assert 53 <= followed <= 73
    assert last == len(place) - 1


def test_without_anticipation_the_execution_begins_with_the_movement():
    place = stroke((0.5, 1.0, 1.0), (1.5, 2.5, -1.0))
    prepared, anticipated, *_ = stage_end_frames(
        place, RATE_HZ, cyclic=False, touches=standing(place)
    )
    assert prepared == 0
    assert 30 <= anticipated <= 40


@pytest.mark.parametrize("cyclic", [True, False])
def test_ends_are_in_order_whatever_moves(cyclic):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        place = np.cumsum(np.cumsum(rng.normal(0.0, 1e-3, (90, 5, 3)), axis=0), axis=0)
        ends = stage_end_frames(place, RATE_HZ, cyclic=cyclic, touches=standing(place))
        assert (np.diff(ends) >= 0).all() and ends[0] >= 0 and ends[-1] == 89
    still = np.zeros((50, 2, 3))
    ends = stage_end_frames(still, RATE_HZ, cyclic=False, touches=standing(still))
    assert ends.tolist() == [0, 0, 49, 49, 49]


@pytest.mark.parametrize("landed", [50, 70, 100])
def test_what_flies_is_executed_until_it_has_landed(landed):
    place = stroke((0.2, 0.6, -0.3), (0.6, 0.9, 1.0), (1.2, 2.0, -0.7))
    touches = standing(place)
    touches[40:landed] = False
    prepared, anticipated, executed, followed, last = stage_end_frames(
        place, RATE_HZ, cyclic=False, touches=touches
    )
    without = stages(place)
    assert (prepared, anticipated) == tuple(without[:2])
    assert executed == max(landed, without[2])
    assert executed <= followed <= last


@pytest.mark.parametrize("air", [slice(0, 20), slice(60, None), slice(0, None)])
def test_who_begins_or_ends_in_the_air_has_not_jumped(air):
    touches = np.ones((90, 2), dtype=bool)
    touches[air] = False
    assert landing_frame(touches, 80) == 0


def test_a_flight_counts_that_begins_in_time():
    touches = np.ones((90, 2), dtype=bool)
    touches[20:30] = touches[60:70] = False
    assert [landing_frame(touches, frame) for frame in (10, 25, 59, 65)] == [0, 30, 30, 70]


def test_a_zigzag_turns_where_it_turns():
    way = np.interp(np.arange(101), [0, 20, 50, 60, 100], [0.0, 1.0, -1.0, 0.0, -2.0])
    assert turning_frames(way, 0.1) == [0, 20, 50, 60, 100]
    assert turning_frames(way, 1.5) == [0, 100]


def test_strikes_are_found_within_a_few_frames_of_where_they_were_authored():
    """Docs print the figure over all clips; these are the ones that a rule can find."""
    library = load_library()
    for name in ("punch", "slash", "throw"):
        clip = library.clip(name)
        _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
        seen = place - place[:, :1]
        found = stage_end_frames(seen, clip.rate_hz, cyclic=False, touches=clip.contacts)
        assert np.abs(found - clip.stage_end_frames)[1:4].max() <= 12
