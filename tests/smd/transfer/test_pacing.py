"""Pacing: what a clip is about is done by its phrase's end; the body comes back in the pause."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from actions_library.folder import load_library
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.transfer.pacing import NEAR_M, RECOVERING, core_frame, near_share, paced

LIBRARY = load_library()
ONCE = [action.name for action in LIBRARY.actions if not LIBRARY.clip(action.name).cyclic]


def near(clip: Clip) -> float:
    place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    return near_share(clip, place)


def test_a_clip_shorter_than_its_phrase_is_stretched_over_it():
    clip = LIBRARY.clip("punch")
    pacing = paced(clip, near(clip), 3.0, 3.0 + 2.0 * clip.duration_s, pause_s=9.0)
    assert (pacing.end_s, pacing.left_frame) == (3.0 + 2.0 * clip.duration_s, len(clip) - 1)
    assert pacing.frame_at(np.array([3.0 + clip.duration_s])) == pytest.approx(
        0.5 * len(clip), 0.02
    )


def test_with_time_afterwards_a_punch_goes_at_its_own_pace_and_comes_back_in_the_pause():
    clip = LIBRARY.clip("punch")
    lasting_s = 1.05 * core_frame(clip) / clip.rate_hz
    pacing = paced(clip, near(clip), 1.0, 1.0 + lasting_s, pause_s=4.0)
    assert pacing.left_frame == len(clip) - 1
    assert pacing.end_s == pytest.approx(1.0 + clip.duration_s)


def test_what_is_lying_is_not_left_before_it_is_up_again():
    clip = LIBRARY.clip("fall")
    core, last = core_frame(clip), len(clip) - 1
    left = round(core + near(clip) * (last - core))
    hips_m = clip.translation_m[:, 1, 1]
    assert hips_m[core] < 0.3 * hips_m[-1] < 0.7 * hips_m[-1] < hips_m[left]
    assert paced(clip, near(clip), 0.0, 1.0, pause_s=0.0).left_frame > left - 1


@pytest.mark.parametrize("name", ONCE)
def test_from_there_on_the_pose_is_near(name):
    clip = LIBRARY.clip(name)
    place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    core, last = core_frame(clip), len(clip) - 1
    left = round(core + near(clip) * (last - core))
    # Told without the ground root: what does not turn is compared as it is seen.
    turned = np.abs(clip.rotation_xyzw[left, 0] @ clip.rotation_xyzw[-1, 0])
    if turned > 0.999:
        seen = place - clip.translation_m[:, :1] * [1.0, 0.0, 1.0]
        apart = np.linalg.norm(seen[left:] - seen[-1], axis=-1).mean(axis=-1)
        assert apart.max() < NEAR_M + 0.03


@given(st.sampled_from(ONCE), st.floats(0.1, 6.0), st.floats(0.0, 5.0), st.floats(0.0, 1.0))
def test_every_pacing_keeps_its_promises(name, lasting_s, pause_s, share):
    clip = LIBRARY.clip(name)
    pacing = paced(clip, share, 0.0, lasting_s, pause_s)
    core, last = core_frame(clip), len(clip) - 1
    assert lasting_s - 1e-9 <= pacing.end_s <= lasting_s + RECOVERING * pause_s + 1e-9
    assert core + share * (last - core) - 1e-6 <= pacing.left_frame <= last + 1e-6
    assert pacing.frame_at(np.array([lasting_s]))[0] >= core - 1e-6
    pace = pacing.left_frame / pacing.end_s / clip.rate_hz
    hurried = pace > 1.0 + 1e-9
    # It hurries only where it must: for its core, or for what has to be done in the pause.
    tight_s = pacing.end_s - (lasting_s + RECOVERING * pause_s)
    assert not hurried or pace == pytest.approx(core / lasting_s / clip.rate_hz) or tight_s > -1e-6


def test_a_longer_pause_changes_nothing_of_the_phrase_where_the_first_was_enough():
    clip = LIBRARY.clip("slash")
    some, more = (paced(clip, near(clip), 0.0, 1.1, pause_s) for pause_s in (1.0, 5.0))
    time_s = np.linspace(0.0, 1.1, 50)
    np.testing.assert_allclose(some.frame_at(time_s), more.frame_at(time_s), atol=1e-9)
