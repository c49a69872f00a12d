"""Quick steps: what stands in for a side-step or a walk backward that would have to be too fast."""

from __future__ import annotations

import numpy as np
import pytest

import smd
from actions_library.authoring.clips.quick_steps import gallop_left, gallop_right, run_backward
from actions_library.authoring.clips.side_steps import side_step_left
from actions_library.authoring.humanoid import humanoid_skeleton
from actions_library.folder import load_library
from benchmarks.clips import angles_deg, bend_range_deg
from benchmarks.physics import anatomy_of, centre_of_mass
from smd.acting.legs import feet_of, legs_of
from smd.acting.performance import Performance
from smd.acting.standing import standing
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.doodle import Doodle, Recording
from smd.geometry.rotations import heading_rad, rotate
from smd.geometry.runs import runs_of_true
from smd.score import Part, Phrase, Score
from smd.transfer.gait import MOST_RUNNING_PER_MIN, Gait, gait_of

G_M_S2 = 9.81
SKELETON = humanoid_skeleton()
CLIPS = {make.__name__: make(SKELETON) for make in (gallop_left, gallop_right, run_backward)}
GALLOPS = {"gallop_left": 1.0, "gallop_right": -1.0}


@pytest.fixture(params=sorted(CLIPS))
def clip(request: pytest.FixtureRequest) -> Clip:
    return CLIPS[request.param]


def world(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)


def joint(clip: Clip, name: str) -> np.ndarray:
    return world(clip)[1][:, clip.skeleton.index(name)]


def stands_of(clip: Clip) -> dict[int, np.ndarray]:
    return standing(clip, legs_of(clip.skeleton, feet_of(clip)))


def gait(clip: Clip) -> Gait:
    return gait_of(clip, stands_of(clip))


def mass_centre(clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    """The mass centre over three cycles, and its acceleration over the one in the middle."""
    anatomy = anatomy_of(clip.skeleton)
    assert anatomy is not None
    centre = centre_of_mass(world(clip)[1], anatomy)[:-1]
    travel = clip.translation_m[-1, 0] - clip.translation_m[0, 0]
    three = np.concatenate([centre + lap * travel for lap in range(3)])
    acceleration = np.diff(three, 2, axis=0) * clip.rate_hz**2
    return three, acceleration[len(centre) - 1 : 2 * len(centre) - 1]


def test_the_planner_takes_it_for_a_run_of_two_steps_that_may_end_after_either(clip):
    found = gait(clip)
    assert len(found.passings) == 2
    assert found.flies and found.halves
    assert found.most_steps_per_min == MOST_RUNNING_PER_MIN


@pytest.mark.parametrize(
    ("name", "speed_m_s", "steps_per_min"),
    [
        ("gallop_left", (1.8, 2.2), (200, 240)),
        ("gallop_right", (1.8, 2.2), (200, 240)),
        ("run_backward", (1.9, 2.1), (170, 200)),
    ],
)
def test_its_pace_is_that_of_people(name, speed_m_s, steps_per_min):
    found = gait(CLIPS[name])
    assert speed_m_s[0] <= found.speed_m_s <= speed_m_s[1]
    assert steps_per_min[0] <= 120.0 / found.duration_s <= steps_per_min[1]


def test_it_touches_the_ground_with_the_joints_of_a_side_step(clip):
    assert clip.contact_joints == side_step_left(SKELETON).contact_joints
    assert clip.contacts.any(axis=0).all()


def test_it_faces_ahead_with_an_upright_trunk_and_bent_knees(clip):
    rotation, position = world(clip)
    for part, least, most in (("head", 0.0, 15.0), ("upper_chest", 5.0, 25.0)):
        q = rotation[:, clip.skeleton.index(part)]
        up = rotate(q, [0.0, 1.0, 0.0])
        lean = np.degrees(np.arctan2(up[:, 2], up[:, 1]))
        assert least <= lean.min() and lean.max() <= most
        assert np.abs(np.degrees(heading_rad(q))).max() < 15.0
    assert bend_range_deg(clip, position, "upper_leg", "lower_leg", "foot")[0] > 35.0
    assert np.abs(angles_deg(clip, rotation, position)["trunk tilt"]).max() < 10.0


@pytest.mark.parametrize("name", GALLOPS)
def test_a_galloper_s_feet_part_far_and_close_without_crossing(name):
    clip = CLIPS[name]
    for part in ("foot", "toes"):
        apart = joint(clip, f"left_{part}")[:, 0] - joint(clip, f"right_{part}")[:, 0]
        assert 0.15 < apart.min() < 0.25
        assert apart.max() > 0.80


@pytest.mark.parametrize(("name", "to"), GALLOPS.items())
def test_a_galloper_is_in_the_air_longest_while_the_feet_close(name, to):
    clip = CLIPS[name]
    air = ~np.any(list(stands_of(clip).values()), axis=0)[:-1]
    flights = runs_of_true(np.roll(air, 8))  # no flight goes over the end
    assert len(flights) == 2
    longest = max(flights, key=lambda flight: flight[1] - flight[0])
    apart = joint(clip, "left_foot")[:-1, 0] - joint(clip, "right_foot")[:-1, 0]
    closing = np.roll(apart, 8)[longest[0] : longest[1]]
    assert closing.max() < 0.4
    leading = "left" if to > 0 else "right"
    bears = clip.contacts[:, clip.contact_joints.index(f"{leading}_toes")]
    (landed,) = np.flatnonzero(bears[:-1] & ~np.roll(bears[:-1], 1))
    ahead = joint(clip, f"{leading}_foot")[landed, 0] - clip.translation_m[landed, 0, 0]
    assert to * ahead > 0.40


def test_its_mass_is_accelerated_as_people_do(clip):
    level = np.linalg.norm(mass_centre(clip)[1][:, [0, 2]], axis=1)
    assert level.max() <= 6.0


def test_in_the_air_its_mass_falls_freely(clip):
    centre, _ = mass_centre(clip)
    air = np.tile(~np.any(list(stands_of(clip).values()), axis=0)[:-1], 3)
    inner = [flight for flight in runs_of_true(air) if flight[0] > 0 and flight[1] < len(air)]
    assert len(inner) >= 4
    for first, end in inner:
        frames = np.arange(first - 1, end + 1)
        bend = np.polyfit(frames / clip.rate_hz, centre[frames, 1], 2)[0]
        assert 0.8 <= -2.0 * bend / G_M_S2 <= 1.3


def test_a_backward_runner_lands_behind_the_body_on_its_toes():
    clip = CLIPS["run_backward"]
    for side in ("left", "right"):
        sole, toes = (
            clip.contacts[:, clip.contact_joints.index(f"{side}_{part}")]
            for part in ("foot", "toes")
        )
        (landed,) = np.flatnonzero(toes[:-1] & ~np.roll(toes[:-1], 1))
        assert not sole[landed]
        behind = joint(clip, f"{side}_foot")[landed, 2] - clip.translation_m[landed, 0, 2]
        assert behind < -0.25


@pytest.mark.parametrize(
    ("action", "instead", "direction"),
    [
        ("side_step_left", "gallop_left", (1.0, 0.0, 0.0)),
        ("side_step_right", "gallop_right", (-1.0, 0.0, 0.0)),
        ("walk_backward", "run_backward", (0.0, 0.0, -1.0)),
    ],
)
def test_three_metres_at_two_metres_a_second_are_too_fast_for_steps_but_not_for_these(
    action, instead, direction
):
    time_s = np.arange(0.0, 4.1, 1.0 / 90.0)
    speed = 2.0 * np.clip(np.minimum(time_s - 1.0, 3.1 - time_s) / 0.6, 0.0, 1.0)
    way_m = 0.1 * np.concatenate([[0.0], np.cumsum(speed[:-1]) / 90.0])
    place_m = way_m[:, None] * np.array(direction) + [0.0, 0.0875, 0.0]
    upright = np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1))
    recording = Recording((Doodle(time_s, place_m, upright, "prop"),), "made up")
    library = load_library()

    def acted(name: str) -> Performance:
        score = Score((Part("prop", (Phrase(name, 1.0, 3.1),)),), "made up")
        return smd.animate(score, recording, library, timing="drawn")

    assert any("steps a minute" in warning for warning in acted(action).warnings)
    performance = acted(instead)
    assert performance.warnings == ()
    (actor,) = performance.actors
    skeleton = actor.character.skeleton
    _, position = forward_kinematics(skeleton, *actor.poses)
    left, right = (position[:, skeleton.index(f"{side}_foot")] for side in ("left", "right"))
    assert (left - right)[:, 0].min() > 0.15
    went = position[-1, 0] - position[0, 0]
    np.testing.assert_allclose(went, 3.0 * np.array(direction), atol=0.02)
    for side in ("left", "right"):
        ball = position[:, skeleton.index(f"{side}_toes")]
        rests = ball[:, 1] < SKELETON.world_from_bind[SKELETON.index(f"{side}_toes"), 1, 3] + 0.001
        slid = np.linalg.norm(np.diff(ball[:, [0, 2]], axis=0), axis=1) * performance.rate_hz
        assert slid[rests[1:] & rests[:-1]].max() < 0.02
