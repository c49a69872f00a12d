"""The shipped figure, and that the code that makes it makes it again."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.body import BODY_TRIANGLES, humanoid_character
from actions_library.authoring.hand_shape import left_fingers
from actions_library.authoring.humanoid import HEIGHT_M, humanoid_skeleton
from actions_library.folder import load_library
from smd.character.character import Character, Mesh
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.geometry.rotations import quaternion_about

SINGLE_M = 1e-6
"""The stored figure's places are single precision."""

COARSE_STEP_M = 0.008
"""A grid on which the figure is made in seconds; too coarse for its fingers."""


@pytest.fixture(scope="module")
def shipped() -> Character:
    return load_library().character


@pytest.fixture(scope="module")
def coarse() -> Character:
    return humanoid_character(step_m=COARSE_STEP_M)


@pytest.fixture(scope="module", params=["shipped", "coarse"])
def figure(request) -> Character:
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def body(figure) -> Mesh:
    return named(figure, "body")


@pytest.fixture(scope="module")
def head(figure) -> Mesh:
    return named(figure, "head")


def named(character: Character, name: str) -> Mesh:
    return next(mesh for mesh in character.meshes if mesh.name == name)


def half_edges(mesh: Mesh) -> np.ndarray:
    t = mesh.triangles
    return np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])


def pieces(mesh: Mesh) -> int:
    """How many parts a mesh falls into."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    edges, p = half_edges(mesh), len(mesh.points_m)
    links = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(p, p))
    return int(connected_components(links, directed=False)[0])


def normals(mesh: Mesh) -> np.ndarray:
    """Twice the area vectors of the triangles."""
    a, b, c = np.moveaxis(mesh.points_m[mesh.triangles], 1, 0)
    return np.cross(b - a, c - a)


def volume_m3(mesh: Mesh) -> float:
    """The enclosed volume, by the divergence theorem: negative for normals that point inwards."""
    return float((mesh.points_m[mesh.triangles].mean(axis=1) * normals(mesh)).sum() / 6.0)


def mirror_points(mesh: Mesh) -> np.ndarray:
    """Each point's nearest point to its image in x = 0."""
    from scipy.spatial import KDTree

    distance, index = KDTree(mesh.points_m).query(mesh.points_m * [-1.0, 1.0, 1.0])
    assert distance.max() < SINGLE_M
    return np.asarray(index)


def weights(figure: Character, mesh: Mesh, *joints: str) -> np.ndarray:
    """How much joints move each point, together."""
    chosen = [figure.skeleton.index(joint) for joint in joints]
    return np.where(np.isin(mesh.joint_indices, chosen), mesh.joint_weights, 0.0).sum(axis=1)


def posed(figure: Character, mesh: Mesh, **turns: np.ndarray) -> np.ndarray:
    """A mesh's points with some joints turned."""
    skeleton = figure.skeleton
    q = skeleton.rest_rotation_xyzw.copy()
    for joint, turn in turns.items():
        q[skeleton.index(joint)] = turn
    return skin_points(
        mesh, skeleton, *forward_kinematics(skeleton, q, skeleton.rest_translation_m)
    )


def test_every_mesh_is_closed_and_its_two_sides_agree(figure):
    for mesh in figure.meshes:
        edges = half_edges(mesh)
        there, count = np.unique(edges, axis=0, return_counts=True)
        assert (count == 1).all(), mesh.name
        assert {tuple(e) for e in there} == {tuple(e) for e in there[:, ::-1]}, mesh.name


def test_body_and_head_are_one_piece_each_and_nothing_has_a_handle(shipped):
    assert pieces(named(shipped, "body")) == pieces(named(shipped, "head")) == 1
    for mesh in shipped.meshes:
        euler = len(mesh.points_m) - len(half_edges(mesh)) // 2 + len(mesh.triangles)
        assert euler == 2 * pieces(mesh), mesh.name


def test_points_are_welded_and_used(figure):
    for mesh in figure.meshes:
        assert len(np.unique(mesh.points_m, axis=0)) == len(mesh.points_m), mesh.name
        assert len(np.unique(mesh.triangles)) == len(mesh.points_m), mesh.name


@pytest.mark.parametrize("name", ["body", "head"])
def test_the_skins_triangles_are_many_enough_and_well_shaped(shipped, name):
    skin = named(shipped, name)
    assert 6_000 <= len(skin.triangles) <= 20_000
    corners = skin.points_m[skin.triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    height = np.linalg.norm(normals(skin), axis=1) / longest
    assert np.quantile(longest / height, 0.995) < 8.0


def test_the_figure_is_as_tall_as_its_skeleton_says(figure, head):
    assert figure.height_m == pytest.approx(HEIGHT_M, abs=0.01)
    assert head.points_m[:, 1].max() == pytest.approx(HEIGHT_M, abs=0.015)


def test_the_volume_is_a_persons_and_the_normals_point_outwards(figure, body, head):
    assert 0.05 < volume_m3(body) + volume_m3(head) < 0.09
    assert all(volume_m3(mesh) > 0 for mesh in figure.meshes)


def test_the_soles_stand_on_the_ground(figure, body):
    assert abs(named(figure, "soles").points_m[:, 1].min()) < 1e-3
    assert 0.0 <= body.points_m[:, 1].min() <= 0.002 + SINGLE_M


def test_the_figure_is_its_own_mirror_image(figure):
    skeleton = figure.skeleton
    for mesh in figure.meshes:
        image = mirror_points(mesh)
        for joint in skeleton.joints:
            twin = joint.replace("left", "LEFT").replace("right", "left").replace("LEFT", "right")
            mine, its = weights(figure, mesh, joint), weights(figure, mesh, twin)
            np.testing.assert_allclose(mine, its[image], atol=1e-4, err_msg=mesh.name)


def test_the_figure_faces_forward(figure, body, head):
    face = head.points_m[weights(figure, head, "head") > 0.99]
    nose = face[face[:, 2].argmax()]
    assert abs(nose[0]) < 0.005
    assert 1.58 < nose[1] < 1.64
    for name in ("irises", "brows", "lips"):
        assert named(figure, name).points_m[:, 2].min() > 0.05
    toes = body.points_m[weights(figure, body, "left_toes", "right_toes") > 0.99]
    assert toes[:, 2].min() > figure.skeleton.world_from_bind[0, 2, 3] + 0.1


def test_the_face_moves_with_the_head_and_each_eye_with_its_own_joint(figure):
    for name in ("brows", "lashes", "lips", "mouth", "upper_teeth", "tongue", "hair"):
        assert weights(figure, named(figure, name), "head").min() == pytest.approx(1.0)
    for name in ("eyes", "irises", "pupils", "glints"):
        mesh = named(figure, name)
        left = weights(figure, mesh, "left_eye")
        np.testing.assert_array_equal(left, mesh.points_m[:, 0] > 0.0)
        np.testing.assert_array_equal(weights(figure, mesh, "right_eye"), 1.0 - left)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_leg_moves_nothing_of_the_other(figure, side):
    leg = [f"{side}_{part}" for part in ("upper_leg", "lower_leg", "foot", "toes")]
    sign = 1.0 if side == "left" else -1.0
    for name in ("body", "trousers", "shoes", "soles"):
        mesh = named(figure, name)
        x, y = sign * mesh.points_m[:, 0], mesh.points_m[:, 1]
        assert weights(figure, mesh, *leg)[(x < -0.08) | ((x < 0.0) & (y < 0.75))].max() == 0.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_an_arm_moves_the_torso_at_the_armpit_only(figure, side):
    fingers = [joint for finger in left_fingers() for joint in finger.joints]
    arm = [f"{side}_{part}" for part in ("upper_arm", "lower_arm", "hand", *fingers)]
    sign = 1.0 if side == "left" else -1.0
    for name in ("body", "shirt", "trousers"):
        mesh = named(figure, name)
        x, y, _ = mesh.points_m.T
        torso = (sign * x < 0.22) & (y < 1.20)
        assert weights(figure, mesh, *arm)[torso | (sign * x < 0.0)].max() < 1e-6


@pytest.mark.parametrize("side", ["left", "right"])
def test_each_finger_moves_its_own_flesh_alone(shipped, side):
    body = named(shipped, "body")
    out = 1.0 if side == "left" else -1.0
    for finger in left_fingers():
        tip = finger.places[3] * [out, 1.0, 1.0]
        at_tip = np.linalg.norm(body.points_m - tip, axis=1) < 0.011
        joints = [f"{side}_{joint}" for joint in finger.joints]
        assert at_tip.sum() > 5
        assert weights(shipped, body, *joints)[at_tip].min() > 0.97, finger.name
        assert weights(shipped, body, joints[2])[at_tip].mean() > 0.9, finger.name


def test_a_hand_by_the_thigh_does_not_pull_it(figure, body):
    down = quaternion_about((0.0, 0.0, 1.0), np.radians(-40.0))
    moved = posed(figure, body, left_upper_arm=down) - body.points_m
    below_chest = (body.points_m[:, 0] < 0.22) & (body.points_m[:, 1] < 1.20)
    assert np.abs(moved[below_chest]).max() < 1e-6


def test_a_bent_knee_keeps_most_of_its_thickness(figure):
    """Linear blending thins a joint by cos(bend / 2) at worst; soft weights must do better."""
    trousers = named(figure, "trousers")
    bend = np.radians(120.0)
    knee = figure.skeleton.world_from_bind[figure.skeleton.index("left_lower_leg"), :3, 3]
    moved = posed(figure, trousers, left_lower_leg=quaternion_about((1.0, 0.0, 0.0), bend))
    near = (np.abs(trousers.points_m[:, 1] - knee[1]) < 0.06) & (trousers.points_m[:, 0] > 0)
    kneecap = near & (trousers.points_m[:, 2] > knee[2] + 0.03)
    away = np.linalg.norm(moved[kneecap] - knee, axis=1)
    assert away.min() > 0.5 * np.linalg.norm(trousers.points_m[kneecap] - knee, axis=1).min()


def test_no_edge_is_torn_in_a_deep_squat(shipped):
    turns = {}
    for side in ("left", "right"):
        turns[f"{side}_upper_leg"] = quaternion_about((1.0, 0.0, 0.0), np.radians(-100.0))
        turns[f"{side}_lower_leg"] = quaternion_about((1.0, 0.0, 0.0), np.radians(120.0))
    for name in ("body", "trousers"):
        mesh = named(shipped, name)
        edges = half_edges(mesh)
        before = np.linalg.norm(np.diff(mesh.points_m[edges], axis=1)[:, 0], axis=1)
        after = np.linalg.norm(np.diff(posed(shipped, mesh, **turns)[edges], axis=1)[:, 0], axis=1)
        assert (after / before).max() < 6.0, name  # the crotch stretches fivefold


@pytest.mark.rebuild
def test_making_the_figure_again_gives_the_same_bytes(coarse):
    again = humanoid_character(step_m=COARSE_STEP_M)
    for first, second in zip(coarse.meshes, again.meshes, strict=True):
        for name in ("points_m", "triangles", "joint_indices", "joint_weights"):
            assert getattr(first, name).tobytes() == getattr(second, name).tobytes(), name


def test_the_code_makes_the_figure_that_is_shipped(shipped, coarse):
    """The same pieces, places and colours, within what the coarse grid can tell."""
    assert [m.name for m in coarse.meshes] == [m.name for m in shipped.meshes]
    assert coarse.skeleton.joints == humanoid_skeleton().joints == shipped.skeleton.joints
    for made, its in zip(coarse.meshes, shipped.meshes, strict=True):
        np.testing.assert_allclose(made.color_rgb, its.color_rgb, atol=1e-6)
        for corner in ("min", "max"):
            ends = [getattr(m.points_m, corner)(axis=0) for m in (made, its)]
            np.testing.assert_allclose(*ends, atol=1.5 * COARSE_STEP_M, err_msg=made.name)
    assert len(named(shipped, "body").triangles) == pytest.approx(BODY_TRIANGLES, rel=0.01)
