from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.actions import HUMANOID_ACTIONS
from actions_library.authoring.clips import humanoid_clips
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.authoring.mass import centre_of_mass
from benchmarks.clips import Quality, measure
from benchmarks.weight import BLOWS, ClipWeight, weigh
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
CYCLIC = [
    *("walk", "run", "sneak", "walk_backward", "side_step_left", "side_step_right", "hop"),
    *("crawl", "fly", "swim", "climb", "dance", "idle", "idle_sitting"),
    *("gallop_left", "gallop_right", "run_backward"),
]
GESTURES = sorted(set(CLIPS) - set(CYCLIC))
WAY = {  # metres to the left and ahead, from the first to the last frame
    "walk": (0.0, 1.40),
    "run": (0.0, 2.40),
    "sneak": (0.0, 1.16),
    "walk_backward": (0.0, -0.92),
    "side_step_left": (0.60, 0.0),
    "side_step_right": (-0.60, 0.0),
    "gallop_left": (1.00, 0.0),
    "gallop_right": (-1.00, 0.0),
    "run_backward": (0.0, -1.32),
    "jump": (0.0, 1.20),
    "leap": (0.0, 2.30),
    "crawl": (0.0, 0.62),
    "roll": (0.0, 1.55),
    "fly": (0.0, 3.00),
    "swim": (0.0, 1.90),
}
SEATED = {"sit_down": (-1,), "stand_up": (0,)}  # the frames in which these sit


@pytest.fixture(scope="module", params=sorted(CLIPS))
def clip(request: pytest.FixtureRequest) -> Clip:
    return CLIPS[request.param]


@pytest.fixture(scope="module")
def quality(clip: Clip) -> Quality:
    return measure(clip)


@pytest.fixture(scope="module")
def weight(clip: Clip) -> ClipWeight:
    return weigh(clip)


def world(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)


def joint(clip: Clip, name: str) -> np.ndarray:
    return world(clip)[1][:, clip.skeleton.index(name)]


def test_every_action_of_the_humanoid_has_its_clip_and_there_are_enough():
    assert set(CLIPS) == {action.name for action in HUMANOID_ACTIONS}
    assert len(CLIPS) >= 32


def test_cycles_are_those_that_say_so():
    assert [name for name, clip in CLIPS.items() if clip.cyclic] == [
        name for name in CLIPS if name in CYCLIC
    ]


def test_planted_joints_hold_still(quality):
    assert quality.slide_m_s <= 0.02


def test_no_sole_goes_under_the_ground(quality):
    assert quality.lowest_sole_m >= -0.002


def test_knees_and_elbows_bend_as_a_person_s_and_never_lock(quality):
    for least, greatest in (quality.knee_deg, quality.elbow_deg):
        assert least >= 3.0
        assert greatest <= 150.0


def test_joints_stay_within_what_a_supple_body_reaches(quality):
    assert quality.beyond_limits_deg <= 0.0


def test_nothing_pops(quality):
    assert quality.turn_rad_s <= 30.0


def test_a_slow_body_is_over_its_feet(quality):
    assert quality.off_balance_m <= 0.020


def test_the_ground_could_push_the_body_as_it_moves(weight):
    assert weight.acceleration_max_m_s2 <= 8.0
    assert weight.least_load is None or weight.least_load >= 0.1
    if weight.outside_p95_m is not None:
        assert weight.outside_p95_m <= 0.35
        assert weight.outside_share <= 0.08


def test_who_flies_falls_as_the_earth_pulls(weight):
    for flight in weight.flights:
        assert 0.8 <= flight.gravity <= 1.3


@pytest.mark.parametrize("name", ["jump", "leap", "cheer"])
def test_a_jump_is_carried_by_a_crouch_before_it_and_knees_that_yield_after(name):
    flights = weigh(CLIPS[name]).flights
    assert flights
    for flight in flights:
        assert flight.crouch_m >= 0.20
        assert flight.landing_s >= 0.25
        assert flight.landing_knee_deg >= 60.0


@pytest.mark.parametrize("name", sorted(BLOWS))
def test_a_blow_goes_from_the_hips_over_the_chest_to_the_arm(name):
    when_s = weigh(CLIPS[name]).chain_s
    assert len(when_s) == len(BLOWS[name])
    assert list(when_s) == sorted(set(when_s), reverse=True)


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


@pytest.mark.parametrize("name", ["walk", "run", "run_backward"])
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


@pytest.mark.parametrize("name", ["side_step", "gallop", "turn"])
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
    clip = CLIPS[name]
    for frame in (0, -1):
        idle = CLIPS["idle_sitting" if frame in SEATED.get(name, ()) else "idle"]
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
    softened = 4
    take_off = int(np.flatnonzero(clip.contacts.any(axis=1)[:end]).max())
    mass = centre_of_mass(clip.skeleton, world(clip)[1])[take_off + softened : end - softened + 1]
    np.testing.assert_allclose(np.diff(mass[:, 1], 2) * clip.rate_hz**2, -9.81, atol=0.8)
    np.testing.assert_allclose(np.ptp(np.diff(mass[:, 2])) * clip.rate_hz, 0.0, atol=0.1)


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


@pytest.mark.rebuild
def test_authoring_gives_the_same_clips_each_time():
    again = {clip.name: clip for clip in humanoid_clips(humanoid_skeleton())}
    for name, clip in CLIPS.items():
        np.testing.assert_array_equal(clip.rotation_xyzw, again[name].rotation_xyzw)


def lean_deg(clip: Clip, part: str) -> np.ndarray:
    """Angle of a part's up axis from the vertical, at every frame."""
    rotation, _ = world(clip)
    up = rotate(rotation[:, clip.skeleton.index(part)], [0.0, 1.0, 0.0])
    return np.degrees(np.arccos(np.clip(up[:, 1], -1.0, 1.0)))


def test_a_sneaker_stays_low_and_lifts_its_knees_higher_than_a_walker():
    sneak, walk = CLIPS["sneak"], CLIPS["walk"]
    assert joint(sneak, "head")[:, 1].max() < joint(walk, "head")[:, 1].min() - 0.1
    lifted = {c.name: joint(c, "left_foot")[:, 1].max() for c in (sneak, walk)}
    assert lifted["sneak"] > lifted["walk"] + 0.1


def test_a_spinner_turns_once_and_comes_back():
    clip = CLIPS["spin"]
    rotation, position = world(clip)
    yaw = np.degrees(np.unwrap(heading_rad(rotation[:, 0])))
    assert yaw[-1] - yaw[0] == pytest.approx(360.0, abs=1e-6)
    np.testing.assert_allclose(position[-1], position[0], atol=0.01)


def test_a_leaper_splits_its_legs_high_in_the_air():
    clip = CLIPS["leap"]
    feet = [joint(clip, f"{side}_foot") for side in ("left", "right")]
    top = int(np.argmax(joint(clip, "hips")[:, 1]))
    assert feet[1][top, 2] - feet[0][top, 2] > 1.0
    assert min(foot[top, 1] for foot in feet) > 0.4


def test_a_hopper_hops_on_one_foot():
    clip = CLIPS["hop"]
    assert joint(clip, "right_toes")[:, 1].min() > 0.1
    assert clip.contacts.any() and not clip.contacts.any(axis=1).all()


def test_a_crawler_goes_on_hands_and_toes_crosswise():
    clip = CLIPS["crawl"]
    assert {"left_hand", "right_hand"} <= set(clip.contact_joints)
    assert lean_deg(clip, "upper_chest").min() > 70.0
    down = {name: clip.contacts[:, i] for i, name in enumerate(clip.contact_joints)}
    together = np.mean(down["left_middle_proximal"] == down["right_toes"])
    apart = np.mean(down["left_middle_proximal"] == down["left_toes"])
    assert together > apart + 0.3


def test_a_roller_goes_head_over_heels_once():
    clip = CLIPS["roll"]
    rotation, _ = world(clip)
    hips = rotation[:, clip.skeleton.index("hips")]
    step = rotvec_from_quaternion(multiply(hips[1:], inverse(hips[:-1])))
    assert np.degrees(step[:, 0].sum()) == pytest.approx(360.0, abs=5.0)
    assert joint(clip, "head")[:, 1].min() < 0.25


def test_who_falls_lies_on_the_back_and_stands_up_again():
    clip = CLIPS["fall"]
    lies = clip.stage_end_frames[2]
    assert joint(clip, "hips")[lies, 1] < 0.2
    assert joint(clip, "head")[lies, 1] < 0.3
    assert joint(clip, "head")[-1, 1] > 1.5


def test_a_climber_s_hands_go_down_while_they_hold_and_one_holds_always():
    clip = CLIPS["climb"]
    hands = [joint(clip, f"{side}_hand") for side in ("left", "right")]
    falling = [np.gradient(hand[:, 1]) < 0.0 for hand in hands]
    assert (falling[0] | falling[1]).mean() > 0.95


def test_a_kick_puts_the_right_foot_far_ahead_and_hip_high():
    clip = CLIPS["kick"]
    foot = joint(clip, "right_foot")[clip.stage_end_frames[3]]
    assert foot[2] > 0.6
    assert foot[1] > 0.65


def test_a_slash_goes_from_high_on_the_right_to_low_on_the_left():
    clip = CLIPS["slash"]
    hand = joint(clip, "right_hand")
    start, end = hand[clip.stage_end_frames[1]], hand[clip.stage_end_frames[3]]
    assert start[1] > end[1] + 0.6
    assert start[0] < end[0] - 0.3


def test_a_push_goes_with_both_hands_at_once():
    clip = CLIPS["push"]
    arrived = clip.stage_end_frames[3]
    left, right = (joint(clip, f"{side}_hand")[arrived] for side in ("left", "right"))
    np.testing.assert_allclose(left * [-1.0, 1.0, 1.0], right, atol=0.02)
    assert left[2] > 0.8


def test_what_is_picked_up_is_at_the_feet_and_comes_up_to_the_belly():
    clip = CLIPS["pick_up"]
    hand = joint(clip, "right_hand")
    assert hand[clip.stage_end_frames[2], 1] < 0.25
    assert hand[int(2.1 * clip.rate_hz), 1] > 0.85


def test_claps_meet_in_the_middle_and_never_cross():
    clip = CLIPS["clap"]
    left, right = (joint(clip, f"{side}_hand")[:, 0] for side in ("left", "right"))
    gap = left - right
    claps = np.flatnonzero((gap[1:-1] < gap[:-2]) & (gap[1:-1] <= gap[2:]) & (gap[1:-1] < 0.1))
    assert len(claps) == 5
    assert gap.min() > 0.03


def test_a_wave_goes_from_side_to_side_above_the_shoulder():
    clip = CLIPS["wave"]
    start, end = clip.stage_end_frames[1:3]
    hand = joint(clip, "right_hand")[start : end + 1]
    assert hand[:, 1].min() > joint(clip, "right_shoulder")[start : end + 1, 1].max()
    turns = np.flatnonzero(np.diff(np.sign(np.diff(hand[:, 0]))))
    assert len(turns) >= 4
    assert np.ptp(hand[:, 0]) > 0.15


def test_a_nod_is_the_head_s_twice():
    lean = lean_deg(CLIPS["nod"], "head")
    deep = (lean[1:-1] > lean[:-2]) & (lean[1:-1] >= lean[2:]) & (lean[1:-1] > 20.0)
    assert deep.sum() == 2
    assert lean_deg(CLIPS["nod"], "upper_chest").max() < 10.0


def test_who_cheers_leaves_the_ground_twice_with_both_hands_up():
    clip = CLIPS["cheer"]
    up = ~clip.contacts.any(axis=1)
    assert np.sum(np.diff(up.astype(int)) == 1) == 2
    for side in ("left", "right"):
        assert joint(clip, f"{side}_hand")[up, 1].min() > joint(clip, "head")[up, 1].min()


def test_who_sits_down_sits_until_it_stands_up():
    sit_down, sitting, stand_up = (CLIPS[n] for n in ("sit_down", "idle_sitting", "stand_up"))
    assert joint(sitting, "hips")[:, 1].max() < 0.2
    np.testing.assert_allclose(world(sit_down)[1][-1], world(sitting)[1][0], atol=0.01)
    np.testing.assert_allclose(world(stand_up)[1][0], world(sitting)[1][0], atol=0.01)


def test_a_croucher_s_hips_come_down_to_the_knees():
    assert joint(CLIPS["crouch"], "hips")[:, 1].min() < 0.5
