"""Displacement fields and eyes: mirror images, smooth reach, lids that stay outside the ball."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.displacement import (
    image_of,
    on_both,
    pulled,
    sided,
    step,
    swung,
    with_shapes,
)
from actions_library.authoring.eyes import PUPIL, Eye, lid_mesh, lids_moved
from actions_library.authoring.rigging import JointRow, skeleton_of
from actions_library.authoring.solids import capsule, globe, on_both_sides_of, solid_mesh

SKELETON = skeleton_of(
    [
        JointRow("root", "", (0.0, 0.0, 0.0), "root"),
        JointRow("face", "root", (0.0, 1.0, 0.0), "root"),
    ]
)
EYE = Eye(centre=(0.05, 1.0, 0.1), radius=0.03, out_deg=25.0)
FLIP = np.array([-1.0, 1.0, 1.0])


def points(seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, 0.1, (200, 3))


def volume(mesh) -> float:
    """Of a closed surface, by the divergence theorem: positive if triangles face outward."""
    a, b, c = np.moveaxis(mesh.points_m[mesh.triangles], 1, 0)
    return float(np.einsum("tk,tk->t", a, np.cross(b, c)).sum() / 6.0)


def test_a_landmark_goes_the_whole_way_and_nothing_goes_beyond_the_reach():
    motion = pulled((0.1, 0.2, 0.3), (0.05, 0.06, 0.07), (1.0, -2.0, 3.0))
    at = np.array([[0.1, 0.2, 0.3], [0.151, 0.2, 0.3], [0.1, 0.261, 0.3], [0.1, 0.2, 0.371]])
    np.testing.assert_allclose(motion(at)[0], [0.001, -0.002, 0.003])
    assert not motion(at)[1:].any()


def test_a_right_shape_is_the_mirror_image_of_the_left_one():
    both = sided({"smile": pulled((0.05, 0.0, 0.1), (0.2, 0.2, 0.2), (3.0, 4.0, -1.0))})
    at = points()
    np.testing.assert_array_equal(both["left_smile"](at) * FLIP, both["right_smile"](at * FLIP))
    whole = on_both(both["left_smile"])
    np.testing.assert_allclose(whole(at) * FLIP, whole(at * FLIP), atol=1e-15)


def test_what_is_mirrored_twice_is_itself():
    motion, at = swung((0.01, 0.2, 0.0), (0.3, 1.0, 0.2), 20.0), points()
    np.testing.assert_array_equal(image_of(image_of(motion))(at), motion(at))


def test_what_swings_keeps_its_distance_from_the_axis():
    at, pivot = points(), np.array([0.1, -0.2, 0.05])
    moved = at + swung((0.1, -0.2, 0.05), (1.0, 0.0, 0.0), 33.0)(at)
    before, after = (np.linalg.norm((p - pivot)[:, 1:], axis=1) for p in (at, moved))
    np.testing.assert_allclose(after, before, atol=1e-12)
    np.testing.assert_allclose(moved[:, 0], at[:, 0], atol=1e-12)


def test_a_step_is_flat_at_its_ends():
    np.testing.assert_allclose(
        step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0]), 0.0, 1.0), [0, 0, 0.5, 1, 1]
    )
    assert step(np.array([1e-3]), 0.0, 1.0)[0] < 1e-7


@pytest.mark.parametrize(
    ("solid", "expected"),
    [
        (globe("face", (0.3, 0.1, 0.0), (0.1, 0.2, 0.3), rings=40, around=80), 0.006),
        (capsule("face", (0, 0, 0), (0, 0.4, 0.3), 0.1, 0.1, rings=40, around=80), None),
    ],
)
def test_solids_are_closed_and_face_outward(solid, expected):
    mesh = solid_mesh("solid", SKELETON, on_both_sides_of([solid]), (0.5, 0.5, 0.5))
    ball, rod = 4.0 / 3.0 * np.pi, np.pi * 0.01 * 0.5 + 4.0 / 3.0 * np.pi * 0.001
    one = ball * expected if expected else rod
    assert volume(mesh) == pytest.approx(2.0 * one, rel=0.01)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75, 1.0])
def test_lids_stay_outside_the_ball_on_all_their_way(share):
    # weights mix straight lines, not arcs: half closed is where a lid would cut in
    closed = lids_moved(EYE, 1.04, 1.0)
    mesh = with_shapes(lid_mesh(EYE, SKELETON, "face", (0.5, 0.5, 0.5)), {"blink": closed})
    at = mesh.points_m.copy()
    at[mesh.shapes[0].indices] += share * mesh.shapes[0].offsets_m
    left = at[at[:, 0] > 0.0] - np.array(EYE.centre)
    assert np.linalg.norm(left, axis=1).min() > PUPIL * EYE.radius


def test_closed_lids_cover_the_ball_and_open_ones_show_it():
    lids = lid_mesh(EYE, SKELETON, "face", (0.5, 0.5, 0.5))
    shut = with_shapes(lids, {"blink": lids_moved(EYE, 1.04, 1.0)}).shapes[0]
    local = (lids.points_m - np.array(EYE.centre)) @ EYE.axes
    moved = lids.points_m.copy()
    moved[shut.indices] += shut.offsets_m
    moved = (moved - np.array(EYE.centre)) @ EYE.axes
    quarter = len(local) // 4  # the left upper lid, its image, the left lower lid, its image
    for at, shown_deg in ((local, EYE.upper_deg - EYE.lower_deg), (moved, 0.0)):
        upper, lower = at[:quarter], at[2 * quarter : 3 * quarter]
        up, low = (
            np.degrees(np.arctan2(part[:, 1], part[:, 2]))[np.abs(part[:, 0]) < 0.1 * EYE.radius]
            for part in (upper, lower)
        )
        if shown_deg:
            assert up.min() - low.max() == pytest.approx(shown_deg, abs=2.0)
        else:
            assert up.min() <= low.max()
