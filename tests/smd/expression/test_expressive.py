"""What each operator and each Effort does; the laws that all keep are in test_operator_laws."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import smd
from actions_library.folder import load_library
from laban import Effort
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.skeleton import Skeleton
from smd.errors import TransferError
from smd.expression.attack import attacked, with_attack
from smd.expression.body import body_of
from smd.expression.expressive import effort_timing, expressive
from smd.expression.operators import (
    SOFT,
    between_frames,
    powered_pace,
    rescaled,
    reshaped,
    retimed,
    stack_of,
)
from smd.expression.reaching import ArmPoses, arm_poses, with_hands_moved
from smd.expression.springs import DAMPING, SPRING_HZ, damped, sprung
from smd.expression.study import Study, poses_at, study_of
from smd.expression.timing import (
    FASTEST,
    fastest_paces,
    flowing_slowness,
    pace_slowness,
    shown_frames,
    sustained_slowness,
    time_slowness,
    within_pace,
)
from smd.expression.tracing import Held, redrawn, sweeps
from smd.geometry.rotations import inverse, multiply, rotate, rotvec_from_quaternion, slerp
from smd.transfer.repertoire import piece_name, played_effort

LIBRARY = load_library()
BODY = body_of(LIBRARY.clip("idle"))
ONCE = ["punch", "kick", "throw", "bow", "jump", "wave", "sit_down"]
POLES = [(t, w) for t in (-1.0, 0.0, 1.0) for w in (-1.0, 0.0, 1.0)]


def world_of(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)


def studied(name: str) -> Study:
    return study_of(LIBRARY.clip(name), BODY)


def played(name: str, time: float, weight: float):
    travels = LIBRARY.action(name).travels
    return expressive(studied(name), [Effort(time=time, weight=weight)], travels=travels)[0]


def attacking(clip: Clip, time: float) -> Clip:
    poses = with_attack(stack_of(clip, 1), np.array([time]), clip, BODY)
    return replace(clip, rotation_xyzw=poses.rotation_xyzw[:, 0])


def redrawn_once(path, space, held=None) -> np.ndarray:
    """The displacement of a path in one state, at 60 frames a second."""
    return redrawn(path, np.array([space]), 60.0, held)[:, 0]


def same(one, other, atol=0.0):
    dots = np.abs(np.sum(one.rotation_xyzw * other.rotation_xyzw, axis=-1))
    assert dots.min() >= 1.0 - 1e-12 - atol
    np.testing.assert_allclose(one.translation_m, other.translation_m, atol=1e-12 + atol)


@pytest.mark.parametrize("name", [*ONCE, "walk", "fly"])
def test_without_effort_a_clip_is_the_same(name):
    for effort in (Effort(), Effort(time=0.0, weight=0.0), Effort(space=0.0, flow=0.0)):
        travels = LIBRARY.action(name).travels
        assert expressive(studied(name), [effort], travels=travels) == (LIBRARY.clip(name),)


@pytest.mark.parametrize("name", ONCE)
@pytest.mark.parametrize(("time", "weight"), POLES)
def test_nothing_pops(name, time, weight):
    def fastest(clip) -> float:
        q = clip.rotation_xyzw[:, 1:]
        turns = rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:]))
        return float(np.linalg.norm(turns, axis=-1).max())

    # As many frames are passed as the pace allows, each as much larger as the scale.
    assert fastest(played(name, time, weight)) < 1.6 * FASTEST * fastest(LIBRARY.clip(name))


def lasts(clip: Clip, stage: int) -> int:
    """How many frames one of a clip's stages but the first lasts."""
    return int(clip.stage_end_frames[stage] - clip.stage_end_frames[stage - 1])


@pytest.mark.parametrize("name", ["punch", "kick", "throw", "slash", "wave", "pick_up", "jump"])
def test_a_sudden_clip_anticipates_longer_and_bursts_and_a_sustained_one_does_not(name):
    sudden, neutral, sustained = (played(name, t, 0.0) for t in (1.0, 0.0, -1.0))
    assert lasts(sudden, 1) > 1.1 * lasts(neutral, 1) > 1.2 * lasts(sustained, 1)
    assert lasts(sudden, 2) < 0.75 * lasts(neutral, 2) < 0.6 * lasts(sustained, 2)


def hand_speed(clip) -> np.ndarray:
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    hand = place[:, clip.skeleton.index("right_hand")] - place[:, 0]
    return np.linalg.norm(np.diff(hand, axis=0), axis=-1) * clip.rate_hz


@pytest.mark.parametrize("name", ["punch", "kick", "throw", "slash", "wave"])
def test_a_strong_clip_is_faster_at_its_fastest_and_a_light_one_smaller(name):
    strong, neutral, light = (played(name, 0.0, w) for w in (1.0, 0.0, -1.0))
    assert hand_speed(strong).max() > hand_speed(neutral).max() > hand_speed(light).max()
    ways = [hand_speed(clip).sum() for clip in (strong, neutral, light)]
    assert ways[0] > ways[1] > 1.05 * ways[2]


def test_a_strong_back_sinks_and_a_light_one_rises_and_the_eyes_stay():
    def leans(clip, part: str) -> float:
        q, _ = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
        x, y, z, w = q[:, clip.skeleton.index(part)].T
        forward = 2.0 * (y * z + x * w) / (1.0 - 2.0 * (x * x + z * z))
        return float(np.degrees(np.arctan(forward)).mean())

    strong, light = played("walk", 0.0, 1.0), played("walk", 0.0, -1.0)
    assert leans(strong, "upper_chest") > leans(light, "upper_chest") + 15.0
    assert abs(leans(strong, "head") - leans(light, "head")) < 25.0


@pytest.mark.parametrize("name", ["walk", "run", "sneak", "crawl"])
@pytest.mark.parametrize("weight", [-1.0, 1.0])
def test_without_time_a_gait_s_legs_are_its_own(name, weight):
    neutral, clip = LIBRARY.clip(name), played(name, 0.0, weight)
    legs = [j for j, joint in enumerate(clip.skeleton.joints) if "leg" in joint or "foot" in joint]
    kept = clip.rotation_xyzw[:, legs], neutral.rotation_xyzw[:, legs]
    np.testing.assert_allclose(*kept, atol=1e-12)


@pytest.mark.parametrize("name", ["walk", "run", "sneak", "walk_backward", "hop"])
@pytest.mark.parametrize("time", [-1.0, -0.4, 0.4, 1.0])
def test_time_gives_steps_their_attack_and_leaves_the_pace_and_who_stands(name, time):
    neutral, clip = LIBRARY.clip(name), played(name, time, 0.0)
    np.testing.assert_array_equal(clip.translation_m, neutral.translation_m)
    np.testing.assert_array_equal(clip.contacts, neutral.contacts)
    for side in ("left", "right"):
        leg = [
            j
            for j, joint in enumerate(clip.skeleton.joints)
            if joint.startswith(side) and ("leg" in joint or "foot" in joint)
        ]
        columns = [i for i, one in enumerate(clip.contact_joints) if one.startswith(side)]
        stands = neutral.contacts[:, columns].any(axis=1)
        own, there = neutral.rotation_xyzw[:, leg], clip.rotation_xyzw[:, leg]
        same_turn = np.abs(np.sum(own * there, axis=-1))
        assert same_turn[stands].min(initial=1.0) > 1.0 - 1e-12
        if stands.any() and not stands.all():
            assert same_turn[~stands].min() < 1.0 - 1e-5


@pytest.mark.parametrize("name", ["walk", "run", "hop", "dance", "feet together"])
def test_where_a_cycle_begins_does_not_matter_to_its_steps(name):
    clip = LIBRARY.clip("walk" if name == "feet together" else name)
    n = len(clip) - 1
    if name == "feet together":
        lands = [20 if joint.startswith("left") else 24 for joint in clip.contact_joints]
        frame = np.arange(n + 1)[:, None]
        clip = replace(clip, contacts=(frame >= lands) & (frame < np.add(lands, 30)))

    def begun(one: Clip, at: int) -> Clip:
        frames = np.append(np.roll(np.arange(n), -at), at)
        return replace(one, rotation_xyzw=one.rotation_xyzw[frames], contacts=one.contacts[frames])

    for at in range(0, n, 2):
        for time in (-1.0, 1.0):
            there = attacking(begun(clip, at), time).rotation_xyzw[:, 1:]
            here = begun(attacking(clip, time), at).rotation_xyzw[:, 1:]
            assert np.abs(np.sum(there * here, axis=-1)).min() > 1.0 - 1e-9


def test_an_attack_is_early_when_sudden_and_even_when_sustained_and_joins_at_both_ends():
    u = np.linspace(0.0, 1.0, 1001)
    for time in (-1.0, -0.3, 0.3, 1.0):
        shown = attacked(u, time)
        pace = np.diff(shown) / np.diff(u)
        assert (shown[0], shown[-1]) == (0.0, 1.0)
        assert pace.min() > 0.3 and pace.max() < 2.0
        assert pace[[0, -1]] == pytest.approx(1.0, abs=0.01)
        assert (attacked(0.5, time) > 0.5) == (time > 0.0)
    # A step at its own pace is quickest in the middle; a sustained one is less so.
    step = 0.5 - 0.5 * np.cos(np.pi * u)
    assert np.diff(np.interp(attacked(u, -1.0), u, step)).max() < 0.84 * np.diff(step).max()
    np.testing.assert_array_equal(attacked(u, 0.0), u)


def test_equation_7_with_one_nothing_and_a_half():
    clip, joints = LIBRARY.clip("throw"), [3, 9, 12]
    n = len(clip)
    same(rescaled(clip, joints, np.ones((n, 1)), poses_at(clip, np.array([10]))), clip)
    none = rescaled(clip, joints, np.zeros((n, 1)), poses_at(clip, np.array([10])))
    for joint in joints:
        first = np.broadcast_to(clip.rotation_xyzw[10, joint], (n, 4))
        np.testing.assert_allclose(
            np.abs(np.sum(none.rotation_xyzw[:, joint] * first, axis=-1)), 1.0, atol=1e-12
        )
    about = poses_at(clip, np.array([10]))
    half = rescaled(clip, joints, np.full((n, 1), 0.5), about).rotation_xyzw[:, joints]
    first = np.broadcast_to(clip.rotation_xyzw[10, joints], half.shape)
    between = slerp(first, clip.rotation_xyzw[:, joints], np.full(half.shape[:-1], 0.5))
    np.testing.assert_allclose(np.abs(np.sum(half * between, axis=-1)), 1.0, atol=1e-9)


@pytest.mark.parametrize("weight", [-1.0, -0.5, 0.5, 1.0])
def test_who_sits_down_sits_and_who_falls_lies_on_the_ground(weight):
    for name in ("sit_down", "stand_up", "fall", "roll", "crouch", "pick_up", "jump"):
        clip, neutral = played(name, 0.0, weight), LIBRARY.clip(name)
        pelvis = clip.skeleton.index("hips")
        high, own = clip.translation_m[:, pelvis, 1], neutral.translation_m[:, pelvis, 1]
        assert high[[0, -1]] == pytest.approx(own[[0, -1]])
        assert high.min() > min(own.min(), 0.3) - 0.005
        assert high.max() < max(own.max(), 0.96) * 1.06
        if name in ("sit_down", "stand_up", "fall", "roll"):
            assert high.min() < own.min() + 0.01


def test_a_slowness_of_one_is_the_clip_itself():
    clip = LIBRARY.clip("throw")
    frames = shown_frames(np.ones(len(clip) - 1), 62)
    np.testing.assert_array_equal(frames, np.arange(len(clip)))
    same(retimed(clip, frames), clip)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(0.2, 5.0), min_size=5, max_size=5),
    st.integers(0, 2**32 - 1),
    st.sampled_from(ONCE),
)
def test_every_timing_goes_on_from_the_first_frame_to_the_last(lasting, seed, name):
    clip = LIBRARY.clip(name)
    rng = np.random.default_rng(seed)
    slowness = np.repeat(lasting, np.diff(clip.stage_end_frames, prepend=0))
    slowness *= np.exp(rng.normal(0.0, 0.3, len(slowness)))
    fastest = np.linspace(1.2, FASTEST, len(clip) - 1)
    kept = within_pace(slowness, fastest)
    assert kept.sum() == pytest.approx(len(clip) - 1)
    assert (1.0 / kept < fastest + 1e-9).all()
    aim = int(clip.stage_end_frames[2])
    frames = shown_frames(kept, aim)
    assert (frames[0], frames[-1]) == pytest.approx((0.0, len(clip) - 1))
    assert (np.diff(frames) > 0.0).all()
    assert np.abs(frames - aim).min() < 1e-9


def test_what_is_within_its_limits_is_only_made_as_long_as_the_clip():
    slowness = np.linspace(1.0, 1.2, 80)
    kept = within_pace(slowness, np.full(80, 4.0))
    ratio = kept / slowness
    assert ratio.max() / ratio.min() < 1.02  # the faster half nears its limit a little
    np.testing.assert_array_equal(within_pace(np.full(80, 3.0), np.full(80, 4.0)), np.ones(80))


@pytest.mark.parametrize("time", [0.05, 0.2, 0.5, 1.0])
def test_the_stages_of_time_last_as_in_6_4_1(time):
    clip = LIBRARY.clip("cheer")  # whose stages are long enough for what is blended at their ends
    begins, ends = clip.stage_end_frames[1:3]
    slowness = time_slowness(clip, time)
    assert slowness[begins:ends].mean() == pytest.approx(1.0 / (1.0 + 2.0 * time), rel=0.1)
    assert slowness[:begins].mean() == pytest.approx(1.0 / (1.0 - 0.5 * time), rel=0.1)
    slowness = time_slowness(clip, -time)
    assert slowness[begins:ends].mean() == pytest.approx(1.0 + 2.0 * time, rel=0.1)
    assert slowness[:begins].mean() == pytest.approx(1.0 - 0.5 * time, rel=0.15)


@pytest.mark.parametrize("value", [-1.0, -0.4, 0.0, 0.4, 1.0])
def test_effort_s_slownesses_are_finite_and_above_zero(value):
    for name in ONCE:
        asked = studied(name)
        even = np.ones(len(asked.clip) - 1)
        found = [
            time_slowness(asked.clip, value),
            sustained_slowness(asked.vigour, asked.clip, min(value, -0.1)),
            pace_slowness(asked.vigour, even, value),
            flowing_slowness(even, asked.clip, value),
        ]
        for slowness in found:
            assert np.isfinite(slowness).all() and slowness.min() > 0.05 and slowness.max() < 20.0
        np.testing.assert_allclose(pace_slowness(asked.vigour, even, 0.0), even, atol=1e-12)


@pytest.mark.parametrize("exponent", [0.6, 1.0, 1.4])
def test_a_powered_pace_is_the_slope_of_the_softened_power(exponent):
    v = np.linspace(0.0, 1.0, 100_001)
    low, high = SOFT**exponent, (1.0 + SOFT) ** exponent
    u = ((v + SOFT) ** exponent - low) / (high - low)
    slope = np.diff(u) / np.diff(v)
    np.testing.assert_allclose(powered_pace(0.5 * (u[1:] + u[:-1]), exponent), slope, rtol=1e-4)
    assert slope.min() > 0.1 and slope.max() < 4.0


def test_between_frames_a_parabola_is_one_and_a_straight_line_goes_on():
    t = np.arange(12.0)
    at = np.linspace(1.0, 10.0, 73)
    parabola = np.stack([t * t, 3.0 - t], axis=-1)
    np.testing.assert_allclose(
        between_frames(parabola, at), np.stack([at * at, 3.0 - at], axis=-1), atol=1e-12
    )
    line = between_frames(t, np.linspace(0.0, 11.0, 89))
    np.testing.assert_allclose(line, np.linspace(0.0, 11.0, 89), atol=1e-12)
    np.testing.assert_array_equal(between_frames(parabola, t), parabola)


def test_reshaping_adds_its_angle_about_the_left_axis():
    clip = LIBRARY.clip("idle")
    spine = clip.skeleton.index("spine")
    bent = reshaped(clip, {spine: np.full(len(clip), 0.3)}, BODY.rest_xyzw)
    turn = rotvec_from_quaternion(
        multiply(inverse(clip.rotation_xyzw[:, spine]), bent.rotation_xyzw[:, spine])
    )
    np.testing.assert_allclose(turn, np.tile([0.3, 0.0, 0.0], (len(clip), 1)), atol=1e-9)


def test_the_dial_scales_what_is_played_and_never_beyond_the_poles():
    effort = Effort(time=0.62, weight=-0.97, space=0.6)
    assert played_effort(effort, 0.0) == Effort(time=0.0, weight=0.0, space=0.0, flow=0.0)
    assert played_effort(effort, 1.0) == Effort(time=0.6, weight=-1.0, space=0.5, flow=0.0)
    assert played_effort(effort, 2.0) == Effort(time=1.0, weight=-1.0, space=1.0, flow=0.0)
    assert piece_name("bow", effort, 0.0) == "bow"
    assert piece_name("bow", effort, 1.0) == "bow time +0.6 weight -1.0 space +0.5"


@pytest.mark.parametrize("time", [-1.0, 0.0, 0.5, 1.0])
@pytest.mark.parametrize(("weight", "flow"), [(0.0, 1.0), (1.0, 0.0), (-1.0, -1.0), (1.0, 1.0)])
def test_all_timings_together_go_on_and_keep_the_length(time, weight, flow):
    for name in ONCE:
        clip = LIBRARY.clip(name)
        fastest = fastest_paces(clip.rotation_xyzw, clip.rate_hz)
        frames = effort_timing(studied(name), fastest, time, weight, flow)
        assert frames[0] == pytest.approx(0.0, abs=1e-9)
        assert frames[-1] == pytest.approx(len(clip) - 1)
        assert np.diff(frames).min() > 0.0
        assert np.diff(frames).max() <= FASTEST + 0.1


@pytest.mark.parametrize("name", ["throw", "punch", "wave"])
def test_a_sudden_clip_moves_from_its_first_frame_on_and_waits_when_it_is_over(name):
    asked = studied(name)
    fastest = fastest_paces(asked.clip.rotation_xyzw, asked.clip.rate_hz)
    pace = np.diff(effort_timing(asked, fastest, 1.0, 0.0, 0.0))
    assert pace[:5].min() > 0.5
    assert pace[-10:].max() < 0.4 and pace.min() > 0.1


def test_a_bound_clip_rests_at_the_ends_of_its_stages_and_a_free_one_runs_on():
    clip = LIBRARY.clip("throw")
    even = np.ones(len(clip) - 1)
    for flow, least, most in ((1.0, 0.0, 0.5), (-1.0, 1.05, 2.0)):
        pace = 1.0 / flowing_slowness(even, clip, flow)
        for end in clip.stage_end_frames[:-1]:
            assert least < pace[end - 1 : end + 1].min() <= pace[end - 1 : end + 1].max() < most
        lasting = np.add.reduceat(1.0 / pace, [0, *clip.stage_end_frames[:-1]])
        np.testing.assert_allclose(lasting, np.diff(clip.stage_end_frames, prepend=0), atol=1e-9)


def arc(bow: float, n: int = 61) -> np.ndarray:
    """Return a sweep along x of length 1 from rest to rest that bows out upward."""
    u = np.linspace(0.0, 1.0, n)
    u = u * u * (3.0 - 2.0 * u)
    return np.stack([u, bow * np.sin(np.pi * u), np.zeros(n)], axis=-1)


def test_there_and_back_are_two_sweeps():
    there = arc(0.2)
    assert sweeps(np.concatenate([there, there[-2::-1]]), 60.0) == [(0, 60), (60, 120)]


def test_a_direct_hand_goes_straighter_and_an_indirect_one_bends():
    def bend(path: np.ndarray) -> float:
        return float(np.linalg.norm(path[:, 1:], axis=-1).max())

    for bow in (0.1, 0.3):
        path = arc(bow)
        for space in (0.5, 1.0):
            assert bend(path + redrawn_once(path, space)) < (1.0 - 0.6 * space) * bow
            assert bend(path + redrawn_once(path, -space)) > bow + 0.08 * space
    straight = arc(0.0)
    np.testing.assert_allclose(redrawn_once(straight, 1.0), 0.0, atol=1e-12)
    for path in (straight, arc(0.3)):
        for space in (-1.0, 1.0):
            np.testing.assert_allclose(redrawn_once(path, space)[[0, -1]], 0.0, atol=1e-9)


def test_a_circle_has_no_straight_way():
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    circle = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=-1)
    assert np.abs(redrawn_once(circle, 1.0)).max() < 1e-9


def test_a_straight_way_does_not_lead_through_the_shoulder():
    turn = np.linspace(0.0, np.pi, 61)
    around = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=-1)  # half round a shoulder
    shoulder = np.zeros((61, 3))
    for reach in (1.0, 1.5):
        held = Held(np.ones(61), shoulder[:, None], reach, through=())
        path = around + redrawn_once(around, 1.0, held)
        assert np.linalg.norm(path, axis=-1).min() == pytest.approx(0.5 * reach, abs=1e-9)
    fast = around + redrawn_once(around, 1.0)
    assert np.linalg.norm(fast, axis=-1).min() < 0.4


def test_a_redrawn_path_leads_through_what_it_must():
    there = np.concatenate([arc(0.2), arc(0.2)[1:] + np.array([1.0, 0.0, 0.0])])
    held = Held(np.ones(121), there[:, None] - [0.0, 0.0, 5.0], 6.0, through=(20, 90))
    for space in (-1.0, 1.0):
        offset = redrawn_once(there, space, held)
        assert np.abs(offset[[0, 20, 90, 120]]).max() < 1e-3
        assert np.abs(offset).max() > 0.02


def test_a_redrawn_path_turns_with_the_world():
    from smd.geometry.rotations import quaternion_from_rotvec

    q, path = quaternion_from_rotvec(np.array([0.3, -0.8, 0.5])), arc(0.2)
    for space in (-1.0, 1.0):
        turned = redrawn_once(rotate(q, path), space)
        np.testing.assert_allclose(turned, rotate(q, redrawn_once(path, space)), atol=1e-9)


@pytest.mark.parametrize("name", ["throw", "clap", "crawl"])
def test_a_hand_is_moved_by_what_was_asked_and_by_nothing_where_nothing_was(name):
    clip, arms = LIBRARY.clip(name), BODY.arms
    pose = arm_poses(clip.skeleton, clip, arms)
    same(with_hands_moved(clip, arms, pose, np.zeros_like(pose.hand_m)), clip, 1e-9)
    chest = world_of(clip)[1][:, [BODY.chest]]
    offset = 0.2 * (chest - pose.hand_m)
    moved = arm_poses(clip.skeleton, with_hands_moved(clip, arms, pose, offset), arms)
    assert np.abs(moved.hand_m - pose.hand_m - offset).max() < 0.02
    # The elbow stays in the plane that it is bent in: nothing but a swing is added.
    assert elbow_sides(moved).min() > min(elbow_sides(pose).min(), 0.0) - 0.02


def test_arms_are_moved_each_by_itself():
    clip, arms = LIBRARY.clip("throw"), BODY.arms
    pose = arm_poses(clip.skeleton, clip, arms)
    offset = 0.1 * np.random.default_rng(1).normal(size=pose.hand_m.shape)
    both = with_hands_moved(clip, arms, pose, offset)
    for i in range(len(arms)):
        one = with_hands_moved(
            clip, arms[i : i + 1], arm_poses(clip.skeleton, clip, arms[i : i + 1]), offset[:, [i]]
        )
        moved = [arms[i].upper, arms[i].middle]
        np.testing.assert_array_equal(both.rotation_xyzw[:, moved], one.rotation_xyzw[:, moved])


def elbow_sides(pose: ArmPoses) -> np.ndarray:
    """Return the sines by which elbows are bent, ``(n, a)``, negative when one is broken."""
    upper, lower = pose.elbow_m - pose.shoulder_m, pose.hand_m - pose.elbow_m
    hinges = np.stack([arm.limb.upper_hinge for arm in BODY.arms])
    sine = np.sum(np.cross(upper, lower) * rotate(pose.upper_xyzw, hinges), axis=-1)
    return sine / (np.linalg.norm(upper, axis=-1) * np.linalg.norm(lower, axis=-1))


@pytest.mark.parametrize("name", ["pick_up", "slash", "throw", "spin"])
@pytest.mark.parametrize("farther_m", [0.02, 0.1, 0.5])
def test_an_arm_that_reaches_for_what_is_too_far_does_not_bend_backwards(name, farther_m):
    clip, arms = LIBRARY.clip(name), BODY.arms
    pose = arm_poses(clip.skeleton, clip, arms)
    away = pose.hand_m - pose.shoulder_m
    offset = farther_m * away / np.linalg.norm(away, axis=-1, keepdims=True)
    assert (
        elbow_sides(
            arm_poses(clip.skeleton, with_hands_moved(clip, arms, pose, offset), arms)
        ).min()
        > 0.0
    )


def test_a_spring_swings_over_as_its_damping_says_and_comes_to_rest():
    clip = LIBRARY.clip("idle")
    hand = BODY.arms[0].hand
    n, start = len(clip), 60
    angle = np.where(np.arange(n) < start, 0.0, 0.4)
    from smd.geometry.rotations import quaternion_about

    rotation = clip.rotation_xyzw.copy()
    rotation[:, hand] = quaternion_about([0.0, 1.0, 0.0], angle)
    stepping = replace(clip, rotation_xyzw=rotation, cyclic=False)
    swung = sprung(stepping, stepping, [hand], BODY, np.ones(n)).rotation_xyzw[:, hand]
    turned = 2.0 * np.arctan2(swung[:, 1], swung[:, 3])
    over = np.exp(-np.pi * DAMPING / np.sqrt(1.0 - DAMPING**2))
    assert turned.max() / 0.4 - 1.0 == pytest.approx(over, abs=0.02)
    assert turned[-1] == pytest.approx(0.4, abs=1e-3)
    first_top = (int(np.argmax(turned)) - start) / clip.rate_hz
    assert 0.5 / SPRING_HZ < first_top < 1.0 / SPRING_HZ


@pytest.mark.parametrize("name", ["throw", "wave", "walk", "dance"])
@pytest.mark.parametrize("flow", [-1.0, 1.0])
@pytest.mark.parametrize("space", [-1.0, 1.0])
def test_space_and_flow_break_no_elbow_and_no_cycle(name, flow, space):
    travels = LIBRARY.action(name).travels
    (clip,) = expressive(studied(name), [Effort(space=space, flow=flow)], travels=travels)
    assert elbow_sides(arm_poses(clip.skeleton, clip, BODY.arms)).min() > 0.0
    if clip.cyclic:
        dots = np.abs(np.sum(clip.rotation_xyzw[0, 1:] * clip.rotation_xyzw[-1, 1:], axis=-1))
        assert dots.min() > 1.0 - 1e-3


def test_damping_leaves_what_is_slow_and_takes_what_is_quick():
    from smd.geometry.rotations import quaternion_about

    clip, hand = LIBRARY.clip("idle"), BODY.arms[0].hand
    time_s = np.arange(len(clip)) / clip.rate_hz
    for hz in (0.25, 6.0):
        rotation = clip.rotation_xyzw.copy()
        rotation[:, hand] = quaternion_about([1.0, 0.0, 0.0], 0.2 * np.sin(2 * np.pi * hz * time_s))
        shaking = replace(clip, rotation_xyzw=rotation, cyclic=False)
        left = damped(shaking, shaking, [hand], np.ones(len(clip))).rotation_xyzw[30:-30, hand]
        kept = np.ptp(2.0 * np.arctan2(left[:, 0], left[:, 3])) / 0.4
        # A Gaussian's own answer to a sine.
        assert kept == pytest.approx(np.exp(-0.5 * (2 * np.pi * hz * 0.07) ** 2), abs=0.03)


@pytest.mark.parametrize("ends", [[0, 0, 1, 1, 1], [1] * 5, [0, 0, 0, 0, 39], [1, 2, 3, 4, 39]])
def test_the_shortest_stages_play_every_effort(ends):
    clip, n = LIBRARY.clip("throw"), ends[-1] + 1
    short = replace(
        clip,
        rotation_xyzw=clip.rotation_xyzw[:n],
        translation_m=clip.translation_m[:n],
        contacts=clip.contacts[:n],
        stage_end_frames=np.array(ends),
    )
    asked = study_of(short, BODY)
    efforts = [Effort(*effort) for effort in product((-1.0, 0.5, 1.0), repeat=4)]
    for clip in expressive(asked, efforts, travels=False):
        assert len(clip) == n and np.isfinite(clip.rotation_xyzw).all()


@pytest.mark.parametrize("joints", [1, 2, 5])
@pytest.mark.parametrize("cyclic", [False, True])
def test_a_body_without_limbs_plays_every_effort(joints, cyclic):
    snake = Skeleton(
        joints=tuple(f"joint_{i}" for i in range(joints)),
        parents=np.arange(joints) - 1,
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (joints, 1)),
        rest_translation_m=np.tile([0.0, 0.0, 0.1], (joints, 1)),
        world_from_bind=np.tile(np.eye(4), (joints, 1, 1)),
        roles=("root", *["spine"] * (joints - 1)),
    )
    turn = 0.4 * np.sin(np.linspace(0.0, 2.0 * np.pi, 51))[:, None] * np.arange(joints)
    rotation = np.zeros((51, joints, 4))
    rotation[..., 1], rotation[..., 3] = np.sin(0.5 * turn), np.cos(0.5 * turn)
    clip = Clip(
        name="writhe",
        skeleton=snake,
        rate_hz=60.0,
        rotation_xyzw=rotation,
        translation_m=np.tile(snake.rest_translation_m, (51, 1, 1)),
        stage_end_frames=np.array([0, 0, 50, 50, 50] if cyclic else [5, 12, 30, 40, 50]),
        contact_joints=(),
        contacts=np.zeros((51, 0), dtype=bool),
        cyclic=cyclic,
    )
    asked = study_of(clip, body_of(clip))
    efforts = [Effort(*effort) for effort in product((-1.0, 0.5, 1.0), repeat=4)]
    for played in expressive(asked, efforts, travels=False):
        assert np.isfinite(played.rotation_xyzw).all()


def test_a_performance_with_the_dial_at_0_is_neutral_and_above_it_is_not():
    from smd.formats import read_recording
    from smd.score_file import read_score
    from tests.smd.synthetic.test_stories import RECORDINGS

    recording = read_recording(RECORDINGS / "postman.csv")
    score = smd.parse(recording, LIBRARY)
    neutral = smd.animate(score, recording, LIBRARY, expressiveness=0.0)
    played_ = smd.animate(score, recording, LIBRARY)
    assert read_score(RECORDINGS / "postman.score.json").performers  # it has phrases
    apart = np.abs(neutral.actors[0].poses.rotation_xyzw - played_.actors[0].poses.rotation_xyzw)
    assert apart.max() > 0.05
    # the same way, each place of it at another moment
    way, there = (
        actor.poses.translation_m[:, 0] for actor in (neutral.actors[0], played_.actors[0])
    )
    step = np.diff(way, axis=0)
    along = np.einsum("nmi,mi->nm", there[:, None] - way[:-1], step) / (
        np.einsum("mi,mi->m", step, step) + 1e-12
    )
    nearest = way[:-1] + np.clip(along, 0.0, 1.0)[..., None] * step
    assert np.linalg.norm(there[:, None] - nearest, axis=-1).min(axis=1).max() < 0.05
    for wrong in (-0.1, 2.1, float("nan")):
        with pytest.raises(TransferError, match="expressiveness"):
            smd.animate(score, recording, LIBRARY, expressiveness=wrong)
