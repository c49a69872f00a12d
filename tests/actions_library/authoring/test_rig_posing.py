from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.authoring.gait import (
    GaitDiagram,
    Step,
    gait_plants,
    metachronal,
    standing_plants,
)
from actions_library.authoring.keys import LegKey, Place, Turn
from actions_library.authoring.posing import RATE_HZ
from actions_library.authoring.rig import Chain, Rig
from actions_library.authoring.rig_keys import key, mirrored_key, on_both_sides, track_curves
from actions_library.authoring.rig_posing import at_half_rate, make_rig_clip
from actions_library.authoring.stance import standing_still, steady_travel
from actions_library.authoring.waves import Wave
from smd.character.kinematics import forward_kinematics
from smd.character.quality import flaws
from smd.errors import CharacterError
from smd.geometry.rotations import rotate
from tests.naive.ant import ant_legs, ant_rig

GAIT = GaitDiagram(0.5, 0.06, metachronal(ant_legs(), 0.5), Step(duty=0.55, lift=0.02))


def ant_walk(keys=(), waves=()):
    return make_rig_clip(
        ant_rig(),
        "walk",
        keys,
        steady_travel(GAIT.period_s, ahead=GAIT.stride_m),
        plants=gait_plants(ant_rig(), GAIT),
        waves=waves,
        stage_ends_s=(0.0, 0.0, 0.5, 0.5, 0.5),
        cyclic=True,
    )


def placed(clip):
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def test_six_legs_walk_without_a_flaw():
    clip = ant_walk(waves=[Wave("tail", "yaw", 8.0)])
    assert list(flaws(clip, travels=True)) == []
    assert len(clip.contact_joints) == 6


def test_knees_point_up_all_the_way():
    clip = ant_walk()
    place = placed(clip)
    for name in (leg for pair in ant_legs() for leg in pair):
        hip, knee, foot = (
            place[:, clip.skeleton.index(f"{name}_{joint}")] for joint in ("hip", "knee", "foot")
        )
        bulge = knee - 0.5 * (hip + foot)
        assert (bulge[:, 1] > 0.01).all()


def test_bones_keep_their_length():
    clip = ant_walk([key(0.0, place=Place(up=0.01), body=Turn(tilt=4.0))])
    place = placed(clip)
    for j, parent in enumerate(clip.skeleton.parents):
        if parent > 0 and clip.skeleton.joints[j] != "body":
            length = np.linalg.norm(place[:, j] - place[:, parent], axis=1)
            rest = np.linalg.norm(clip.skeleton.rest_translation_m[j])
            np.testing.assert_allclose(length, rest, atol=1e-9)


def test_a_chain_turns_by_its_key_in_all_and_its_tip_comes_later():
    rig = ant_rig()
    keys = [key(0.5, tail=Turn()), key(1.0, tail=Turn(yaw=60.0))]
    clip = make_rig_clip(
        rig,
        "turn",
        keys,
        standing_still(2.0),
        stage_ends_s=(0, 0, 2, 2, 2),
        plants=standing_plants(rig),
    )
    turned, _ = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    joints = [rig.skeleton.index(f"tail_{k}") for k in (1, 2, 3)]
    end = 2.0 * np.degrees(np.arcsin(turned[-1, joints, 1]))
    np.testing.assert_allclose(end, [20.0, 40.0, 60.0], atol=1e-6)
    own = 2.0 * np.degrees(np.arcsin(clip.rotation_xyzw[:, joints, 1]))
    half_s = [np.interp(10.0, own[:, k], np.arange(len(own)) / RATE_HZ) for k in range(3)]
    np.testing.assert_allclose(np.diff(half_s), 0.05, atol=0.005)


def test_a_steady_chain_looks_ahead_whatever_the_body_does():
    ant = ant_rig()
    rig = Rig(ant.skeleton, "body", (Chain("tail", ("tail_1", "tail_2", "tail_3"), steady=True),))
    keys = [
        key(0.0, body=Turn(), tail=Turn(yaw=5.0)),
        key(0.5, body=Turn(yaw=40.0, lean=20.0), tail=Turn(yaw=5.0)),
    ]
    clip = make_rig_clip(rig, "turn", keys, standing_still(1.0), stage_ends_s=(0, 0, 1, 1, 1))
    turned, _ = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    tip = turned[:, rig.skeleton.index("tail_3")]
    np.testing.assert_allclose(np.abs(tip @ tip[0]), 1.0, atol=1e-12)


def test_a_body_turns_about_its_pivot():
    ant = ant_rig()
    rig = Rig(ant.skeleton, "body", pivot_m=(0.0, 0.02, 0.3))
    keys = [key(0.0, body=Turn()), key(0.5, body=Turn(yaw=50.0, lean=20.0, tilt=-9.0))]
    clip = make_rig_clip(rig, "turn", keys, standing_still(1.0), stage_ends_s=(0, 0, 1, 1, 1))
    turned, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    body = rig.skeleton.index("body")
    pivot = place[:, body] + rotate(turned[:, body], np.array(rig.pivot_m))
    np.testing.assert_allclose(pivot, np.tile([0.0, 0.12, 0.3], (len(pivot), 1)), atol=1e-12)


def test_a_leg_that_is_lifted_by_its_keys_goes_where_they_say():
    rig = ant_rig()
    plants = standing_plants(rig)
    del plants["left_fore"]
    up = LegKey(to=(1.0, 1.0, 0.0), bend=40.0, knee=(0.0, 1.0, 0.0))
    keys = [key(0.0, left_fore=up)]
    clip = make_rig_clip(
        rig, "greet", keys, standing_still(1.0), plants=plants, stage_ends_s=(0, 0, 1, 1, 1)
    )
    place = placed(clip)
    way = (
        place[:, rig.skeleton.index("left_fore_foot")]
        - place[:, rig.skeleton.index("left_fore_hip")]
    )
    np.testing.assert_allclose(
        way / np.linalg.norm(way, axis=1, keepdims=True),
        np.tile(np.sqrt([0.5, 0.5, 0.0]), (len(way), 1)),
        atol=1e-9,
    )


def test_a_foot_out_of_reach_is_refused_with_its_time():
    with pytest.raises(ValueError, match=r"walk: left_hind: expected feet within reach, fell"):
        ant_walk([key(0.0, place=Place(up=0.3))])


def test_a_key_of_no_part_is_refused():
    with pytest.raises(ValueError, match=r"keys: expected parts of the rig .* got tial"):
        ant_walk([key(0.0, tial=Turn())])


def test_a_joint_belongs_to_one_part():
    with pytest.raises(CharacterError, match="each joint once, found 'tail_1' twice"):
        Rig(ant_rig().skeleton, "body", (Chain("a", ("tail_1",)), Chain("b", ("tail_1",))))


def test_keys_mirror_by_name():
    one = key(0.2, left_fore=LegKey(bend=30.0), tail=Turn(yaw=9.0, lean=2.0, tilt=1.0))
    other = mirrored_key(one)
    assert set(other.parts) == {"right_fore", "tail"}
    assert other.parts["tail"] == Turn(yaw=-9.0, lean=2.0, tilt=-1.0)
    assert mirrored_key(other) == one
    assert set(on_both_sides(one).parts) == {"left_fore", "right_fore", "tail"}


def test_tracks_run_through_their_keys():
    keys = [key(0.0, glow=0.2), key(0.5, glow=0.9)]
    values = track_curves(keys, ("glow", "hum"), 61, RATE_HZ, cyclic=True)
    assert values.shape == (61, 2)
    assert values[[0, 30, 60], 0] == pytest.approx([0.2, 0.9, 0.2], abs=0.02)
    assert not values[:, 1].any()


def test_a_clip_has_the_tracks_of_its_rig():
    rig = replace(ant_rig(), tracks=("glow", "hum"))
    keys = [key(0.0, place=Place(), glow=0.2), key(0.5, glow=0.9)]
    clip = make_rig_clip(
        rig,
        "glow",
        keys,
        standing_still(1.0),
        plants=standing_plants(rig),
        stage_ends_s=(0, 0, 1, 1, 1),
        cyclic=True,
    )
    assert clip.tracks.names == ("glow", "hum")
    assert clip.tracks.of(["glow"])[30, 0] == pytest.approx(0.9, abs=0.02)


def test_half_the_rate_keeps_every_second_frame_and_both_ends():
    clip = ant_walk()
    half = at_half_rate(clip)
    assert (half.rate_hz, half.duration_s) == (0.5 * clip.rate_hz, clip.duration_s)
    np.testing.assert_allclose(half.rotation_xyzw, clip.rotation_xyzw[::2], atol=1e-15)
    assert np.array_equal(half.contacts, clip.contacts[::2])
    assert half.stage_end_frames[-1] == len(half) - 1
    with pytest.raises(ValueError, match="odd number of frames, got 16"):
        at_half_rate(at_half_rate(clip))
