"""Pacing: what a clip is about is done by its phrase's end; the body comes back in the pause."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from actions_library.folder import load_library
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.transfer.pacing import NEAR_M, RECOVERING, Pacing, core_frame, near_share, paced

LIBRARY = load_library()
ONCE = [action.name for action in LIBRARY.actions if not LIBRARY.clip(action.name).cyclic]


def near(clip: Clip) -> float:
    place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    return near_share(clip, place)


def shown(pacing: Pacing) -> tuple[np.ndarray, np.ndarray]:
    """Return even times at 240 Hz and the frames that are shown at them."""
    time_s = np.linspace(pacing.time_s[0], pacing.end_s, round(240.0 * np.ptp(pacing.time_s)) + 1)
    return time_s, pacing.frame_at(time_s)


def test_a_clip_shorter_than_its_phrase_is_stretched_over_it():
    clip = LIBRARY.clip("punch")
    last = len(clip) - 1
    pacing = paced(clip, near(clip), 3.0, 3.0 + 2.0 * clip.duration_s, pause_s=9.0)
    assert pacing.end_s == 3.0 + 2.0 * clip.duration_s
    assert pacing.frame_at(np.linspace(3.0, pacing.end_s, 5)) == pytest.approx(
        [0.0, last / 4, last / 2, last * 3 / 4, last]
    )


def test_a_punch_strikes_when_the_phrase_says_and_comes_back_in_its_own_time():
    clip = LIBRARY.clip("punch")
    struck, last = clip.stage_end_frames[2], len(clip) - 1
    lasting_s = 0.5 * clip.duration_s
    pacing = paced(clip, near(clip), 1.0, 1.0 + lasting_s, pause_s=4.0)
    struck_s = 1.0 + lasting_s * struck / last
    assert pacing.frame[-1] == last
    assert pacing.end_s == pytest.approx(struck_s + (last - struck) / clip.rate_hz)
    time_s, frame = shown(pacing)
    pace = np.gradient(frame, time_s) / clip.rate_hz
    assert np.interp(struck_s - 0.1, time_s, pace) == pytest.approx(2.0, abs=0.01)
    assert np.interp(struck_s + 0.15, time_s, pace) == pytest.approx(1.0, abs=0.01)
    assert (np.diff(frame) > 0.0).all()


def test_what_is_lying_is_not_left_before_it_is_up_again():
    clip = LIBRARY.clip("fall")
    core, last = core_frame(clip), len(clip) - 1
    left = round(core + near(clip) * (last - core))
    hips_m = clip.translation_m[:, 1, 1]
    assert hips_m[core] < 0.3 * hips_m[-1] < 0.7 * hips_m[-1] < hips_m[left]
    assert paced(clip, near(clip), 0.0, 1.0, pause_s=0.0).frame[-1] > left - 1


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
    assert core + share * (last - core) - 1e-6 <= pacing.frame[-1] <= last + 1e-6
    assert np.interp(lasting_s, pacing.time_s, pacing.frame) >= core - 1e-6
    paces = np.diff(pacing.frame) / np.diff(pacing.time_s) / clip.rate_hz
    # Coming back is never faster than the strike, and never faster than it was made for nothing.
    assert (np.diff(paces) <= 1e-9).all()
    if len(paces) == 2 and paces[1] > 1.0 + 1e-9:
        whole_s = lasting_s + RECOVERING * pause_s
        reached = np.interp([lasting_s, whole_s], pacing.time_s, pacing.frame)
        wanted = [core, core + share * (last - core)]
        assert (reached - wanted).min() == pytest.approx(0.0, abs=1e-6)


def test_a_longer_pause_changes_nothing_of_the_phrase_where_the_first_was_enough():
    clip = LIBRARY.clip("slash")
    some, more = (paced(clip, near(clip), 0.0, 1.1, pause_s) for pause_s in (2.0, 5.0))
    for knots in zip((some.time_s, some.frame), (more.time_s, more.frame), strict=True):
        np.testing.assert_allclose(*knots, atol=1e-9)
