"""A dog on a doodle's path: its own legs, which stand, and bend the way they do at rest."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import smd
from benchmarks.creatures import footed
from smd.acting.gaze import neck_of
from smd.acting.legs import feet_of, legs_of
from smd.character.kinematics import forward_kinematics, joints_in_world
from smd.geometry.rotations import rotate

DOG = smd.load_library("dog")
SKELETON = DOG.character.skeleton
STORIES = Path(__file__).parents[3] / "recordings"


def test_who_stands_on_toes_has_legs_from_hip_to_hock():
    legs = legs_of(SKELETON, feet_of(DOG.clip("walk")))
    found = {tuple(SKELETON.joints[j] for j in (leg.upper, leg.lower, leg.foot)) for leg in legs}
    assert found == {
        *((f"{side}_hip", f"{side}_knee", f"{side}_hock") for side in ("left", "right")),
        *((f"{side}_shoulder", f"{side}_elbow", f"{side}_wrist") for side in ("left", "right")),
    }


def test_people_keep_their_heels():
    people = smd.load_library()
    skeleton = people.character.skeleton
    legs = legs_of(skeleton, feet_of(people.clip("walk")))
    assert [skeleton.joints[leg.foot] for leg in legs] == ["left_foot", "right_foot"]
    assert all(leg.heel_m[2] < 0.0 for leg in legs)


@pytest.mark.parametrize("stretch", [1.0, 3.0])
def test_paws_hold_the_ground_and_do_not_sink(stretch):
    found = list(footed(DOG, (stretch,)))
    actions = {one.action for one in found}
    assert {"run", "jump", "bow", "trot" if stretch == 1.0 else "walk"} <= actions
    for one in found:
        assert one.lowest_m > -0.005
        assert one.slide_m_s <= 0.02


def test_knees_point_ahead_and_elbows_back_on_a_path():
    recording = smd.read_recording(STORIES / "postman.csv")
    score = smd.parse(recording, DOG)
    for stretch in (1.0, 3.0):
        performance = smd.animate(score, recording, DOG, stretch=stretch)
        rotation, translation = performance.actors[0].poses
        rotation = rotation.copy()
        rotation[:, 0] = [0.0, 0.0, 0.0, 1.0]  # seen from the dog itself
        place = forward_kinematics(SKELETON, rotation, translation)[1]
        for side in ("left", "right"):
            for names, ahead in (
                (("hip", "knee", "hock"), 1.0),
                (("shoulder", "elbow", "wrist"), -1.0),
            ):
                a, b, c = (place[:, SKELETON.index(f"{side}_{name}")] for name in names)
                # a leg that is stretched out is straight to rounding
                assert (ahead * np.cross(b - a, c - b)[:, 0] > -1e-4).all()


def test_a_dog_looks_at_the_person_beside_it():
    neck = neck_of(SKELETON)
    assert neck is not None and SKELETON.joints[neck.chest] == "chest"
    assert [SKELETON.joints[joint] for joint in neck.joints] == ["neck", "upper_neck", "head"]
    recording = smd.read_recording(STORIES / "duel.csv")
    cast = smd.Cast(smd.load_library(), {"rival": DOG})
    performance = smd.animate(smd.parse(recording, cast), recording, cast)
    knight, dog = performance.actors
    eyes = [
        joints_in_world(one.character.skeleton, [one.character.skeleton.index("head")], *one.poses)
        for one in (knight, dog)
    ]
    to_knight = eyes[0][1][:, 0] - eyes[1][1][:, 0]
    face = rotate(eyes[1][0][:, 0], np.array([0.0, 0.0, 1.0]))
    looking = slice(round(6.0 * performance.rate_hz), round(9.0 * performance.rate_hz))
    apart = heading(face[looking]) - heading(to_knight[looking])
    assert np.degrees(np.abs(np.arctan2(np.sin(apart), np.cos(apart)))).max() < 15.0
    assert np.degrees(np.arcsin(face[looking, 1])).min() > 10.0  # up at a person


def heading(way):
    return np.arctan2(way[:, 0], way[:, 2])
