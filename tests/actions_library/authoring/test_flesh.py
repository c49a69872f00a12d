from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.body_field import RoundCone
from actions_library.authoring.flesh import Lump, ball, bone, lump_weights, melted_mesh
from actions_library.authoring.rigging import JointRow, other_side, skeleton_of, with_right_side

SKELETON = skeleton_of(
    with_right_side(
        (
            JointRow("root", "", (0.0, 0.0, 0.0), "root"),
            JointRow("trunk", "root", (0.0, 0.5, -0.2), "spine"),
            JointRow("left_wing", "trunk", (0.10, 0.5, 0.0), "intermediate"),
            JointRow("left_wing_tip", "left_wing", (0.30, 0.55, 0.0), "end_effector"),
        )
    )
)
LUMPS = [
    bone(SKELETON, "trunk", (0.0, 0.5, 0.2), 0.08, 0.06),
    bone(SKELETON, "left_wing", "left_wing_tip", 0.04, 0.03),
    bone(SKELETON, "left_wing_tip", (0.45, 0.60, 0.0), 0.03, 0.02),
]


@pytest.fixture(scope="module")
def mesh():
    return melted_mesh(
        "coat", SKELETON, LUMPS, step_m=0.01, triangle_count=1200, color_rgb=(0.5, 0.4, 0.3)
    )


def test_a_mesh_is_its_own_mirror_image_and_so_are_its_weights(mesh):
    image = {tuple(p): k for k, p in enumerate(mesh.points_m)}
    dense = np.zeros((len(mesh.points_m), len(SKELETON)))
    np.add.at(dense, (np.arange(len(dense))[:, None], mesh.joint_indices), mesh.joint_weights)
    twins = [SKELETON.index(other_side(joint)) for joint in SKELETON.joints]
    for k, (x, y, z) in enumerate(mesh.points_m):
        np.testing.assert_allclose(dense[image[(-x, y, z)]], dense[k][twins], atol=1e-12)


def test_a_mesh_is_closed_and_turned_outward(mesh):
    ends = np.concatenate([mesh.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    there, back = {tuple(e) for e in ends}, {tuple(e[::-1]) for e in ends}
    assert len(there) == len(ends)
    assert there == back
    assert volume_m3(mesh) > 0.0


def volume_m3(mesh):
    corners = mesh.points_m[mesh.triangles]
    return np.einsum("tk,tk->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6


def ball_mesh(hollows=()):
    return melted_mesh(
        "ball",
        SKELETON,
        [ball("trunk", (0.0, 0.5, 0.0), 0.1)],
        step_m=0.006,
        triangle_count=3000,
        color_rgb=(1.0, 0.0, 0.0),
        hollows=hollows,
    )


def test_a_ball_alone_has_the_volume_of_a_sphere():
    assert volume_m3(ball_mesh()) == pytest.approx(4.0 / 3.0 * np.pi * 0.1**3, rel=0.01)


def test_hollows_are_taken_away_on_both_sides():
    r = 0.03  # of a socket whose centre is on the surface: about half of it is inside
    hollow = ball("trunk", (0.06, 0.5, 0.08), r, reach_m=0.0)
    lost = volume_m3(ball_mesh()) - volume_m3(ball_mesh([hollow]))
    # the lens of two spheres whose centres are 0.1 apart
    d, big = 0.1, 0.1
    lens = np.pi * (big + r - d) ** 2 * (d**2 + 2 * d * (big + r) - 3 * (big - r) ** 2) / (12 * d)
    assert lost == pytest.approx(2.0 * lens, rel=0.1)


def test_two_solids_off_the_middle_are_two_meshes_in_one():
    eye = ball("trunk", (0.05, 0.5, 0.2), 0.02)
    mesh = melted_mesh(
        "eyes", SKELETON, [eye], step_m=0.003, triangle_count=400, color_rgb=(0.0, 0.0, 0.0)
    )
    x = mesh.points_m[:, 0]
    assert x[x > 0].mean() == pytest.approx(0.05, abs=1e-3)
    assert (x > 0).sum() == (x < 0).sum()


def test_weights_sum_to_one_and_are_even_where_two_solids_are_equally_near(mesh):
    np.testing.assert_allclose(mesh.joint_weights.sum(axis=1), 1.0, atol=1e-12)
    ends = [
        Lump("left_wing", RoundCone((-0.1, 0.0, 0.0), (0.0, 0.0, 0.0), 0.02, 0.02)),
        Lump("trunk", RoundCone((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), 0.02, 0.02)),
    ]
    at = np.array([[0.0, 0.02, 0.0], [-0.09, 0.02, 0.0], [0.09, 0.02, 0.0]])
    weights = lump_weights(at, ends, SKELETON)[:, [SKELETON.index("left_wing"), 1]]
    np.testing.assert_allclose(weights[0], [0.5, 0.5])
    np.testing.assert_allclose(weights[1:], [[1.0, 0.0], [0.0, 1.0]], atol=1e-3)
