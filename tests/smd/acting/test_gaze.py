"""Heads turn to their way and to a partner, and to nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library
from actions_library.library import Library
from smd.acting.gaze import BEHIND_RAD, MOST_YAW_RAD, NEAR, SMOOTHED_S, neck_of, with_gaze
from smd.acting.performance import Actor
from smd.character.kinematics import joints_in_world
from smd.character.poses import Poses, sampled
from smd.geometry.rotations import (
    heading_rad,
    inverse,
    multiply,
    quaternion_about,
    rotate,
    rotvec_from_quaternion,
)
from tests.naive.puppet import puppet

SHIPPED = Path(__file__).parents[3] / "actions_library"

RATE_HZ, COUNT = 24.0, 96
PUPPET = puppet()
SKELETON = PUPPET.skeleton
HEAD = SKELETON.index("head")
UP, FRONT = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


def standing(name: str, place_m=(0.0, 0.0, 0.0), facing_rad: float = 0.0) -> Actor:
    """Somebody who stands still, upright."""
    return going(name, np.tile(np.asarray(place_m, float), (COUNT, 1)), np.full(COUNT, facing_rad))


def going(name: str, root_m: np.ndarray, facing_rad: np.ndarray) -> Actor:
    """Somebody whose ground root goes a way, the body stiff."""
    rotation = np.tile(SKELETON.rest_rotation_xyzw, (len(root_m), 1, 1))
    rotation[:, 0] = quaternion_about(UP, facing_rad)
    translation = np.tile(SKELETON.rest_translation_m, (len(root_m), 1, 1))
    translation[:, 0] = root_m
    return Actor(name, PUPPET, Poses(rotation, translation))


def face(actor: Actor) -> np.ndarray:
    """Which way its head faces, ``(n, 3)``."""
    return rotate(joints_in_world(SKELETON, [HEAD], *actor.poses)[0][:, 0], FRONT)


def head_m(actor: Actor) -> np.ndarray:
    return joints_in_world(SKELETON, [HEAD], *actor.poses)[1][:, 0]


def bearing_deg(actor: Actor) -> np.ndarray:
    """How far to the left of its heading a head faces."""
    ahead = face(actor)
    off = np.arctan2(ahead[:, 0], ahead[:, 2]) - heading_rad(actor.poses.rotation_xyzw[:, 0])
    return np.degrees(np.arctan2(np.sin(off), np.cos(off)))


@pytest.mark.parametrize("angle_deg", [-55.0, -20.0, 0.0, 35.0, 55.0])
@pytest.mark.parametrize("facing_deg", [0.0, 160.0])
def test_a_head_faces_the_one_beside(angle_deg: float, facing_deg: float) -> None:
    toward = np.radians(facing_deg + angle_deg)
    other = standing("b", 2.0 * np.array([np.sin(toward), 0.0, np.cos(toward)]))
    seen, _ = with_gaze([standing("a", facing_rad=np.radians(facing_deg)), other], RATE_HZ)
    between = head_m(other) - head_m(seen)
    assert np.cross(face(seen), between)[:, 1] == pytest.approx(
        0.0, abs=0.02
    )  # half a degree: the neck moves it
    assert bearing_deg(seen) == pytest.approx(angle_deg, abs=1.0)


def test_it_looks_up_at_a_higher_one() -> None:
    flying = standing("bird", (0.0, 0.8, 2.0))
    looking, _ = with_gaze([standing("a"), flying], RATE_HZ)
    assert np.degrees(np.arcsin(face(looking)[:, 1])) == pytest.approx(
        np.degrees(np.arctan2(0.8, 2.0)), abs=0.1
    )


@pytest.mark.parametrize(
    "place_m", [(0.0, 0.0, -2.0), (0.0, 0.0, 3.0 * NEAR), (0.5, 0.0, -2.0)], ids=str
)
def test_nobody_looks_behind_or_far_away(place_m: tuple[float, ...]) -> None:
    assert abs(np.arctan2(0.5, -2.0)) > BEHIND_RAD
    alone = standing("a")
    seen, _ = with_gaze([alone, standing("b", place_m)], RATE_HZ)
    np.testing.assert_allclose(seen.poses.rotation_xyzw, alone.poses.rotation_xyzw, atol=1e-12)


def test_whoever_stands_alone_moves_as_the_clip_does(library: Library) -> None:
    clip = library.clip("nod")
    actor = Actor("a", library.character, sampled(clip, np.arange(0.0, len(clip), 2.5)))
    (seen,) = with_gaze([actor], RATE_HZ)
    np.testing.assert_allclose(seen.poses.rotation_xyzw, actor.poses.rotation_xyzw, atol=1e-9)


def test_a_nod_at_somebody_is_still_one(library: Library) -> None:
    clip = library.clip("nod")
    actor = Actor("a", library.character, sampled(clip, np.arange(0.0, len(clip), 2.5)))
    count = len(actor)
    beside = standing("b", (1.5, 0.0, 1.5))
    beside = replace(beside, poses=Poses(*(part[:count] for part in beside.poses)))
    seen, _ = with_gaze([actor, beside], RATE_HZ)

    def pitch_deg(one: Actor) -> np.ndarray:
        q = joints_in_world(one.character.skeleton, [HEAD], *one.poses)[0][:, 0]
        return np.degrees(np.arcsin(rotate(q, FRONT)[:, 1]))

    assert np.ptp(pitch_deg(seen)) > 0.8 * np.ptp(pitch_deg(actor)) > 20.0
    assert bearing_deg(seen).mean() > 30.0


def test_a_head_leads_into_a_curve() -> None:
    time_s = np.arange(COUNT) / RATE_HZ
    facing = np.clip(time_s - 1.5, 0.0, 1.2)  # turns left at 1 rad/s, from 1.5 s to 2.7 s
    step = np.stack([np.sin(facing), 0.0 * facing, np.cos(facing)], axis=1) * (1.4 / RATE_HZ)
    (seen,) = with_gaze([going("a", np.cumsum(step, axis=0), facing)], RATE_HZ)
    off = bearing_deg(seen)
    assert off[time_s < 0.5] == pytest.approx(0.0, abs=0.2)
    assert off[(time_s > 1.3) & (time_s < 1.5)].min() > 3.0  # before the body does
    assert off[(time_s > 1.7) & (time_s < 2.3)].mean() > 12.0
    assert off[time_s > 3.4] == pytest.approx(0.0, abs=0.5)


def test_who_steps_aside_looks_there_and_who_goes_backward_does_not() -> None:
    way = 1.5 * np.arange(COUNT)[:, None] / RATE_HZ
    for direction, least, most in (((1.0, 0.0, 0.0), 50.0, 60.0), ((0.0, 0.0, -1.0), -0.1, 0.1)):
        (seen,) = with_gaze([going("a", way * direction, np.zeros(COUNT))], RATE_HZ)
        middle = bearing_deg(seen)[20:-40]
        assert least < middle.min() <= middle.max() < most


def test_a_lying_body_keeps_its_head() -> None:
    lying = standing("a")
    rotation = lying.poses.rotation_xyzw.copy()
    rotation[:, 1] = quaternion_about([1.0, 0.0, 0.0], np.full(COUNT, np.radians(85.0)))
    lying = replace(lying, poses=Poses(rotation, lying.poses.translation_m))
    seen, _ = with_gaze([lying, standing("b", (1.5, 0.0, 1.5))], RATE_HZ)
    np.testing.assert_allclose(seen.poses.rotation_xyzw, rotation, atol=1e-12)


def test_turned_and_mirrored_scenes_are_looked_at_alike() -> None:
    a, b = standing("a", facing_rad=0.3), standing("b", (1.0, 0.3, 1.2), 2.0)
    angle = 1.1
    turn = quaternion_about(UP, angle)
    turned = [
        replace(
            one,
            poses=Poses(
                np.concatenate(
                    [
                        multiply(turn, one.poses.rotation_xyzw[:, :1]),
                        one.poses.rotation_xyzw[:, 1:],
                    ],
                    axis=1,
                ),
                np.concatenate(
                    [rotate(turn, one.poses.translation_m[:, :1]), one.poses.translation_m[:, 1:]],
                    axis=1,
                ),
            ),
        )
        for one in (a, b)
    ]
    for one, other in zip(with_gaze([a, b], RATE_HZ), with_gaze(turned, RATE_HZ), strict=True):
        np.testing.assert_allclose(rotate(turn, face(one)), face(other), atol=1e-9)
    mirrored = [standing("a", facing_rad=-0.3), standing("b", (-1.0, 0.3, 1.2), -2.0)]
    for one, other in zip(with_gaze([a, b], RATE_HZ), with_gaze(mirrored, RATE_HZ), strict=True):
        np.testing.assert_allclose(face(one) * [-1.0, 1.0, 1.0], face(other), atol=1e-9)


def test_only_neck_and_head_turn_within_their_range_and_smoothly() -> None:
    time_s = np.arange(COUNT) / RATE_HZ
    around = np.stack(
        [2.0 * np.sin(3.0 * time_s), 0.5 + 0.0 * time_s, 2.0 * np.cos(3.0 * time_s)], axis=1
    )
    still = standing("a")
    seen, _ = with_gaze([still, going("b", around, 0.0 * time_s)], RATE_HZ)
    neck = neck_of(SKELETON)
    assert neck is not None
    assert [SKELETON.joints[joint] for joint in neck.joints] == ["neck", "head"]
    others = [joint for joint in range(len(SKELETON)) if joint not in neck.joints]
    np.testing.assert_array_equal(
        seen.poses.rotation_xyzw[:, others], still.poses.rotation_xyzw[:, others]
    )
    np.testing.assert_array_equal(seen.poses.translation_m, still.poses.translation_m)
    assert np.abs(bearing_deg(seen)).max() <= np.degrees(MOST_YAW_RAD) + 1e-6
    head = joints_in_world(SKELETON, [HEAD], *seen.poses)[0][:, 0]
    speed = np.linalg.norm(rotvec_from_quaternion(multiply(inverse(head[:-1]), head[1:])), axis=1)
    # From one side to the other at once, smoothed: twice the angle times a Gaussian's height.
    assert speed.max() * RATE_HZ < 2.0 * MOST_YAW_RAD / (np.sqrt(2.0 * np.pi) * SMOOTHED_S)


def test_a_character_without_a_head_is_left_as_it_is(library: Library) -> None:
    legs = [i for i in range(len(SKELETON)) if "leg" in SKELETON.joints[i] or i < 2]
    skeleton = replace(
        SKELETON,
        joints=tuple(SKELETON.joints[i] for i in legs),
        parents=np.array([legs.index(p) if (p := SKELETON.parents[i]) >= 0 else -1 for i in legs]),
        rest_rotation_xyzw=SKELETON.rest_rotation_xyzw[legs],
        rest_translation_m=SKELETON.rest_translation_m[legs],
        world_from_bind=SKELETON.world_from_bind[legs],
        roles=tuple(SKELETON.roles[i] for i in legs),
    )
    assert neck_of(skeleton) is None


def test_segments_that_hold_feet_are_no_neck() -> None:
    # a caterpillar's spine is its body: turning it to look would drag the feet along
    skeleton = load_library(SHIPPED / "caterpillar").character.skeleton
    neck = neck_of(skeleton)
    assert neck is not None
    assert [skeleton.joints[joint] for joint in (neck.chest, *neck.joints)] == [
        "segment_12",
        "head",
    ]
    for name in ("humanoid", "dog"):
        skeleton = load_library(SHIPPED / name).character.skeleton
        neck = neck_of(skeleton)
        assert neck is not None
        assert "chest" in skeleton.joints[neck.chest]
