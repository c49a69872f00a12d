"""Shapes on their way from a file into a library and out again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pxr import Sdf, Usd

from actions_library.adoption.character import adopted_character
from actions_library.adoption.clip import adopted_clip
from actions_library.adoption.library import import_clip, library_from
from actions_library.checking import check_library
from actions_library.folder import load_library
from actions_library.importers import Imported, import_file
from actions_library.stage_frame import StageFrame
from exporters.figures import read_scene
from exporters.usd import write_usd
from smd.acting.performance import Actor, Performance
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.quality import flaws
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from tests.naive.shaped import NAMES, shaped_performance, shaped_puppet, weights_of


def one_actor() -> Performance:
    whole = shaped_performance(seconds=2.0)
    return replace(whole, actors=whole.actors[:1])


def played(clip: Clip, character) -> Performance:
    poses = Poses(clip.rotation_xyzw, clip.translation_m)
    return Performance(
        clip.rate_hz, 0.0, (Actor("left hand", character, poses, tracks=clip.tracks),)
    )


def faces(path: Path) -> dict[str, object]:
    """Return all numbers of shapes in a USD file: points, offsets, weights over time."""
    layer = Usd.Stage.Open(str(path)).Flatten()
    found: dict[str, object] = {}
    ends = ("points", "offsets", "pointIndices", "blendShapes", "blendShapeWeights")

    def keep(where: Sdf.Path) -> None:
        if where.IsPropertyPath() and where.name in ends and "_character" in str(where):
            attribute = layer.GetAttributeAtPath(where)
            if attribute is not None:
                times = layer.ListTimeSamplesForPath(where)
                found[str(where)] = [layer.QueryTimeSample(where, t) for t in times] or [
                    attribute.default
                ]

    layer.Traverse(Sdf.Path.absoluteRootPath, keep)
    return found


def test_from_usd_to_a_library_to_usd_every_number_is_the_same(tmp_path):
    write_usd(one_actor(), tmp_path / "before.usdc")
    imported = import_file(tmp_path / "before.usdc")
    library, _ = library_from(tmp_path / "mine", imported)
    (animation,) = imported.animations
    library, adopted = import_clip(library, imported, animation, "wave", cyclic=False)
    assert adopted.left_out == ()
    write_usd(played(library.clip("wave"), library.character), tmp_path / "after.usdc")
    before, after = faces(tmp_path / "before.usdc"), faces(tmp_path / "after.usdc")
    assert len(before) == 3 + 2 * 4 + 1  # points and names of two meshes, four shapes, …
    assert after == before


@pytest.mark.parametrize("frame", [StageFrame("z"), StageFrame("y", 0.01)])
def test_in_other_frames_the_same_figure_comes_in(tmp_path, frame):
    write_usd(one_actor(), tmp_path / "a.usdc", frame=frame)
    character = adopted_character(import_file(tmp_path / "a.usdc"), "puppet")
    for mesh, ours in zip(character.meshes, shaped_puppet().meshes, strict=True):
        for shape, own in zip(mesh.shapes, ours.shapes, strict=True):
            assert np.array_equal(shape.indices, own.indices)
            np.testing.assert_allclose(shape.offsets_m, own.offsets_m, atol=1e-7)


def test_offsets_turn_with_a_figure_that_is_turned_to_the_front(tmp_path):
    """Turning a figure and adding a shape may be done in either order."""
    write_usd(one_actor(), tmp_path / "a.usdc")
    imported = import_file(tmp_path / "a.usdc")
    plain = adopted_character(imported, "a")
    turned = adopted_character(imported, "a", front=(1.0, 0.0, 0.0))
    for one, other in zip(plain.meshes, turned.meshes, strict=True):
        for a, b in zip(one.shapes, other.shapes, strict=True):
            x, y, z = a.offsets_m.T
            np.testing.assert_allclose(b.offsets_m, np.stack([-z, y, x], axis=-1), atol=1e-12)


def test_an_imported_file_is_skinned_as_usd_evaluates_it(tmp_path, shared_data):
    path = shared_data / "clips" / "usd" / "blendshape-and-animation-test-001.usda"
    imported, scene = import_file(path), read_scene(path)
    (mesh,), (animation,), (figure,) = imported.meshes, imported.animations, scene.figures
    pose = forward_kinematics(imported.skeleton, animation.rotation_xyzw, animation.translation_m)
    ours = skin_points(mesh, imported.skeleton, *pose, weights_of(mesh, animation.tracks))
    for frame in (0, 9, 18, 40):
        np.testing.assert_allclose(
            ours[frame], figure.points_m(scene.start_code + frame), atol=1e-5
        )
    assert np.ptp(ours, axis=0).max() > 0.5


def imported_puppet(tmp_path) -> Imported:
    write_usd(one_actor(), tmp_path / "a.usdc")
    return import_file(tmp_path / "a.usdc")


def test_a_cycle_s_tracks_are_closed_with_its_joints(tmp_path):
    imported = imported_puppet(tmp_path)
    (animation,) = imported.animations
    character = adopted_character(imported, "puppet")
    once = adopted_clip(imported, animation, character, "wave", cyclic=False).clip.tracks
    adopted = adopted_clip(imported, animation, character, "wave", cyclic=True).clip
    tracks = adopted.tracks
    assert tracks.value[-1] == pytest.approx(tracks.value[0])
    assert tracks.value[: len(tracks) // 2] == pytest.approx(once.value[: len(tracks) // 2])
    assert [text for text in flaws(adopted, travels=False) if "close" in text] == []


def test_a_cycle_whose_tracks_end_elsewhere_is_a_flaw(tmp_path):
    imported = imported_puppet(tmp_path)
    (animation,) = imported.animations
    character = adopted_character(imported, "puppet")
    clip = adopted_clip(imported, animation, character, "wave", cyclic=True).clip
    value = clip.tracks.value.copy()
    value[-1, 1] += 0.5
    opened = replace(clip, tracks=Tracks(clip.tracks.names, value))
    found = [text for text in flaws(opened, travels=False) if "close" in text]
    assert found == [
        f"does not close: {clip.tracks.names[1]} end with other values than they begin"
    ]


def test_weights_of_shapes_that_the_character_lacks_are_left_out_and_named(tmp_path):
    imported = imported_puppet(tmp_path)
    (animation,) = imported.animations
    plain = load_library().character
    adopted = adopted_clip(imported, animation, plain, "wave")
    assert adopted.clip.tracks.names == ()
    assert set(adopted.left_out) == set(NAMES)


def test_a_figure_that_rests_with_a_weight_idles_with_it(tmp_path):
    resting = replace(imported_puppet(tmp_path), animations=())
    resting = replace(resting, rest_tracks=Tracks(("smile",), np.array([[0.25]])))
    library, _ = library_from(tmp_path / "mine", resting)
    assert library.clip("idle").tracks.of(["smile", "jaw open"]).tolist() == [[0.25, 0.0]] * 2
    assert check_library(library).faults == ()
