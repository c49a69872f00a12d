from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.geometry.rotations import heading_rad, inverse, multiply, rotate, rotvec_from_quaternion
from smd.synthetic.gestures import gesture
from smd.synthetic.hands import MEASURED, Hands, hand_person
from smd.synthetic.person import STEADY, Person, simulated_person
from smd.synthetic.takes import Take

NOTHING = Hands(
    *(0.0,) * 9,
    swing_rad_per_m=((0.0,) * 3,) * 3,
    swing_between=0.0,
    swing_spread=0.0,
    roundness=(0.0, 0.0),
    roundness_spread=0.0,
    skew=0.0,
    swings=(1.0, 0.0, 0.0),
)


def people(count: int, hands: Hands = MEASURED) -> list[Person]:
    return [hand_person(np.random.default_rng([3, seed]), hands) for seed in range(count)]


def played(person: Person, action: str, seed: int = 0):
    return Take(person, np.random.default_rng(seed)).play(action).exact_doodle()


def test_people_differ_and_the_same_seed_gives_the_same_person():
    rngs = [np.random.default_rng(seed) for seed in (1, 1, 2)]
    one, again, other = (hand_person(rng) for rng in rngs)
    assert one == again
    assert one != other


def test_people_differ_as_much_as_was_measured():
    many = people(2000)
    for values, spread in (
        (np.log([p.size for p in many]), MEASURED.size),
        (np.log([p.pace for p in many]), MEASURED.pace),
        (np.array([p.askew_rad for p in many]), MEASURED.askew_rad),
        (np.array([p.misfacing_rad for p in many]), MEASURED.misfacing_rad),
    ):
        assert values.mean() == pytest.approx(0.0, abs=0.1 * spread)
        assert values.std() == pytest.approx(spread, rel=0.1)
    swing = np.array([p.swing_rad_per_m for p in many])
    assert swing.mean(axis=0) == pytest.approx(np.array(MEASURED.swing_rad_per_m), abs=0.1)
    assert swing.std(axis=0) == pytest.approx(np.full((3, 3), MEASURED.swing_between), rel=0.1)
    swings = np.bincount([p.swings for p in many]) / len(many)
    assert swings == pytest.approx(MEASURED.swings, abs=0.04)


def test_hands_that_do_not_differ_keep_only_what_everybody_has():
    (person,) = people(1, NOTHING)
    usual = simulated_person(np.random.default_rng([3, 0]))
    kept = ("overlap", "bob_m", "grip_m", "wobble_rad", "drift_m", "tremor_m", "tremor_rad")
    kept += ("rebound_m",)
    for name in kept:
        assert getattr(person, name) == getattr(usual, name)
    assert replace(person, **{name: getattr(STEADY, name) for name in kept}) == replace(
        STEADY, swing_limit_rad=NOTHING.swing_limit_rad
    )


@pytest.mark.parametrize(
    "habits",
    [
        {"stroke_spread": 0.3},
        {"stroke_aim_rad": 0.2},
        {"stroke_turn_rad": 0.2},
        {"skew": 0.4},
        {"swing_spread": 2.0},
    ],
)
def test_an_error_of_strokes_leaves_what_else_a_take_draws_as_it_is(habits):
    # Drawn from the take's own source, one habit would change every other error with it.
    usual = simulated_person(np.random.default_rng(8))
    one, other = (
        Take(person, np.random.default_rng(9)).play("jump")
        for person in (usual, replace(usual, **habits))
    )
    assert one.phrases == other.phrases
    unrest = [take.pause(3.0).exact_doodle().orientation_xyzw[-90:] for take in (one, other)]
    back = rotvec_from_quaternion(multiply(inverse(unrest[0]), unrest[1]))
    assert back.std(axis=0).max() < 5e-3  # turned at most, then alike; unrest is 0.02


def test_a_stroke_as_long_as_another_s_error_says_ends_there():
    person = Person(stroke_spread=0.2)
    ends = [played(person, "walk", seed).position_m[-1, 2] for seed in range(300)]
    (glide,) = gesture("walk").strokes
    assert np.log(np.array(ends) / glide.move_m[2]).std() == pytest.approx(0.2, rel=0.15)


def test_a_stroke_s_error_of_aim_turns_it_and_leaves_its_length():
    person = Person(stroke_aim_rad=np.radians(8.0))
    ends = np.array([played(person, "walk", seed).position_m[-1] for seed in range(300)])
    assert np.linalg.norm(ends, axis=1) == pytest.approx(0.35, abs=1e-5)
    assert np.degrees(np.arctan2(ends[:, 0], ends[:, 2])).std() == pytest.approx(8.0, rel=0.15)


@pytest.mark.parametrize(("action", "at_s"), [("punch", 0.35), ("walk", 1.2)])
def test_the_prop_is_turned_aside_between_strokes_and_comes_back(action, at_s):
    person = Person(stroke_turn_rad=np.radians(10.0), overlap=0.0)
    aside = []
    for seed in range(300):
        doodle = played(person, action, seed)
        turned = rotvec_from_quaternion(doodle.orientation_xyzw)
        assert turned[[0, -1]] == pytest.approx(np.zeros((2, 3)), abs=1e-4)
        aside.append(turned[np.searchsorted(doodle.time_s, at_s)])
    assert np.degrees(np.std(aside, axis=0)) == pytest.approx([10.0] * 3, rel=0.2)


def test_a_skewed_stroke_is_fastest_early_or_late_and_ends_where_and_when_it_did():
    doodles = [played(Person(skew=0.3), "punch", seed) for seed in range(60)]
    straight = played(STEADY, "punch")
    fastest = []
    for doodle in doodles:
        assert doodle.position_m[-1] == pytest.approx(straight.position_m[-1], abs=1e-5)
        first = doodle.time_s < 0.32
        fastest.append(np.gradient(doodle.position_m[first, 2]).argmax() / first.sum())
    assert min(fastest) < 0.42
    assert max(fastest) > 0.58


def test_a_hand_turns_with_its_way_as_its_swing_says_up_to_its_limit():
    left_turns_left = ((0.0,) * 3, (2.0, 0.0, 0.0), (0.0,) * 3)
    for limit_rad, most_rad in ((10.0, 0.5), (0.2, 0.2)):
        person = Person(swing_rad_per_m=left_turns_left, swing_limit_rad=limit_rad)
        doodle = played(person, "side_step_left")
        assert doodle.position_m[-1, 0] == pytest.approx(0.25, abs=1e-6)
        assert heading_rad(doodle.orientation_xyzw[-1]) == pytest.approx(most_rad, rel=0.02)


def test_who_waves_longer_waves_oftener_and_ends_upright():
    turns = []
    for swings in (0, 1, 2):
        doodle = played(Person(swings=swings), "wave")
        up = rotate(doodle.orientation_xyzw, np.tile([0.0, 1.0, 0.0], (len(doodle), 1)))
        turns.append(int((np.diff(np.sign(np.round(up[:, 0], 6))) != 0).sum()))
        assert up[-1] == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)
        assert doodle.duration_s == pytest.approx(1.5 + 0.6 * swings, abs=0.02)
    assert np.diff(turns).min() > 0


def test_strokes_bow_out_as_far_as_said():
    for spread in (0.0, 0.5):
        person = Person(roundness=0.1, roundness_spread=spread)
        bows = [
            np.linalg.norm(played(person, "walk", seed).position_m[:, :2], axis=1).max() / 0.35
            for seed in range(200)
        ]
        assert np.exp(np.log(bows).mean()) == pytest.approx(0.1, rel=0.1)
        assert np.log(bows).std() == pytest.approx(spread, rel=0.15, abs=1e-3)
