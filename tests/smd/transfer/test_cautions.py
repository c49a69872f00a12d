from __future__ import annotations

from dataclasses import replace

import smd
from smd.score import Phrase
from smd.synthetic.stories import duel


def test_a_phrase_too_short_for_its_clip_is_played_with_a_word_on_it():
    story, library = duel(), smd.load_library()
    part = story.score.performers[0]
    length_s, start_s = library.clip("bow").duration_s, part.phrases[0].start_s

    def warnings(pace: float) -> tuple[str, ...]:
        bow = Phrase("bow", start_s, start_s + length_s / pace)
        score = replace(story.score, performers=(replace(part, phrases=(bow,)),))
        return smd.animate(score, story.recording, library).score.warnings

    (line,) = warnings(4.0)
    assert f"'bow' at {start_s:.2f} s" in line
    assert "4.0 times as fast" in line
    assert warnings(2.5) == ()
