"""Blender opens what we write, as a user would; runs where its Python module is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import smd
from smd.character.kinematics import forward_kinematics

bpy = pytest.importorskip("bpy", reason="Blender's Python module (pip install bpy) is absent")

RECORDINGS = Path(__file__).parents[2] / "recordings"


def test_blender_puts_every_bone_where_we_put_it(tmp_path):
    library = smd.load_library()
    recording = smd.read_recording(RECORDINGS / "duel.csv")
    performance = smd.animate(smd.parse(recording, library), recording, library)
    path = tmp_path / "duel.usda"
    smd.write(performance, path)

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(path))
    scene = bpy.context.scene
    assert scene.render.fps == performance.rate_hz
    armatures = {
        thing.parent.name.split(".")[0]: thing
        for thing in scene.objects
        if thing.type == "ARMATURE"
    }
    frames = np.linspace(0, len(performance) - 1, 10).astype(int)
    for actor in performance.actors:
        _, ours_m = forward_kinematics(
            actor.character.skeleton, actor.rotation_xyzw[frames], actor.translation_m[frames]
        )
        armature = armatures[actor.device]
        for frame, positions_m in zip(frames, ours_m, strict=True):
            scene.frame_set(int(frame))
            bones = armature.pose.bones
            for joint, (x, y, z) in zip(actor.character.skeleton.joints, positions_m, strict=True):
                theirs_m = armature.matrix_world @ bones[joint].head
                # Blender is Z up: our +Y is its +Z, our +Z its -Y
                np.testing.assert_allclose(theirs_m, [x, -z, y], atol=1e-5)
