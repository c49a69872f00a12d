"""Legs that are not people's: bent backward or outward, short, many."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import smd
from actions_library.folder import load_library
from benchmarks.crawls import footholds, on_a_bend
from smd.acting.act import grounded_actor
from smd.acting.flight import DEEPEST
from smd.acting.grounding import MOST_SINK
from smd.acting.legs import feet_of, legs_of
from smd.acting.move import Footwork
from smd.acting.stepping import stepping
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.quality import MOST_SLIDE_M_S

SHIPPED = Path(__file__).parents[3] / "actions_library"


def stood(name, *, aside_m=0.0):
    """An idle pose for a second, moved aside, put on the ground: poses before and after, legs."""
    library = load_library(SHIPPED / name)
    clip = library.clip("idle")
    legs = legs_of(clip.skeleton, feet_of(clip))
    rotation, translation = (
        np.repeat(part[:1], 61, axis=0) for part in (clip.rotation_xyzw, clip.translation_m)
    )
    translation[:, 1, 0] += aside_m * np.linspace(0.0, 1.0, 61)
    footwork = Footwork(np.ones((61, len(legs)), bool), np.zeros((61, len(legs))))
    before = Poses(rotation, translation)
    actor = grounded_actor(name, library.character, before, footwork, legs, rate_hz=60.0)
    return clip.skeleton, before, actor.poses, legs


@pytest.mark.parametrize("name", ["dog", "caterpillar", "humanoid"])
def test_knees_of_legs_that_stand_well_stay_where_they_are(name):
    skeleton, before, after, legs = stood(name)
    knees = [leg.lower for leg in legs]
    then, now = (forward_kinematics(skeleton, *poses)[1][:, knees] for poses in (before, after))
    np.testing.assert_allclose(now, then, atol=0.008)


@pytest.mark.parametrize("aside_m", [0.11, 0.20])
def test_a_body_on_short_legs_does_not_sink_by_more_than_a_share_of_them(aside_m):
    skeleton, before, after, legs = stood("caterpillar", aside_m=aside_m)
    trunk = skeleton.index("trunk")
    sunk_m = before.translation_m[:, trunk, 1] - after.translation_m[:, trunk, 1]
    assert sunk_m.max() > 0.0
    assert sunk_m.max() <= MOST_SINK * max(leg.limb.reach_m for leg in legs) + 1e-9


def test_many_legs_step_in_groups_and_most_of_them_stand():
    count, frames = 16, 400
    yaw = np.radians(80.0) * np.clip((np.arange(frames) - 150) / 100, 0.0, 1.0)
    along = np.tile(np.linspace(-0.4, 0.4, count // 2), 2)
    left = np.repeat([0.06, -0.06], count // 2)
    cosine, sine = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    place = np.stack([cosine * left + sine * along, cosine * along - sine * left], axis=-1)
    everywhere = np.ones((frames, count), dtype=bool)
    stands, lift_m = stepping(place, np.tile(yaw[:, None], count), everywhere, left, 60.0)
    assert (~stands).any(axis=0).all()  # each steps
    assert (~stands).sum(axis=1).max() == count // 4
    assert np.ptp(np.flatnonzero(~stands.all(axis=1))) / 60.0 < 2.0
    assert ((lift_m > 0.0) <= ~stands).all()


@pytest.mark.parametrize("action", ["walk", "loop"])
@pytest.mark.parametrize("radius_m", [0.6, 1.2])
def test_a_caterpillar_on_a_bend_holds_the_ground_with_its_feet(action, radius_m):
    library = load_library(SHIPPED / "caterpillar")
    speed, on, least = footholds(on_a_bend(library, action, radius_m))
    assert on.mean(axis=0).min() > 0.4  # each foot, by where it is
    assert speed[on].max() < MOST_SLIDE_M_S
    assert least.min() > -0.001


def test_a_low_body_does_not_crouch_into_the_ground_to_jump():
    library = load_library(SHIPPED / "caterpillar")
    clip = library.clip("jump")
    recording = smd.read_recording(SHIPPED.parent / "recordings" / "postman.csv")
    score = smd.parse(recording, library)  # it ends with a jump
    (actor,) = smd.animate(score, recording, library, rate_hz=60.0).actors
    assert "jump" in [phrase.action for phrase in actor.phrases]
    trunk = clip.skeleton.index("trunk")
    lowest_m, own_m = (
        forward_kinematics(clip.skeleton, *poses)[1][:, trunk, 1].min()
        for poses in (actor.poses, (clip.rotation_xyzw, clip.translation_m))
    )
    height_m = clip.skeleton.world_from_bind[trunk, 1, 3]
    assert lowest_m > own_m - 1.5 * DEEPEST * height_m
