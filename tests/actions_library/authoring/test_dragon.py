"""The dragon: symmetry, contacts, what beats and folds, shapes that fold no triangle."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from actions_library.authoring.dragon.body import dragon_character
from actions_library.authoring.dragon.library import DRAGON_ACTIONS, dragon_clips
from actions_library.authoring.dragon.skeleton import SHAPES, dragon_rig
from actions_library.authoring.rigging import other_side
from actions_library.checking import check_library
from actions_library.folder import load_library
from smd.character.character import Character
from smd.character.kinematics import forward_kinematics
from smd.character.quality import MOST_SLIDE_M_S, flaws
from smd.character.skinning import skin_points

RIG = dragon_rig()
CLIPS = {clip.name: clip for clip in dragon_clips(RIG)}
FEET = ("left_hind", "left_fore", "right_hind", "right_fore")
FOLDER = Path(__file__).parents[3] / "actions_library" / "dragon"
WING_FROM_M = 0.14
"""How far from the middle, spread, a wing is no longer what joins it to the body."""

FLIP = np.array([-1.0, 1.0, 1.0])


@cache
def figure() -> Character:
    return load_library(FOLDER).character


def placed(clip):
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def down(clip, foot):
    """When a foot is down by where it is, not by its label: its toes still and low."""
    path = placed(clip)[:, clip.skeleton.index(f"{foot}_toes")]
    step = np.linalg.norm(np.diff(path, axis=0), axis=1) * clip.rate_hz
    return (step < 0.05) & (path[:-1, 1] < 0.035)


def skinned(clip, frame):
    """Points of each mesh in a frame, with its shapes."""
    turned, place = forward_kinematics(
        clip.skeleton, clip.rotation_xyzw[frame], clip.translation_m[frame]
    )
    found = {}
    for mesh in figure().meshes:
        weights = clip.tracks.of(shape.name for shape in mesh.shapes)[frame]
        found[mesh.name] = skin_points(mesh, clip.skeleton, turned, place, weights)
    return found


def test_a_walk_lands_in_lateral_sequence_and_a_gallop_flies():
    clip = CLIPS["walk"]
    at = {
        foot: np.flatnonzero(down(clip, foot) & ~np.roll(down(clip, foot), 1))[0] for foot in FEET
    }
    order = sorted(FEET, key=lambda foot: (at[foot] - at["left_hind"]) % (len(clip) - 1))
    assert order == ["left_hind", "left_fore", "right_hind", "right_fore"]
    assert all(down(clip, foot).mean() > 0.5 for foot in FEET)
    assert (~np.any([down(CLIPS["run"], foot) for foot in FEET], axis=0)).any()


def test_walking_is_its_own_mirror_image_half_a_cycle_later():
    clip = CLIPS["walk"]
    legs = [j for j in clip.skeleton.joints if "tail" not in j]
    half = (len(clip) - 1) // 2
    place = placed(clip) - clip.translation_m[:, :1]
    own = [clip.skeleton.index(joint) for joint in legs]
    twins = [clip.skeleton.index(other_side(joint)) for joint in legs]
    image = place[: half + 1][:, twins] * FLIP
    np.testing.assert_allclose(place[half : 2 * half + 1][:, own], image, atol=0.003)


def test_flight_is_symmetric_and_its_wings_go_above_and_below_the_back():
    clip = CLIPS["fly"]
    place = placed(clip)
    twins = [clip.skeleton.index(other_side(joint)) for joint in clip.skeleton.joints]
    np.testing.assert_allclose(place[:, twins] * FLIP, place, atol=1e-6)
    wrist = place[:, clip.skeleton.index("left_finger_1"), 1]
    root = place[:, clip.skeleton.index("left_wing"), 1]
    assert (wrist - root).max() > 0.2
    assert (wrist - root).min() < -0.1
    assert place[:, [clip.skeleton.index(f"{foot}_toes") for foot in FEET], 1].min() > 0.3


@pytest.mark.parametrize("name", CLIPS)
def test_no_clip_has_a_flaw(name):
    travels = {action.name: action.travels for action in DRAGON_ACTIONS}
    assert list(flaws(CLIPS[name], travels=travels[name])) == []


@pytest.mark.parametrize("name", CLIPS)
def test_planted_paws_stand_still(name):
    clip = CLIPS[name]
    place = placed(clip)
    for column, joint in enumerate(clip.contact_joints):
        path = place[:, clip.skeleton.index(joint)]
        on = clip.contacts[:-1, column] & clip.contacts[1:, column]
        step = np.linalg.norm(np.diff(path, axis=0), axis=1) * clip.rate_hz
        assert step[on].max(initial=0.0) < MOST_SLIDE_M_S


@pytest.mark.parametrize("name", CLIPS)
def test_nothing_sinks_into_the_ground(name):
    clip = CLIPS[name]
    for frame in range(0, len(clip), 15):
        for mesh, points in skinned(clip, frame).items():
            assert points[:, 1].min() > -0.005, (mesh, frame)


@pytest.mark.parametrize("name", CLIPS)
def test_bones_keep_their_length(name):
    clip = CLIPS[name]
    fixed = [j for j, n in enumerate(clip.skeleton.joints) if n not in ("root", RIG.body)]
    rest = clip.skeleton.rest_translation_m[fixed]
    np.testing.assert_array_equal(clip.translation_m[:, fixed], np.tile(rest, (len(clip), 1, 1)))


@pytest.mark.parametrize("name", CLIPS)
def test_wings_stay_out_of_the_body(name):
    """No point of skin or bones of a wing is inside the body, but where it joins it."""
    clip = CLIPS[name]
    meshes = {mesh.name: mesh for mesh in figure().meshes}
    faces = np.insert(meshes["skin"].triangles, 0, 3, axis=1).ravel()
    free = {
        part: np.abs(meshes[part].points_m[:, 0]) > WING_FROM_M for part in ("wings", "wing_bones")
    }
    for frame in range(0, len(clip), 15):
        points = skinned(clip, frame)
        trunk = pv.PolyData(points["skin"], faces)
        wing = pv.PolyData(np.concatenate([points[part][free[part]] for part in free]))
        away_m = wing.compute_implicit_distance(trunk)["implicit_distance"]
        assert away_m.min() > -0.001, frame


def test_gestures_begin_and_end_as_their_rests_do():
    for name, first, last in (
        ("sit_down", "idle", "idle_sitting"),
        ("stand_up", "idle_sitting", "idle"),
        ("roar", "idle", "idle"),
        ("hop", "idle", "idle"),
    ):
        place = placed(CLIPS[name])
        tail = [j for j, n in enumerate(RIG.skeleton.joints) if "tail" not in n]
        np.testing.assert_allclose(place[0][tail], placed(CLIPS[first])[0][tail], atol=0.02)
        np.testing.assert_allclose(place[-1][tail], placed(CLIPS[last])[0][tail], atol=0.02)


def test_a_turn_is_a_quarter_and_its_image_the_other_one():
    left, right = placed(CLIPS["turn_left"]), placed(CLIPS["turn_right"])
    names = RIG.skeleton.joints
    nose = left[-1, names.index("head")] - left[-1, names.index("pelvis")]
    assert np.degrees(np.arctan2(nose[0], nose[2])) == pytest.approx(90.0, abs=1.0)
    twins = [names.index(other_side(joint)) for joint in names]
    np.testing.assert_allclose(right[:, twins] * FLIP, left, atol=1e-5)


def test_its_shapes_are_sparse_and_known():
    assert set(figure().shapes) == set(SHAPES)
    points = sum(len(mesh.points_m) for mesh in figure().meshes)
    for name in SHAPES:
        own = [s for mesh in figure().meshes for s in mesh.shapes if s.name == name]
        assert 0 < sum(len(shape.indices) for shape in own) < 0.2 * points, name
        assert max(np.linalg.norm(shape.offsets_m, axis=1).max() for shape in own) > 0.004, name


@pytest.mark.parametrize("name", SHAPES)
def test_no_triangle_flips(name):
    for mesh in figure().meshes:
        for shape in (s for s in mesh.shapes if s.name == name):
            moved = mesh.points_m.copy()
            moved[shape.indices] += shape.offsets_m
            before, after = (_normals(points, mesh.triangles) for points in (mesh.points_m, moved))
            turned = np.einsum("tk,tk->t", before, after)
            # what turns as a whole may face another way: horns of the crest, the jaw, lids
            if name in ("crest_raise", "jaw_open", "left_blink", "right_blink"):
                continue
            assert (turned > 0.0).all(), mesh.name


def _normals(points, triangles):
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def test_its_meshes_are_mirror_images_of_themselves():
    from scipy.spatial import KDTree

    made = dragon_character(RIG.skeleton, step_m=0.010)
    for mesh in made.meshes:
        away, _ = KDTree(mesh.points_m).query(mesh.points_m * FLIP)
        assert away.max() < 1e-9, mesh.name


def test_the_library_in_the_tree_is_what_the_authoring_makes():
    library = load_library(FOLDER)
    assert [action.name for action in library.actions] == [a.name for a in DRAGON_ACTIONS]
    assert check_library(library).faults == ()
    for name, clip in CLIPS.items():
        stored = library.clip(name)
        assert np.array_equal(stored.contacts, clip.contacts)
        np.testing.assert_allclose(stored.translation_m, clip.translation_m, atol=1e-5)
        np.testing.assert_allclose(stored.rotation_xyzw, clip.rotation_xyzw, atol=1e-5)
        np.testing.assert_allclose(stored.tracks.of(SHAPES), clip.tracks.of(SHAPES), atol=1e-6)


def test_the_dragon_is_drawn_as_people_are():
    dragon, humanoid = load_library(FOLDER), load_library()
    for name in ("walk", "run", "fly", "jump", "hop", "turn_left", "bow", "sit_down"):
        assert dragon.action(name).pattern == humanoid.action(name).pattern
        assert dragon.action(name).exemplar is not None
    assert dragon.action("roar").pattern is None


def test_the_folder_is_small():
    assert sum(file.stat().st_size for file in FOLDER.rglob("*") if file.is_file()) < 5_000_000
