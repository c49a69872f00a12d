from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.character.character_rig import CharacterRig
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.rig import ControlRig, Controls, FunctionRig
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from smd.errors import CharacterError
from smd.geometry.rotations import quaternion_about
from tests.naive.puppet import puppet, waving_clip
from tests.naive.shaped import NAMES, shaped_clip, shaped_puppet, weights_of

LAMP = Controls(("height", "swing"), [1.0, 0.0], [0.5, -1.0], [2.0, 1.0])
TRIANGLE = [[0, 1, 2]]


def lamp(poses: np.ndarray) -> np.ndarray:
    """A triangle as high as one control, swung aside by the other."""
    height, swing = poses.T
    tip = np.stack([swing, height, 0.0 * height], axis=-1)
    feet = np.broadcast_to([[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]], (len(poses), 2, 3))
    return np.concatenate([feet, tip[:, None]], axis=1)


def test_a_function_is_a_rig():
    rig: ControlRig = FunctionRig(LAMP, TRIANGLE, lamp)
    surface = rig.surface_m([[1.5, 0.25], rig.controls.rest])
    assert surface.shape == (2, 3, 3)
    assert surface[:, 2].tolist() == [[0.25, 1.5, 0.0], [0.0, 1.0, 0.0]]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"names": ("height", "height")}, "unique names"),
        ({"names": ()}, "at least one"),
        ({"rest": [1.0]}, r"controls: rest: expected shape \(2\), got \(1,\)"),
        ({"high": [2.0, np.inf]}, "controls: high: expected finite"),
        ({"rest": [3.0, 0.0]}, "control 'height': expected its rest within 0.5 to 2, got 3"),
    ],
)
def test_what_are_no_controls_is_refused(change, said):
    given = {"names": LAMP.names, "rest": LAMP.rest, "low": LAMP.low, "high": LAMP.high}
    with pytest.raises(CharacterError, match=said):
        Controls(**given | change)


@pytest.mark.parametrize("poses", [[[1.0]], [1.0, 0.0], [[1.0, np.nan]]])
def test_what_are_no_poses_is_refused(poses):
    with pytest.raises(CharacterError, match="poses: expected"):
        FunctionRig(LAMP, TRIANGLE, lamp).surface_m(poses)


def test_a_surface_that_changes_its_topology_is_refused():
    def growing(poses: np.ndarray) -> np.ndarray:
        return np.zeros((len(poses), 3 if (poses == LAMP.rest).all() else 4, 3))

    rig = FunctionRig(LAMP, TRIANGLE, growing)
    with pytest.raises(CharacterError, match=r"surface: expected shape \(1, 3, 3\), got"):
        rig.surface_m([[2.0, 0.0]])
    with pytest.raises(CharacterError, match="triangles: expected indices below 3"):
        FunctionRig(LAMP, [[0, 1, 3]], lamp)


@pytest.fixture(scope="module")
def faced() -> CharacterRig:
    return CharacterRig(shaped_puppet(), [shaped_clip()])


def test_a_clip_comes_back_from_its_numbers(faced):
    clip = shaped_clip()
    values = faced.values(Poses(clip.rotation_xyzw, clip.translation_m), clip.tracks)
    poses, tracks = faced.posed(values)
    same = np.abs(np.sum(poses.rotation_xyzw[:, 1:] * clip.rotation_xyzw[:, 1:], axis=-1))
    assert same == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(poses.translation_m[:, 1:], clip.translation_m[:, 1:], atol=1e-12)
    np.testing.assert_allclose(tracks.value, clip.tracks.of(NAMES), atol=1e-12)
    assert (poses.translation_m[:, 0] == 0.0).all()


def test_its_surface_is_its_skin(faced):
    rng = np.random.default_rng(0)
    values = rng.uniform(-0.5, 0.5, size=(4, len(faced.controls)))
    surface = faced.surface_m(values)
    poses, tracks = faced.posed(values)
    character = faced.character
    pose = forward_kinematics(character.skeleton, *poses)
    start = 0
    for mesh in character.meshes:
        skin = skin_points(mesh, character.skeleton, *pose, weights_of(mesh, tracks))
        end = start + skin.shape[1]
        assert np.array_equal(surface[:, start:end], skin)
        start = end
    assert faced.triangles.max() == surface.shape[1] - 1 == start - 1


def test_ranges_hold_what_the_clips_do_and_the_rest(faced):
    clip = shaped_clip()
    values = faced.values(Poses(clip.rotation_xyzw, clip.translation_m), clip.tracks)
    controls = faced.controls
    assert (values >= controls.low).all()
    assert (values <= controls.high).all()
    assert controls.names[-3:] == NAMES
    assert controls.rest[-3:].tolist() == [0.0, 0.0, 0.0]
    assert "hips.move_y" in controls.names


def test_the_mean_is_in_the_middle_and_turns_are_measured_from_it():
    """A joint that turns evenly from 0 to 1 rad has its mean at half a radian."""
    clip = waving_clip(frames=101)
    rotation = clip.rotation_xyzw.copy()
    joint = clip.skeleton.index("left_upper_arm")
    angle = np.linspace(0.0, 1.0, 101)
    rotation[:, joint] = quaternion_about([0.0, 0.0, 1.0], angle)
    turning = replace(clip, rotation_xyzw=rotation)
    rig = CharacterRig(puppet(), [turning])
    column = rig.controls.names.index("left_upper_arm.turn_z")
    values = rig.values(Poses(turning.rotation_xyzw, turning.translation_m), turning.tracks)
    assert values[:, column] == pytest.approx(angle - 0.5, abs=1e-9)
    assert rig.controls.low[column] == pytest.approx(-0.5)
    assert rig.controls.high[column] == pytest.approx(0.5)


def test_a_rig_needs_clips_of_its_character():
    with pytest.raises(CharacterError, match="at least one clip"):
        CharacterRig(puppet(), [])
    other = replace(
        waving_clip(),
        skeleton=replace(puppet().skeleton, joints=tuple(map(str, range(len(puppet().skeleton))))),
        contact_joints=(),
        contacts=np.zeros((30, 0), bool),
    )
    with pytest.raises(CharacterError, match="all of the character's joints"):
        CharacterRig(puppet(), [other])


def test_tracks_of_another_length_are_no_pose(faced):
    clip = shaped_clip()
    poses = Poses(clip.rotation_xyzw, clip.translation_m)
    with pytest.raises(CharacterError, match="tracks: expected 30 frames, got 2"):
        faced.values(poses, Tracks(("smile",), np.zeros((2, 1))))
