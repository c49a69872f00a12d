"""Where a recording was hardly understood, the reading that makes it readable is named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import smd
from smd.advice import Asked, axes_otherwise, better_reading, size_otherwise, understood_share
from smd.doodle import Doodle, Recording
from smd.formats.frame import SourceFrame
from smd.formats.reading import format_frame
from smd.geometry.rotations import (
    inverse,
    multiply,
    quaternion_about,
    quaternion_from_rotvec,
    rotate,
)
from smd.smoothing import RATE_HZ

RECORDINGS = Path(__file__).parents[2] / "recordings"
OURS = Asked({}, SourceFrame.ours(), 0.175)


@pytest.fixture(scope="module")
def library():
    return smd.Cast(smd.load_library())


def story(name: str = "postman") -> Recording:
    return smd.read_recording(RECORDINGS / f"{name}.csv")


def changed(recording: Recording, change) -> Recording:
    return replace(recording, doodles=tuple(change(doodle) for doodle in recording.doodles))


def held(axis, angle_rad):
    """The tracker sits on the prop turned about one of the prop's axes."""
    turn = quaternion_about(axis, angle_rad)
    return lambda d: replace(d, orientation_xyzw=multiply(d.orientation_xyzw, turn))


def lying(doodle: Doodle) -> Doodle:
    """A file of the same movement whose world has Z up, as CAD has it."""
    turn = quaternion_about([1.0, 0.0, 0.0], np.pi / 2)
    seen = multiply(turn, doodle.orientation_xyzw)
    return replace(
        doodle,
        position_m=rotate(turn, doodle.position_m),
        orientation_xyzw=multiply(seen, inverse(turn)),
    )


MISTAKES = {
    "back to front": (held([0.0, 1.0, 0.0], np.pi), "--mount yaw=180"),
    "facing left": (held([0.0, 1.0, 0.0], np.pi / 2), "--mount yaw=-90"),
    "upside down": (held([0.0, 0.0, 1.0], np.pi), "--mount roll=180"),
    "in centimetres": (lambda d: replace(d, position_m=100.0 * d.position_m), "--unit cm"),
    "in millimetres": (lambda d: replace(d, position_m=1000.0 * d.position_m), "--unit mm"),
    "Z up": (lying, "--up z"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
@pytest.mark.long
def test_the_option_that_mends_a_mistake_is_named_and_mends_it(library, tmp_path, mistake):
    change, option = MISTAKES[mistake]
    path = tmp_path / "story.csv"
    smd.write_recording(changed(story(), change), path)
    recording = smd.read_recording(path)
    asked = replace(OURS, format_frame=format_frame(path))
    better = better_reading(recording, smd.parse(recording, library), library, asked)
    assert str(better) == f"{option}: 7 phrases would be recognised"
    frame = SourceFrame.from_options(**dict(better.options))
    (part,) = smd.parse(smd.read_recording(path, frame), library).performers
    meant = smd.read_score(RECORDINGS / "postman.score.json").performers[0]
    assert [p.action for p in part.phrases] == [p.action for p in meant.phrases]


def test_what_was_said_is_kept_and_only_the_mistake_is_named(library):
    """A mount that steps to the prop's centre keeps its step."""
    frame = SourceFrame.from_options(mount="roll=180,y=0.02")
    recording = smd.read_recording(RECORDINGS / "postman.csv", frame)
    asked = replace(OURS, options={"mount": "roll=180,y=0.02"})
    better = better_reading(recording, smd.parse(recording, library), library, asked)
    assert better is not None
    assert better.options == (("mount", "y=0.02"),)


def test_a_story_that_is_understood_is_left_alone(library):
    recording = story("duel")
    score = smd.parse(recording, library)
    assert understood_share(recording, score) > 0.9
    assert better_reading(recording, score, library, OURS) is None


def test_a_command_is_told_only_of_options_that_it_has(library):
    recording = changed(story(), lying)
    score = smd.parse(recording, library)
    assert better_reading(recording, score, library, OURS, only=("mount",)) is None


def wandering(seed: int, seconds: float = 20.0) -> Recording:
    """A hand that plays freely: smooth, never resting, no gesture."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(0.0, seconds, 1.0 / RATE_HZ)
    knots_s = np.arange(-1.0, seconds + 1.0, 0.35)
    wave = lambda size: np.stack(  # noqa: E731
        [np.interp(time_s, knots_s, size * rng.standard_normal(len(knots_s))) for _ in range(3)], 1
    )
    kernel = np.hanning(21) / np.hanning(21).sum()
    soft = lambda x: np.stack([np.convolve(c, kernel, "same") for c in x.T], 1)  # noqa: E731
    orientation_xyzw = quaternion_from_rotvec(soft(wave(0.6)))
    return Recording((Doodle(time_s, soft(wave(0.25)), orientation_xyzw),), f"wandering {seed}")


@pytest.mark.parametrize("seed", range(3))
def test_free_play_gets_no_false_advice(library, seed):
    recording = wandering(seed)
    assert better_reading(recording, smd.parse(recording, library), library, OURS) is None


def test_nothing_is_advised_where_nothing_moves(library):
    time_s = np.arange(0.0, 5.0, 1.0 / RATE_HZ)
    upright = np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1))
    recording = Recording((Doodle(time_s, np.zeros((len(time_s), 3)), upright),))
    assert better_reading(recording, smd.parse(recording, library), library, OURS) is None


@pytest.mark.parametrize("name", ["dance", "grabLeft", "grabRight", "dev-recording"])
def test_real_free_play_gets_no_false_advice(library, shared_data, name):
    path = shared_data / "controllers" / "aframe" / "raw" / f"{name}.json"
    recording = smd.read_recording(path)
    asked = replace(OURS, format_frame=format_frame(path))
    assert better_reading(recording, smd.parse(recording, library), library, asked) is None


def test_all_24_ways_to_hold_a_prop_are_tried_but_the_present_one():
    turns = [options["mount"] for options in axes_otherwise(OURS) if "mount" in options]
    matrices = {
        tuple(np.round(SourceFrame.from_options(mount=turn).mount.tracker_from_prop_xyzw, 6) ** 2)
        for turn in turns
    }
    assert len(turns) == len(set(turns)) == 23
    assert len(matrices) > 8  # squares alone do not tell a turn from its inverse
    assert {"unit": "cm"} in list(size_otherwise(OURS))
