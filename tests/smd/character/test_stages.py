from __future__ import annotations

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.character.kinematics import forward_kinematics
from smd.character.stages import stage_end_frames, turning_frames

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


def test_back_ahead_and_home_is_anticipation_execution_and_transition():
    place = stroke((0.2, 0.6, -0.3), (0.6, 0.9, 1.0), (1.2, 2.0, -0.7))
    prepared, anticipated, executed, followed, last = stage_end_frames(place, RATE_HZ, cyclic=False)
    assert prepared <= 12
    assert anticipated == pytest.approx(36, abs=2)
    assert 46 <= executed <= 54
    assert 53 <= followed <= 73
    assert last == len(place) - 1


def test_without_anticipation_the_execution_begins_with_the_movement():
    place = stroke((0.5, 1.0, 1.0), (1.5, 2.5, -1.0))
    prepared, anticipated, *_ = stage_end_frames(place, RATE_HZ, cyclic=False)
    assert prepared == 0
    assert 30 <= anticipated <= 40


@pytest.mark.parametrize("cyclic", [True, False])
def test_ends_are_in_order_whatever_moves(cyclic):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        place = np.cumsum(np.cumsum(rng.normal(0.0, 1e-3, (90, 5, 3)), axis=0), axis=0)
        ends = stage_end_frames(place, RATE_HZ, cyclic=cyclic)
        assert (np.diff(ends) >= 0).all() and ends[0] >= 0 and ends[-1] == 89
    assert stage_end_frames(np.zeros((50, 2, 3)), RATE_HZ, cyclic=False).tolist() == [
        *(0, 0, 49, 49, 49)
    ]


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
        found = stage_end_frames(place - place[:, :1], clip.rate_hz, cyclic=False)
        assert np.abs(found - clip.stage_end_frames)[1:4].max() <= 12
