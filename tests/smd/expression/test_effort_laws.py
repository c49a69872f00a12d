"""What every expression keeps: each axis has one direction, an action its aim, a hinge its side.

The measures are the benchmark's, which prints them for all actions and states.
"""

from __future__ import annotations

import functools
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from actions_library.folder import load_library
from benchmarks.expression import (
    LAWS,
    NINE,
    acting,
    bends_rad,
    executed_s,
    off_aim_m,
    peak_m_s2,
    places,
    played_along,
    wrong_way,
)
from laban import Effort
from laban.effort import AXES
from smd.character.clip import Clip
from smd.expression.aim import aim_of, progress, seen_from_root
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import Study, study_of
from smd.geometry.rotations import multiply, quaternion_about, rotate

LIBRARY = load_library()
BODY = body_of(LIBRARY.clip("idle"))
EVERY = [action.name for action in LIBRARY.actions]
ONCE = [name for name in EVERY if not LIBRARY.clip(name).cyclic]
TOLERANCE = {"time": 0.0, "weight": 0.03, "space": 0.002, "flow": 0.025}
"""How far a measure may go the wrong way in a step: an execution ends on a frame, which is as much
as 2 % of the time before it; and peaks lie between frames."""

POLES = [Effort(**{axis: pole}) for axis, pole in product(AXES, (-1.0, 1.0))]
CORNERS = [Effort(*corner) for corner in product((-1.0, 1.0), repeat=4)]


@functools.cache
def studied(name: str) -> Study:
    return study_of(LIBRARY.clip(name), BODY)


def played(name: str, effort: Effort) -> Clip:
    return expressive(studied(name), [effort], travels=LIBRARY.action(name).travels)[0]


@functools.cache
def along(name: str, axis: str) -> tuple[Clip, ...]:
    return played_along(studied(name), axis, NINE, travels=LIBRARY.action(name).travels)


@pytest.mark.parametrize("name", EVERY[::4])
def test_states_made_together_are_those_made_one_by_one(name):
    """Whatever else is in the stack: no state knows of another."""
    states = [*POLES, Effort(), *CORNERS[::3], Effort(0.5, -0.2), Effort(space=0.3, flow=-0.4)]
    together = expressive(studied(name), states, travels=LIBRARY.action(name).travels)
    for clip, effort in zip(together, states, strict=True):
        alone = played(name, effort)
        for array in ("rotation_xyzw", "translation_m"):
            made, expected = getattr(clip, array), getattr(alone, array)
            np.testing.assert_allclose(made, expected, rtol=0.0, atol=1e-12)
        np.testing.assert_array_equal(clip.stage_end_frames, alone.stage_end_frames)
        np.testing.assert_array_equal(clip.contacts, alone.contacts)


@pytest.mark.parametrize("name", ONCE)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: f"{law[0]}: {law[1]}")
def test_more_of_an_axis_is_never_less_of_its_measure(law, name):
    axis, _, sign, measure = law
    joint = acting(studied(name))
    values = [measure(clip, joint) for clip in along(name, axis)]
    assert wrong_way(values, sign) <= TOLERANCE[axis], np.round(values, 3)


@pytest.mark.parametrize("name", ONCE)
def test_time_and_weight_do_show(name):
    joint = acting(studied(name))
    lasting = [executed_s(clip, joint) for clip in along(name, "time")]
    peaks = [peak_m_s2(clip, joint) for clip in along(name, "weight")]
    assert lasting[0] > 1.15 * lasting[4] > 2.0 * lasting[-1]
    assert 1.15 * peaks[0] < peaks[4] < 1.03 * peaks[-1]  # a hop is as quick as joints are


@pytest.mark.parametrize("name", ONCE)
def test_nothing_turns_back_or_jumps_at_neutral(name):
    """Peaks in the execution change with Time as much on one side of 0 as on the other, about."""
    joint = acting(studied(name))

    def peak(time: float) -> float:
        clip = played(name, Effort(time=time))
        begins, ends = clip.stage_end_frames[1:3]
        place = places(clip)[max(begins - 3, 0) : ends + 4, joint]
        return float(np.log(np.linalg.norm(np.diff(place, n=2, axis=0), axis=-1).max()))

    before, here, after = peak(-0.1), peak(0.0), peak(0.1)
    assert after - here < 0.45
    assert after - here < 3.0 * abs(here - before) + 0.15


def test_actions_with_an_aim_are_found_by_what_their_clips_do():
    def ends(name: str) -> set[str]:
        clip = LIBRARY.clip(name)
        return {clip.skeleton.joints[effector.end] for effector in studied(name).aim.effectors}

    for name in ("punch", "slash", "throw", "wave", "pick_up"):
        assert "right_hand" in ends(name)
    for name in ("push", "clap", "cheer"):
        assert ends(name) == {"left_hand", "right_hand"}
    assert "right_foot" in ends("kick") and "left_foot" not in ends("kick")
    for name in ("turn_left", "spin", "bow", "nod", "crouch", "jump", "roll", "walk", "idle"):
        assert not ends(name)


@functools.cache
def in_many_states(name: str) -> tuple[float, float]:
    """How far an action is from its aim at most, and the least bend of an elbow or knee."""
    efforts = [*POLES, *CORNERS]
    clips = expressive(studied(name), efforts, travels=LIBRARY.action(name).travels)
    return (
        max(off_aim_m(studied(name), clip) for clip in clips),
        min(float(bends_rad(clip).min()) for clip in clips),
    )


@pytest.mark.parametrize("name", [name for name in ONCE if studied(name).aim.effectors])
def test_what_an_action_is_for_is_kept(name):
    assert in_many_states(name)[0] < 0.03


@pytest.mark.parametrize("size", [0.1, 3.0])
def test_an_aim_does_not_depend_on_size_or_on_where_somebody_stands(size):
    for name in ("punch", "kick", "bow", "clap"):
        clip = LIBRARY.clip(name)
        turn = quaternion_about([0.0, 1.0, 0.0], 2.0)
        rotation, translation = clip.rotation_xyzw.copy(), size * clip.translation_m
        rotation[:, 0] = multiply(turn, rotation[:, 0])
        translation[:, 0] = rotate(turn, translation[:, 0]) + np.array([5.0, 0.0, -3.0])
        skeleton = replace(
            clip.skeleton, rest_translation_m=size * clip.skeleton.rest_translation_m
        )
        there = replace(clip, skeleton=skeleton, rotation_xyzw=rotation, translation_m=translation)
        found = study_of(there, body_of(there)).aim
        expected = studied(name).aim
        assert found.frame == expected.frame
        assert [x.end for x in found.effectors] == [x.end for x in expected.effectors]


def test_seen_from_the_ground_root_somebody_who_goes_along_stands():
    clip = LIBRARY.clip("walk")
    seen = seen_from_root(clip, np.repeat(clip.translation_m[:, :1], 2, axis=1))
    np.testing.assert_allclose(seen, 0.0, atol=1e-12)
    assert aim_of(clip, BODY, places(clip)).effectors == ()


def test_progress_stands_while_the_body_draws_back_and_is_there_at_the_poses():
    x = np.concatenate([np.linspace(0.0, -0.5, 40), np.linspace(-0.5, 1.0, 60), np.ones(40)])
    back = np.linspace(1.0, 0.0, 60)
    path = np.concatenate([x, back])[:, None, None] * np.array([1.0, 0.0, 0.0])
    got = progress(path, [0, 120, 199], 60.0)
    assert got[[0, 120, 199]] == pytest.approx([0.0, 1.0, 2.0], abs=1e-6)
    assert got[:55].max() < 0.02
    assert np.diff(got).min() > -1e-3


@pytest.mark.parametrize("name", EVERY)
def test_no_elbow_or_knee_bends_backwards(name):
    own = float(bends_rad(LIBRARY.clip(name)).min())
    assert own > 0.0
    assert in_many_states(name)[1] > 0.0


def test_a_measure_of_bends_knows_which_way_a_limb_is_bent():
    """An elbow turned about its own hinge, by a known angle, either way."""
    clip = LIBRARY.clip("idle")
    arm = BODY.arms[0]
    rest = np.broadcast_to(clip.skeleton.rest_rotation_xyzw, clip.rotation_xyzw.shape)
    at_rest = bends_rad(replace(clip, rotation_xyzw=rest))
    for angle in (-0.2, 0.3, 1.0):
        rotation = rest.copy()
        rotation[:, arm.middle] = multiply(
            clip.skeleton.rest_rotation_xyzw[arm.middle],
            quaternion_about(arm.limb.lower_hinge, angle),
        )
        bends = bends_rad(replace(clip, rotation_xyzw=rotation))
        assert any(
            np.allclose(bends[:, i] - at_rest[:, i], angle, atol=0.02)
            for i in range(bends.shape[1])
        )
