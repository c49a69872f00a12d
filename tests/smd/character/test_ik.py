from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.humanoid import humanoid_skeleton
from smd.character.ik import Limb, limb_of, two_bone_ik
from smd.errors import CharacterError
from smd.geometry.rotations import (
    inverse,
    multiply,
    normalized,
    quaternion_from_rotvec,
    rotate,
    rotvec_from_quaternion,
)

LIMBS = {
    "leg": ("left_upper_leg", "left_lower_leg", "left_foot", [0.0, 0.0, 1.0]),
    "arm": ("right_upper_arm", "right_lower_arm", "right_hand", [0.0, 0.0, -1.0]),
}


@pytest.fixture(params=sorted(LIMBS))
def limb(request: pytest.FixtureRequest) -> Limb:
    return limb_of(humanoid_skeleton(), *LIMBS[request.param])


def end_of(limb: Limb, base, upper, lower):
    return base + rotate(upper, limb.upper_bone_m) + rotate(lower, limb.lower_bone_m)


def random_problem(rng: np.random.Generator, limb: Limb, n: int = 200):
    """Bases, targets within reach and poles."""
    base = rng.normal(size=(n, 3))
    near = abs(limb.upper_length_m - limb.lower_length_m) / limb.reach_m
    span = limb.reach_m * rng.uniform(near + 1e-3, 0.999, size=(n, 1))
    target = base + span * normalized(rng.normal(size=(n, 3)))
    return base, target, rng.normal(size=(n, 3))


@pytest.mark.parametrize("seed", range(5))
def test_the_end_is_at_any_target_within_reach(limb, seed):
    base, target, pole = random_problem(np.random.default_rng(seed), limb)
    upper, lower = two_bone_ik(limb, base, target, pole)
    np.testing.assert_allclose(end_of(limb, base, upper, lower), target, atol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_the_middle_joint_lies_on_the_pole_s_side_and_in_its_plane(limb, seed):
    base, target, pole = random_problem(np.random.default_rng(seed), limb)
    upper, _ = two_bone_ik(limb, base, target, pole)
    middle = rotate(upper, limb.upper_bone_m)
    toward = normalized(target - base)
    aside = middle - toward * np.sum(middle * toward, axis=-1, keepdims=True)
    across = pole - toward * np.sum(pole * toward, axis=-1, keepdims=True)
    cosine = np.sum(normalized(aside) * normalized(across), axis=-1)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_the_limb_only_folds_about_its_hinge_and_one_way(limb, seed):
    base, target, pole = random_problem(np.random.default_rng(seed), limb)
    upper, lower = two_bone_ik(limb, base, target, pole)
    hinge = rotate(
        upper,
        limb.upper_hinge
        - limb.upper_bone_m * (limb.upper_hinge @ limb.upper_bone_m / limb.upper_length_m**2),
    )
    fold = np.cross(rotate(upper, limb.upper_bone_m), rotate(lower, limb.lower_bone_m))
    cosine = np.sum(normalized(fold) * normalized(hinge), axis=-1)
    np.testing.assert_allclose(cosine, 1.0, atol=1e-6)


def test_moving_the_world_moves_the_answer(limb):
    rng = np.random.default_rng(3)
    base, target, pole = random_problem(rng, limb, 20)
    turn = quaternion_from_rotvec(rng.normal(size=3))
    upper, lower = two_bone_ik(limb, base, target, pole)
    moved = two_bone_ik(
        limb, rotate(turn, base) + 1.0, rotate(turn, target) + 1.0, rotate(turn, pole)
    )
    for got, still in zip(moved, (upper, lower), strict=True):
        difference = multiply(inverse(got), multiply(turn, still))
        np.testing.assert_allclose(rotvec_from_quaternion(difference), 0.0, atol=1e-7)


@pytest.mark.parametrize("softness", [0.0, 0.05])
def test_out_of_reach_the_limb_stretches_toward_the_target(limb, softness):
    target = np.array([0.3, 2.0, -5.0])
    upper, lower = two_bone_ik(limb, np.zeros(3), target, [0.0, 0.0, 1.0], softness=softness)
    end = end_of(limb, np.zeros(3), upper, lower)
    np.testing.assert_allclose(normalized(end), normalized(target), atol=1e-9)
    assert limb.reach_m * (1.0 - 1e-9) <= np.linalg.norm(end) <= limb.reach_m * (1.0 + 1e-9)


@pytest.mark.parametrize("target", [[0.0, 0.0, 0.0], [0.0, 1e-4, 0.0]])
def test_too_near_the_limb_folds_without_nan(limb, target):
    upper, lower = two_bone_ik(limb, np.zeros(3), target, [0.0, 0.0, 1.0])
    nearest = abs(limb.upper_length_m - limb.lower_length_m)
    end = end_of(limb, np.zeros(3), upper, lower)
    assert np.linalg.norm(end) == pytest.approx(nearest, abs=1e-6)


def test_a_pole_along_the_limb_or_without_length_still_reaches(limb):
    target = np.array([0.1, -0.4, 0.0])
    for pole in (target, -target, np.zeros(3)):
        upper, lower = two_bone_ik(limb, np.zeros(3), target, pole)
        np.testing.assert_allclose(end_of(limb, np.zeros(3), upper, lower), target, atol=1e-9)


def test_softness_changes_nothing_before_its_zone_and_keeps_the_limb_bent_after(limb):
    hard, soft = (
        two_bone_ik(limb, np.zeros(3), [0.0, -0.9 * limb.reach_m, 0.0], [0, 0, 1], softness=s)
        for s in (0.0, 0.05)
    )
    np.testing.assert_allclose(hard[0], soft[0], atol=1e-12)
    upper, lower = two_bone_ik(
        limb, np.zeros(3), [0.0, -1.02 * limb.reach_m, 0.0], [0, 0, 1], softness=0.05
    )
    assert np.linalg.norm(end_of(limb, np.zeros(3), upper, lower)) < 0.99 * limb.reach_m


def test_straightening_softly_the_bend_never_jumps(limb):
    distance = np.linspace(0.90, 1.05, 400)[:, None] * limb.reach_m
    target = distance * np.array([0.0, -1.0, 0.0])
    upper, _ = two_bone_ik(limb, np.zeros(3), target, [0.0, 0.0, 1.0], softness=0.05)
    step = rotvec_from_quaternion(multiply(inverse(upper[:-1]), upper[1:]))
    steepest_in_reach = 0.02
    assert np.linalg.norm(step, axis=-1).max() < steepest_in_reach


def test_the_resting_limb_is_left_as_it_is(limb):
    straight_pole = limb.upper_hinge  # any: the rest pose defines the answer
    pole = np.cross(limb.upper_bone_m + limb.lower_bone_m, straight_pole)
    upper, lower = two_bone_ik(limb, np.zeros(3), limb.upper_bone_m + limb.lower_bone_m, pole)
    for got in (upper, lower):
        assert np.linalg.norm(rotvec_from_quaternion(got)) < np.radians(12.0)


def test_joints_that_are_not_a_chain_are_named():
    with pytest.raises(CharacterError, match="'left_hand'"):
        limb_of(humanoid_skeleton(), "left_upper_leg", "left_lower_leg", "left_hand", [0, 0, 1])


def test_a_pole_along_the_bones_is_refused():
    skeleton = humanoid_skeleton()
    up = skeleton.world_from_bind[:, :3, 3]
    along = up[skeleton.index("left_foot")] - up[skeleton.index("left_upper_leg")]
    with pytest.raises(CharacterError, match="hinge"):
        limb_of(skeleton, "left_upper_leg", "left_lower_leg", "left_foot", along)
