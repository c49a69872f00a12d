from __future__ import annotations

import numpy as np
import pytest

from smd.doodle import Doodle, Recording
from smd.pipeline import animate
from smd.score import Part, Phrase, Score

RATE_HZ = 90.0


def taken(library, speed_m_s, action="walk", phrases=1, warnings=()):
    """The warnings of a performance, as drawn, of straight ways at a speed, with pauses."""
    scale = library.character.height_m / 0.175
    time_s = np.arange(round((1.0 + 4.0 * phrases) * RATE_HZ) + 1) / RATE_HZ
    way = np.zeros_like(time_s)
    for i in range(phrases):
        way += np.clip(time_s - (1.0 + 4.0 * i), 0.0, 3.0) * speed_m_s / scale
    place = np.stack([0.0 * way, 0.8 + 0.0 * way, way], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(way), 1)), "fox")
    spoken = tuple(Phrase(action, 1.0 + 4.0 * i, 4.0 + 4.0 * i) for i in range(phrases))
    score = Score((Part("fox", spoken),), warnings=warnings)
    return animate(score, Recording((doodle,)), library, timing="drawn").warnings


@pytest.mark.parametrize(("action", "speed"), [("walk", 1.3), ("walk", 0.5), ("run", 4.0)])
def test_what_people_do_is_not_warned_of(library, action, speed):
    assert taken(library, speed, action) == ()


def test_a_walk_that_ought_to_run_is_warned_of_once_for_all_its_phrases(library):
    (line,) = taken(library, 4.0, phrases=3)
    assert line.startswith("device 'fox': walk at 1.00 s: expected up to 140 steps a minute, the ")
    assert line.endswith(" (the most of 3 phrases)")
    asked = float(line.split("asks for ")[1].split(" ")[0])
    # 4 m/s in strides of 1.25 times 1.4 m, two steps each; it gets going and comes to rest too.
    assert asked == pytest.approx(60.0 * 2.0 * 4.0 / (1.25 * 1.4), rel=0.15)


def test_a_walk_without_a_way_is_done_on_the_spot_and_said_so(library):
    (line,) = taken(library, 0.0)
    assert line == (
        "device 'fox': walk at 1.00 s: expected a way of 0.05 m on the stage, found 0.00 m; "
        "it is done on the spot"
    )


def test_the_scores_own_warnings_come_first_and_none_comes_twice(library):
    once = taken(library, 4.0, warnings=("lost",))
    assert once[0] == "lost"
    assert taken(library, 4.0, warnings=once) == once


def test_a_phrase_too_short_for_its_clip_is_warned_of(library):
    time_s = np.arange(round(8.0 * RATE_HZ) + 1) / RATE_HZ
    place = np.tile([0.0, 0.8, 0.0], (len(time_s), 1))
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)), "fox")
    length_s = library.clip("bow").duration_s

    def said(pace: float) -> tuple[str, ...]:
        score = Score((Part("fox", (Phrase("bow", 1.0, 1.0 + length_s / pace),)),))
        return animate(score, Recording((doodle,)), library, timing="drawn").warnings

    assert said(2.8) == ()
    (line,) = said(4.0)
    assert line == (
        "device 'fox': bow at 1.00 s: expected up to 3 times its clip's pace, the phrase asks "
        "for 4.0"
    )
