"""A Score that a person edited: each edit does just that, and nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import smd
from laban import Effort
from smd.acting.performance import Performance
from smd.formats import read_recording
from smd.score import Part, Phrase
from smd.score_file import read_score

STORIES = Path(__file__).parents[3] / "recordings"
LIBRARY = smd.load_library()
RECORDING = read_recording(STORIES / "duel.csv")
SCORE = read_score(STORIES / "duel.score.json")
RATE_HZ = 60.0
TRANSITION_S = 0.3
LEGS = ("leg", "foot", "toes")
UPPER = [
    j
    for j, name in enumerate(LIBRARY.character.skeleton.joints)
    if j > 0 and not any(part in name for part in LEGS)
]
"""What feet do not move; the pelvis sinks for them."""


def performed(part: Part) -> Performance:
    score = replace(SCORE, performers=(part, *SCORE.performers[1:]))
    return smd.animate(score, RECORDING, LIBRARY, rate_hz=RATE_HZ, timing="drawn")


BEFORE = performed(SCORE.performers[0])


def with_phrases(phrases: list[Phrase]) -> Part:
    return replace(SCORE.performers[0], phrases=tuple(phrases))


def edited(index: int, edit: str) -> Part:
    """Return the knight's part with one phrase edited."""
    phrases = list(SCORE.performers[0].phrases)
    phrase = phrases[index]
    if edit == "other action":
        phrases[index] = replace(phrase, action="bow" if phrase.action == "wave" else "wave")
    elif edit == "other Effort":
        phrases[index] = replace(phrase, effort=Effort(time=-0.8, weight=0.9, space=-0.5, flow=0.5))
    elif edit == "moved boundary":
        phrases[index] = replace(phrase, end_s=phrase.end_s - 0.2)
    elif edit == "removed":
        del phrases[index]
    elif edit == "new":
        pause_s = (phrase.end_s, phrases[index + 1].start_s)
        middle = [float(x) for x in np.interp([0.3, 0.7], [0.0, 1.0], pause_s)]
        phrases.insert(index + 1, Phrase("nod", *middle))
    return with_phrases(phrases)


def turned_deg(one: Performance, other: Performance) -> np.ndarray:
    """Return how far the knight's joints are turned apart, ``(n, j)``, but for the ground root."""
    a, b = (performance.actors[0].poses.rotation_xyzw for performance in (one, other))
    dots = np.minimum(np.abs(np.sum(a * b, axis=-1)), 1.0)
    apart = np.degrees(2.0 * np.arccos(dots))
    apart[:, 0] = 0.0
    return apart


@pytest.mark.parametrize(
    "edit", ["other action", "other Effort", "moved boundary", "removed", "new"]
)
@pytest.mark.parametrize("index", [1, 2, 4, 5])
def test_what_was_not_edited_stays(index, edit):
    phrases = SCORE.performers[0].phrases
    after = performed(edited(index, edit))
    time_s = BEFORE.start_s + np.arange(len(BEFORE)) / RATE_HZ
    apart = turned_deg(BEFORE, after)
    assert apart.max() > 2.0  # something was edited
    # The body comes back from the phrase before in the pause, and goes over into the next one.
    begins_s = phrases[index].end_s if edit == "new" else phrases[index - 1].end_s
    ends_s = phrases[index + 1].start_s + TRANSITION_S
    elsewhere = (time_s <= begins_s) | (time_s >= ends_s)
    assert apart[elsewhere][:, UPPER].max() < 0.1
    # A foot stands where it does on average, also before and after what was edited.
    assert apart[elsewhere].max() < 4.0
    # The others do not care, and the way goes on as it went from where it has come to.
    for one, other in zip(BEFORE.actors[1:], after.actors[1:], strict=True):
        np.testing.assert_array_equal(one.poses.rotation_xyzw, other.poses.rotation_xyzw)
        np.testing.assert_array_equal(one.poses.translation_m, other.poses.translation_m)
    for rows in (time_s <= begins_s, time_s >= ends_s):
        ways = [np.diff(p.actors[0].poses.translation_m[rows, 0], axis=0) for p in (BEFORE, after)]
        np.testing.assert_allclose(*ways, atol=1e-3)
