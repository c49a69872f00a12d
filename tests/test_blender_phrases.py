"""examples/blender/phrases.py: few keys and an action a phrase, in Blender where that is."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import smd
from smd.character.poses import Poses
from smd.geometry.rotations import matrix_from_quaternion

ROOT = Path(__file__).parents[1]
WITHIN_MM = 2.0


@pytest.fixture(scope="module")
def script():
    """The script as a module; what needs no Blender runs without one."""
    path = ROOT / "examples" / "blender" / "phrases.py"
    spec = importlib.util.spec_from_file_location("phrases_in_blender", path)
    module = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        if importlib.util.find_spec("bpy") is None:
            patch.setitem(sys.modules, "bpy", ModuleType("bpy"))
        patch.setitem(sys.modules, spec.name, module)
        spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def bpy():
    return pytest.importorskip("bpy", reason="Blender's Python module (pip install bpy) is absent")


def smooth(seed: int, count: int = 60, components: int = 4) -> np.ndarray:
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, 1.0, count)[:, None]
    waves = [rng.normal(size=components) * np.sin(k * time + rng.uniform(0, 6)) for k in range(9)]
    return np.sum(waves, axis=0)


@pytest.mark.parametrize("gap", [1, 2, 3, 4, 12, 48])
def test_a_cubic_is_one_segment_and_exact(script, gap):
    u = np.arange(gap + 1.0) / 10.0
    values = np.stack([u, 1.0 - u**2, 2.0 + u - 3.0 * u**3], axis=-1)
    fit = script.fitted(values, script.window_errors(values), 1e-9)
    assert fit.keys == [0, gap]
    shown = script.Channel('pose.bones["hips"].location', "hips", values).shown(fit)
    np.testing.assert_allclose(shown.values, values, atol=1e-9)


@pytest.mark.parametrize("gap", [3, 7, 20])
def test_no_handles_fit_better(script, gap):
    values = smooth(gap)[: gap + 1]
    handles, shape = script.bezier(gap)
    ends = shape[:, [0, 3]] @ values[[0, -1]]
    best = np.linalg.lstsq(shape[:, 1:3], values[1:-1] - ends, rcond=None)[0]
    np.testing.assert_allclose(handles @ values, best, atol=1e-9)
    off = np.linalg.norm(ends + shape[:, 1:3] @ best - values[1:-1], axis=-1).max()
    assert script.window_errors(values)[0, gap] == pytest.approx(off)


@pytest.mark.parametrize("allowed", [0.0, 0.001, 0.03, 1.0])
@pytest.mark.parametrize("seed", range(5))
def test_keys_are_exact_and_what_is_between_strays_no_further_than_allowed(script, seed, allowed):
    values = smooth(seed)
    fit = script.fitted(values, script.window_errors(values), allowed)
    assert fit.keys[0] == 0
    assert fit.keys[-1] == len(values) - 1
    assert len(fit.handles) == len(fit.keys) - 1
    shown = script.Channel("rotation_quaternion", "hips", values).shown(fit).values
    assert np.array_equal(shown[fit.keys], values[fit.keys])
    assert np.linalg.norm(shown - values, axis=-1).max() <= allowed + 1e-12
    assert (len(fit.keys) < 20) == (allowed > 0.0)


def test_what_stands_still_has_a_key_or_none(script):
    def without_motion(kind, values):
        path = f'pose.bones["hips"].{kind}'
        return script.Channel(path, "hips", np.array(values)).without_motion(1e-4)

    assert without_motion("location", [[0.0, 0.0, 1e-5]] * 9).keys == []
    assert without_motion("scale", [[1.0, 1.0, 1.0]] * 9).keys == []
    assert without_motion("rotation_quaternion", [[1.0, 0.0, 0.0, 0.0]] * 9).keys == []
    assert without_motion("location", [[0.0, 0.3, 0.0]] * 9).keys == [0]
    assert without_motion("location", [[0.0, 0.0, 0.0], [0.0, 0.0, 2e-4]]) is None


@pytest.mark.parametrize("seed", range(30))
def test_phrases_and_pauses_cover_every_frame_once(script, seed):
    rng = np.random.default_rng(seed)
    # Some overlap, are empty, or reach beyond the take.
    starts = np.sort(rng.integers(-5, 55, rng.integers(0, 6)))
    phrases = [(f"act{k}", int(s), int(s + rng.integers(0, 15))) for k, s in enumerate(starts)]
    cut = list(script.stretches("knight", phrases, 0, 50))
    assert cut[0][1] == 0
    assert cut[-1][2] == 50
    assert all(start < end for _, start, end in cut)
    assert [end for _, _, end in cut[:-1]] == [start for _, start, _ in cut[1:]]
    assert len({name for name, _, _ in cut}) == len(cut)
    for name, start, end in cut:
        number, action = int(name.split()[1]), name.split()[-1]
        if action == f"act{number - 1}" and "after" not in name:
            assert phrases[number - 1][1] <= start < end <= phrases[number - 1][2]


def test_a_take_of_one_frame_is_one_stretch(script):
    assert list(script.stretches("knight", [], 3, 3)) == [("knight 00 before", 3, 3)]


def test_quaternions_of_any_length_turn_as_ours_do(script):
    wxyz = np.random.default_rng(0).normal(size=(20, 4))
    xyzw = np.roll(wxyz / np.linalg.norm(wxyz, axis=-1, keepdims=True), -1, axis=-1)
    np.testing.assert_allclose(script.matrices(wxyz), matrix_from_quaternion(xyzw), atol=1e-12)


@pytest.fixture(scope="module")
def duel() -> smd.Performance:
    library = smd.load_library()
    recording = smd.read_recording(ROOT / "recordings" / "duel.csv")
    return smd.animate(smd.parse(recording, library), recording, library, rate_hz=30.0)


@pytest.fixture(scope="module")
def edited(bpy, script, duel, tmp_path_factory):
    """Where the bones were before Blender ran the script, in metres by frame."""
    folder = tmp_path_factory.mktemp("blender")
    smd.write(duel, folder / "duel.usdc")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(folder / "duel.usdc"))
    before = {frame: bones_m(bpy, frame) for frame in range(0, len(duel), 4)}
    bpy.ops.wm.read_factory_settings()
    script.main([str(folder / "duel.usdc"), "--within", f"{WITHIN_MM}"])
    return before


def bones_m(bpy, frame: int) -> dict[str, np.ndarray]:
    """Return heads and tails of the bones of every armature, in the world."""
    bpy.context.scene.frame_set(frame)
    return {
        thing.name: np.array(
            [
                [thing.matrix_world @ bone.head, thing.matrix_world @ bone.tail]
                for bone in thing.pose.bones
            ]
        )
        for thing in bpy.context.scene.objects
        if thing.type == "ARMATURE"
    }


def test_no_bone_is_further_away_than_was_allowed(bpy, duel, edited):
    furthest = 0.0
    for frame, meant in edited.items():
        shown = bones_m(bpy, frame)
        assert shown.keys() == meant.keys() == {actor.name for actor in duel.actors}
        for name in meant:
            apart = np.linalg.norm(shown[name] - meant[name], axis=-1).max()
            furthest = max(furthest, float(apart))
    assert 0.2 * WITHIN_MM < 1000.0 * furthest <= WITHIN_MM + 0.01


def test_each_phrase_is_an_action_with_few_keys(bpy, duel, edited):
    for actor in duel.actors:
        data = bpy.data.objects[actor.name].animation_data
        assert data.action is None
        (track,) = data.nla_tracks
        strips = list(track.strips)
        phrases = [s for s in strips if " after " not in s.name and " before" not in s.name]
        assert [s.name.split()[-1] for s in phrases] == [p.action for p in actor.phrases]
        for strip, phrase in zip(phrases, actor.phrases, strict=True):
            start, end = ((t - duel.start_s) * duel.rate_hz for t in (phrase.start_s, phrase.end_s))
            assert strip.frame_start == pytest.approx(start, abs=0.51)
            assert strip.frame_end == pytest.approx(min(end, len(duel) - 1), abs=0.51)
            assert strip.name == strip.action.name
        assert strips[0].frame_start == 0
        assert strips[-1].frame_end == len(duel) - 1
        assert all(a.frame_end == b.frame_start for a, b in pairwise(strips))
        keys = sum(len(curve.keyframe_points) for s in strips for curve in curves_of(s.action))
        assert keys < 270 * len(duel) / 12
        assert not [c for s in strips for c in curves_of(s.action) if c.data_path.endswith("scale")]
    used = {s.action for o in bpy.data.objects if o.animation_data for s in all_strips(o)}
    assert set(bpy.data.actions) == used


def all_strips(thing):
    return [strip for track in thing.animation_data.nla_tracks for strip in track.strips]


def curves_of(action):
    return action.layers[0].strips[0].channelbags[0].fcurves


def test_markers_camera_lights_and_rate_are_there_and_the_cube_is_not(bpy, duel, edited):
    scene = bpy.context.scene
    names = sorted(f"{actor.name}: {p.action}" for actor in duel.actors for p in actor.phrases)
    assert sorted(marker.name for marker in scene.timeline_markers) == names
    assert scene.camera.parent.name == "Scenery"
    views = [a for screen in bpy.data.screens for a in screen.areas if a.type == "VIEW_3D"]
    assert views
    assert {a.spaces.active.region_3d.view_perspective for a in views} == {"CAMERA"}
    assert (scene.frame_start, scene.frame_end) == (0, len(duel) - 1)
    lights = [thing for thing in scene.objects if thing.type == "LIGHT"]
    assert sorted(light.name for light in lights) == ["Fill light", "Key light"]
    for light in lights:
        down = light.matrix_world.to_3x3() @ type(light.location)((0.0, 0.0, -1.0))
        away = (scene.camera.matrix_world.to_3x3() @ type(down)((0.0, 0.0, -1.0))).dot(down)
        assert down.z < -0.3
        assert away > 0.2  # from the camera's side
    assert scene.render.fps / scene.render.fps_base == pytest.approx(30.0)
    assert "Cube" not in scene.objects
    for actor in duel.actors:
        (paint,) = scene.objects[f"{actor.name}_doodle"].data.materials
        named = {node.attribute_name for node in paint.node_tree.nodes if node.type == "ATTRIBUTE"}
        assert named <= set(scene.objects[f"{actor.name}_doodle"].data.attributes.keys())
        assert named


def test_a_scene_of_one_s_own_stays_as_it_is(bpy, script, duel, tmp_path, capsys):
    actor = replace(duel.actors[0], phrases=())
    still = Poses(*(np.repeat(part[:1], 5, axis=0) for part in actor.poses))
    moving = Poses(*(part[:20] for part in actor.poses))
    bpy.ops.wm.read_factory_settings()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "own.blend"))
    for name, poses in (("still", still), ("moving", moving)):
        alone = replace(duel, actors=(replace(actor, name=name, poses=poses),))
        smd.write(alone, tmp_path / f"{name}.usda")
        script.main([str(tmp_path / f"{name}.usda"), "--save", str(tmp_path / f"{name}.blend")])
        assert (tmp_path / f"{name}.blend").stat().st_size > 0
    scene = bpy.context.scene
    assert {"Cube", "Light", "still", "moving"} <= {thing.name for thing in scene.objects}
    assert scene.camera.name == "Camera" and scene.camera.parent is None
    assert (scene.render.fps, scene.frame_start, scene.frame_end) == (24, 1, 250)
    assert "the file has 30 frames a second" in capsys.readouterr().out
    assert len([thing for thing in scene.objects if thing.type == "LIGHT"]) == 1
    (strip,) = all_strips(bpy.data.objects["moving"])
    assert strip.name == "moving 00 before"
    assert len(scene.timeline_markers) == 0


def test_what_is_no_usd_is_said(bpy, script, capsys):
    with pytest.raises(SystemExit):
        script.main([str(Path(__file__))])
    assert f"{Path(__file__)}: expected a USD file, got something else" in capsys.readouterr().err


def test_an_older_blender_is_told(bpy, script, monkeypatch, capsys):
    monkeypatch.setattr(script, "OLDEST", (99, 1))
    with pytest.raises(SystemExit):
        script.main([str(Path(__file__))])
    assert "expected Blender 99.1 or newer, found" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["gone.usdc"], "gone.usdc: expected a USD file, found none"),
        ([str(Path(__file__)), "--within", "0"], "--within: expected millimetres above 0, found 0"),
        ([str(Path(__file__)), "--within", "nan"], "--within: expected millimetres above 0"),
        ([], "usd"),
    ],
)
def test_bad_arguments_are_said(script, capsys, arguments, said):
    with pytest.raises(SystemExit) as stopped:
        script.main(arguments)
    assert stopped.value.code == 2
    assert said in capsys.readouterr().err
