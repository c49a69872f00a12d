from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.clips import humanoid_clips
from actions_library.authoring.humanoid import humanoid_skeleton
from benchmarks.clips import Quality, measure
from smd.character.clip import STAGES, Clip
from smd.character.kinematics import forward_kinematics
from smd.geometry.rotations import (
    heading_rad,
    inverse,
    multiply,
    rotate,
    rotvec_from_quaternion,
)

CLIPS = {clip.name: clip for clip in humanoid_clips(humanoid_skeleton())}
CYCLIC = ["walk", "run", "side_step_left", "side_step_right", "fly", "idle"]
GESTURES = sorted(set(CLIPS) - set(CYCLIC))
WAY = {  # metres to the left and ahead, from the first to the last frame
    "walk": (0.0, 1.40),
    "run": (0.0, 2.40),
    "side_step_left": (0.60, 0.0),
    "side_step_right": (-0.60, 0.0),
    "jump": (0.0, 1.20),
    "fly": (0.0, 3.00),
}


@pytest.fixture(scope="module", params=sorted(CLIPS))
def clip(request: pytest.FixtureRequest) -> Clip:
    return CLIPS[request.param]


@pytest.fixture(scope="module")
def quality(clip: Clip) -> Quality:
    return measure(clip)


def world(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)


def joint(clip: Clip, name: str) -> np.ndarray:
    return world(clip)[1][:, clip.skeleton.index(name)]


def test_every_first_action_has_its_clip():
    assert set(CLIPS) == {
        *("walk", "run", "side_step_left", "side_step_right", "jump", "turn_left", "turn_right"),
        *("punch", "throw", "fly", "bow", "idle"),
    }


def test_planted_joints_hold_still(quality):
    assert quality.slide_m_s <= 0.02


def test_no_sole_goes_under_the_ground(quality):
    assert quality.lowest_sole_m >= -0.002


def test_knees_and_elbows_bend_as_a_person_s_and_never_lock(quality):
    for least, greatest in (quality.knee_deg, quality.elbow_deg):
        assert least >= 3.0
        assert greatest <= 150.0


def test_nothing_pops(quality):
    assert quality.turn_rad_s <= 30.0


def test_a_slow_body_is_over_its_feet(quality):
    assert quality.off_balance_m <= 0.020


def test_the_root_stands_on_the_ground_and_only_turns_about_the_vertical(clip):
    assert np.abs(clip.translation_m[:, 0, 1]).max() == 0.0
    up = rotate(clip.rotation_xyzw[:, 0], [0.0, 1.0, 0.0])
    np.testing.assert_allclose(up, np.tile([0.0, 1.0, 0.0], (len(clip), 1)), atol=1e-12)


def test_every_clip_starts_at_the_origin_facing_ahead(clip):
    np.testing.assert_allclose(clip.translation_m[0, 0], 0.0, atol=1e-12)
    assert heading_rad(clip.rotation_xyzw[0, 0]) == pytest.approx(0.0, abs=1e-12)


def test_bones_keep_their_lengths(clip):
    rest = clip.skeleton.rest_translation_m[2:]
    np.testing.assert_allclose(
        clip.translation_m[:, 2:], np.broadcast_to(rest, (len(clip), *rest.shape)), atol=1e-9
    )


@pytest.mark.parametrize("name", CYCLIC)
def test_a_cycle_ends_in_the_pose_it_began_with(name):
    clip = CLIPS[name]
    turn = multiply(inverse(clip.rotation_xyzw[0, 1:]), clip.rotation_xyzw[-1, 1:])
    np.testing.assert_allclose(rotvec_from_quaternion(turn), 0.0, atol=1e-6)
    np.testing.assert_allclose(clip.translation_m[-1, 1:], clip.translation_m[0, 1:], atol=1e-9)


@pytest.mark.parametrize("name", CYCLIC)
def test_a_cycle_goes_over_its_seam_as_smoothly_as_elsewhere(name):
    assert measure(CLIPS[name]).seam_kink <= 1.01


@pytest.mark.parametrize("name", CYCLIC)
def test_a_cycle_travels_at_constant_speed(name):
    step = np.diff(CLIPS[name].translation_m[:, 0], axis=0)
    np.testing.assert_allclose(step, np.broadcast_to(step[0], step.shape), atol=1e-12)


@pytest.mark.parametrize("name", sorted(CLIPS))
def test_a_clip_travels_as_far_as_its_feet_and_as_it_says(name):
    clip = CLIPS[name]
    left, ahead = WAY.get(name, (0.0, 0.0))
    np.testing.assert_allclose(clip.translation_m[-1, 0], [left, 0.0, ahead], atol=1e-9)
    assert measure(clip).feet_travel_m == pytest.approx(np.hypot(left, ahead), abs=0.005)


@pytest.mark.parametrize("name", ["walk", "run"])
def test_a_gait_is_its_mirror_image_half_a_cycle_later(name):
    clip = CLIPS[name]
    half = (len(clip) - 1) // 2
    for part in ("hand", "foot", "lower_leg"):
        left = joint(clip, f"left_{part}") - clip.translation_m[:, 0]
        right = joint(clip, f"right_{part}") - clip.translation_m[:, 0]
        np.testing.assert_allclose(left[: half + 1] * [-1.0, 1.0, 1.0], right[half:], atol=1e-6)


def test_a_runner_is_in_the_air_twice_a_cycle_and_a_walker_never():
    def stands(name: str) -> np.ndarray:
        clip = CLIPS[name]
        heights = [joint(clip, f"{side}_toes")[:, 1] for side in ("left", "right")]
        rest = clip.skeleton.world_from_bind[clip.skeleton.index("left_toes"), 1, 3]
        heels = CLIPS[name].contacts.any(axis=1)
        return heels | (np.min(heights, axis=0) < rest + 1e-3)

    takeoffs = np.sum(np.diff(stands("run").astype(int)) == -1)
    assert takeoffs == 2
    walk = CLIPS["walk"]
    low = [joint(walk, f"{side}_foot")[:, 1] < 0.11 for side in ("left", "right")]
    assert (stands("walk") | low[0] | low[1]).all()


@pytest.mark.parametrize("name", ["side_step", "turn"])
def test_the_right_way_is_the_left_way_s_mirror_image_from_the_first_pose_on(name):
    left, right = CLIPS[f"{name}_left"], CLIPS[f"{name}_right"]
    tolerance_m = 0.08 if name == "turn" else 1e-6  # both turns start in one unsymmetric stance
    for one, other in (("left_hand", "right_hand"), ("left_foot", "right_foot"), ("head", "head")):
        mirrored = joint(left, one) * [-1.0, 1.0, 1.0]
        np.testing.assert_allclose(mirrored, joint(right, other), atol=tolerance_m)


@pytest.mark.parametrize(("name", "heading"), [("turn_left", 90.0), ("turn_right", -90.0)])
def test_a_turn_is_a_quarter_led_by_the_eyes(name, heading):
    clip = CLIPS[name]
    rotation, _ = world(clip)
    yaw = {
        part: np.unwrap(heading_rad(rotation[:, clip.skeleton.index(part)]))
        for part in ("root", "head", "upper_chest", "hips")
    }
    assert np.degrees(yaw["root"][-1]) == pytest.approx(heading, abs=1e-9)
    half = {part: int(np.argmax(np.abs(y) > np.radians(45.0))) for part, y in yaw.items()}
    assert half["head"] < half["upper_chest"] < half["hips"]


@pytest.mark.parametrize("name", GESTURES)
def test_a_gesture_starts_and_ends_standing_as_idle_does(name):
    clip, idle = CLIPS[name], CLIPS["idle"]
    for frame in (0, -1):
        turn = multiply(inverse(idle.rotation_xyzw[0, 1:]), clip.rotation_xyzw[frame, 1:])
        assert np.linalg.norm(rotvec_from_quaternion(turn), axis=-1).max() < 0.25


@pytest.mark.parametrize("name", GESTURES)
def test_a_gesture_has_an_execution_and_a_way_back(name):
    ends = dict(zip(STAGES, CLIPS[name].stage_end_frames, strict=True))
    assert ends["anticipation"] < ends["execution"] < ends["transition"]


def test_a_jump_travels_in_its_execution_only_and_falls_freely_in_the_air():
    clip = CLIPS["jump"]
    start, end = clip.stage_end_frames[1:3]
    ahead = clip.translation_m[:, 0, 2]
    np.testing.assert_allclose(ahead[: start + 1], 0.0, atol=1e-9)
    np.testing.assert_allclose(ahead[end:], 1.20, atol=1e-9)
    softened = 7
    take_off = int(np.flatnonzero(clip.contacts.any(axis=1)[:end]).max())
    height = joint(clip, "hips")[take_off + softened : end - softened + 1, 1]
    fall = np.diff(height, 2) * clip.rate_hz**2
    np.testing.assert_allclose(fall, -9.81, atol=0.01)


def test_a_punch_goes_far_ahead_with_the_right_hand_and_the_hips_behind_it():
    clip = CLIPS["punch"]
    end = clip.stage_end_frames[3]
    assert joint(clip, "right_hand")[end, 2] > 0.70
    assert joint(clip, "left_hand")[end, 2] < 0.45
    rotation, _ = world(clip)
    hips = np.degrees(heading_rad(rotation[:, clip.skeleton.index("hips")]))
    assert hips[end] - hips[clip.stage_end_frames[1]] > 45.0


def test_a_throw_takes_the_right_hand_from_behind_over_the_shoulder_to_the_other_side():
    clip = CLIPS["throw"]
    hand, head = joint(clip, "right_hand"), joint(clip, "head")
    _, anticipation, execution, follow_through, _ = clip.stage_end_frames
    assert hand[anticipation, 2] < head[anticipation, 2] - 0.3
    assert hand[anticipation:execution, 1].max() > head[execution, 1] + 0.1
    assert hand[follow_through + 2, 0] > joint(clip, "hips")[follow_through + 2, 0]


def test_a_bow_bends_at_the_hips_with_a_straight_back():
    clip = CLIPS["bow"]
    rotation, _ = world(clip)
    deep = clip.stage_end_frames[2]
    up = {
        part: rotate(rotation[deep, clip.skeleton.index(part)], [0.0, 1.0, 0.0])
        for part in ("hips", "upper_chest")
    }
    lean = {part: np.degrees(np.arctan2(v[2], v[1])) for part, v in up.items()}
    assert lean["hips"] > 40.0
    assert abs(lean["upper_chest"] - lean["hips"]) < 15.0


def test_a_flyer_lies_on_the_air():
    clip = CLIPS["fly"]
    hips, head = joint(clip, "hips"), joint(clip, "head")
    slope = np.degrees(np.arctan2(head[:, 1] - hips[:, 1], head[:, 2] - hips[:, 2]))
    assert np.abs(slope).max() < 30.0
    assert abs(hips[:, 1].mean() - 1.05) < 0.10


def test_authoring_gives_the_same_clips_each_time():
    again = {clip.name: clip for clip in humanoid_clips(humanoid_skeleton())}
    for name, clip in CLIPS.items():
        np.testing.assert_array_equal(clip.rotation_xyzw, again[name].rotation_xyzw)
