"""Mass: a body's weight is where tables of segments say, whatever it does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from benchmarks.physics import anatomy_of, centre_of_mass
from smd.character.kinematics import forward_kinematics
from smd.character.mass import mass_of
from smd.character.skeleton import Skeleton
from smd.errors import CharacterError
from smd.geometry.rotations import multiply, quaternion_about, rotate

LIBRARY = load_library()
SKELETON = LIBRARY.character.skeleton
ANATOMY = anatomy_of(SKELETON)
MASS = mass_of(SKELETON)
REST = (SKELETON.rest_rotation_xyzw[None], SKELETON.rest_translation_m[None])
AGREES_M, FOLDED_M = 0.02, 0.03
"""How near it is to the segments' own centres, RMS over a clip: a bent trunk is no line between
hips and shoulders, in those who crawl or sit."""

FOLDED = {"crawl", "sit_down", "idle_sitting"}


def legless() -> Skeleton:
    """A root and a ball on it."""
    return Skeleton(
        joints=("root", "body"),
        parents=np.array([-1, 0]),
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)),
        rest_translation_m=np.array([[0.0, 0.0, 0.0], [0.0, 0.5, 0.0]]),
        world_from_bind=np.tile(np.eye(4), (2, 1, 1)),
        roles=("root", "root"),
    )


def test_all_shares_add_up_to_the_whole():
    assert MASS.share.sum() == pytest.approx(1.0, abs=1e-12)
    assert len(set(MASS.joints.tolist())) == len(MASS.joints)


def test_standing_people_have_it_at_fifty_six_hundredths_of_their_height():
    """D. A. Winter, "Biomechanics and Motor Control of Human Movement": 0.55 to 0.58."""
    (centre_m,) = MASS.centre_m(SKELETON, *REST)
    assert 0.55 < centre_m[1] / LIBRARY.character.height_m < 0.58
    assert centre_m[0] == pytest.approx(0.0, abs=1e-6)


def test_its_height_at_rest_is_over_the_lowest_joint():
    (centre_m,) = MASS.centre_m(SKELETON, *REST)
    (place_m,) = forward_kinematics(SKELETON, *REST)[1]
    assert MASS.height_m == pytest.approx(centre_m[1] - place_m[:, 1].min(), abs=1e-12)
    raised = replace(
        SKELETON,
        rest_translation_m=SKELETON.rest_translation_m
        + np.where(np.arange(len(SKELETON)) == 0, 3.0, 0.0)[:, None] * [0.0, 1.0, 0.0],
    )
    assert mass_of(raised).height_m == pytest.approx(MASS.height_m, abs=1e-12)


def test_left_and_right_weigh_the_same():
    share = dict(zip((SKELETON.joints[j] for j in MASS.joints), MASS.share, strict=True))
    left = {name.removeprefix("left_"): w for name, w in share.items() if "left_" in name}
    right = {name.removeprefix("right_"): w for name, w in share.items() if "right_" in name}
    assert left.keys() == right.keys()
    assert len(left) >= 6
    assert [left[name] for name in left] == pytest.approx([right[name] for name in left])


def test_what_lifts_an_arm_moves_it_by_the_arm_s_share():
    """Winter's table: an arm, hand included, is 5 % of a body."""
    rotation, translation = REST[0].copy(), REST[1].copy()
    translation[:, SKELETON.index("left_upper_arm")] += [0.0, 0.0, 0.1]
    (moved_m,) = MASS.centre_m(SKELETON, rotation, translation) - MASS.centre_m(SKELETON, *REST)
    # The trunk and the head hang from the shoulders too.
    assert 0.1 * 0.05 < moved_m[2] < 0.1 * 0.30
    rotation, translation = REST[0].copy(), REST[1].copy()
    translation[:, SKELETON.index("left_lower_arm")] += [0.0, 0.0, 0.1]
    (moved_m,) = MASS.centre_m(SKELETON, rotation, translation) - MASS.centre_m(SKELETON, *REST)
    assert moved_m == pytest.approx([0.0, 0.0, 0.1 * (0.5 * 0.028 + 0.022)], abs=1e-9)


@pytest.mark.parametrize("name", [action.name for action in LIBRARY.actions])
def test_on_every_clip_it_is_where_the_segments_have_it(name):
    clip = LIBRARY.clip(name)
    found_m = MASS.centre_m(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    place_m = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]
    apart_m = np.linalg.norm(found_m - centre_of_mass(place_m, ANATOMY), axis=-1)
    assert np.sqrt(np.mean(apart_m**2)) < (FOLDED_M if name in FOLDED else AGREES_M)


def test_it_goes_and_turns_with_the_body():
    clip = LIBRARY.clip("slash")
    turn, way_m = quaternion_about([0.0, 1.0, 0.0], 1.1), np.array([2.0, 0.3, -1.0])
    rotation, translation = clip.rotation_xyzw.copy(), clip.translation_m.copy()
    n = len(clip)
    rotation[:, 0] = multiply(np.broadcast_to(turn, (n, 4)), rotation[:, 0])
    translation[:, 0] = rotate(np.broadcast_to(turn, (n, 4)), translation[:, 0]) + way_m
    own_m = MASS.centre_m(SKELETON, clip.rotation_xyzw, clip.translation_m)
    moved_m = MASS.centre_m(SKELETON, rotation, translation)
    expected_m = rotate(np.broadcast_to(turn, (n, 4)), own_m) + way_m
    assert moved_m == pytest.approx(expected_m, abs=1e-9)


def test_a_larger_body_has_it_in_the_same_place():
    larger = replace(SKELETON, rest_translation_m=1.7 * SKELETON.rest_translation_m)
    grown = mass_of(larger)
    assert (grown.joints == MASS.joints).all()
    assert grown.share == pytest.approx(MASS.share, abs=1e-12)
    assert grown.height_m == pytest.approx(1.7 * MASS.height_m)


def test_without_legs_there_is_none():
    assert mass_of(legless()) is None


def test_without_arms_trunk_and_head_still_weigh(skeleton):
    mass = mass_of(skeleton)
    assert mass.share.sum() == pytest.approx(1.0, abs=1e-12)
    # There is nothing above the hips to hang them from.
    assert 0.4 < mass.height_m < 0.9


def test_shares_must_fit_the_joints():
    with pytest.raises(CharacterError, match="share: expected shape"):
        replace(MASS, share=MASS.share[1:])
