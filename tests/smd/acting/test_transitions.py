from __future__ import annotations

import numpy as np
import pytest

from smd.acting.transitions import (
    TRANSITION_S,
    TURNING_RAD_S,
    carried_over,
    transition_s,
)
from smd.character.poses import Poses, sampled
from smd.character.roles import to_knuckles, without_digits
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotvec_from_quaternion,
)

STEP_S = 1e-3
OVER_S = 0.25
FINGERS = ("thumb", "index", "middle", "ring", "little")


def motion(seed: int, time_s: np.ndarray) -> Poses:
    """Two joints that turn and shift at constant speeds."""
    rng = np.random.default_rng(seed)
    start, speed = 0.6 * rng.normal(size=(2, 2, 3))
    rotation = multiply(
        quaternion_from_rotvec(start), quaternion_from_rotvec(speed * time_s[:, None, None])
    )
    place, velocity = rng.normal(size=(2, 2, 3))
    return Poses(rotation, place + velocity * time_s[:, None, None])


def joined(passed_s: np.ndarray) -> tuple[Poses, Poses, Poses]:
    before = motion(1, np.array([-STEP_S, 0.0]))
    after = motion(2, np.array([0.0, STEP_S]))
    into = motion(2, passed_s)
    done = carried_over(before, after, into, passed_s, over_s=OVER_S, step_s=STEP_S)
    return before, into, done


def turned(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return rotvec_from_quaternion(multiply(inverse(a), b))


def test_a_transition_begins_in_the_pose_before_it_and_ends_in_the_next_move():
    before, into, done = joined(np.array([0.0, OVER_S]))
    assert np.abs(turned(before.rotation_xyzw[1], done.rotation_xyzw[0])).max() < 1e-9
    assert done.translation_m[0] == pytest.approx(before.translation_m[1])
    assert np.abs(turned(into.rotation_xyzw[1], done.rotation_xyzw[1])).max() < 1e-9
    assert done.translation_m[1] == pytest.approx(into.translation_m[1])


def test_a_transition_begins_and_ends_with_the_speeds_on_either_side():
    e = 1e-5
    before, into, done = joined(np.array([0.0, e, OVER_S - e, OVER_S]))
    shifting = np.diff(done.translation_m, axis=0)[[0, 2]] / e
    assert shifting[0] == pytest.approx(np.diff(before.translation_m, axis=0)[0] / STEP_S, abs=1e-2)
    assert shifting[1] == pytest.approx(np.diff(into.translation_m, axis=0)[2] / e, abs=1e-2)
    turning = turned(done.rotation_xyzw[2], done.rotation_xyzw[3]) / e
    assert turning == pytest.approx(
        turned(into.rotation_xyzw[2], into.rotation_xyzw[3]) / e, abs=1e-2
    )


def test_moves_that_meet_are_left_alone():
    passed_s = np.linspace(0.0, OVER_S, 7)
    same = motion(3, np.array([-STEP_S, 0.0])), motion(3, np.array([0.0, STEP_S]))
    into = motion(3, passed_s)
    done = carried_over(*same, into, passed_s, over_s=OVER_S, step_s=STEP_S)
    assert np.abs(turned(into.rotation_xyzw, done.rotation_xyzw)).max() < 1e-9
    assert done.translation_m == pytest.approx(into.translation_m)


def test_fingers_do_not_hold_a_transition_up(library):
    skeleton = library.character.skeleton
    slow = {skeleton.joints[joint] for joint in without_digits(skeleton)}
    quick = set(skeleton.joints) - slow
    assert {"left_hand", "right_foot", "head", "hips", "root"} <= slow
    assert {"left_thumb_metacarpal", "right_middle_proximal", "left_toes"} <= quick
    assert all("toes" in name or any(f in name for f in FINGERS) for name in quick)
    clip = library.clip("idle")
    pose = sampled(clip, np.zeros(2))
    turned = pose.rotation_xyzw.copy()
    finger = skeleton.index("right_middle_proximal")
    turned[:, finger] = multiply(turned[:, finger], quaternion_about([0.0, 0.0, 1.0], 2.0))
    fist = Poses(turned, pose.translation_m)
    assert transition_s(pose, fist) == pytest.approx(2.0 / TURNING_RAD_S)
    assert transition_s(pose, fist, without_digits(skeleton)) == TRANSITION_S


def test_a_hand_is_as_one_joint_and_its_knuckle(library):
    skeleton = library.character.skeleton
    beyond = set(to_knuckles(skeleton)) - set(without_digits(skeleton))
    assert {skeleton.joints[joint] for joint in beyond} == {
        f"{side}_{name}" for side in ("left", "right") for name in ("middle_proximal", "toes")
    }
