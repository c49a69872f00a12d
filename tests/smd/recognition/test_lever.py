"""The point about which a prop is turned is found, or it is said why not."""

from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle
from smd.errors import DoodleError
from smd.geometry.rotations import multiply, quaternion_from_rotvec, rotate
from smd.recognition.lever import estimate_lever
from smd.smoothing import smooth
from smd.synthetic.person import simulated_person
from smd.synthetic.tracker import tracker_times

AXES = np.eye(3)


def waves(rng: np.random.Generator, t: np.ndarray, most_hz: float, amplitude: float) -> np.ndarray:
    """Smooth unrest (n, 3) of about this amplitude: four sines an axis."""
    out = np.zeros((len(t), 3))
    for _ in range(4):
        hz, phase = rng.uniform(0.1, most_hz, 3), rng.uniform(0.0, 2 * np.pi, 3)
        out += 0.5 * amplitude * np.sin(2 * np.pi * hz * t[:, None] + phase)
    return out


def turned_about(
    lever_m: np.ndarray,
    rng: np.random.Generator,
    *,
    seconds: float = 15.0,
    axes: np.ndarray = AXES,
    swing_rad: float = 1.0,
    drift_m: float = 0.0,
    noise_m: float = 0.0,
) -> Doodle:
    """A prop turned about a place that drifts, recorded by a tracker beside its centre."""
    t = tracker_times(0.0, seconds, 90.0, rng)
    orientation = quaternion_from_rotvec(waves(rng, t, 0.8, swing_rad) @ axes.T @ axes)
    centre = np.array([0.3, 1.1, -0.4]) + waves(rng, t, 1.5, drift_m)
    position = centre - rotate(orientation, lever_m) + rng.normal(0.0, noise_m, centre.shape)
    return Doodle(t, position, orientation)


@pytest.mark.parametrize("seed", range(5))
def test_without_noise_the_lever_is_exact(seed):
    rng = np.random.default_rng(seed)
    lever = rng.normal(0.0, 0.05, 3)
    found = estimate_lever([smooth(turned_about(lever, rng))])
    # smoothing shortens arcs a little, positions not by quite as much as turns
    np.testing.assert_allclose(found.lever_m, lever, atol=3e-4)
    assert found.centre_wander_m < 0.02 * found.tracker_wander_m


@pytest.mark.parametrize("seed", range(12))
def test_simulated_peoples_grips_are_found_within_millimetres(seed):
    rng = np.random.default_rng(seed)
    person = simulated_person(rng)
    lever = np.array(person.grip_m)
    doodle = turned_about(lever, rng, drift_m=person.drift_m, noise_m=person.tremor_m)
    found = estimate_lever([smooth(doodle)])
    assert np.linalg.norm(found.lever_m - lever) < 2.5e-3
    assert (np.abs(found.lever_m - lever) < 5.0 * found.error_m + 3e-4).all()


def test_twice_the_error_holds_the_truth_most_of_the_time():
    inside = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        lever = rng.normal(0.0, 0.05, 3)
        found = estimate_lever([smooth(turned_about(lever, rng, seconds=20.0, drift_m=2e-3))])
        inside.extend(np.abs(found.lever_m - lever) < 2.0 * found.error_m)
    assert np.mean(inside) > 0.75


def test_where_the_prop_is_turned_and_which_way_the_world_faces_do_not_matter():
    rng = np.random.default_rng(3)
    doodle = turned_about(np.array([0.02, -0.07, 0.01]), rng, drift_m=1e-3)
    turn, step = quaternion_from_rotvec(rng.normal(size=3)), rng.normal(size=3)
    moved = Doodle(
        doodle.time_s,
        rotate(turn, doodle.position_m) + step,
        multiply(turn, doodle.orientation_xyzw),
    )
    here, there = (estimate_lever([smooth(each)]) for each in (doodle, moved))
    np.testing.assert_allclose(here.lever_m, there.lever_m, atol=1e-9)
    np.testing.assert_allclose(here.error_m, there.error_m, atol=1e-9)


def test_a_steady_walk_while_turning_does_no_harm():
    rng = np.random.default_rng(4)
    lever = np.array([0.03, 0.05, 0.0])
    still = turned_about(lever, rng)
    walking = Doodle(
        still.time_s,
        still.position_m + still.time_s[:, None] * [0.2, 0.0, 0.05],
        still.orientation_xyzw,
    )
    np.testing.assert_allclose(estimate_lever([smooth(walking)]).lever_m, lever, atol=1e-3)


def test_a_moment_of_moving_off_does_not_count():
    rng = np.random.default_rng(5)
    lever = np.array([0.03, 0.05, 0.0])
    doodle = turned_about(lever, rng, drift_m=5e-4)
    bump = 0.3 * np.exp(-(((doodle.time_s - 7.0) / 0.3) ** 2))
    knocked = Doodle(
        doodle.time_s, doodle.position_m + bump[:, None] * AXES[0], doodle.orientation_xyzw
    )
    found = estimate_lever([smooth(knocked)])
    assert np.linalg.norm(found.lever_m - lever) < 2e-3


def test_several_recordings_tell_one_lever_about_different_places():
    rng = np.random.default_rng(6)
    lever = np.array([0.0, 0.06, -0.02])
    nods = turned_about(lever, rng, axes=AXES[:1], seconds=8.0)
    rolls = turned_about(lever, rng, axes=AXES[2:], seconds=8.0)
    away = Doodle(rolls.time_s, rolls.position_m + 1.0, rolls.orientation_xyzw)
    np.testing.assert_allclose(
        estimate_lever([smooth(nods), smooth(away)]).lever_m, lever, atol=5e-4
    )


def test_too_little_turning_is_refused_with_what_was_found():
    doodle = turned_about(np.zeros(3), np.random.default_rng(0), swing_rad=0.005)
    with pytest.raises(DoodleError, match=r"turning of at least 180 degrees.*got \d+"):
        estimate_lever([smooth(doodle)])


@pytest.mark.parametrize("axis", range(3))
def test_turning_about_one_axis_is_refused_and_the_axis_named(axis):
    rng = np.random.default_rng(axis)
    doodle = turned_about(np.array([0.03, 0.04, 0.05]), rng, axes=AXES[axis : axis + 1])
    with pytest.raises(DoodleError, match=f"about two axes.*mostly {'xyz'[axis]},"):
        estimate_lever([smooth(doodle)])


def test_a_centre_that_was_not_held_is_refused():
    rng = np.random.default_rng(1)
    doodle = turned_about(np.zeros(3), rng, drift_m=0.15, swing_rad=0.4)
    with pytest.raises(DoodleError, match=r"within 10 mm, got \d+ mm along [xyz]"):
        estimate_lever([smooth(doodle)])
