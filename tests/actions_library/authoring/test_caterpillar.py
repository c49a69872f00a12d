"""The caterpillar: what the literature says of its crawl, and what must hold of any clip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.authoring.caterpillar.body import caterpillar_character
from actions_library.authoring.caterpillar.library import CATERPILLAR_ACTIONS, caterpillar_clips
from actions_library.authoring.caterpillar.skeleton import (
    PAIRS,
    SEGMENTS,
    caterpillar_rig,
    segment,
)
from actions_library.authoring.rigging import other_side
from actions_library.checking import check_library
from actions_library.folder import load_library
from smd.character.kinematics import forward_kinematics
from smd.character.quality import MOST_SLIDE_M_S, flaws

RIG = caterpillar_rig()
CLIPS = {clip.name: clip for clip in caterpillar_clips(RIG)}
CRAWLS = ("crawl", "walk", "hump", "loop")
"""From the flattest to the highest."""

FOLDER = Path(__file__).parents[3] / "actions_library" / "caterpillar"


def placed(clip):
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def joint_path(clip, joint):
    return placed(clip)[:, clip.skeleton.index(joint)]


def trunk(clip):
    joints = [clip.skeleton.index(segment(k)) for k in range(1, SEGMENTS + 1)]
    return placed(clip)[:, joints]


def lifted(clip, k):
    """When a pair of feet is off the ground by where it is, not by its label."""
    foot = f"left_foot_{k}"
    rest = clip.skeleton.world_from_bind[clip.skeleton.index(foot), 1, 3]
    return joint_path(clip, foot)[:-1, 1] > rest + 0.002


def middle_phase(on):
    """The phase in the middle of what is true once a cycle."""
    turn = np.exp(2j * np.pi * np.arange(len(on)) / len(on))
    return float(np.angle((turn * on).sum()) / (2.0 * np.pi)) % 1.0


@pytest.mark.parametrize("name", CRAWLS)
def test_a_wave_of_lift_runs_from_the_last_pair_of_feet_to_the_first(name):
    # van Griethuijsen, Trimmer 2014: the wave is anterograde, and runs over prolegs and legs
    phases = np.array([middle_phase(lifted(CLIPS[name], k)) for k in PAIRS])
    later = np.diff(phases) % 1.0
    assert (later > 0.01).all()
    assert later.sum() < 1.0  # one wave in the body, not several
    along = np.array(PAIRS)
    since = np.concatenate([[0.0], np.cumsum(later)])
    even = np.polyval(np.polyfit(along, since, 1), along)
    np.testing.assert_allclose(since, even, atol=1.0 / (len(CLIPS[name]) - 1))  # within a frame


@pytest.mark.parametrize("name", CRAWLS)
def test_both_feet_of_a_pair_step_together(name):
    # so do caterpillars', unlike insects on six legs
    place = placed(CLIPS[name]) - CLIPS[name].translation_m[:, :1]
    twins = [RIG.skeleton.index(other_side(joint)) for joint in RIG.skeleton.joints]
    np.testing.assert_allclose(place, place[:, twins] * [-1.0, 1.0, 1.0], atol=1e-6)


def test_each_crawl_is_higher_than_the_one_before_and_its_stride_longer():
    height = [
        trunk(CLIPS[name])[..., 1].max() - trunk(CLIPS[name])[..., 1].min() for name in CRAWLS
    ]
    stride = [CLIPS[name].travel_m for name in CRAWLS]
    assert height[0] < 0.03
    assert all(np.diff(height) > 0.03)
    assert all(np.diff(stride) > 0.01)


def test_a_flat_crawl_gets_ahead_by_shortening_and_a_loop_by_its_arch():
    # Trimmer, Lin 2014: segments shorten as the wave passes; what does not shorten must rise
    def length(name):
        return np.linalg.norm(np.diff(trunk(CLIPS[name]), axis=1), axis=-1).sum(axis=1)

    lost = {name: 1.0 - length(name).mean() / length("idle")[0] for name in CRAWLS}
    assert lost["crawl"] * length("idle")[0] > 0.8 * CLIPS["crawl"].travel_m * 0.9
    taken_up = {name: CLIPS[name].travel_m - lost[name] * length("idle")[0] for name in CRAWLS}
    assert taken_up["loop"] > 0.5 * CLIPS["loop"].travel_m
    assert taken_up["crawl"] < 0.2 * CLIPS["crawl"].travel_m


@pytest.mark.parametrize("name", CRAWLS)
def test_some_feet_are_down_at_every_moment(name):
    # a caterpillar does not fly
    down = ~np.array([lifted(CLIPS[name], k) for k in PAIRS])
    assert down.sum(axis=0).min() >= 1


@pytest.mark.parametrize(("name", "uneven"), [("crawl", 0.25), ("walk", 0.25), ("hump", 0.4)])
def test_the_body_travels_at_an_even_speed(name, uneven):
    clip = CLIPS[name]
    np.testing.assert_allclose(
        np.diff(clip.translation_m[:, 0, 2]), clip.travel_m / (len(clip) - 1), atol=1e-9
    )
    speed = np.diff(trunk(clip)[..., 2].mean(axis=1))
    np.testing.assert_allclose(speed, clip.travel_m / (len(clip) - 1), rtol=uneven)


@pytest.mark.parametrize("name", CRAWLS)
def test_a_cycle_ends_as_it_begins_a_stride_ahead(name):
    clip = CLIPS[name]
    place = placed(clip)
    step = np.array([0.0, 0.0, clip.travel_m])
    np.testing.assert_allclose(place[-1], place[0] + step, atol=1e-6)
    # and goes on as it began: nothing changes its step more at the seam than elsewhere
    into, out = place[-1] - place[-2], place[1] - place[0]
    elsewhere = np.abs(np.diff(place, 2, axis=0)).max()
    assert np.abs(out - into).max() <= elsewhere


@pytest.mark.parametrize("name", CLIPS)
def test_no_clip_has_a_flaw(name):
    travels = {action.name: action.travels for action in CATERPILLAR_ACTIONS}
    assert list(flaws(CLIPS[name], travels=travels[name])) == []


@pytest.mark.parametrize("name", CLIPS)
def test_planted_feet_stand_still_and_no_foot_is_in_the_ground(name):
    clip = CLIPS[name]
    for column, joint in enumerate(clip.contact_joints):
        path = joint_path(clip, joint)
        on = clip.contacts[:-1, column] & clip.contacts[1:, column]
        step = np.linalg.norm(np.diff(path, axis=0), axis=1) * clip.rate_hz
        assert step[on].max(initial=0.0) < MOST_SLIDE_M_S
        rest = clip.skeleton.world_from_bind[clip.skeleton.index(joint), 1, 3]
        assert path[:, 1].min() > rest - 0.005


@pytest.mark.parametrize("name", CLIPS)
def test_segments_shorten_and_lengthen_within_bounds_and_all_other_bones_keep_their_length(name):
    clip = CLIPS[name]
    length = np.linalg.norm(clip.translation_m, axis=-1)
    rest = np.linalg.norm(clip.skeleton.rest_translation_m, axis=-1)
    soft = [clip.skeleton.index(segment(k)) for k in range(2, SEGMENTS + 1)]
    fixed = [clip.skeleton.index(j) for j in clip.skeleton.joints if "_" in j and "seg" not in j]
    share = length[:, soft] / rest[soft]
    assert share.min() > 0.45
    assert share.max() < 1.2
    np.testing.assert_allclose(length[:, fixed], np.tile(rest[fixed], (len(clip), 1)), atol=1e-9)


def test_looking_raises_the_front_and_keeps_the_prolegs_down():
    clip = CLIPS["look"]
    head = joint_path(clip, "head")
    assert head[:, 1].max() - head[0, 1] > 0.2
    assert head[:, 0].max() > 0.05
    assert head[:, 0].min() < -0.05
    for k in PAIRS[:5]:
        assert not lifted(clip, k).any()
    for k in PAIRS[5:]:
        assert lifted(clip, k).any()


def test_crouching_lowers_and_shortens_the_body():
    body = trunk(CLIPS["crouch"])
    middle = len(body) // 2
    assert body[middle, :, 1].mean() < body[0, :, 1].mean() - 0.02
    assert np.ptp(body[middle, :, 2]) < 0.92 * np.ptp(body[0, :, 2])


def test_a_jump_leaves_the_ground_with_all_feet_and_lands_ahead():
    clip = CLIPS["jump"]
    flying = np.all([lifted(clip, k) for k in PAIRS], axis=0)
    assert flying.sum() / clip.rate_hz > 0.25
    assert clip.travel_m == pytest.approx(0.40, abs=1e-6)


@pytest.mark.parametrize("name", ["look", "crouch", "jump"])
def test_gestures_begin_and_end_near_where_they_rest(name):
    clip, idle = CLIPS[name], placed(CLIPS["idle"])[0]
    place = placed(clip) - clip.translation_m[:, :1]
    np.testing.assert_allclose(place[0], idle, atol=0.03)
    np.testing.assert_allclose(place[-1], idle, atol=0.03)


def test_the_caterpillar_stands_on_the_ground_and_is_symmetric():
    character = caterpillar_character(RIG.skeleton, step_m=0.010)
    points = np.concatenate([mesh.points_m for mesh in character.meshes])
    assert points[:, 1].min() == pytest.approx(0.0, abs=0.004)
    assert np.ptp(points[:, 2]) == pytest.approx(1.16, abs=0.06)
    assert points[:, 0].max() == pytest.approx(-points[:, 0].min(), abs=1e-9)


def test_the_library_in_the_tree_is_what_the_authoring_makes():
    library = load_library(FOLDER)
    names = [action.name for action in CATERPILLAR_ACTIONS]
    assert [action.name for action in library.actions] == names
    assert check_library(library).faults == ()
    for name, clip in CLIPS.items():
        stored = library.clip(name)
        assert np.array_equal(stored.contacts, clip.contacts)
        np.testing.assert_allclose(stored.translation_m, clip.translation_m, atol=1e-5)
        np.testing.assert_allclose(stored.rotation_xyzw, clip.rotation_xyzw, atol=1e-5)


def test_the_caterpillar_is_drawn_as_people_are():
    caterpillar, humanoid = load_library(FOLDER), load_library()
    for name in ("walk", "crawl", "crouch", "jump"):
        assert caterpillar.action(name).pattern == humanoid.action(name).pattern
        assert caterpillar.action(name).exemplar is not None


def test_the_folder_is_small():
    assert sum(file.stat().st_size for file in FOLDER.rglob("*") if file.is_file()) < 2_000_000
