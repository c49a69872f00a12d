"""Blender opens what we write, as a user would; runs where its Python module is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import smd
from exporters.usd import write_usd, write_usd_layers
from smd.character.kinematics import forward_kinematics

bpy = pytest.importorskip("bpy", reason="Blender's Python module (pip install bpy) is absent")

RECORDINGS = Path(__file__).parents[2] / "recordings"
FRAMES = [smd.StageFrame(up, unit_m) for up in "yz" for unit_m in (1.0, 0.01)]


@pytest.fixture(scope="module")
def duel():
    """The duel with its Effort, and without."""
    library = smd.load_library()
    recording = smd.read_recording(RECORDINGS / "duel.csv")
    score = smd.parse(recording, library)
    return [smd.animate(score, recording, library, expressiveness=much) for much in (1.0, 0.0)]


@pytest.mark.parametrize("frame", FRAMES, ids=lambda f: f"{f.up}-{f.unit_m}")
def test_blender_puts_every_bone_where_we_put_it(duel, tmp_path, frame):
    write_usd(duel[0], tmp_path / "duel.usda", frame=frame)
    expect_bones(tmp_path / "duel.usda", duel[0])
    (camera,) = bpy.data.cameras
    assert camera.lens == pytest.approx(40.0, rel=1e-3)  # millimetres
    assert camera.sensor_width == pytest.approx(36.0, rel=1e-3)


def test_blender_shows_the_selected_variant_of_layers(duel, tmp_path):
    expressive, neutral = duel
    write_usd_layers(expressive, tmp_path / "duel.usda", neutral=neutral)
    expect_bones(tmp_path / "duel.usda", expressive)


def test_blender_keeps_the_distance_of_few_keys(duel, tmp_path):
    write_usd(duel[0], tmp_path / "duel.usdc", keys_within_m=0.002)
    expect_bones(tmp_path / "duel.usdc", duel[0], within_m=0.002, count=60)
    for actor in duel[0].actors:
        action = bpy.data.objects[actor.name].animation_data.action
        keys = {len(curve.keyframe_points) for curve in curves_of(action)}
        assert 2 < min(keys) == max(keys) < 0.85 * len(actor)


def curves_of(action):
    ((bag,),) = ([*strip.channelbags] for layer in action.layers for strip in layer.strips)
    return bag.fcurves


def expect_bones(path: Path, performance, *, within_m: float = 0.0, count: int = 10) -> None:
    """Check every bone at some frames of a file, in a new scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(path))
    scene = bpy.context.scene
    assert scene.render.fps == performance.rate_hz
    frames = np.linspace(0, len(performance) - 1, count).astype(int)
    for actor in performance.actors:
        _, ours_m = forward_kinematics(
            actor.character.skeleton,
            actor.poses.rotation_xyzw[frames],
            actor.poses.translation_m[frames],
        )
        armature = scene.objects[actor.name]
        assert armature.type == "ARMATURE"
        assert armature.animation_data.action.name == f"{actor.name}_animation"
        for frame, positions_m in zip(frames, ours_m, strict=True):
            scene.frame_set(int(frame))
            bones = armature.pose.bones
            for joint, (x, y, z) in zip(actor.character.skeleton.joints, positions_m, strict=True):
                theirs_m = armature.matrix_world @ bones[joint].head
                # Blender is Z up: our +Y is its +Z, our +Z its -Y
                apart_m = np.linalg.norm(np.array(theirs_m) - [x, -z, y])
                assert apart_m <= within_m + 1.5e-5
