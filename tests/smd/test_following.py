"""Where nothing is recognised and the prop travels, the character goes along."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import smd
from smd.doodle import Doodle, Recording
from smd.errors import ScoreError
from smd.following import PREFERRED, going_along, paces
from smd.geometry.rotations import quaternion_about
from smd.score import Phrase
from smd.smoothing import RATE_HZ, smooth

RECORDINGS = Path(__file__).parents[2] / "recordings"
HEIGHT_M = 0.175
OTHERS = {"sneak", "crawl", "gallop_left", "gallop_right", "run_backward"}


@pytest.fixture(scope="module")
def library():
    return smd.load_library()


def travel(heights_s: float, *, seconds: float = 3.0, heading=0.7, aside_rad=0.0) -> Doodle:
    """A prop that faces one way, waits, goes evenly with its direction turned aside, and waits."""
    time_s = np.arange(0.0, seconds + 2.0, 1.0 / RATE_HZ)
    way_m = heights_s * HEIGHT_M * np.clip(time_s - 1.0, 0.0, seconds)
    angle = heading + aside_rad
    direction = np.array([np.sin(angle), 0.0, np.cos(angle)])
    orientation = np.tile(quaternion_about([0.0, 1.0, 0.0], heading), (len(time_s), 1))
    return Doodle(time_s, way_m[:, None] * direction, orientation)


def followed(doodle: Doodle, library, phrases=()):
    known = paces(library)
    return going_along(phrases, [smooth(doodle)], known, figure_height_m=HEIGHT_M)


@pytest.mark.parametrize(
    ("heights_s", "aside_rad", "action"),
    [
        (0.75, 0.0, "walk"),
        (2.0, 0.0, "run"),
        (0.45, np.pi, "walk_backward"),
        (0.4, np.pi / 2, "side_step_left"),
        (0.4, -np.pi / 2, "side_step_right"),
        (6.0, np.pi / 2, "run"),  # nobody steps sideways at ten metres a second
    ],
)
def test_the_gait_suits_the_pace_and_the_way(library, heights_s, aside_rad, action):
    (phrase,) = followed(travel(heights_s, aside_rad=aside_rad), library)
    assert (phrase.action, phrase.implied, phrase.confidence) == (action, True, 0.0)
    assert phrase.start_s == pytest.approx(1.0, abs=0.4)
    assert phrase.end_s == pytest.approx(4.0, abs=0.4)


def test_the_shipped_gaits_are_those_of_who_just_goes_along(library):
    assert {pace.action for pace in paces(library)} == set(PREFERRED)
    assert {pace.action for pace in paces(without(library, *PREFERRED))} == OTHERS


def without(library, *names):
    left = tuple(action for action in library.actions if action.name not in names)
    files = {name: file for name, file in library.exemplar_files.items() if name not in names}
    return replace(library, actions=left, exemplar_files=files)


def test_a_library_without_gaits_lets_the_character_stand(library):
    still = without(library, *PREFERRED, *OTHERS)
    assert followed(travel(0.75), still) == ()


@pytest.mark.parametrize("doodle", [travel(0.05), travel(0.75, seconds=0.5)])
def test_who_hardly_travels_is_not_followed(library, doodle):
    assert followed(doodle, library) == ()


def test_phrases_are_left_as_they_are_and_followed_around(library):
    bow = Phrase("bow", 5.0, 7.0)
    phrases = followed(travel(0.75, seconds=10.0), library, (bow,))
    assert bow in phrases
    assert [phrase.action for phrase in phrases] == ["walk", "bow", "walk"]
    for before, after in pairwise(phrases):
        assert before.end_s <= after.start_s


def test_a_score_that_follows_is_acted_out_and_the_character_gets_about(library, tmp_path):
    recording = Recording((travel(0.75, seconds=6.0),))
    left, follows = (
        smd.parse(recording, library, unexplained=how, tolerance=0.05)
        for how in ("leave", "follow")
    )
    (phrase,) = follows.performers[0].phrases
    assert phrase.implied
    assert follows.performers[0].suggestions == left.performers[0].suggestions
    smd.write_score(follows, tmp_path / "s.json")
    assert smd.read_score(tmp_path / "s.json").performers[0].phrases[0].implied
    ways = []
    for score in (left, follows):
        (actor,) = smd.animate(score, recording, library).actors
        root = actor.poses.translation_m[:, 0]
        ways.append(float(np.linalg.norm(root[-1] - root[0])))
    assert ways[0] == pytest.approx(0.0, abs=0.1)
    assert ways[1] == pytest.approx(0.75 * 6.0 * library.character.height_m, rel=0.05)


def test_a_story_that_is_recognised_is_the_same_when_followed(library):
    recording = smd.read_recording(RECORDINGS / "duel.csv")
    assert smd.parse(recording, library, unexplained="follow") == smd.parse(recording, library)


def test_another_way_to_go_on_is_refused(library):
    with pytest.raises(ScoreError, match="unexplained: expected leave or follow, got 'guess'"):
        smd.parse(Recording((travel(1.0),)), library, unexplained="guess")
