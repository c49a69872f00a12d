"""Body time: what is pushed too hard is slowed down, and the strike comes when it is planned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import smd
from actions_library.folder import load_library
from smd.acting.legs import feet_of, legs_of
from smd.character.mass import mass_of
from smd.doodle import Doodle, Recording
from smd.score import Part, Phrase, Score
from smd.transfer.body_time import MOST_FLOWN, BodyTime, body_pacing, body_time
from smd.transfer.limits import Limits
from smd.transfer.pacing import RECOVERING
from smd.transfer.repertoire import Piece, piece_of
from tests.smd.acting import test_odd_characters as odd

LIBRARY = load_library()
LIMITS = Limits()
ONCE = [action.name for action in LIBRARY.actions if not LIBRARY.clip(action.name).cyclic]


def piece(name: str) -> Piece:
    clip = LIBRARY.clip(name)
    travels = next(action.travels for action in LIBRARY.actions if action.name == name)
    legs = legs_of(clip.skeleton, feet_of(clip))
    return piece_of(clip, travels=travels, legs=legs, mass=mass_of(clip.skeleton))


PIECES = {name: piece(name) for name in ONCE}


def time_of(name: str, entry_s: float = 0.0, limits: Limits = LIMITS) -> BodyTime:
    flies = PIECES[name].airborne is not None
    return body_time(PIECES[name], None, 0.5 if flies else None, entry_s, limits)


@pytest.mark.parametrize("name", ONCE)
def test_no_frame_is_comfortable_in_less_than_its_own_time_unless_it_flies(name):
    time, clip = time_of(name), LIBRARY.clip(name)
    ground = ~time.flies
    assert (time.comfortable_s[ground] >= 1.0 / clip.rate_hz - 1e-12).all()
    assert (time.least_s <= time.comfortable_s + 1e-12).all()
    assert time.before_s + time.after_s <= time.comfortable_s.sum() + 1e-9
    if time.flies.any():
        assert time.comfortable_s[time.flies].sum() == pytest.approx(0.5)
    assert (PIECES[name].airborne is not None) == time.flies.any()


@pytest.mark.parametrize("name", [name for name in ONCE if PIECES[name].airborne is None])
def test_a_push_that_is_four_times_as_hard_takes_twice_as_long(name):
    """An acceleration falls with the square of the time."""
    weak = replace(LIMITS, push_m_s2=1e-3)
    weaker = replace(LIMITS, push_m_s2=0.25e-3)
    one, other = (time_of(name, limits=limits).comfortable_s for limits in (weak, weaker))
    pushed = one > 1.5 / LIBRARY.clip(name).rate_hz
    assert pushed.any()
    level = other[pushed] / one[pushed]
    assert np.median(level) == pytest.approx(2.0, rel=1e-6)


def test_without_a_body_s_weight_a_clip_keeps_its_own_time():
    weightless = replace(PIECES["punch"], body=None)
    time = body_time(weightless, None, None, 0.0, LIMITS)
    assert time.comfortable_s == pytest.approx(1.0 / weightless.clip.rate_hz)


@given(
    st.sampled_from(ONCE),
    st.floats(0.02, 4.0),
    st.floats(0.02, 4.0),
    st.floats(0.0, 3.0),
    st.floats(0.0, 1.0),
)
def test_every_pacing_keeps_its_promises(name, before_s, after_s, pause_s, entry_s):
    time, last = time_of(name, entry_s), PIECES[name].last_frame
    strike_s = 2.0 + before_s
    end_s = strike_s if time.struck == last else strike_s + after_s
    pacing = body_pacing(time, 2.0, strike_s, end_s, pause_s)
    assert np.isfinite(pacing.time_s).all() and np.isfinite(pacing.frame).all()
    assert (np.diff(pacing.time_s) > 0.0).all()
    assert (np.diff(pacing.frame) >= -1e-9).all()
    assert pacing.start_s == 2.0 and pacing.frame[0] == 0.0
    assert pacing.frame[-1] <= last + 1e-9
    assert end_s - 1e-9 <= pacing.end_s <= end_s + RECOVERING * pause_s + 1e-9
    struck = np.interp(strike_s, pacing.time_s, pacing.frame)
    assert struck == pytest.approx(time.struck, abs=1e-3)
    # The core is done with the phrase.
    assert np.interp(end_s, pacing.time_s, pacing.frame) >= time.core - 1e-3


@given(st.sampled_from(ONCE), st.floats(1.0, 2.0), st.floats(0.0, 0.6))
def test_with_the_time_that_it_wishes_no_frame_is_hurried(name, more, entry_s):
    time = time_of(name, entry_s)
    if time.flies.sum() and time.before_s - entry_s < 0.5 / MOST_FLOWN:
        return
    strike_s = max(more * time.before_s, 2.0 * entry_s)
    pacing = body_pacing(time, 0.0, strike_s, strike_s + more * time.after_s + 1.0, 10.0)
    leaves = np.append(np.diff(pacing.frame) > 1e-12, True)  # the first frame is waited in
    at_s = np.interp(np.arange(time.struck + 1), pacing.frame[leaves], pacing.time_s[leaves])
    lasting_s = np.diff(at_s)
    assert (lasting_s >= time.comfortable_s[: time.struck] - 1e-6).all()


@pytest.mark.parametrize("ends", [[0, 0, 0, 0, 60], [0, 0, 0, 30, 60], [0, 0, 60, 60, 60]])
@pytest.mark.parametrize("name", odd.CHARACTERS)
def test_a_clip_that_strikes_with_its_first_frame_is_acted(monkeypatch, tmp_path, name, ends):
    make = odd.Clip

    def clip(**parts):
        jumps = parts["name"] == "jump"
        return make(**{**parts, "stage_end_frames": np.array(ends)} if jumps else parts)

    monkeypatch.setattr(odd, "Clip", clip)
    library = odd.library_of(tmp_path / "odd", *odd.CHARACTERS[name])
    time_s = np.arange(5 * 90 + 1) / 90.0
    q = np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1))
    doodle = Doodle(time_s, np.zeros((len(time_s), 3)), q, "fox")
    score = Score((Part("fox", (Phrase("jump", 2.0, 3.0),)),))
    (actor,) = smd.animate(score, Recording((doodle,)), library).actors
    assert np.isfinite(actor.poses.translation_m).all()
    assert np.isfinite(actor.poses.rotation_xyzw).all()


def test_rounding_does_not_decide_how_a_phrase_without_time_is_shared_out():
    """Where least and comfortable times come to the same, a hair more or less changes nothing."""
    easy_s, least_s = np.array([0.1, 0.3, 0.2]), np.array([0.3, 0.2, 0.1])
    none = np.zeros(3, dtype=bool)
    hair_s = 1e-15
    pacings = [
        body_pacing(
            BodyTime(easy_s, least_s + more, none, none, 0.0, struck=3, core=3, needed=3.0),
            *(0.0, 0.4, 0.4, 0.0),
        )
        for more in (-hair_s, hair_s)
    ]
    np.testing.assert_allclose(pacings[0].time_s, pacings[1].time_s, atol=1e-9)
