"""Few keys keep their promise: the skin stays within a distance, however a reader interpolates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdSkel, UsdValidation

import exporters
import smd
from exporters.figures import read_scene
from exporters.keys import MIXES, drift_m, key_frames
from exporters.usd import write_usd, write_usd_layers
from smd.acting.performance import Actor, Performance
from smd.character.character import Character
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses, mixed
from smd.character.skinning import skin_points
from smd.errors import ExportError
from smd.geometry.rotations import multiply, normalized, quaternion_about, quaternion_from_rotvec
from tests.exporters.skinned import skinned
from tests.naive.fewest_keys import fewest_keys
from tests.naive.puppet import performance as puppets
from tests.naive.puppet import puppet, wave

RECORDINGS = Path(__file__).parents[2] / "recordings"
SINGLE_M = 2e-5
"""Positions are stored in single precision."""


def random_poses(seed: int, frames: int = 40) -> Poses:
    """Return the puppet's waving, more or less, with every joint swaying and the root going far."""
    rng = np.random.default_rng(seed)
    rotation, translation = wave(frames, rate_hz=120.0)
    time = np.arange(frames)[:, None, None] / frames
    rate, size = rng.uniform(1.0, 8.0, (1, rotation.shape[1], 3)), rng.uniform(0.0, 0.4)
    sway = size * np.sin(rate * time + rng.uniform(0.0, 6.0, rate.shape))
    translation[:, 0] += 3.0 * rng.normal(size=3) * time[:, 0] ** 2
    translation[:, 1] += 0.05 * np.sin(rate[:, 0] * time[:, 0])
    return Poses(multiply(rotation, quaternion_from_rotvec(sway)), translation)


def skin_m(character: Character, poses: Poses) -> np.ndarray:
    """Return every skinned point in every frame."""
    frames = []
    for rotation, translation in zip(*poses, strict=True):
        pose = forward_kinematics(character.skeleton, rotation, translation)
        every = [skin_points(mesh, character.skeleton, *pose) for mesh in character.meshes]
        frames.append(np.concatenate(every))
    return np.array(frames)


def filled(poses: Poses, keys: np.ndarray, mix) -> Poses:
    """Return poses of every frame as a reader has them who was given the keys alone."""
    frames = np.arange(keys[-1] + 1)
    right = np.clip(np.searchsorted(keys, frames), 1, len(keys) - 1)
    first, last = keys[right - 1], keys[right]
    a, b = (Poses(*(part[at] for part in poses)) for at in (first, last))
    return mix(a, b, (frames - first) / (last - first))


def furthest_m(ours: np.ndarray, theirs: np.ndarray) -> float:
    return float(np.linalg.norm(ours - theirs, axis=-1).max())


@pytest.mark.parametrize("within_m", [0.0003, 0.001, 0.01, 0.1])
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("mix", MIXES)
def test_the_skin_stays_within_the_distance(seed, within_m, mix):
    character, poses = puppet(), random_poses(seed)
    keys = key_frames(character, poses, within_m)
    assert keys[0] == 0
    assert keys[-1] == len(poses.rotation_xyzw) - 1
    shown = skin_m(character, filled(poses, keys, mix))
    assert furthest_m(shown, skin_m(character, poses)) <= within_m
    assert drift_m(character, poses, keys).max() <= within_m


@pytest.fixture(scope="module")
def slow() -> Performance:
    """The puppets, at so many frames a second that little happens from one to the next."""
    return puppets(seconds=0.5, rate_hz=120.0)


@pytest.mark.parametrize("within_m", [0.001, 0.01])
def test_usd_shows_every_frame_within_the_distance(slow, tmp_path, within_m):
    write_usd(slow, tmp_path / "all.usdc")
    write_usd(slow, tmp_path / "few.usdc", keys_within_m=within_m)
    every, few = (Usd.Stage.Open(str(tmp_path / f"{name}.usdc")) for name in ("all", "few"))
    for name in ("left_hand", "right_hand"):
        path = f"/Performance/Actors/{name}_character"
        keys = key_times(few, name)
        assert 2 < len(keys) < 0.8 * len(slow)
        extent = UsdSkel.Root(few.GetPrimAtPath(path)).GetExtentAttr()
        for code in range(len(slow)):
            ours, theirs = skinned(every, path, code), skinned(few, path, code)
            assert furthest_m(ours, theirs) <= (SINGLE_M if code in keys else within_m + SINGLE_M)
            low, high = extent.Get(code)
            assert (np.array(low) <= theirs.min(axis=0)).all()
            assert (np.array(high) >= theirs.max(axis=0)).all()


@pytest.mark.parametrize("story", ["duel", "fledgling", "postman"])
def test_the_stories_keep_the_distance_and_their_phrases(story, tmp_path):
    library = smd.load_library()
    recording = smd.read_recording(RECORDINGS / f"{story}.csv")
    performance = smd.animate(smd.parse(recording, library), recording, library)
    smd.write(performance, tmp_path / "all.usdc")
    smd.write(performance, tmp_path / "few.usdc", keys_within_m=0.002)
    every, few = (read_scene(tmp_path / f"{name}.usdc") for name in ("all", "few"))
    for ours, theirs in zip(every.figures, few.figures, strict=True):
        assert ours.phrases == theirs.phrases
        for code in range(len(performance)):
            apart = furthest_m(ours.joints_m(code), theirs.joints_m(code))
            assert apart <= 0.002 + SINGLE_M
        for code in range(0, len(performance), 15):
            apart = furthest_m(ours.points_m(code), theirs.points_m(code))
            assert apart <= 0.002 + SINGLE_M


def key_times(stage: Usd.Stage, name: str) -> list[float]:
    """Return the time codes at which a device's animation has samples."""
    path = f"/Performance/Actors/{name}_character/{name}_animation"
    query = UsdSkel.Cache().GetAnimQuery(UsdSkel.Animation(stage.GetPrimAtPath(path)))
    return query.GetJointTransformTimeSamples()


COUNT = 20


def test_no_choice_of_keys_is_much_smaller():
    character = puppet()
    found, fewest = 0, 0
    for seed in range(4):
        poses = Poses(*(part[:COUNT] for part in random_poses(seed, frames=8 * COUNT)))
        true_m = skin_boxes_m(character, poses)

        def good(first, last, poses=poses, true_m=true_m):
            keys = np.array([0, last - first])
            part = Poses(*(each[first : last + 1] for each in poses))
            return all(
                furthest_m(
                    skin_boxes_m(character, filled(part, keys, mix)), true_m[first : last + 1]
                )
                <= 0.005
                for mix in MIXES
            )

        found += len(key_frames(character, poses, 0.005))
        fewest += fewest_keys(COUNT, good)
    assert fewest <= found <= 1.05 * fewest
    assert fewest < 2 * COUNT  # of 4 * COUNT frames


def skin_boxes_m(character: Character, poses: Poses) -> np.ndarray:
    """Return where the corners of the boxes that are measured are, ``(n, k, 3)``."""
    from exporters.bounds import joint_boxes
    from smd.geometry.rotations import rotate

    rotation, position = forward_kinematics(character.skeleton, *poses)
    corners = rotate(rotation[:, :, None], joint_boxes(character)) + position[:, :, None]
    return corners.reshape(len(corners), -1, 3)


def test_the_boxes_hold_what_each_joint_moves():
    # A point that one joint alone moves goes with that joint's box.
    character, (mesh,) = puppet(), puppet().meshes
    poses = random_poses(1, frames=3)
    corners = skin_boxes_m(character, poses).reshape(3, len(character.skeleton), 8, 3)
    points, joint = skin_m(character, poses), mesh.joint_indices[:, 0]
    axes = corners[..., [1, 2, 4], :] - corners[..., :1, :]
    for frame in range(3):
        for point, owner in zip(points[frame], joint, strict=True):
            edges = axes[frame, owner]
            share = (edges @ (point - corners[frame, owner, 0])) / np.sum(edges**2, axis=-1)
            assert (share > -1e-5).all() and (share < 1.0 + 1e-5).all()  # the skin is single


def still(frames: int) -> Poses:
    return Poses(*(np.repeat(part[:1], frames, axis=0) for part in wave(1)))


@pytest.mark.parametrize("frames", [1, 2, 3, 100])
def test_what_stands_still_or_glides_has_a_key_at_each_end(frames):
    poses = still(frames)
    ends = sorted({0, frames - 1})
    assert key_frames(puppet(), poses, 0.001).tolist() == ends
    poses.translation_m[:, 0] += np.arange(frames)[:, None] * [0.1, 0.0, -0.2]
    assert key_frames(puppet(), poses, 0.001).tolist() == ends


def test_blender_s_way_to_interpolate_counts_too():
    # At constant speed about one axis, USD's way is exact between two keys, and Blender's is not.
    poses = still(49)
    arm = puppet().skeleton.index("left_upper_arm")
    turn = quaternion_about([0.0, 0.0, 1.0], np.linspace(0.0, 2.0, 49))
    poses.rotation_xyzw[:, arm] = multiply(poses.rotation_xyzw[:, arm], turn)
    usd, blender = MIXES
    assert blender is mixed
    ends = np.array([0, 48])
    true_m = skin_m(puppet(), poses)
    assert furthest_m(skin_m(puppet(), filled(poses, ends, usd)), true_m) < 1e-9
    assert furthest_m(skin_m(puppet(), filled(poses, ends, blender)), true_m) > 0.02
    keys = key_frames(puppet(), poses, 0.001)
    assert 2 < len(keys) < 12
    assert furthest_m(skin_m(puppet(), filled(poses, keys, blender)), true_m) <= 0.001


def test_a_hand_without_skin_turns_visibly_all_the_same():
    character = replace(puppet(), meshes=())
    hand = character.skeleton.index("left_hand")
    poses = still(30)
    angle = np.sin(np.linspace(0.0, 9.0, 30))
    poses.rotation_xyzw[:, hand] = quaternion_about([1.0, 0.0, 0.0], angle)
    assert len(key_frames(character, poses, 0.001)) > 10


def in_place(performance: Performance) -> Performance:
    """Return a performance in which joints turn and nothing else."""

    def fixed(actor: Actor) -> Actor:
        translation = np.repeat(actor.poses.translation_m[:1], len(actor), axis=0)
        return replace(actor, poses=Poses(actor.poses.rotation_xyzw, translation))

    return replace(performance, actors=tuple(fixed(actor) for actor in performance.actors))


def test_what_does_not_change_is_written_once(performance, tmp_path):
    write_usd(in_place(performance), tmp_path / "few.usdc", keys_within_m=0.001)
    stage = Usd.Stage.Open(str(tmp_path / "few.usdc"))
    path = "/Performance/Actors/left_hand_character/left_hand_animation"
    animation = UsdSkel.Animation(stage.GetPrimAtPath(path))
    assert animation.GetTranslationsAttr().GetNumTimeSamples() == 0
    assert len(animation.GetTranslationsAttr().Get()) == len(puppet().skeleton)
    assert animation.GetScalesAttr().GetNumTimeSamples() == 0
    assert animation.GetRotationsAttr().GetNumTimeSamples() > 2


@pytest.mark.parametrize("write", [write_usd, write_usd_layers])
def test_few_keys_go_with_every_other_option(slow, tmp_path, write):
    neutral = in_place(slow)
    frame = smd.StageFrame("z", 0.01)
    write(slow, tmp_path / "a.usda", neutral=neutral, frame=frame, keys_within_m=0.005)
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert UsdValidation.ValidationContext(validators).Validate(stage) == []
    path = "/Performance/Actors/left_hand_character"
    write_usd(slow, tmp_path / "all.usdc", neutral=neutral, frame=frame)
    every = Usd.Stage.Open(str(tmp_path / "all.usdc"))
    for variant in ("expressive", "neutral"):
        for each in (stage, every):
            variants = each.GetPrimAtPath(path).GetVariantSet("expression")
            variants.SetVariantSelection(variant)
        assert 2 < len(key_times(stage, "left_hand")) < 0.8 * len(slow)
        for code in range(0, len(slow), 4):
            apart_cm = furthest_m(skinned(stage, path, code), skinned(every, path, code))
            assert apart_cm <= 0.5 + 100 * SINGLE_M


@pytest.mark.parametrize("within_m", [0.0, -0.001, np.nan, np.inf])
def test_a_distance_that_is_none_is_one_line_and_nothing_is_written(
    performance, tmp_path, within_m
):
    with pytest.raises(ExportError, match=r"^keys_within_m: expected a positive number, found"):
        exporters.write(performance, tmp_path / "a.usdc", keys_within_m=within_m)
    assert list(tmp_path.iterdir()) == []


def test_a_key_each_frame_is_what_is_written_unless_asked(performance, tmp_path):
    write_usd(performance, tmp_path / "a.usda")
    exporters.write(performance, tmp_path / "b.usda", keys_within_m=None)
    assert (tmp_path / "a.usda").read_bytes() == (tmp_path / "b.usda").read_bytes()
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    assert key_times(stage, "left_hand") == list(range(len(performance)))


def test_random_turns_are_kept_too():
    rng = np.random.default_rng(0)
    poses = still(12)
    turned = normalized(rng.normal(size=poses.rotation_xyzw.shape))
    keys = key_frames(puppet(), Poses(turned, poses.translation_m), 0.001)
    assert keys.tolist() == list(range(12))
