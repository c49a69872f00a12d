"""The dog: what the literature says of its gaits, and what must hold of any clip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.authoring.dog.body import dog_character
from actions_library.authoring.dog.library import DOG_ACTIONS, dog_clips
from actions_library.authoring.dog.skeleton import SHOULDER_HEIGHT_M, dog_rig
from actions_library.authoring.rigging import other_side
from actions_library.checking import check_library
from actions_library.folder import load_library
from smd.character.kinematics import forward_kinematics
from smd.character.quality import MOST_SLIDE_M_S, flaws

RIG = dog_rig()
CLIPS = {clip.name: clip for clip in dog_clips(RIG)}
FEET = ("left_hind", "left_fore", "right_hind", "right_fore")
FOLDER = Path(__file__).parents[3] / "actions_library" / "dog"


def placed(clip):
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def down(clip, foot):
    """When a foot is down by where it is, not by its label: its toes still and low."""
    path = placed(clip)[:, clip.skeleton.index(f"{foot}_toes")]
    step = np.linalg.norm(np.diff(path, axis=0), axis=1) * clip.rate_hz
    return (step < 0.05) & (path[:-1, 1] < 0.03)


def landings(clip):
    """Phases in which feet land, by foot."""
    found = {}
    for foot in FEET:
        on = down(clip, foot)
        found[foot] = float(np.flatnonzero(on & ~np.roll(on, 1))[0]) / (len(clip) - 1)
    return found


def test_a_walk_lands_in_lateral_sequence():
    at = landings(CLIPS["walk"])
    order = sorted(FEET, key=lambda foot: (at[foot] - at["left_hind"]) % 1.0)
    assert order == ["left_hind", "left_fore", "right_hind", "right_fore"]


def test_a_trot_lands_in_diagonal_pairs_half_a_cycle_apart():
    at, frame = landings(CLIPS["trot"]), 1.0 / (len(CLIPS["trot"]) - 1)
    assert at["left_hind"] == pytest.approx(at["right_fore"], abs=1.5 * frame)
    assert at["right_hind"] == pytest.approx(at["left_fore"], abs=1.5 * frame)
    apart = (at["right_hind"] - at["left_hind"]) % 1.0
    assert apart == pytest.approx(0.5, abs=1.5 * frame)


def test_a_gallop_lands_hind_feet_then_fore_feet_in_a_circle_and_flies_after_each():
    clip = CLIPS["run"]
    at = landings(clip)
    order = sorted(FEET, key=lambda foot: (at[foot] - at["left_hind"]) % 1.0)
    assert order == ["left_hind", "right_hind", "right_fore", "left_fore"]
    flying = ~np.any([down(clip, foot) for foot in FEET], axis=0)
    assert np.count_nonzero(flying & ~np.roll(flying, 1)) == 2


@pytest.mark.parametrize(("gait", "walks"), [("walk", True), ("trot", False), ("run", False)])
def test_walks_have_feet_down_more_than_half_the_time_and_runs_less(gait, walks):
    # Alexander 1984: the duty factor of a walk is above one half, that of a run below
    for foot in FEET:
        assert (down(CLIPS[gait], foot).mean() > 0.5) == walks


@pytest.mark.parametrize("mood", ["happy", "sad"])
@pytest.mark.parametrize("gait", ["walk", "trot", "run"])
def test_a_mood_keeps_the_order_of_feet_and_changes_carriage_and_tempo(gait, mood):
    plain, clip = CLIPS[gait], CLIPS[f"{gait}_{mood}"]

    def order(at):
        return [round((at[foot] - at["left_hind"]) % 1.0, 1) % 1.0 for foot in FEET]

    assert order(landings(clip)) == pytest.approx(order(landings(plain)), abs=0.11)

    def mean_height(one, joint):
        return placed(one)[:-1, one.skeleton.index(joint), 1].mean()

    sign = 1.0 if mood == "happy" else -1.0
    assert sign * (mean_height(clip, "head") - mean_height(plain, "head")) > 0.01
    assert sign * (mean_height(clip, "tail_5") - mean_height(plain, "tail_5")) > 0.02
    assert sign * (plain.duration_s - clip.duration_s) > 0.0
    assert sign * (clip.travel_m / clip.duration_s - plain.travel_m / plain.duration_s) > 0.0

    def bounce(one):
        return float(np.ptp(placed(one)[:, one.skeleton.index("pelvis"), 1]))

    assert sign * (bounce(clip) - bounce(plain)) > 0.0


@pytest.mark.parametrize("name", CLIPS)
def test_tail_and_ears_move_in_every_clip(name):
    clip = CLIPS[name]
    for joint in ("tail_1", "tail_5", "left_ear", "right_ear"):
        q = clip.rotation_xyzw[:, clip.skeleton.index(joint)]
        turned = 2.0 * np.arccos(np.clip(np.abs(q @ q[0]), 0.0, 1.0))
        assert np.degrees(turned.max()) > 1.0


def test_a_jump_takes_off_with_the_hind_feet_falls_by_1_g_and_lands_on_the_fore_feet():
    clip = CLIPS["jump"]
    on = {foot: down(clip, foot) for foot in FEET}
    middle = len(clip) // 2
    flying = np.flatnonzero(~np.any(list(on.values()), axis=0))
    off, land = flying[0], flying[-1] + 1
    assert np.array_equal(flying, np.arange(off, land)) and off < middle
    for side in ("left", "right"):
        assert on[f"{side}_hind"][off - 3] or on["left_hind"][off - 2]
        assert not on[f"{side}_fore"][off - 3 : land - 1].any()
        assert not on[f"{side}_hind"][off:land].any()
    body = placed(clip)[:, [clip.skeleton.index(j) for j in ("pelvis", "chest")], 1].mean(axis=1)
    inside = np.arange(off + 3, land - 3) / clip.rate_hz
    fall = 2.0 * np.polyfit(inside, body[off + 3 : land - 3], 2)[0]
    assert fall == pytest.approx(-9.81, rel=0.25)


def test_the_jaw_opens_to_bark_and_to_yawn_and_shuts_again():
    for name, least in (("bark", 20.0), ("yawn", 35.0)):
        clip = CLIPS[name]
        q = clip.rotation_xyzw[:, clip.skeleton.index("jaw")]
        opened = np.degrees(2.0 * np.arctan2(q[:, 0], q[:, 3]))
        assert opened.max() > least
        assert np.abs(opened[[0, -1]]).max() < 1.0


def test_a_paw_is_raised_to_wave_and_another_to_scratch_while_the_others_stand():
    for name, paw, above in (("wave", "left_fore", 0.30), ("scratch", "left_hind", 0.40)):
        clip = CLIPS[name]
        height = placed(clip)[:, clip.skeleton.index(f"{paw}_toes"), 1]
        assert height.max() > above
        high = np.flatnonzero(height[:-1] > 0.8 * height.max())
        for foot in FEET:
            if foot != paw:
                assert down(clip, foot)[high[0] : high[-1]].all()
        # to and fro at least three times
        tops = (height[1:-1] > height[:-2]) & (height[1:-1] >= height[2:]) & (height[1:-1] > above)
        assert np.count_nonzero(tops) >= 3


@pytest.mark.parametrize("name", CLIPS)
def test_no_paw_sinks_into_the_ground(name):
    clip = CLIPS[name]
    toes = [clip.skeleton.index(f"{foot}_toes") for foot in FEET]
    rest = clip.skeleton.world_from_bind[toes, 1, 3]
    assert (placed(clip)[:, toes, 1] - rest).min() > -0.005


@pytest.mark.parametrize("gait", ["walk", "trot"])
def test_symmetrical_gaits_are_their_own_mirror_image_half_a_cycle_later(gait):
    clip = CLIPS[gait]
    half = (len(clip) - 1) // 2
    place = placed(clip) - clip.translation_m[:, :1]
    twins = [clip.skeleton.index(other_side(joint)) for joint in clip.skeleton.joints]
    image = place[: half + 1, twins] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(place[half : 2 * half + 1], image, atol=0.003)


@pytest.mark.parametrize("name", CLIPS)
def test_no_clip_has_a_flaw(name):
    travels = {action.name: action.travels for action in DOG_ACTIONS}
    assert list(flaws(CLIPS[name], travels=travels[name])) == []


@pytest.mark.parametrize("name", CLIPS)
def test_planted_paws_stand_still_and_flat(name):
    clip = CLIPS[name]
    turned, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    for column, joint in enumerate(clip.contact_joints):
        j = clip.skeleton.index(joint)
        on = clip.contacts[:-1, column] & clip.contacts[1:, column]
        step = np.linalg.norm(np.diff(place[:, j], axis=0), axis=1) * clip.rate_hz
        assert step[on].max(initial=0.0) < MOST_SLIDE_M_S
        up = 1.0 - 2.0 * (turned[:, j, 0] ** 2 + turned[:, j, 2] ** 2)
        assert up[clip.contacts[:, column]].min(initial=1.0) > 1.0 - 1e-9


@pytest.mark.parametrize("name", CLIPS)
def test_bones_keep_their_length(name):
    clip = CLIPS[name]
    fixed = [
        j for j in range(len(clip.skeleton)) if clip.skeleton.joints[j] not in ("root", RIG.body)
    ]
    length = np.linalg.norm(clip.translation_m[:, fixed], axis=-1)
    rest = np.linalg.norm(clip.skeleton.rest_translation_m[fixed], axis=-1)
    np.testing.assert_allclose(length, np.tile(rest, (len(clip), 1)), atol=1e-9)


@pytest.mark.parametrize("name", CLIPS)
def test_a_knee_points_ahead_and_an_elbow_back(name):
    clip = CLIPS[name]
    place = placed(clip)
    for side in ("left", "right"):
        for top, middle, end, ahead in (
            ("hip", "knee", "hock", True),
            ("shoulder", "elbow", "wrist", False),
        ):
            a, b, c = (place[:, clip.skeleton.index(f"{side}_{j}")] for j in (top, middle, end))
            # seen from the left, the fold turns one way in all frames
            turn = np.cross(b - a, c - b)[:, 0]
            assert ((turn > 0.0) if ahead else (turn < 0.0)).all()


def test_the_tail_follows_from_root_to_tip():
    clip = CLIPS["idle"]
    wag = [clip.rotation_xyzw[:-1, clip.skeleton.index(f"tail_{k}"), 1] for k in (1, 3, 5)]

    def lag(one, other):
        spectrum = np.fft.rfft(other - other.mean()) * np.conj(np.fft.rfft(one - one.mean()))
        return int(np.argmax(np.fft.irfft(spectrum, len(one))[: len(one) // 10]))

    assert lag(wag[0], wag[1]) > 0
    assert lag(wag[1], wag[2]) > 0


def test_gestures_begin_and_end_as_their_rests_do():
    for name, first, last in (
        ("sit_down", "idle", "idle_sitting"),
        ("stand_up", "idle_sitting", "idle"),
    ):
        place = placed(CLIPS[name])
        np.testing.assert_allclose(place[0], placed(CLIPS[first])[0], atol=0.02)
        np.testing.assert_allclose(place[-1], placed(CLIPS[last])[0], atol=0.02)


def test_the_dog_is_as_high_as_it_says_and_stands_on_the_ground():
    character = dog_character(RIG.skeleton, step_m=0.008)
    coat = character.meshes[0]
    x, y, z = coat.points_m.T
    withers = y[(np.abs(x) < 0.06) & (np.abs(z - 0.12) < 0.03)].max()
    assert withers == pytest.approx(SHOULDER_HEIGHT_M, abs=0.03)
    assert y.min() == pytest.approx(0.0, abs=0.004)


def test_the_library_in_the_tree_is_what_the_authoring_makes():
    library = load_library(FOLDER)
    assert [action.name for action in library.actions] == [action.name for action in DOG_ACTIONS]
    assert check_library(library).faults == ()
    for name, clip in CLIPS.items():
        stored = library.clip(name)
        assert np.array_equal(stored.contacts, clip.contacts)
        np.testing.assert_allclose(stored.translation_m, clip.translation_m, atol=1e-5)
        np.testing.assert_allclose(stored.rotation_xyzw, clip.rotation_xyzw, atol=1e-5)


def test_the_dog_is_drawn_as_people_are():
    dog, humanoid = load_library(FOLDER), load_library()
    for name in ("walk", "run", "jump", "sit_down", "stand_up", "wave", "bow"):
        assert dog.action(name).pattern == humanoid.action(name).pattern
        assert dog.action(name).exemplar is not None
    for name in ("trot", "walk_happy", "scratch", "yawn"):
        assert dog.action(name).pattern is None


def test_the_folder_is_small():
    assert sum(file.stat().st_size for file in FOLDER.rglob("*") if file.is_file()) < 3_000_000
