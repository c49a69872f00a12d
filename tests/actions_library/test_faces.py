"""The shipped clips of the face: short motions, and moods of several takes."""

from __future__ import annotations

import itertools
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import actions_library
from actions_library.authoring.clips.faces import MOODS, MOTIONS, TAKE_S
from actions_library.authoring.face_keys import BLINKS, FaceKey, blend, face, face_tracks
from actions_library.authoring.face_motion import SHAPE_NAMES
from actions_library.folder import load_library
from actions_library.library import Library
from smd.character.clip import Clip
from smd.geometry.arrays import FloatArray

UNSEEN = 1e-3
"""A weight that moves no point by more than 0.05 mm."""

SHOWN = {
    "smile": "mouthSmileLeft",
    "frown": "browDownLeft",
    "surprise": "browInnerUp",
    "wink": "eyeBlinkLeft",
    "yawn": "jawOpen",
    "laugh": "jawOpen",
    "sneer": "noseSneerLeft",
    "kiss": "mouthPucker",
    "doubt": "browOuterUpRight",
    "eye_roll": "browOuterUpLeft",
}
"""A shape that each motion cannot do without."""


@cache
def faces() -> Library:
    return load_library(Path(actions_library.__file__).with_name("faces"))


def weights(clip: Clip, *names: str) -> FloatArray:
    return clip.tracks.of(names or SHAPE_NAMES)


def takes(clip: Clip) -> list[FloatArray]:
    """Weights in each take, and how head and eyes are turned."""
    length = round(TAKE_S * clip.rate_hz)
    joints = [clip.skeleton.index(joint) for joint in ("head", "left_eye")]
    turned = clip.rotation_xyzw[:, joints, :3].reshape(len(clip), -1)
    every = np.concatenate([weights(clip), turned], axis=1)
    return [every[k : k + length] for k in range(0, len(clip) - 1, length)]


def test_there_are_ten_motions_and_eight_moods():
    assert set(SHOWN) == set(MOTIONS)
    assert len(MOTIONS) == 10
    assert len(MOODS) == 8


def test_the_character_is_the_humanoid():
    ours, its = faces().character, load_library().character
    assert ours.skeleton.joints == its.skeleton.joints
    assert ours.shapes == its.shapes
    for mine, other in zip(ours.meshes, its.meshes, strict=True):
        assert mine.points_m.tobytes() == other.points_m.tobytes(), mine.name


@pytest.mark.parametrize("name", MOTIONS)
def test_a_motion_is_short_and_begins_and_ends_with_a_face_at_rest(name):
    clip = faces().clip(name)
    assert 1.0 <= clip.duration_s <= 3.0
    assert np.abs(weights(clip)[[0, -1]]).max() < UNSEEN
    assert weights(clip, SHOWN[name]).max() > 0.45


@pytest.mark.parametrize("name", MOODS)
def test_a_mood_has_four_takes_that_differ(name):
    clip = faces().clip(name)
    assert 100 <= len(clip) <= 800
    every = takes(clip)
    assert len(every) >= 4
    for one in every:
        assert np.abs(one[0, : len(SHAPE_NAMES)]).max() < 0.02
    for one, other in itertools.combinations(every, 2):
        assert np.abs(one - other).max() > 0.1


@pytest.mark.parametrize("name", [*MOTIONS, *MOODS])
def test_weights_are_shapes_weights_and_change_without_jumps(name):
    library = faces()
    clip = library.clip(name)
    assert set(clip.tracks.names) <= set(library.character.shapes)
    assert clip.tracks.value.min() >= 0.0
    assert clip.tracks.value.max() <= 1.0
    # The quickest thing that a face does is to blink: lids close in 0.07 s.
    assert np.abs(np.diff(clip.tracks.value, axis=0)).max() < 0.40


def test_eyes_roll_all_around_and_a_wink_leaves_the_other_eye_open():
    clip = faces().clip("eye_roll")
    eye = clip.rotation_xyzw[:, clip.skeleton.index("left_eye")]
    yaw, pitch = 2.0 * eye[:, 1], 2.0 * eye[:, 0]
    assert np.degrees(yaw.max()) > 10.0
    assert np.degrees(yaw.min()) < -10.0
    assert np.degrees(-pitch.min()) > 15.0
    assert faces().clip("wink").tracks.of(["eyeBlinkRight"]).max() < 0.05


def test_faces_are_written_for_both_sides_and_blink():
    assert face(eyeBlink=0.5) == dict.fromkeys(BLINKS, 0.5)
    assert face(jawOpen=0.5, mouthSmileLeft=1.0) == {"jawOpen": 0.5, "mouthSmileLeft": 1.0}
    assert blend((0.5, {"jawOpen": 1.0}), (1.0, {"jawOpen": 0.9})) == {"jawOpen": 1.0}
    with pytest.raises(ValueError, match="smirk: expected a shape"):
        face(smirk=1.0)
    keys = [FaceKey(0.0, {}), FaceKey(1.0, {"jawOpen": 1.0})]
    tracks = face_tracks(keys, [0.4], 61, 60.0)
    assert tracks.names == ("jawOpen", *BLINKS)
    assert tracks.of(BLINKS).max(axis=0) == pytest.approx([1.0, 1.0])
    assert tracks.value[-1] == pytest.approx([1.0, 0.0, 0.0], abs=UNSEEN)


def test_the_code_makes_what_is_shipped():
    from actions_library.authoring.clips.face_actions import FACE_ACTIONS
    from actions_library.authoring.clips.faces import motion

    library = faces()
    assert library.actions == FACE_ACTIONS
    shipped = library.clip("wink")
    made = motion(shipped.skeleton, "wink")
    assert made.tracks.names == shipped.tracks.names
    np.testing.assert_allclose(made.tracks.value, shipped.tracks.value, atol=1e-6)
    np.testing.assert_allclose(made.rotation_xyzw, shipped.rotation_xyzw, atol=1e-5)
