"""Laws that every operator of expression keeps, one row an operator: a new one joins `OPERATORS`.

An operator is asked with a study and an amount from -1 to 1; 0 is neutral. What each does beyond
these laws is in the tests of its own module.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import Effort
from smd.character.clip import Clip
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses
from smd.character.quality import fastest_turn_rad_s
from smd.expression.attack import with_attack
from smd.expression.body import body_of
from smd.expression.expressive import expressive, with_flow, with_shape, with_size, with_space
from smd.expression.operators import played_clip, rescaled, reshaped, retimed, stack_of
from smd.expression.springs import damped, sprung
from smd.expression.study import Study, poses_at, study_of
from smd.expression.timing import shown_frames
from smd.geometry.rotations import multiply, quaternion_about, rotate

LIBRARY = load_library()
BODY = body_of(LIBRARY.clip("idle"))
Operator = Callable[[Study, float], Clip]


def with_effort(**of_amount: float) -> Operator:
    """The whole expression, of some axes, each with a share of the amount."""

    def operator(study: Study, amount: float) -> Clip:
        effort = Effort(**{axis: share * amount for axis, share in of_amount.items()})
        travels = LIBRARY.action(study.clip.name).travels
        return expressive(study, [effort], travels=travels)[0]

    return operator


def alone(operator: Callable[[Poses, np.ndarray, Study], Poses]) -> Operator:
    """An operator of stacks, with a stack of one state, and one amount."""

    def on_one(study: Study, amount: float) -> Clip:
        poses = operator(stack_of(study.clip, 1), np.array([amount]), study)
        still = np.arange(float(len(study.clip)))
        return played_clip(study.clip, Poses(*(part[:, 0] for part in poses)), still)

    return on_one


def everywhere(study: Study, value: np.ndarray) -> np.ndarray:
    return np.tile(value, (len(study.clip), 1))


def stages_retimed(study: Study, amount: float) -> Clip:
    lasting = [1.0, 2.0**amount, 3.0**-amount, 1.0, 1.0]
    frames = np.diff(study.clip.stage_end_frames, prepend=0)
    frame = shown_frames(np.repeat(lasting, frames), study.aim.frame)
    return played_clip(study.clip, retimed(study.clip, frame), frame)


def about_the_first(poses: Poses, amount: np.ndarray, study: Study) -> Poses:
    factor = everywhere(study, 1.0 + 0.3 * amount)[..., None]
    return rescaled(poses, BODY.upper, factor, stack_of(poses_at(study.clip, np.array([0])), 1))


RETIMING: dict[str, Operator] = {
    "Time": with_effort(time=1.0),
    "Weight": with_effort(weight=1.0),
    "Flow": with_effort(flow=1.0),
    "Time and Weight": with_effort(time=1.0, weight=1.0),
    "Time against Weight": with_effort(time=1.0, weight=-1.0),
    "all axes": with_effort(time=0.6, weight=-0.8, space=1.0, flow=0.7),
    "stages retimed": stages_retimed,
}
"""Operators that show a pose at another moment."""

RESHAPING: dict[str, Operator] = {
    "Space": with_effort(space=1.0),
    "Weight's size": alone(
        lambda p, a, s: with_size(
            p, 0.0 * a, a, s, gait=s.clip.cyclic and LIBRARY.action(s.clip.name).travels
        )
    ),
    "Weight's back": alone(with_shape),
    "Space's hands and gaze": alone(lambda p, a, s: with_space(s, a)),
    "Flow's springs": alone(lambda p, a, s: with_flow(p, a, s, s.swings[:, None])),
    "a small beginning": alone(lambda p, a, s: with_size(p, np.abs(a), 0.0 * a, s, gait=False)),
    "attack": alone(lambda p, a, s: with_attack(p, a, s.clip, BODY) if s.clip.cyclic else p),
    "rescaled": alone(about_the_first),
    "reshaped": alone(
        lambda p, a, s: reshaped(p, {BODY.spine[0]: everywhere(s, 0.2 * a)}, BODY.rest_xyzw)
    ),
    "sprung": alone(lambda p, a, s: sprung(p, s.clip, BODY.upper, BODY, everywhere(s, np.abs(a)))),
    "damped": alone(lambda p, a, s: damped(p, s.clip, BODY.upper, everywhere(s, np.abs(a)))),
}
"""Operators that change poses where they are."""

OPERATORS = {**RETIMING, **RESHAPING}
RAW = ("rescaled", "reshaped", "sprung", "damped")
"""Operators that do all the way through what they are told: those above let it come and go."""

HUNG = ("Flow", "Flow's springs", "sprung", "damped", "Space", "Space's hands and gaze", "all axes")
"""Operators whose cycles close as nearly as a swing has died away, or a way is smoothed."""

AMOUNTS = (-1.0, 0.4, 1.0)
CLIPS = ("punch", "sit_down", "throw", "jump", "crawl", "dance", "walk")

each = pytest.mark.parametrize("name", OPERATORS)
each_reshaping = pytest.mark.parametrize("name", RESHAPING)


@functools.cache
def study(clip: str) -> Study:
    return study_of(LIBRARY.clip(clip), BODY)


@functools.cache
def done_to(clip: str, name: str, amount: float) -> Clip:
    return OPERATORS[name](study(clip), amount)


def turned_apart_rad(one: Clip, other: Clip) -> float:
    """How far a joint is at most turned from itself in another clip."""
    sine = 0.5 * np.linalg.norm(one.rotation_xyzw - other.rotation_xyzw, axis=-1)
    cosine = 0.5 * np.linalg.norm(one.rotation_xyzw + other.rotation_xyzw, axis=-1)
    return float(4.0 * np.arctan2(np.minimum(sine, cosine), np.maximum(sine, cosine)).max())


def apart_m(one: Clip, other: Clip) -> float:
    """How far a joint is at most from where it is in another clip."""
    return float(np.abs(places(one) - places(other)).max())


def places(clip: Clip) -> np.ndarray:
    return forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)[1]


def turned(clip: Clip, angle_rad: float) -> Clip:
    """The clip of somebody who faces elsewhere."""
    turn = quaternion_about([0.0, 1.0, 0.0], angle_rad)
    rotation, translation = clip.rotation_xyzw.copy(), clip.translation_m.copy()
    rotation[:, 0] = multiply(turn, rotation[:, 0])
    translation[:, 0] = rotate(turn, translation[:, 0])
    return replace(clip, rotation_xyzw=rotation, translation_m=translation)


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_neutral_changes_nothing(name, clip):
    neutral = done_to(clip, name, 0.0)
    assert turned_apart_rad(neutral, LIBRARY.clip(clip)) < 1e-6
    assert apart_m(neutral, LIBRARY.clip(clip)) < 1e-6
    np.testing.assert_array_equal(neutral.contacts, LIBRARY.clip(clip).contacts)
    np.testing.assert_array_equal(neutral.stage_end_frames, LIBRARY.clip(clip).stage_end_frames)


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_an_operator_does_something(name, clip):
    """But for a beginning where there is none, a cycle, which has no stages, and no step."""
    cyclic = LIBRARY.clip(clip).cyclic
    idle = name in {True: ("a small beginning", "stages retimed"), False: ("attack",)}[cyclic]
    changes = [apart_m(done_to(clip, name, a), LIBRARY.clip(clip)) for a in AMOUNTS]
    assert idle or max(changes) > 1e-3


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_it_is_a_clip_of_the_same_length(name, clip):
    for amount in AMOUNTS:
        neutral, done = LIBRARY.clip(clip), done_to(clip, name, amount)
        kept = ("name", "rate_hz", "contact_joints", "cyclic")
        assert [getattr(done, field) for field in kept] == [
            getattr(neutral, field) for field in kept
        ]
        assert done.skeleton is neutral.skeleton
        assert done.rotation_xyzw.shape == neutral.rotation_xyzw.shape
        assert np.abs(np.linalg.norm(done.rotation_xyzw, axis=-1) - 1.0).max() < 1e-9
        assert done.stage_end_frames[-1] == len(done) - 1
        assert (np.diff(done.stage_end_frames) >= 0).all()


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_it_begins_and_ends_as_the_clip_does_or_closes_as_a_cycle(name, clip):
    for amount in AMOUNTS:
        neutral, done = LIBRARY.clip(clip), done_to(clip, name, amount)
        if neutral.cyclic:
            cosine = np.sum(done.rotation_xyzw[0, 1:] * done.rotation_xyzw[-1, 1:], axis=-1)
            assert np.abs(cosine).min() > 1.0 - (1e-3 if name in HUNG else 1e-9)
        elif name not in RAW:
            ends = [0, -1]
            cosine = np.sum(done.rotation_xyzw[ends] * neutral.rotation_xyzw[ends], axis=-1)
            assert np.abs(cosine).min() > 1.0 - 1e-9
            np.testing.assert_allclose(
                done.translation_m[ends], neutral.translation_m[ends], atol=1e-9
            )


@pytest.mark.parametrize("name", RETIMING)
@pytest.mark.parametrize("clip", CLIPS)
def test_contacts_come_in_the_same_order(name, clip):
    """A short one may fall between two frames; none is new, and none comes before its time."""

    def in_turn(contacts: np.ndarray) -> list[tuple[bool, ...]]:
        kept = np.concatenate([[True], (np.diff(contacts, axis=0) != 0).any(axis=1)])
        return [tuple(row) for row in contacts[kept].tolist()]

    for amount in AMOUNTS:
        theirs = iter(in_turn(LIBRARY.clip(clip).contacts))
        assert all(
            any(own == other for other in theirs)
            for own in in_turn(done_to(clip, name, amount).contacts)
        )


@each_reshaping
@pytest.mark.parametrize("clip", CLIPS)
def test_who_reshapes_leaves_the_way_the_stages_and_the_contacts(name, clip):
    for amount in AMOUNTS:
        neutral, done = LIBRARY.clip(clip), done_to(clip, name, amount)
        np.testing.assert_allclose(
            done.translation_m[:, 0], neutral.translation_m[:, 0], rtol=0.0, atol=1e-12
        )
        np.testing.assert_array_equal(done.rotation_xyzw[:, 0], neutral.rotation_xyzw[:, 0])
        np.testing.assert_array_equal(done.contacts, neutral.contacts)
        np.testing.assert_array_equal(done.stage_end_frames, neutral.stage_end_frames)


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_a_little_more_effort_is_a_little_more_change(name, clip):
    """The aim is shown in a frame; where it moves on to the next one, all does by at most one."""

    def a_frame_rad(one: Clip, other: Clip) -> float:
        if one.stage_end_frames[2] == other.stage_end_frames[2]:
            return 0.0
        return max(fastest_turn_rad_s(done) / done.rate_hz for done in (one, other))

    for amount in (-0.7, 0.0, 0.7):
        asked = study(clip)
        before, here, after = (OPERATORS[name](asked, amount + more) for more in (-1e-4, 0.0, 1e-4))
        for one, other in ((before, here), (here, after)):
            assert turned_apart_rad(one, other) < 0.02 + a_frame_rad(one, other)


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_where_somebody_faces_does_not_matter(name, clip):
    for amount in (-1.0, 1.0):
        there = turned(LIBRARY.clip(clip), 1.1)
        expected = turned(done_to(clip, name, amount), 1.1)
        assert apart_m(OPERATORS[name](study_of(there, BODY), amount), expected) < 1e-6


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_the_sign_of_quaternions_does_not_matter(name, clip):
    for amount in (-1.0, 1.0):
        flipped = replace(LIBRARY.clip(clip), rotation_xyzw=-LIBRARY.clip(clip).rotation_xyzw)
        done = OPERATORS[name](study_of(flipped, BODY), amount)
        assert apart_m(done, done_to(clip, name, amount)) < 1e-6


def mirrored(clip: Clip) -> Clip:
    """The clip as a mirror shows it: left and right change places."""
    names = clip.skeleton.joints
    swap = {"left_": "right_", "right_": "left_"}

    def other(name: str) -> str:
        side = name.partition("_")[0] + "_"
        return swap[side] + name.removeprefix(side) if side in swap else name

    at = [names.index(other(name)) for name in names]
    contacts = [clip.contact_joints.index(other(name)) for name in clip.contact_joints]
    return replace(
        clip,
        rotation_xyzw=clip.rotation_xyzw[:, at] * [1.0, -1.0, -1.0, 1.0],
        translation_m=clip.translation_m[:, at] * [-1.0, 1.0, 1.0],
        contacts=clip.contacts[:, contacts],
    )


@each
@pytest.mark.parametrize("clip", CLIPS)
def test_a_left_hander_does_the_same_in_a_mirror(name, clip):
    for amount in AMOUNTS:
        # An indirect gaze sets out to one side, and an indirect hand weaves to one side first.
        if amount < 0.0 and name in ("Space", "Space's hands and gaze", "all axes"):
            continue
        done = OPERATORS[name](study_of(mirrored(LIBRARY.clip(clip)), BODY), amount)
        assert apart_m(done, mirrored(done_to(clip, name, amount))) < 1e-6
