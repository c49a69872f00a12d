from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from laban import Effort
from smd.errors import DoodleError
from smd.smoothing import smooth
from smd.synthetic import efforts
from smd.synthetic.efforts import ACTIONS, labelled_takes, simulated_player, simulated_take
from smd.synthetic.gestures import gesture
from smd.synthetic.person import STEADY


@pytest.fixture
def plain(monkeypatch):
    """A steady player without leanings, takes without spread, a tracker without noise."""
    none = dict.fromkeys(
        ("leaning", "take_effort", "take_size", "take_pace", "sensor_m", "sensor_rad"), 0.0
    )
    monkeypatch.setattr(efforts, "SPREAD", replace(efforts.SPREAD, rest_s=(0.3, 0.3), **none))
    return efforts.Player("steady", STEADY)


def take(player, time, weight, action="punch", seed=0):
    rng = np.random.default_rng(seed)
    return smooth(simulated_take(action, Effort(time=time, weight=weight), player, rng))


def speed(motion):
    return np.linalg.norm(motion.velocity_m_s, axis=1)


def busy_s(motion):
    """How long the speed is above a tenth of its peak."""
    return np.mean(speed(motion) > 0.1 * speed(motion).max()) * np.ptp(motion.time_s)


def test_a_neutral_take_is_the_gesture_that_asks_for_the_action(plain):
    doodle = simulated_take("jump", Effort(), plain, np.random.default_rng(0))
    height = doodle.position_m[:, 1] - doodle.position_m[0, 1]
    assert height.max() == pytest.approx(0.08)
    assert doodle.duration_s == pytest.approx(gesture("jump").duration_s + 0.6, abs=0.02)


def test_sudden_is_short_and_sustained_long_at_the_same_size(plain):
    sudden, neutral, sustained = (take(plain, time, 0.0) for time in (1.0, 0.0, -1.0))
    assert 1.5 * busy_s(sudden) < busy_s(neutral) < busy_s(sustained) / 1.5
    reach = [
        np.ptp(np.linalg.norm(m.position_m - m.position_m[0], axis=1))
        for m in (sudden, neutral, sustained)
    ]
    assert np.ptp(reach) < 0.1 * min(reach)


def test_strong_goes_further_in_the_same_time(plain):
    strong, light = take(plain, 0.0, 1.0), take(plain, 0.0, -1.0)
    assert np.ptp(strong.time_s) == pytest.approx(np.ptp(light.time_s), abs=0.02)
    assert speed(strong).mean() > 2.0 * speed(light).mean()


def test_strong_has_its_force_in_a_burst_and_light_is_even(plain):
    evenness = [
        speed(m).max() / speed(m)[speed(m) > 0.01].mean()
        for m in (take(plain, 0.0, weight, "side_step_left") for weight in (1, 0, -1))
    ]
    assert evenness[0] > 1.1 * evenness[1] > 1.1 * evenness[2]


def test_a_sudden_stroke_has_its_attack_early(plain):
    for time, early in ((1.0, True), (-1.0, False)):
        motion = take(plain, time, 0.0, "turn_left")
        turning = np.linalg.norm(motion.angular_velocity_rad_s, axis=1)
        active = np.flatnonzero(turning > 0.05 * turning.max())
        peak = (np.argmax(turning) - active[0]) / np.ptp(active)
        assert (peak < 0.42) == early


def test_a_strong_stroke_rings_when_it_is_stopped(plain):
    def after(weight):
        motion = take(plain, 0.0, weight, "side_step_left")
        end_s = motion.time_s[-1] - 0.3
        return speed(motion.between(end_s + 0.1, end_s + 0.25)).max() / speed(motion).max()

    assert after(1.0) > 3.0 * after(-1.0)


@pytest.mark.parametrize("action", ACTIONS)
def test_every_action_can_be_played_with_every_effort(action):
    rng = np.random.default_rng(0)
    for time, weight in ((1.0, 1.0), (-1.0, -1.0), (None, None)):
        player = simulated_player("somebody", rng)
        motion = smooth(simulated_take(action, Effort(time=time, weight=weight), player, rng))
        assert speed(motion).max() < 5.0  # a hand, not a bullet


def test_the_same_seed_gives_the_same_takes_and_another_seed_others():
    def first(seed):
        return next(labelled_takes(people=1, repeats=1, seed=seed)).doodle.position_m

    np.testing.assert_array_equal(first(1), first(1))
    assert first(1).shape != first(2).shape or not np.allclose(first(1), first(2))


def test_every_pairing_is_played_as_often_by_everybody():
    takes = list(labelled_takes(people=2, repeats=3, seed=0))
    assert len(takes) == 2 * 9 * 3
    pairs = [(take.player, take.effort.time, take.effort.weight) for take in takes]
    assert all(pairs.count(pair) == 3 for pair in pairs)


def test_no_action_comes_again_before_all_were_played():
    takes = list(labelled_takes(people=1, repeats=len(ACTIONS), seed=0))
    for i in range(0, len(takes), len(ACTIONS)):
        assert {take.action for take in takes[i : i + len(ACTIONS)]} == set(ACTIONS)


def test_an_unknown_action_is_refused():
    rng = np.random.default_rng(0)
    with pytest.raises(DoodleError, match="moonwalk"):
        simulated_take("moonwalk", Effort(), simulated_player("x", rng), rng)
