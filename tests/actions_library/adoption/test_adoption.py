"""From files to a library: what is found out about a clip, checked by where things are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.adoption.character import adopted_character
from actions_library.adoption.clip import adopted_clip
from actions_library.folder import load_library
from actions_library.importers import Animation, Imported, import_file
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.quality import mean_slide_m_s, pose_gap_rad
from smd.errors import ImportedFileError
from smd.geometry.rotations import (
    heading_rad,
    inverse,
    multiply,
    quaternion_about,
    rotate,
    rotvec_from_quaternion,
)

LIBRARY = load_library()


def as_file(clip: Clip, tmp_path, *, yaw_rad: float = 0.0, shift_m=(0.0, 0.0, 0.0)) -> Imported:
    """Our clip as a file of another program: its root keeps still, its hips travel and turn."""
    skeleton = clip.skeleton
    q, p = forward_kinematics(skeleton, clip.rotation_xyzw, clip.translation_m)
    turn = quaternion_about([0.0, 1.0, 0.0], yaw_rad)
    rotation, translation = clip.rotation_xyzw.copy(), clip.translation_m.copy()
    rotation[:, 0], translation[:, 0] = turn, shift_m
    hips = skeleton.index("hips")
    rotation[:, hips] = q[:, hips]
    translation[:, hips] = p[:, hips]
    animation = Animation("taken", clip.rate_hz, rotation, translation)
    meshes = LIBRARY.character.meshes
    return Imported(tmp_path / "a.glb", skeleton, meshes, (animation,))


def adopted(imported: Imported, character=None, **options):
    (animation,) = imported.animations
    return adopted_clip(imported, animation, character or LIBRARY.character, "taken", **options)


@pytest.mark.parametrize("name", ["walk", "run", "side_step_left", "walk_backward", "sneak"])
def test_a_gait_gets_its_root_back(tmp_path, name):
    clip = LIBRARY.clip(name)
    found = adopted(as_file(clip, tmp_path, shift_m=(3.0, 0.0, -2.0)))
    assert (found.same_skeleton, found.ground.travels, found.clip.cyclic) == (True, True, True)
    assert found.clip.travel_m == pytest.approx(clip.travel_m, abs=0.02)
    step = np.diff(found.clip.translation_m[:, 0], axis=0)
    np.testing.assert_allclose(step, np.broadcast_to(step[0], step.shape), atol=1e-9)
    assert pose_gap_rad(found.clip) < 1e-6
    _, place = forward_kinematics(
        found.clip.skeleton, found.clip.rotation_xyzw, found.clip.translation_m
    )
    assert mean_slide_m_s(found.clip, place) < 0.05


def test_a_treadmill_is_walked_off(tmp_path):
    clip = LIBRARY.clip("walk")
    still = clip.translation_m.copy()
    still[:, 0] = 0.0
    found = adopted(as_file(replace(clip, translation_m=still), tmp_path))
    assert found.ground.treadmill
    assert found.clip.travel_m == pytest.approx(clip.travel_m, rel=0.05)


@pytest.mark.parametrize("name", ["bow", "punch", "wave", "crouch"])
def test_a_gesture_stays_in_place_and_is_no_cycle(tmp_path, name):
    found = adopted(as_file(LIBRARY.clip(name), tmp_path))
    assert (found.ground.travels, found.clip.cyclic) == (False, False)
    assert found.clip.travel_m == 0.0


def test_a_turn_turns_the_root(tmp_path):
    found = adopted(as_file(LIBRARY.clip("turn_left"), tmp_path)).clip
    assert heading_rad(found.rotation_xyzw[-1, 0]) == pytest.approx(np.pi / 2, abs=0.1)


def test_joints_are_where_they_were_wherever_the_file_faces(tmp_path):
    clip = LIBRARY.clip("throw")
    _, wanted = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    found = adopted(as_file(clip, tmp_path)).clip
    _, place = forward_kinematics(found.skeleton, found.rotation_xyzw, found.translation_m)
    # The root begins below the pelvis, and faces where that does.
    pelvis = wanted[0, clip.skeleton.index("hips")] * [1.0, 0.0, 1.0]
    first = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[0]
    facing = heading_rad(first[0, clip.skeleton.index("hips")])
    turned = rotate(quaternion_about([0.0, 1.0, 0.0], -facing), wanted - pelvis)
    level = place[:, 1:] - turned[:, 1:]
    assert np.abs(level[..., [0, 2]]).max() < 1e-6
    assert np.ptp(level[..., 1]) < 1e-6


def test_a_turned_figure_stands_as_it_should(tmp_path):
    imported = as_file(LIBRARY.clip("bow"), tmp_path)
    turn, place = quaternion_about([0.0, 1.0, 0.0], 1.2), np.array([2.0, 0.5, 0.0])
    skeleton = imported.skeleton
    rest_q, rest_t = skeleton.rest_rotation_xyzw.copy(), skeleton.rest_translation_m.copy()
    rest_q[0] = turn
    bind = skeleton.world_from_bind.copy()
    bind[:, :3, 3] = rotate(turn, bind[:, :3, 3]) + place
    bind[:, :3, :3] = np.swapaxes(rotate(turn, np.swapaxes(bind[:, :3, :3], -1, -2)), -1, -2)
    rest_t[0] = place
    turned = replace(
        skeleton, rest_rotation_xyzw=rest_q, rest_translation_m=rest_t, world_from_bind=bind
    )
    meshes = tuple(replace(m, points_m=rotate(turn, m.points_m) + place) for m in imported.meshes)
    character = adopted_character(replace(imported, skeleton=turned, meshes=meshes), "turned")
    own = np.concatenate([m.points_m for m in LIBRARY.character.meshes])
    new = np.concatenate([m.points_m for m in character.meshes])
    np.testing.assert_allclose(np.ptp(new, axis=0), np.ptp(own, axis=0), atol=1e-6)
    assert new[:, 1].min() == pytest.approx(0.0, abs=1e-9)
    assert character.skeleton.joints[0] == "ground_root"


def test_a_clip_of_another_body_points_its_bones_the_same_way(shared_data):
    source = import_file(shared_data / "clips" / "gltf" / "Knight.glb")
    found = adopted_clip(source, source.animation("Cheer"), LIBRARY.character, "cheer")
    assert not found.same_skeleton
    clip, names = found.clip, LIBRARY.character.skeleton.joints
    _, own = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    animation = source.animation("Cheer")
    _, theirs = forward_kinematics(
        source.skeleton, animation.rotation_xyzw, animation.translation_m
    )
    pairs = {
        ("left_upper_arm", "left_lower_arm"): ("upperarm.l", "lowerarm.l"),
        ("right_lower_arm", "right_hand"): ("lowerarm.r", "wrist.r"),
        ("left_upper_leg", "left_lower_leg"): ("upperleg.l", "lowerleg.l"),
    }
    turn = inverse(found.ground.pelvis_turn_xyzw)
    for ours, others in pairs.items():
        a, b = (own[: len(theirs), names.index(j)] for j in ours)
        c, d = (theirs[:, source.skeleton.joints.index(j)] for j in others)
        one = rotate(turn, (b - a) / np.linalg.norm(b - a, axis=-1, keepdims=True))
        other = (d - c) / np.linalg.norm(d - c, axis=-1, keepdims=True)
        assert np.sum(one * other, axis=-1).min() > 0.98


def test_a_clip_of_another_kind_of_body_is_refused_with_what_lacks(shared_data):
    horse = import_file(shared_data / "clips" / "gltf" / "horse-animations.glb")
    with pytest.raises(
        ImportedFileError, match=r"same kind.*clip lacks a left arm.*lacks another left leg"
    ):
        adopted_clip(horse, horse.animation("Walk"), LIBRARY.character, "walk")
    snake = import_file(shared_data / "clips" / "gltf" / "snake-animations.glb")
    with pytest.raises(ImportedFileError, match=r"same kind.*lacks a left leg"):
        adopted_clip(snake, snake.animation("Idle"), LIBRARY.character, "idle")


def test_a_walk_of_motion_capture_walks_on_our_body(shared_data):
    walk = import_file(shared_data / "clips" / "bvh" / "cmu_12_01_walk.bvh")
    part = walk.part(walk.animations[0], 1.0, 3.5)
    found = adopted_clip(walk, part, LIBRARY.character, "walk")
    assert found.ground.travels
    assert 1.5 < found.clip.travel_m < 4.0
    _, place = forward_kinematics(
        found.clip.skeleton, found.clip.rotation_xyzw, found.clip.translation_m
    )
    toes = place[:, [found.clip.skeleton.index(f"{s}_toes") for s in ("left", "right")], 1]
    assert -0.02 < toes.min() < 0.04
    knees = []
    for side in ("left", "right"):
        u, m, e = (
            place[:, found.clip.skeleton.index(f"{side}_{j}")]
            for j in ("upper_leg", "lower_leg", "foot")
        )
        knees.append(np.sum((m - u) * (e - m), axis=-1))
    assert np.min(knees) > 0.0  # no knee bends by more than a right angle
    assert 0.2 < found.clip.contacts.mean() < 0.8


def test_the_part_of_an_animation_is_what_was_asked_for(tmp_path):
    imported = as_file(LIBRARY.clip("throw"), tmp_path)
    (animation,) = imported.animations
    part = imported.part(animation, 0.5, 1.0)
    np.testing.assert_array_equal(part.rotation_xyzw, animation.rotation_xyzw[30:61])
    with pytest.raises(ImportedFileError, match="start before an end"):
        imported.part(animation, 1.0, 1.0)


def test_the_pelvis_s_own_turn_is_kept(tmp_path):
    clip = LIBRARY.clip("punch")
    found = adopted(as_file(clip, tmp_path)).clip
    hips = clip.skeleton.index("hips")
    turns = [c.rotation_xyzw[:, hips] for c in (clip, found)]
    one, other = (rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:])) for q in turns)
    np.testing.assert_allclose(one, other, atol=1e-9)


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("RobotExpressive.glb", "Idle"),
        ("RobotExpressive.glb", "Dance"),
        ("snake-animations.glb", None),
    ],
)
def test_a_body_without_legs_moves_as_in_its_file(shared_data, file, name):
    """Below its first joint all stand to each other as in the file, and none is upside down."""
    imported = import_file(shared_data / "clips" / "gltf" / file)
    animation = imported.animation(name or imported.animations[0].name)
    character = adopted_character(imported, "legless")
    clip = adopted_clip(imported, animation, character, "taken", cyclic=False).clip
    _, theirs = forward_kinematics(
        imported.skeleton, animation.rotation_xyzw, animation.translation_m
    )
    _, ours = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    # The snake's hangs from a first joint that stays where it is: bones of ours do not stretch.
    ours = ours[:, [clip.skeleton.index(joint) for joint in imported.skeleton.joints[1:]]]
    theirs = theirs[:, 1:]
    for frame in (0, len(clip) // 2, len(clip) - 1):
        apart = [np.linalg.norm(p[frame, :, None] - p[frame], axis=-1) for p in (ours, theirs)]
        assert np.abs(apart[0] - apart[1]).max() < 0.05 * character.height_m
    up = ours[..., 1] - theirs[..., 1]
    assert np.ptp(up, axis=1).max() < 0.05 * character.height_m
