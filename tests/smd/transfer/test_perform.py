from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.acting.legs import legs_of
from smd.character.kinematics import forward_kinematics
from smd.doodle import Doodle, Recording
from smd.errors import ScoreError, TransferError
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    rotate,
    rotvec_from_quaternion,
)
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

UP = [0.0, 1.0, 0.0]

# (action, seconds, ahead, left, up and back, turned): strokes of a prop, at the figurine's scale.
STORY = [
    (None, 0.8, 0.0, 0.0, 0.0, 0.0),
    ("walk", 2.5, 0.30, 0.0, 0.0, 0.3),
    ("punch", 1.0, 0.04, 0.0, 0.0, 0.0),
    (None, 0.7, 0.0, 0.0, 0.0, 0.0),
    ("turn_left", 1.3, 0.0, 0.0, 0.0, 1.6),
    (None, 0.5, 0.0, 0.0, 0.0, 0.0),
    ("run", 1.4, 0.45, 0.0, 0.0, 0.0),
    ("jump", 1.5, 0.12, 0.0, 0.05, 0.0),
    (None, 0.4, 0.0, 0.0, 0.0, 0.0),
    ("side_step_right", 1.6, 0.0, -0.12, 0.0, 0.0),
    (None, 0.9, 0.0, 0.05, 0.0, -1.2),
    ("throw", 1.8, 0.02, 0.0, 0.0, 0.0),
    ("fly", 2.0, 0.40, 0.0, 0.05, 0.4),
    (None, 0.4, 0.0, 0.0, 0.0, 0.0),
    ("bow", 2.2, 0.0, 0.0, 0.0, 0.0),
    (None, 0.8, 0.0, 0.0, 0.0, 0.0),
]


def minimum_jerk(x: np.ndarray) -> np.ndarray:
    x = np.clip(x, 0.0, 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x * x)


def story(device: str = "fox", at_m: tuple[float, float, float] = (0.0, 0.8, 0.0)):
    """A doodle of every action, and the part it draws."""
    end_s = sum(row[1] for row in STORY)
    time_s = np.arange(round(end_s * 90) + 1) / 90.0
    place, yaw = np.tile(np.array(at_m), (len(time_s), 1)), np.zeros(len(time_s))
    now_s, facing, phrases = 0.0, 0.0, []
    for action, seconds, ahead, left, up, turned in STORY:
        way = minimum_jerk((time_s - now_s) / seconds)
        step = [
            np.sin(facing) * ahead + np.cos(facing) * left,
            0.0,
            np.cos(facing) * ahead - np.sin(facing) * left,
        ]
        place = place + way[:, None] * step + (4.0 * up * way * (1.0 - way))[:, None] * UP
        yaw = yaw + turned * way
        facing += turned
        if action:
            phrases.append(Phrase(action, round(now_s, 3), round(now_s + seconds, 3)))
        now_s += seconds
    doodle = Doodle(time_s, place, quaternion_about(UP, yaw), device)
    return doodle, Part(device, tuple(phrases))


@pytest.fixture(scope="module")
def take():
    doodle, part = story()
    return Recording((doodle,), source="story"), Score((part,))


@pytest.fixture(scope="module")
def performance(take, library):
    return animate(take[1], take[0], library, rate_hz=60.0)


def world_of_frames(performance, actor=0):
    actor = performance.actors[actor]
    return forward_kinematics(actor.character.skeleton, *actor.poses)


def frame_at(performance, time_s):
    return round((time_s - performance.start_s) * performance.rate_hz)


def steps_rad(performance):
    """How far each joint turns from frame to frame."""
    q = performance.actors[0].poses.rotation_xyzw
    return np.linalg.norm(rotvec_from_quaternion(multiply(inverse(q[:-1]), q[1:])), axis=-1)


@pytest.mark.parametrize("rate_hz", [24.0, 25.0, 60.0, 89.7])
def test_a_performance_lasts_from_the_first_sample_to_the_last(take, library, rate_hz):
    performance = animate(take[1], take[0], library, rate_hz=rate_hz)
    (doodle,) = take[0].doodles
    assert performance.start_s == doodle.time_s[0]
    last_s = performance.start_s + (len(performance) - 1) / rate_hz
    assert 0.0 <= doodle.time_s[-1] - last_s + 1e-9 < 1.0 / rate_hz


def test_by_default_there_are_24_frames_a_second(take, library):
    assert animate(take[1], take[0], library).rate_hz == 24.0


def test_poses_are_finite_unit_and_sign_continuous(performance):
    (actor,) = performance.actors
    q = actor.poses.rotation_xyzw
    assert np.isfinite(actor.poses.translation_m).all()
    assert np.linalg.norm(q, axis=-1) == pytest.approx(np.ones(q.shape[:2]), abs=1e-9)
    assert (np.sum(q[1:] * q[:-1], axis=-1) > 0.0).all()


def test_planted_feet_do_not_slide_and_none_is_in_the_ground(performance):
    (actor,) = performance.actors
    world_q, world_p = world_of_frames(performance)
    skeleton = actor.character.skeleton
    for leg in legs_of(skeleton, [skeleton.index("left_foot"), skeleton.index("right_foot")]):
        speeds = []
        for point, height_m in ((leg.heel_m, 0.0), (leg.ball_m, leg.ball_height_m)):
            place = world_p[:, leg.foot] + rotate(world_q[:, leg.foot], point)
            up = place[:, 1] - height_m
            assert up.min() > -2e-3
            speed = np.linalg.norm(np.diff(place, axis=0)[:, [0, 2]], axis=-1) * 60.0
            speeds.append(speed[(up[1:] < 0.005) & (up[:-1] < 0.005)])
        speed = np.concatenate(speeds)
        assert speed.mean() < 0.02
        assert np.quantile(speed, 0.95) < 0.05


def test_nothing_pops_where_one_phrase_becomes_another(performance, take, library):
    """A joint turns no further in a frame around a boundary than within the clips themselves."""
    steps = steps_rad(performance)
    skeleton = performance.actors[0].character.skeleton
    limbs = [j for j, name in enumerate(skeleton.joints) if "arm" not in name]
    inside, around = [], []
    edges = [t for p in take[1].performers[0].phrases for t in (p.start_s, p.end_s)]
    near = np.zeros(len(steps), dtype=bool)
    for time_s in edges:
        frame = frame_at(performance, time_s)
        near[max(frame - 6, 0) : frame + 6] = True
    around, inside = steps[near], steps[~near]
    assert around[:, limbs].max() <= inside[:, limbs].max()
    assert around.max() <= inside.max()


def test_the_character_stands_on_the_doodle_s_path_while_it_travels(performance, take):
    (actor,) = performance.actors
    doodle = actor.doodles[0]
    root = actor.poses.translation_m[:, 0]
    for phrase in take[1].performers[0].phrases:
        if phrase.action not in {"walk", "run", "side_step_right", "fly"}:
            continue
        times = performance.start_s + np.arange(len(performance)) / performance.rate_hz
        rows = (times >= phrase.start_s) & (times <= phrase.end_s)
        inside = (doodle.time_s >= phrase.start_s) & (doodle.time_s <= phrase.end_s)
        path = doodle.position_m[inside][:, [0, 2]]
        goes = root[rows][:, [0, 2]]
        path = path - path[0] + goes[0]
        error = np.linalg.norm(goes[:, None] - path[None], axis=-1).min(axis=1)
        assert np.sqrt(np.mean(error**2)) < 0.03


def test_between_travelling_phrases_the_ground_root_stays(take, library):
    performance = animate(take[1], take[0], library, rate_hz=60.0, timing="drawn")
    root = performance.actors[0].poses.translation_m[:, 0, [0, 2]]
    phrases = take[1].performers[0].phrases
    for phrase in phrases:
        if phrase.action in {"punch", "throw", "bow", "turn_left"}:
            rows = slice(
                frame_at(performance, phrase.start_s) + 1, frame_at(performance, phrase.end_s)
            )
            assert np.ptp(root[rows], axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)


def test_turning_the_world_turns_the_performance(take, library, performance):
    turn = quaternion_about(UP, 0.5 * np.pi)
    (doodle,) = take[0].doodles
    n = len(doodle)
    turned = Doodle(
        doodle.time_s,
        rotate(np.broadcast_to(turn, (n, 4)), doodle.position_m),
        multiply(turn, doodle.orientation_xyzw),
        doodle.device,
    )
    other = animate(take[1], Recording((turned,)), library, rate_hz=60.0)
    a, b = performance.actors[0], other.actors[0]
    assert b.poses.translation_m[:, 0] == pytest.approx(
        rotate(np.broadcast_to(turn, (len(performance), 4)), a.poses.translation_m[:, 0]), abs=1e-6
    )
    assert (
        np.abs(np.abs(b.poses.rotation_xyzw[:, 1:]) - np.abs(a.poses.rotation_xyzw[:, 1:])).max()
        < 1e-5
    )


def test_a_larger_prop_on_a_larger_table_acts_the_same(take, library, performance):
    (doodle,) = take[0].doodles
    larger = Doodle(doodle.time_s, 2.0 * doodle.position_m, doodle.orientation_xyzw, doodle.device)
    score = replace(take[1], figure_height_m=2.0 * take[1].figure_height_m)
    other = animate(score, Recording((larger,)), library, rate_hz=60.0)
    a, b = performance.actors[0], other.actors[0]
    assert b.poses.translation_m == pytest.approx(a.poses.translation_m, abs=1e-6)
    assert b.poses.rotation_xyzw == pytest.approx(a.poses.rotation_xyzw, abs=1e-6)


def test_the_stage_is_ten_times_the_table(take, library, performance):
    height_m = library.character.height_m
    raw, placed = take[0].doodles[0], performance.actors[0].doodles[0]
    assert np.ptp(placed.position_m, axis=0) == pytest.approx(
        np.ptp(raw.position_m, axis=0) * height_m / 0.175
    )


def test_performers_keep_their_places_and_do_not_disturb_each_other(take, library, performance):
    fox, part = story("fox")
    wolf, wolfs = story("wolf", (0.5, 0.8, 0.2))
    both = animate(
        Score((part, wolfs)), Recording((fox, wolf)), library, rate_hz=performance.rate_hz
    )
    first, second = both.actors
    scale = library.character.height_m / 0.175
    apart = second.poses.translation_m[0, 0] - first.poses.translation_m[0, 0]
    assert apart == pytest.approx(scale * np.array([0.5, 0.0, 0.2]), abs=1e-6)
    alone = performance.actors[0].poses.translation_m[:, 0]
    went = first.poses.translation_m[:, 0] - first.poses.translation_m[0, 0]
    assert went == pytest.approx(alone - alone[0], abs=1e-6)


def test_two_performers_do_not_idle_as_one(library):
    fox, wolf = story("fox")[0], story("wolf")[0]
    score = Score((Part("fox"), Part("wolf")))
    first, second = animate(score, Recording((fox, wolf)), library).actors
    assert np.abs(first.poses.rotation_xyzw - second.poses.rotation_xyzw).max() > 0.005


def test_whom_nothing_was_recognised_of_idles_on_the_spot(take, library):
    performance = animate(Score((Part("fox"),)), take[0], library)
    (actor,) = performance.actors
    assert np.ptp(actor.poses.translation_m[:, 0], axis=0) == pytest.approx(np.zeros(3))
    assert actor.poses.rotation_xyzw[0] != pytest.approx(actor.poses.rotation_xyzw[40])


def test_changing_one_phrase_leaves_what_went_before_as_it_was(take, library):
    performance = animate(take[1], take[0], library, rate_hz=60.0, timing="drawn")
    phrases = list(take[1].performers[0].phrases)
    index = next(i for i, phrase in enumerate(phrases) if phrase.action == "throw")
    phrases[index] = replace(phrases[index], action="bow")
    score = replace(take[1], performers=(Part("fox", tuple(phrases)),))
    other = animate(score, take[0], library, rate_hz=60.0, timing="drawn")
    until = frame_at(performance, phrases[index].start_s - 1.0)
    a, b = performance.actors[0], other.actors[0]
    assert b.poses.rotation_xyzw[:until] == pytest.approx(a.poses.rotation_xyzw[:until], abs=1e-9)
    assert b.poses.translation_m[:until] == pytest.approx(a.poses.translation_m[:until], abs=1e-9)


def test_a_doodle_split_by_lost_tracking_is_one_performance(library):
    doodle, part = story()
    cut = int(np.searchsorted(doodle.time_s, 7.0))

    def piece(rows):
        return Doodle(
            doodle.time_s[rows], doodle.position_m[rows], doodle.orientation_xyzw[rows], "fox"
        )

    take = Recording((piece(slice(0, cut - 30)), piece(slice(cut, None))))
    performance = animate(Score((part,)), take, library)
    assert len(performance.actors) == 1
    assert len(performance.actors[0].doodles) == 2
    assert np.isfinite(performance.actors[0].poses.translation_m).all()


def test_one_sample_is_a_performance_of_one_frame(library):
    doodle = Doodle([3.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0, 1.0]], "fox")
    performance = animate(Score((Part("fox"),)), Recording((doodle,)), library)
    assert len(performance) == 1


def faulty(**changes):
    return Score((Part("fox", (replace(Phrase("walk", 1.0, 2.0), **changes),)),))


@pytest.mark.parametrize(
    ("score", "message"),
    [
        (
            faulty(end_s=99.0),
            r"phrases\[0\]: expected times within the device's 0\.000 to \d+\.\d+ s, found 'walk' "
            r"from 1\.000 to 99\.000 s",
        ),
        (faulty(start_s=-1.0), r"found 'walk' from -1\.000 to 2\.000 s"),
        (Score((Part("wolf"),)), r"performers: expected a device of the recording \(fox\), found"),
    ],
)
def test_a_score_that_does_not_fit_is_refused_by_name(take, library, score, message):
    with pytest.raises(ScoreError, match=message) as caught:
        animate(score, take[0], library)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("action", "ends"), [("wlak", "and idles; did you mean 'walk'?"), ("zzz", "and idles")]
)
def test_what_a_character_lacks_is_idled_through_and_named(take, library, action, ends):
    score, nothing = faulty(action=action), Score((Part("fox"),))
    performance = animate(score, take[0], library)
    (said,) = performance.warnings
    assert said.startswith(f"device 'fox': {action!r} at 1.00 s: its character has no such action")
    assert said.endswith(ends)
    still = animate(nothing, take[0], library)
    for one, other in zip(performance.actors[0].poses, still.actors[0].poses, strict=True):
        assert np.array_equal(one, other)
    # the Score that is kept with the performance has the phrase
    assert f'"{action}"' in performance.source["score"]


def test_a_phrase_that_ends_a_hair_after_the_recording_is_played(take, library):
    end_s = float(take[0].doodles[0].time_s[-1])
    score = Score((Part("fox", (Phrase("walk", 1.0, end_s + 0.01),)),))
    assert len(animate(score, take[0], library)) > 0


@pytest.mark.parametrize("rate_hz", [0.0, -24.0, float("nan"), float("inf")])
def test_a_rate_that_is_none_is_refused(take, library, rate_hz):
    with pytest.raises(TransferError, match="rate_hz: expected a positive number"):
        animate(take[1], take[0], library, rate_hz=rate_hz)


def test_a_score_without_performers_is_refused(take, library):
    with pytest.raises(TransferError, match="expected at least one performer"):
        animate(Score(()), take[0], library)
