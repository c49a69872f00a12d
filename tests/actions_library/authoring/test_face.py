"""The humanoid's face: eyes that turn, lids that cover them, lips that part, and its shapes."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.face_shape import EYE_M, EYE_RADIUS_M, MOUTH_M, lip_line_m
from actions_library.folder import load_library
from smd.character.character import Character, Mesh
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.rotations import quaternion_about

ARKIT = {
    *("browInnerUp", "cheekPuff", "jawOpen", "mouthFunnel", "mouthPucker"),
    *(
        f"{name}{side}"
        for name in (
            *("browDown", "browOuterUp", "cheekSquint", "eyeBlink", "eyeSquint", "eyeWide"),
            *("mouthFrown", "mouthLowerDown", "mouthPress", "mouthSmile", "mouthStretch"),
            *("mouthUpperUp", "noseSneer"),
        )
        for side in ("Left", "Right")
    ),
}
"""Names of Apple's ARFaceAnchor.BlendShapeLocation, of which the face has these."""


def figure() -> Character:
    return load_library().character


def named(name: str) -> Mesh:
    return next(mesh for mesh in figure().meshes if mesh.name == name)


def shown(mesh: Mesh, **weights: float) -> np.ndarray:
    """A mesh's points with some shapes mixed in."""
    points = mesh.points_m.copy()
    for shape in mesh.shapes:
        points[shape.indices] += weights.get(shape.name, 0.0) * shape.offsets_m
    return points


def both(**weights: float) -> dict[str, float]:
    """Weights of the left and of the right shape."""
    return {f"{name}{side}": w for name, w in weights.items() for side in ("Left", "Right")}


def normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def flips(mesh: Mesh, **weights: float) -> np.ndarray:
    """Which triangles face the other way when some shapes are mixed in.

    Between closed lips, 0.1 mm from where they meet, triangles are pressed flat and face anywhere.
    """
    before = normals(mesh.points_m, mesh.triangles)
    after = normals(shown(mesh, **weights), mesh.triangles)
    corners = mesh.points_m[mesh.triangles]
    x, y = np.abs(corners[..., 0]), corners[..., 1]
    sealed = (np.abs(y - lip_line_m(x)) < 1e-4).all(axis=1) & (x < MOUTH_M[0]).all(axis=1)
    return (np.einsum("tk,tk->t", before, after) <= 0.0) & ~sealed


def covered(points: np.ndarray, *meshes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Which points have a triangle of some meshes before them, seen from the front."""
    hidden = np.zeros(len(points), dtype=bool)
    for corners, triangles in meshes:
        a, b, c = np.moveaxis(corners[triangles], 1, 0)
        u, v = b - a, c - a
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        ok = np.abs(area) > 1e-14
        a, u, v, area = a[ok], u[ok], v[ok], area[ok]
        w = points[:, None] - a
        s = (w[..., 0] * v[:, 1] - w[..., 1] * v[:, 0]) / area
        t = (u[:, 0] * w[..., 1] - u[:, 1] * w[..., 0]) / area
        inside = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1.0 + 1e-9)
        ahead = a[:, 2] + s * u[:, 2] + t * v[:, 2] > points[:, None, 2] + 1e-6
        hidden |= (inside & ahead).any(axis=1)
    return hidden


def near_left_eye(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The triangles around the left eye."""
    close = np.linalg.norm(points[mesh.triangles].mean(axis=1) - EYE_M, axis=1) < 0.03
    return points, mesh.triangles[close]


def front_of_left_eye() -> np.ndarray:
    """Points all over the front of the left eyeball, its iris and its pupil."""
    found = []
    for name in ("eyes", "irises", "pupils"):
        points = named(name).points_m
        found.append(points[(points[:, 0] > 0.0) & (points[:, 2] > EYE_M[2] + 0.004)])
    return np.concatenate(found)


def test_the_shapes_have_common_names():
    assert set(figure().shapes) == ARKIT
    assert len(ARKIT) >= 24


def test_shapes_move_parts_of_the_face_and_nothing_else():
    head = named("head")
    for shape in head.shapes:
        assert 5 < len(shape.indices) < 0.5 * len(head.points_m), shape.name
        assert 0.001 < np.linalg.norm(shape.offsets_m, axis=1).max() < 0.045, shape.name
        assert (head.points_m[shape.indices, 1] > 1.44).all(), shape.name
    for name in ("body", "hair", "shirt", "eyes", "upper_teeth"):
        assert not named(name).shapes


def test_right_shapes_are_the_mirror_images_of_left_ones():
    from scipy.spatial import KDTree

    flip = np.array([-1.0, 1.0, 1.0])
    for name in ("head", "brows", "lashes", "lips"):
        mesh = named(name)
        away, image = KDTree(mesh.points_m).query(mesh.points_m * flip)
        assert away.max() < 1e-6
        shapes = {shape.name: shown(mesh, **{shape.name: 1.0}) for shape in mesh.shapes}
        for own, points in shapes.items():
            twin = own.replace("Left", "Right") if "Left" in own else own.replace("Right", "Left")
            assert np.abs(points[image] * flip - shapes[twin]).max() < 1e-6, own


@pytest.mark.parametrize("shape", sorted(ARKIT))
def test_no_triangle_flips(shape):
    for mesh in figure().meshes:
        if shape not in {own.name for own in mesh.shapes}:
            continue
        assert not flips(mesh, **{shape: 1.0}).any(), mesh.name


@pytest.mark.parametrize("shape", sorted(ARKIT))
def test_the_skin_moves_smoothly(shape):
    """Hardly an edge of the skin is more than twice as long as it was.

    Those that are run from lip to lip, at the corners of the mouth and in it.
    """
    head = named("head")
    moved = shown(head, **{shape: 1.0}) - head.points_m
    t = head.triangles
    edges = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    length = np.linalg.norm(np.diff(head.points_m[edges], axis=1)[:, 0], axis=1)
    apart = np.linalg.norm(np.diff(moved[edges], axis=1)[:, 0], axis=1)
    assert np.quantile(apart / np.maximum(length, 1e-4), 0.99) < 1.0


def test_an_open_eye_shows_its_pupil_and_a_closed_lid_covers_all_of_it():
    head, lashes, front = named("head"), named("lashes"), front_of_left_eye()
    pupil = EYE_M + np.array([[0.0, 0.0, EYE_RADIUS_M + 0.001]])

    def lids(**weights: float) -> list[tuple[np.ndarray, np.ndarray]]:
        return [near_left_eye(mesh, shown(mesh, **weights)) for mesh in (head, lashes)]

    assert not covered(pupil, *lids()).any()
    assert 1.0 - covered(front, *lids()).mean() > 0.6
    assert covered(front, *lids(eyeBlinkLeft=1.0)).all()
    wide = 1.0 - covered(front, *lids(eyeWideLeft=1.0)).mean()
    squint = 1.0 - covered(front, *lids(eyeSquintLeft=1.0)).mean()
    assert squint < 1.0 - covered(front, *lids()).mean() < wide
    np.testing.assert_array_equal(
        covered(front, *lids()), covered(front, *lids(eyeBlinkRight=1.0, eyeWideRight=1.0))
    )


@pytest.mark.parametrize("shape", ["", "eyeBlinkLeft", "eyeWideLeft", "eyeSquintLeft"])
def test_lids_stay_outside_the_eyeball(shape):
    points = shown(named("head"), **{shape: 1.0})
    away = np.linalg.norm(points - EYE_M, axis=1)
    before = points[:, 2] > EYE_M[2] + 0.003
    assert away[before].min() > EYE_RADIUS_M


def test_a_lid_half_closed_does_not_sink_into_the_eye():
    """A shape's points go straight: half-way they may come nearer, by less than lids are thick."""
    points = shown(named("head"), eyeBlinkLeft=0.5)
    away = np.linalg.norm(points - EYE_M, axis=1)
    assert away[points[:, 2] > EYE_M[2] + 0.003].min() > EYE_RADIUS_M - 0.0008


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_eye_turns_about_its_middle(side):
    character = figure()
    skeleton = character.skeleton
    q = skeleton.rest_rotation_xyzw.copy()
    q[skeleton.index(f"{side}_eye")] = quaternion_about([0.0, 1.0, 0.0], np.radians(30.0))
    world = forward_kinematics(skeleton, q, skeleton.rest_translation_m)
    out = 1.0 if side == "left" else -1.0
    pupils = named("pupils")
    own = out * pupils.points_m[:, 0] > 0.0
    moved = skin_points(pupils, skeleton, *world)
    middle = EYE_M * [out, 1.0, 1.0]
    way = (moved[own].mean(axis=0) - middle) / np.linalg.norm(moved[own].mean(axis=0) - middle)
    np.testing.assert_allclose(
        way, [np.sin(np.radians(30.0)), 0.0, np.cos(np.radians(30.0))], atol=0.01
    )
    np.testing.assert_allclose(moved[~own], pupils.points_m[~own], atol=1e-6)
    eyes = named("eyes")
    ball = skin_points(eyes, skeleton, *world)[out * eyes.points_m[:, 0] > 0.0]
    np.testing.assert_allclose(np.linalg.norm(ball - middle, axis=1), EYE_RADIUS_M, atol=1e-6)


def gap_m(**weights: float) -> float:
    """Height of the opening between the lips in the middle of the face."""
    moved, rest = shown(named("head"), **weights), named("head").points_m
    middle = (np.abs(rest[:, 0]) < 0.003) & (rest[:, 2] > MOUTH_M[2] - 0.006)
    above = rest[:, 1] > MOUTH_M[1]
    return float(moved[middle & above, 1].min() - moved[middle & ~above, 1].max())


def test_lips_touch_at_rest_and_part_with_the_jaw_and_with_a_smile_on_it():
    assert 0.0 <= gap_m() < 0.0015
    assert 0.018 < gap_m(jawOpen=1.0) < 0.040
    assert gap_m(jawOpen=0.5) == pytest.approx(0.5 * gap_m(jawOpen=1.0), abs=0.0015)
    assert gap_m(jawOpen=1.0, **both(mouthSmile=1.0)) > 0.018


@pytest.mark.parametrize(
    "weights",
    [
        {"jawOpen": 1.0, **both(mouthSmile=1.0)},
        {"jawOpen": 1.0, "mouthFunnel": 0.5},
        {"jawOpen": 0.6, "browInnerUp": 1.0, **both(browOuterUp=1.0, eyeWide=1.0)},
        both(mouthSmile=0.8, cheekSquint=0.8, eyeSquint=0.5),
        both(browDown=1.0, noseSneer=0.7, mouthFrown=0.6),
    ],
)
def test_shapes_combine_without_folding_the_skin(weights):
    for name in ("head", "brows", "lashes"):
        assert not flips(named(name), **weights).any(), name
    assert flips(named("lips"), **weights).mean() < 0.005


def test_the_dark_of_the_mouth_lies_behind_the_teeth_and_the_teeth_behind_the_lips():
    front = {name: named(name).points_m[:, 2].max() for name in ("mouth", "tongue", "lips")}
    for teeth in ("upper_teeth", "lower_teeth"):
        assert front["mouth"] < named(teeth).points_m[:, 2].max() < front["lips"] - 0.004
    skins = [(mesh.points_m, mesh.triangles) for mesh in (named("head"), named("lips"))]
    for name in ("mouth", "tongue", "upper_teeth", "lower_teeth"):
        assert covered(named(name).points_m, *skins).all(), name
