"""Legs that are not people's: bent backward or outward, short, many."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import smd
from actions_library.authoring.caterpillar.skeleton import PAIRS
from actions_library.folder import load_library
from smd.acting.act import grounded_actor
from smd.acting.grounding import MOST_SINK
from smd.acting.legs import feet_of, legs_of
from smd.acting.move import Footwork
from smd.acting.stepping import stepping
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.doodle import Recording
from smd.score import Part, Phrase, Score
from smd.synthetic.curves import circle

SHIPPED = Path(__file__).parents[3] / "actions_library"
HOLDS_M_S = 0.02


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


@pytest.mark.parametrize("radius_m", [0.6, 1.2])
def test_a_caterpillar_on_a_bend_holds_the_ground_with_its_feet(radius_m):
    library = load_library(SHIPPED / "caterpillar")
    clip = library.clip("walk")
    speed_m_s, lasts_s = clip.travel_m / clip.duration_s, 6.0
    scale = library.character.height_m / 0.175
    doodle = circle(
        radius_m=radius_m / scale,
        duration_s=lasts_s,
        turns=speed_m_s * lasts_s / (2.0 * np.pi * radius_m),
    )
    score = Score((Part(doodle.device, (Phrase("walk", 0.2, lasts_s - 0.2),)),))
    (actor,) = smd.animate(score, Recording((doodle,)), library, rate_hz=60.0).actors
    skeleton = actor.character.skeleton
    place = forward_kinematics(skeleton, *actor.poses)[1]
    still, down = [], []
    for k in PAIRS:
        for side in ("left", "right"):
            j = skeleton.index(f"{side}_foot_{k}")
            up = place[:, j, 1] - skeleton.world_from_bind[j, 1, 3]
            assert up.min() > -0.005
            low = np.lib.stride_tricks.sliding_window_view(up < 5e-4, 6).all(axis=1)
            on = np.pad(low, 2)  # of each step: it has come down, and does not leave yet
            step = np.linalg.norm(np.diff(place[:, j][:, [0, 2]], axis=0), axis=1) * 60.0
            still.append(step[on])
            down.append(on.mean())
    assert min(down) > 0.4  # each foot is on the ground for most of the time that its clip says
    speeds = np.concatenate(still)
    assert speeds.mean() < 0.25 * HOLDS_M_S
    assert np.mean(speeds > HOLDS_M_S) < 0.05
