"""Shapes in what is written: as USD and Blender evaluate them, and as they are drawn."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdSkel, UsdValidation

from actions_library.stage_frame import StageFrame
from actions_library.usd_skel import unique_identifiers
from exporters.figures import read_scene
from exporters.filmstrip import write_filmstrip
from exporters.keys import drift_m, key_frames
from exporters.usd import write_usd, write_usd_layers
from smd.acting.performance import Actor, Performance
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from tests.naive.shaped import shaped_performance, shaped_puppet, weights_of

SINGLE_M = 2e-5
"""Positions are stored in single precision."""


@pytest.fixture(scope="module")
def played() -> Performance:
    return shaped_performance(seconds=2.0, rate_hz=24.0)


def skin_m(actor: Actor, tracks: Tracks | None = None) -> np.ndarray:
    """Return all of an actor's points in each frame, by our own skinning."""
    tracks = tracks or actor.tracks
    character = actor.character
    pose = forward_kinematics(character.skeleton, *actor.poses)
    meshes = [
        skin_points(mesh, character.skeleton, *pose, weights_of(mesh, tracks))
        for mesh in character.meshes
    ]
    return np.concatenate(meshes, axis=1)


@pytest.mark.parametrize("frame", [StageFrame(u, m) for u in "yz" for m in (1.0, 0.01)])
def test_usd_puts_every_point_where_our_skinning_does(played, tmp_path, frame):
    write_usd(played, tmp_path / "a.usdc", frame=frame)
    figures = read_scene(tmp_path / "a.usdc").figures
    for figure, actor in zip(figures, played.actors, strict=True):
        ours = skin_m(actor)
        for code in (0, 13, 48):
            np.testing.assert_allclose(figure.points_m(code), ours[code], atol=SINGLE_M)


def test_shapes_are_seen_at_all(played):
    moved = skin_m(played.actors[0]) - skin_m(replace(played.actors[0], character=_still()))
    assert np.abs(moved).max() > 0.05


def _still():
    character = shaped_puppet()
    return replace(character, meshes=tuple(replace(m, shapes=()) for m in character.meshes))


@pytest.mark.parametrize("variants", [False, True])
@pytest.mark.parametrize("write", [write_usd, write_usd_layers])
def test_validators_are_silent(played, tmp_path, write, variants):
    write(played, tmp_path / "a.usdc", neutral=played if variants else None)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert UsdValidation.ValidationContext(validators).Validate(stage) == []


def test_each_variant_has_its_own_weights(played, tmp_path):
    calm = replace(played, actors=tuple(replace(a, tracks=_halved(a)) for a in played.actors))
    write_usd(played, tmp_path / "a.usdc", neutral=calm)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    root = next(p for p in stage.Traverse() if p.IsA(UsdSkel.Root))
    found = []
    for name in ("expressive", "neutral"):
        root.GetVariantSet("expression").SetVariantSelection(name)
        animation = next(p for p in stage.Traverse() if p.IsA(UsdSkel.Animation))
        found.append(np.array(UsdSkel.Animation(animation).GetBlendShapeWeightsAttr().Get(20)))
    assert found[1] == pytest.approx(0.5 * found[0])
    assert found[0].max() > 0.1


def _halved(actor: Actor) -> Tracks:
    return Tracks(actor.tracks.names, 0.5 * actor.tracks.value)


@pytest.mark.parametrize("within_m", [0.006, 0.02])
def test_few_keys_keep_their_distance_with_shapes(played, within_m):
    actor = played.actors[0]
    keys = key_frames(actor.character, actor.poses, within_m, actor.tracks)
    assert 2 < len(keys) < len(played)
    assert drift_m(actor.character, actor.poses, keys, actor.tracks).max() <= within_m
    frames = np.arange(len(played))
    few = Tracks(
        actor.tracks.names,
        np.stack([np.interp(frames, keys, v[keys]) for v in actor.tracks.value.T], axis=-1),
    )
    assert np.linalg.norm(skin_m(actor, few) - skin_m(actor), axis=-1).max() <= within_m


def test_a_face_that_moves_takes_more_keys_than_one_that_rests(played):
    actor = played.actors[0]
    moving = key_frames(actor.character, actor.poses, 0.005, actor.tracks)
    assert len(moving) > len(key_frames(actor.character, actor.poses, 0.005))


def test_a_filmstrip_draws_the_shapes(played, tmp_path):
    """The same performance with a face that rests gives another picture."""
    from PIL import Image

    pictures = []
    for name, tracks in (("moves", played.actors[0].tracks), ("rests", played.actors[1].tracks)):
        one = replace(played, actors=(replace(played.actors[0], tracks=tracks),))
        write_usd(one, tmp_path / f"{name}.usdc")
        write_filmstrip(tmp_path / f"{name}.usdc", tmp_path / f"{name}.png", rows=1)
        pictures.append(np.asarray(Image.open(tmp_path / f"{name}.png").convert("L"), float))
    assert pictures[0].shape == pictures[1].shape
    assert (np.abs(pictures[0] - pictures[1]) > 30.0).mean() > 1e-3


@pytest.mark.parametrize("keys_within_m", [None, 0.002])
def test_blender_shows_the_shapes_where_our_skinning_puts_them(played, tmp_path, keys_within_m):
    bpy = pytest.importorskip("bpy", reason="Blender's Python module (pip install bpy) is absent")
    path: Path = tmp_path / "a.usdc"
    write_usd(played, path, keys_within_m=keys_within_m)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(path))
    scene = bpy.context.scene
    within_m = 1e-4 + (keys_within_m or 0.0)
    for actor in played.actors:
        ours = skin_m(actor)
        (name,) = unique_identifiers([actor.name])
        beside = scene.objects[f"{name}_character"].children
        by_name = {each.name.partition(".")[0]: each for each in beside if each.type == "MESH"}
        for frame in np.linspace(0, len(played) - 1, 10).astype(int):
            scene.frame_set(int(frame))
            graph = bpy.context.evaluated_depsgraph_get()
            start = 0
            for mesh in actor.character.meshes:
                made = by_name[mesh.name].evaluated_get(graph)
                world = np.array(made.matrix_world)
                points = np.array([v.co for v in made.data.vertices])
                x, y, z = (points @ world[:3, :3].T + world[:3, 3]).T
                theirs = np.stack([x, z, -y], axis=-1)  # Blender is Z up
                end = start + len(points)
                apart = np.linalg.norm(theirs - ours[frame, start:end], axis=-1)
                assert apart.max() < within_m
                start = end
