"""The moon: mirror images, shapes without folds, lips that touch, a library without walking."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from actions_library.authoring.moon.face import moon_character
from actions_library.authoring.moon.library import MOON_ACTIONS, moon_clips
from actions_library.authoring.moon.motions import MOON_SHAPES
from actions_library.authoring.moon.mouth import MOUTH_M, lip_line_m
from actions_library.authoring.moon.skeleton import EYE, moon_rig
from actions_library.checking import check_library
from actions_library.folder import load_library
from smd.character.character import Character, Mesh
from smd.character.quality import flaws
from smd.doodle import Doodle, Recording
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

RIG = moon_rig()
CLIPS = {clip.name: clip for clip in moon_clips(RIG)}
FOLDER = Path(__file__).parents[3] / "actions_library" / "moon"
FLIP = np.array([-1.0, 1.0, 1.0])


@cache
def figure() -> Character:
    return moon_character(RIG.skeleton)


def named(name: str) -> Mesh:
    return next(mesh for mesh in figure().meshes if mesh.name == name)


def shown(mesh: Mesh, name: str) -> np.ndarray:
    points = mesh.points_m.copy()
    for shape in mesh.shapes:
        if shape.name == name:
            points[shape.indices] += shape.offsets_m
    return points


def normals(points, triangles):
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def test_it_has_the_shapes_it_says():
    assert set(figure().shapes) == set(MOON_SHAPES)
    assert len(MOON_SHAPES) >= 16


@pytest.mark.parametrize("name", ["skin", "lips", "lids", "brows"])
def test_right_shapes_are_the_mirror_images_of_left_ones(name):
    from scipy.spatial import KDTree

    mesh = named(name)
    away, image = KDTree(mesh.points_m).query(mesh.points_m * FLIP)
    assert away.max() < 1e-9
    for own in (shape.name for shape in mesh.shapes):
        twin = own.replace("left_", "right_") if "left_" in own else own.replace("right_", "left_")
        np.testing.assert_allclose(shown(mesh, own)[image] * FLIP, shown(mesh, twin), atol=1e-7)


@pytest.mark.parametrize("name", MOON_SHAPES)
def test_no_triangle_of_the_skin_flips(name):
    mesh = named("skin")
    before, after = (normals(p, mesh.triangles) for p in (mesh.points_m, shown(mesh, name)))
    corners = mesh.points_m[mesh.triangles]
    x, y = np.abs(corners[..., 0]), corners[..., 1]
    # closed lips are pressed flat against each other, and face anywhere
    sealed = (np.abs(y - lip_line_m(x)) < 4e-4).all(axis=1) & (x < MOUTH_M[0]).all(axis=1)
    flat = np.einsum("tk,tk->t", before, after) <= 0.0
    assert not (flat & ~sealed).any()


@pytest.mark.parametrize("name", MOON_SHAPES)
def test_shapes_move_part_of_the_face(name):
    points = sum(len(mesh.points_m) for mesh in figure().meshes)
    own = [s for mesh in figure().meshes for s in mesh.shapes if s.name == name]
    assert sum(len(shape.indices) for shape in own) < 0.6 * points
    assert 0.002 < max(np.linalg.norm(s.offsets_m, axis=1).max() for s in own) < 0.05


def test_an_open_mouth_shows_the_dark_and_a_closed_one_does_not():
    # along a line of sight from the front, through the middle of the open mouth
    at = np.array([0.0, MOUTH_M[1] - 0.018])
    ahead = {}
    for weight in ("", "jaw_open"):
        ahead[weight] = {
            mesh.name: _front(shown(mesh, weight), mesh.triangles, at) for mesh in figure().meshes
        }
    assert ahead["jaw_open"]["mouth"] > max(ahead["jaw_open"][n] for n in ("skin", "lips"))
    assert ahead[""]["mouth"] < max(ahead[""][name] for name in ("skin", "lips"))


def _front(points, triangles, at):
    """Return how far to the front a mesh is on a line along z, -1 where it is not."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    u, v, w = (b - a)[:, :2], (c - a)[:, :2], at - a[:, :2]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    area = np.where(np.abs(area) < 1e-14, np.nan, area)
    s = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
    t = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
    hit = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
    z = a[:, 2] + s * (b - a)[:, 2] + t * (c - a)[:, 2]
    return float(z[hit].max(initial=-1.0))


def test_a_closed_lid_is_before_the_pupil_and_an_open_one_is_not():
    at = np.array(EYE.centre[:2])
    pupil = _front(named("pupils").points_m, named("pupils").triangles, at)
    lids = named("lids")
    assert _front(shown(lids, "left_blink"), lids.triangles, at) > pupil
    assert _front(lids.points_m, lids.triangles, at) < pupil


@pytest.mark.parametrize("name", CLIPS)
def test_no_clip_has_a_flaw_and_each_begins_and_ends_at_rest(name):
    clip = CLIPS[name]
    assert list(flaws(clip, travels=False)) == []
    if name != "idle":
        np.testing.assert_allclose(clip.tracks.value[[0, -1]], 0.0, atol=1e-3)
    assert clip.tracks.value.min() >= -1e-9


@pytest.mark.parametrize("action", [action.name for action in MOON_ACTIONS])
def test_whatever_it_is_asked_to_do_it_does_without_feet(action):
    time_s = np.arange(0.0, 6.0, 1.0 / 60.0)
    place = np.outer(time_s, [0.0, 0.0, 0.1]) + np.array([0.0, 0.8, 0.0])
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)), "prop")
    score = Score((Part("prop", (Phrase(action, 1.5, 4.0),)),))
    played = animate(score, Recording((doodle,)), load_library(FOLDER))
    actor = played.actors[0]
    assert np.isfinite(actor.poses.translation_m).all()
    assert np.abs(actor.tracks.value).max() > 0.1


def test_the_library_in_the_tree_is_what_the_authoring_makes():
    library = load_library(FOLDER)
    assert [action.name for action in library.actions] == [a.name for a in MOON_ACTIONS]
    assert check_library(library).faults == ()
    for name, clip in CLIPS.items():
        stored = library.clip(name)
        np.testing.assert_allclose(stored.rotation_xyzw, clip.rotation_xyzw, atol=1e-5)
        np.testing.assert_allclose(
            stored.tracks.of(MOON_SHAPES), clip.tracks.of(MOON_SHAPES), atol=1e-6
        )
    assert library.action("nod").pattern == load_library().action("nod").pattern


def test_the_folder_is_small():
    assert sum(file.stat().st_size for file in FOLDER.rglob("*") if file.is_file()) < 2_000_000
