from __future__ import annotations

import numpy as np
import pytest

from smd.acting.grounding import MOST_SINK_M, grounded
from smd.acting.legs import feet_of, legs_of, world_of
from smd.acting.move import Footwork
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.geometry.rotations import rotate
from smd.transfer.repertoire import piece_of

CLIPS = ["walk", "run", "side_step_left", "jump", "turn_left", "punch", "throw", "bow", "idle"]


def study(library, name):
    clip = library.clip(name)
    legs = legs_of(clip.skeleton, feet_of(clip))
    piece = piece_of(clip, travels=True, legs=legs)
    return clip, legs, piece.stands, piece.yaw_rad


@pytest.mark.parametrize("name", CLIPS)
def test_a_clip_on_its_own_path_is_hardly_touched(library, name):
    clip, legs, stands, pivot = study(library, name)
    raw = Poses(clip.rotation_xyzw, clip.translation_m)
    done = grounded(clip.skeleton, raw, Footwork(stands, pivot), legs, clip.rate_hz)
    before = forward_kinematics(clip.skeleton, *raw)[1]
    after = forward_kinematics(clip.skeleton, *done)[1]
    assert np.linalg.norm(after - before, axis=-1).max() < 0.025


@pytest.mark.parametrize("stretch", [0.7, 1.2])
@pytest.mark.parametrize("name", ["walk", "side_step_left"])
def test_on_a_longer_or_shorter_way_planted_soles_stand_still(library, name, stretch):
    clip, legs, stands, pivot = study(library, name)
    laps, last = 4, len(clip) - 1
    rows = np.concatenate([np.arange(last)] * laps)
    translation = clip.translation_m[rows].copy()
    lap = np.repeat(np.arange(laps), last)[:, None]
    travel = clip.translation_m[last, 0] - clip.translation_m[0, 0]
    translation[:, 0] = stretch * (translation[:, 0] + lap * travel)
    raw = Poses(clip.rotation_xyzw[rows], translation)
    done = grounded(clip.skeleton, raw, Footwork(stands[rows], pivot[rows]), legs, clip.rate_hz)
    slides = []
    for leg, on in zip(legs, stands[rows].T, strict=True):
        q, ankle = world_of(clip.skeleton, leg.foot, *done)
        heel, ball = ankle + rotate(q, leg.heel_m), ankle + rotate(q, leg.ball_m)
        assert heel[:, 1].min() > -1e-3
        assert (ball[:, 1] - leg.ball_height_m).min() > -1e-3
        on_heel = heel[:, 1] < ball[:, 1] - leg.ball_height_m
        same = on[1:] & on[:-1] & (on_heel[1:] == on_heel[:-1])
        low = np.where(on_heel[1:, None], np.diff(heel, axis=0), np.diff(ball, axis=0))
        slides.append(np.linalg.norm(low[same][:, [0, 2]], axis=-1) * clip.rate_hz)
    slide = np.concatenate(slides)
    assert slide.mean() < 0.02
    assert np.quantile(slide, 0.95) < 0.06


def test_the_body_sinks_no_further_than_it_may(library):
    clip, legs, stands, pivot = study(library, "walk")
    translation = clip.translation_m.copy()
    translation[:, 0] *= 3.0
    raw = Poses(clip.rotation_xyzw, translation)
    done = grounded(clip.skeleton, raw, Footwork(stands, pivot), legs, clip.rate_hz)
    hips = clip.skeleton.index("hips")
    sunk = raw.translation_m[:, hips, 1] - done.translation_m[:, hips, 1]
    assert sunk.min() > -1e-12
    assert sunk.max() <= MOST_SINK_M + 1e-12


def test_above_the_legs_nothing_turns(library):
    clip, legs, stands, pivot = study(library, "walk")
    raw = Poses(clip.rotation_xyzw, 0.8 * clip.translation_m)
    done = grounded(clip.skeleton, raw, Footwork(stands, pivot), legs, clip.rate_hz)
    of_legs = {joint for leg in legs for joint in (leg.upper, leg.lower, leg.foot)}
    others = [joint for joint in range(len(clip.skeleton)) if joint not in of_legs]
    assert (done.rotation_xyzw[:, others] == raw.rotation_xyzw[:, others]).all()


def test_a_character_without_legs_stays_as_it_is(library):
    clip = library.clip("fly")
    n = len(clip)
    raw = Poses(clip.rotation_xyzw, clip.translation_m)
    no_feet = Footwork(np.zeros((n, 0), bool), np.zeros((n, 0)))
    done = grounded(clip.skeleton, raw, no_feet, (), clip.rate_hz)
    assert (done.rotation_xyzw == raw.rotation_xyzw).all()
    assert (done.translation_m == raw.translation_m).all()
