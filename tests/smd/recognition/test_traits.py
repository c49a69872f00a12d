from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.geometry.rotations import multiply, quaternion_about, quaternion_from_rotvec, rotate
from smd.recognition.traits import COURSES, MEASURES, SAMPLES, fitted, traits_of
from smd.smoothing import smooth
from smd.synthetic.curves import helix, straight_line
from smd.synthetic.gestures import GESTURES
from smd.synthetic.person import simulated_person
from smd.synthetic.takes import Take


def performance(action="throw", seed=3):
    rng = np.random.default_rng(seed)
    return Take(simulated_person(rng), rng).play(action).exact_doodle()


def moved(doodle, turn_xyzw, by_m):
    return replace(
        doodle,
        position_m=rotate(turn_xyzw, doodle.position_m) + by_m,
        orientation_xyzw=multiply(turn_xyzw, doodle.orientation_xyzw),
    )


@pytest.mark.parametrize("action", GESTURES)
def test_traits_do_not_depend_on_where_the_user_stands_and_faces(action):
    doodle = performance(action)
    turn = quaternion_about([0.0, 1.0, 0.0], 2.0)
    a = traits_of(smooth(doodle))
    b = traits_of(smooth(moved(doodle, turn, [3.0, -1.0, 2.0])))
    for ours, theirs in zip(a.courses, b.courses, strict=True):
        assert ours == pytest.approx(theirs, abs=1e-8)
    assert a.measures == pytest.approx(b.measures, abs=1e-8)


def test_the_prop_s_own_courses_do_not_depend_on_which_way_is_up():
    doodle = performance()
    turn = quaternion_from_rotvec([0.7, -0.4, 1.1])
    a, b = (traits_of(smooth(d)) for d in (doodle, moved(doodle, turn, [0.0, 0.0, 0.0])))
    for name in ("shape_prop", "flow_prop"):
        i = COURSES.index(name)
        assert a.courses[i] == pytest.approx(b.courses[i], abs=1e-8)


def test_lengths_are_counted_in_figure_heights():
    doodle = performance()
    twice = replace(doodle, position_m=2.0 * doodle.position_m)
    a = traits_of(smooth(doodle), figure_height_m=0.175)
    b = traits_of(smooth(twice), figure_height_m=0.35)
    assert a.measures == pytest.approx(b.measures, abs=1e-6)
    for ours, theirs in zip(a.courses, b.courses, strict=True):
        assert ours == pytest.approx(theirs, abs=1e-6)


def test_measures_of_a_straight_line_are_its_own():
    length_m, duration_s, height_m = 0.35, 2.0, 0.175
    motion = smooth(straight_line(length_m=length_m, duration_s=duration_s))
    measures = dict(zip(MEASURES, np.exp(traits_of(motion).measures), strict=True))
    way = length_m / height_m
    assert measures["duration"] == pytest.approx(duration_s + 0.05, abs=0.02)
    assert measures["path"] == pytest.approx(way + 0.2, rel=0.02)
    # root mean square distance of even points on a segment from its middle
    assert measures["extent"] == pytest.approx(way / np.sqrt(12.0) + 0.1, rel=0.05)
    assert measures["turning"] == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize("facing", [-0.4, 0.0, 0.3])
@pytest.mark.parametrize("askew", [(0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.1, 0.0, 0.15)])
def test_fitting_takes_away_how_the_hand_faces_and_holds(facing, askew):
    motion = smooth(helix(radius_m=0.2, rise_m=0.1, duration_s=2.0, turns=0.6))
    shape = traits_of(motion).courses[0]
    vectors = shape.reshape(SAMPLES, 4, 3).copy()
    held = quaternion_from_rotvec(askew)
    # axes of a frame that is turned in itself: columns times the turn
    columns = vectors[:, 1:].transpose(0, 2, 1)
    turn = np.stack([rotate(held, axis) for axis in np.eye(3)], axis=-1)
    vectors[:, 1:] = (columns @ turn).transpose(0, 2, 1)
    yaw = quaternion_about([0.0, 1.0, 0.0], facing)
    changed = rotate(yaw, vectors).reshape(1, SAMPLES, 12)
    before = np.abs(changed[0] - shape).max()
    (after,) = fitted(changed, shape, facing_rad=0.6, askew_rad=0.5)
    assert np.abs(after - shape).max() < max(0.35 * before, 1e-9)
