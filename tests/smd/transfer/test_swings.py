"""A clip that repeats itself is played at its own tempo, oftener where there is more time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import smd
from actions_library.library import Library
from smd.character.kinematics import forward_kinematics
from smd.score import Part, Phrase, Score
from smd.transfer.pacing import Pacing
from smd.transfer.swings import Swing, at_own_tempo, swing_of, with_periods

COUNTS = (1, 2, 3, 4, 9)


def places(clip) -> np.ndarray:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def test_waves_and_claps_are_found_and_nothing_else(library: Library) -> None:
    once = [clip for clip in library.clips.values() if not clip.cyclic]
    found = {clip.name: swing_of(clip, places(clip)) for clip in once}
    assert {name for name, swing in found.items() if swing} == {"wave", "clap"}
    wave = found["wave"]
    assert wave is not None
    assert wave.period / 60.0 == pytest.approx(0.42, abs=0.02)  # of two beats of 0.21 s


@pytest.mark.parametrize("name", ["wave", "clap"])
@pytest.mark.parametrize("count", COUNTS)
def test_other_counts_are_as_smooth(library: Library, name: str, count: int) -> None:
    clip = library.clip(name)
    swing = swing_of(clip, places(clip))
    assert swing is not None
    other = with_periods(clip, swing, count)
    more = (count - swing.periods) * swing.period
    assert len(other) == len(clip) + more
    assert other.stage_end_frames[2:].tolist() == (clip.stage_end_frames[2:] + more).tolist()
    assert other.stage_end_frames[:2].tolist() == clip.stage_end_frames[:2].tolist()
    for order in (1, 2):
        change = [
            np.linalg.norm(np.diff(places(one), n=order, axis=0), axis=-1).max()
            for one in (clip, other)
        ]
        assert change[1] <= 1.02 * change[0]
    np.testing.assert_allclose(
        other.rotation_xyzw[: swing.first], clip.rotation_xyzw[: swing.first], atol=1e-12
    )
    np.testing.assert_allclose(
        other.rotation_xyzw[swing.end + more :], clip.rotation_xyzw[swing.end :], atol=1e-12
    )


@pytest.mark.parametrize("name", ["wave", "clap"])
def test_as_many_periods_as_before_are_the_clip_itself(library: Library, name: str) -> None:
    clip = library.clip(name)
    swing = swing_of(clip, places(clip))
    assert swing is not None
    np.testing.assert_allclose(
        with_periods(clip, swing, swing.periods).rotation_xyzw, clip.rotation_xyzw, atol=1e-12
    )


@pytest.mark.parametrize(("lasting_s", "count"), [(0.2, 1), (1.0, 2), (1.2, 2), (5.1, 10)])
def test_the_time_that_there_is_gives_the_count(lasting_s: float, count: int) -> None:
    swing = Swing(first=30, period=30, periods=2, own_s=0.5)
    pacing = Pacing(
        np.array([0.0, 1.0, 1.0 + lasting_s, 3.0 + lasting_s]), np.array([0.0, 30.0, 90.0, 120.0])
    )
    found, paced = at_own_tempo(pacing, swing)
    assert found == count
    more = (count - 2) * 30
    assert paced.time_s.tolist() == pacing.time_s.tolist()
    assert paced.frame.tolist() == [0.0, 30.0, 90.0 + more, 120.0 + more]


def crossings_hz(library: Library, lasting_s: float) -> float:
    """How often a hand that waves for some time goes from side to side and back, per second."""
    time_s = np.arange(0.0, lasting_s + 4.0, 1.0 / 60.0)
    doodle = smd.Doodle(
        time_s,
        np.zeros((len(time_s), 3)),
        np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)),
        device="hand",
    )
    recording = smd.Recording((doodle,))
    phrase = Phrase("wave", 1.0, 1.0 + lasting_s)
    played = smd.animate(
        Score((Part("hand", (phrase,)),), figure_height_m=0.2), recording, library, rate_hz=60.0
    ).actors[0]
    skeleton = library.character.skeleton
    hand, chest = skeleton.index("right_hand"), skeleton.index("upper_chest")
    place = forward_kinematics(skeleton, *played.poses)[1]
    up = place[:, hand, 1] > place[:, chest, 1] + 0.2
    side = place[up, hand, 0]
    turns = [i for i, (a, b) in enumerate(pairwise(np.diff(side))) if a * b < 0.0]
    return (len(turns) - 1) / 2.0 / ((turns[-1] - turns[0]) / 60.0)


def test_a_long_wave_waves_oftener_not_slower(library: Library) -> None:
    own_hz = 1.0 / 0.42
    for lasting_s in (2.6, 5.0, 9.0):
        assert crossings_hz(library, lasting_s) == pytest.approx(own_hz, rel=0.25)
