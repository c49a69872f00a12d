"""Operators and Effort: the laws they state, on the shipped clips."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import smd
from actions_library.folder import load_library
from laban import Effort
from smd.character.kinematics import forward_kinematics
from smd.errors import TransferError
from smd.geometry.rotations import inverse, multiply, rotvec_from_quaternion, slerp
from smd.transfer.expression import (
    FASTEST,
    body_of,
    expressive,
    time_timing,
    weight_timing,
    within_pace,
)
from smd.transfer.operators import rescaled, reshaped, retimed, softened_power, stage_timing
from smd.transfer.repertoire import piece_name, played_effort

LIBRARY = load_library()
BODY = body_of(LIBRARY.clip("idle"))
ONCE = ["punch", "kick", "throw", "bow", "jump", "wave", "sit_down"]
POLES = [(t, w) for t in (-1.0, 0.0, 1.0) for w in (-1.0, 0.0, 1.0)]


def played(name: str, time: float, weight: float):
    travels = LIBRARY.action(name).travels
    return expressive(LIBRARY.clip(name), Effort(time=time, weight=weight), BODY, travels=travels)


def same(one, other, atol=0.0):
    dots = np.abs(np.sum(one.rotation_xyzw * other.rotation_xyzw, axis=-1))
    assert dots.min() >= 1.0 - 1e-12 - atol
    np.testing.assert_allclose(one.translation_m, other.translation_m, atol=1e-12 + atol)


@pytest.mark.parametrize("name", [*ONCE, "walk", "fly"])
def test_without_effort_a_clip_is_the_same(name):
    for effort in (Effort(), Effort(time=0.0, weight=0.0), Effort(space=1.0, flow=-1.0)):
        travels = LIBRARY.action(name).travels
        assert expressive(LIBRARY.clip(name), effort, BODY, travels=travels) is LIBRARY.clip(name)


@pytest.mark.parametrize("name", ONCE)
@pytest.mark.parametrize(("time", "weight"), POLES)
def test_length_ends_and_order_are_kept(name, time, weight):
    neutral, clip = LIBRARY.clip(name), played(name, time, weight)
    assert len(clip) == len(neutral)
    assert (np.diff(clip.stage_end_frames) >= 0).all()
    for frame in (0, -1):
        np.testing.assert_allclose(
            np.abs(np.sum(clip.rotation_xyzw[frame] * neutral.rotation_xyzw[frame], axis=-1)),
            1.0,
            atol=1e-9,
        )


@pytest.mark.parametrize("name", ONCE)
@pytest.mark.parametrize(("time", "weight"), POLES)
def test_nothing_pops(name, time, weight):
    def fastest(clip) -> float:
        q = clip.rotation_xyzw[:, 1:]
        turns = rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:]))
        return float(np.linalg.norm(turns, axis=-1).max())

    # As many frames are passed as the pace allows, each as much larger as the scale.
    assert fastest(played(name, time, weight)) < 1.6 * FASTEST * fastest(LIBRARY.clip(name))


def test_a_sudden_punch_waits_and_bursts_and_a_sustained_one_does_not():
    def lasts(clip, stage: int) -> float:
        return float(clip.stage_end_frames[stage] - clip.stage_end_frames[stage - 1])

    sudden, neutral, sustained = (played("punch", t, 0.0) for t in (1.0, 0.0, -1.0))
    assert lasts(sudden, 1) > lasts(neutral, 1) > lasts(sustained, 1)
    assert lasts(sudden, 2) < lasts(neutral, 2) < lasts(sustained, 2)


def hand_speed(clip) -> np.ndarray:
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    hand = place[:, clip.skeleton.index("right_hand")] - place[:, 0]
    return np.linalg.norm(np.diff(hand, axis=0), axis=-1) * clip.rate_hz


@pytest.mark.parametrize("name", ["punch", "kick", "throw", "slash", "wave"])
def test_a_strong_clip_is_faster_at_its_fastest_and_a_light_one_smaller(name):
    strong, neutral, light = (played(name, 0.0, w) for w in (1.0, 0.0, -1.0))
    assert hand_speed(strong).max() > hand_speed(neutral).max() > hand_speed(light).max()
    assert hand_speed(light).sum() < 0.8 * hand_speed(neutral).sum()


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
def test_a_gait_s_legs_and_pace_are_its_own(name, weight):
    neutral, clip = LIBRARY.clip(name), played(name, 1.0, weight)
    legs = [j for j, joint in enumerate(clip.skeleton.joints) if "leg" in joint or "foot" in joint]
    kept = clip.rotation_xyzw[:, legs], neutral.rotation_xyzw[:, legs]
    np.testing.assert_allclose(*kept, atol=1e-12)
    np.testing.assert_array_equal(clip.translation_m[:, 0], neutral.translation_m[:, 0])
    np.testing.assert_array_equal(clip.contacts, neutral.contacts)


@pytest.mark.parametrize("name", ["walk", "dance", "fly"])
def test_a_cycle_still_closes(name):
    clip = played(name, -1.0, 1.0)
    dots = np.abs(np.sum(clip.rotation_xyzw[0, 1:] * clip.rotation_xyzw[-1, 1:], axis=-1))
    assert dots.min() > 1.0 - 1e-9


def test_equation_7_with_one_nothing_and_a_half():
    clip, joints = LIBRARY.clip("throw"), [3, 9, 12]
    n = len(clip)
    same(rescaled(clip, joints, np.ones(n), 10), clip)
    none = rescaled(clip, joints, np.zeros(n), 10)
    for joint in joints:
        first = np.broadcast_to(clip.rotation_xyzw[10, joint], (n, 4))
        np.testing.assert_allclose(
            np.abs(np.sum(none.rotation_xyzw[:, joint] * first, axis=-1)), 1.0, atol=1e-12
        )
    half = rescaled(clip, joints, np.full(n, 0.5), 10).rotation_xyzw[:, joints]
    first = np.broadcast_to(clip.rotation_xyzw[10, joints], half.shape)
    between = slerp(first, clip.rotation_xyzw[:, joints], np.full(half.shape[:-1], 0.5))
    np.testing.assert_allclose(np.abs(np.sum(half * between, axis=-1)), 1.0, atol=1e-9)


def test_equation_7_does_not_mind_a_quaternion_s_sign():
    from dataclasses import replace

    clip = LIBRARY.clip("punch")
    flipped = replace(clip, rotation_xyzw=-clip.rotation_xyzw)
    factor = np.linspace(0.2, 1.2, len(clip))
    same(rescaled(flipped, BODY.every, factor, 0), rescaled(clip, BODY.every, factor, 0), 1e-9)


def test_equation_6_without_change_is_the_clip():
    clip = LIBRARY.clip("throw")
    frames = stage_timing(clip, [1.0] * 5, [1.0] * 5)
    np.testing.assert_allclose(frames, np.arange(len(clip)), atol=1e-9)
    same(retimed(clip, frames), clip, 1e-9)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(0.2, 5.0), min_size=5, max_size=5),
    st.lists(st.floats(0.4, 1.6), min_size=5, max_size=5),
    st.sampled_from(ONCE),
)
def test_every_timing_goes_on_from_the_first_frame_to_the_last(lasting, power, name):
    clip = LIBRARY.clip(name)
    frames = stage_timing(clip, lasting, power)
    assert frames[0] == pytest.approx(0.0, abs=1e-9)
    assert frames[-1] == pytest.approx(len(clip) - 1)
    assert (np.diff(frames) > 0.0).all()
    kept = within_pace(frames)
    assert kept[-1] == pytest.approx(len(clip) - 1)
    assert (np.diff(kept) > 0.0).all()


@pytest.mark.parametrize("value", [-1.0, -0.4, 0.4, 1.0])
@pytest.mark.parametrize("timing", [time_timing, weight_timing])
def test_effort_s_timings_go_on_too(timing, value):
    for name in ONCE:
        frames = timing(LIBRARY.clip(name), value)
        assert frames[0] == pytest.approx(0.0, abs=1e-6)
        assert frames[-1] == pytest.approx(len(frames) - 1)
        assert np.diff(frames).min() > 0.0


@pytest.mark.parametrize("exponent", [0.6, 1.0, 1.4])
def test_a_softened_power_goes_from_0_to_1_with_a_finite_slope(exponent):
    u = np.linspace(0.0, 1.0, 1001)
    value = softened_power(u, exponent)
    assert (value[0], value[-1]) == pytest.approx((0.0, 1.0))
    slope = np.diff(value) / np.diff(u)
    assert slope.min() > 0.1 and slope.max() < 4.0


def test_reshaping_adds_its_angle_about_the_left_axis():
    clip = LIBRARY.clip("idle")
    spine = clip.skeleton.index("spine")
    bent = reshaped(clip, {spine: np.full(len(clip), 0.3)}, BODY.rest_xyzw)
    turn = rotvec_from_quaternion(
        multiply(inverse(clip.rotation_xyzw[:, spine]), bent.rotation_xyzw[:, spine])
    )
    np.testing.assert_allclose(turn, np.tile([0.3, 0.0, 0.0], (len(clip), 1)), atol=1e-9)


def test_the_dial_scales_what_is_played_and_never_beyond_the_poles():
    effort = Effort(time=0.62, weight=-0.97, space=1.0)
    assert played_effort(effort, 0.0) == Effort(time=0.0, weight=0.0)
    assert played_effort(effort, 1.0) == Effort(time=0.6, weight=-1.0)
    assert played_effort(effort, 2.0) == Effort(time=1.0, weight=-1.0)
    assert piece_name("bow", effort, 0.0) == "bow"
    assert piece_name("bow", effort, 1.0) == "bow time +0.6 weight -1.0"


def test_a_performance_with_the_dial_at_0_is_neutral_and_above_it_is_not():
    from smd.formats import read_recording
    from smd.score import read_score
    from tests.smd.synthetic.test_stories import RECORDINGS

    recording = read_recording(RECORDINGS / "postman.csv")
    score = smd.parse(recording, LIBRARY)
    neutral = smd.animate(score, recording, LIBRARY, expressiveness=0.0)
    played_ = smd.animate(score, recording, LIBRARY)
    assert read_score(RECORDINGS / "postman.score.json").performers  # it has phrases
    apart = np.abs(neutral.actors[0].rotation_xyzw - played_.actors[0].rotation_xyzw)
    assert apart.max() > 0.05
    np.testing.assert_allclose(
        neutral.actors[0].translation_m[:, 0], played_.actors[0].translation_m[:, 0], atol=0.25
    )
    for wrong in (-0.1, 2.1, float("nan")):
        with pytest.raises(TransferError, match="expressiveness"):
            smd.animate(score, recording, LIBRARY, expressiveness=wrong)
