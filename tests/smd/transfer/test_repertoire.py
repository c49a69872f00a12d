"""Repertoire: pieces that are prepared together are those prepared one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import Effort
from smd.acting.legs import feet_of, legs_of
from smd.character.mass import mass_of
from smd.score import Phrase
from smd.transfer.repertoire import piece_name, pieces_of, repertoire

LIBRARY = load_library()
SKELETON = LIBRARY.character.skeleton
LEGS = legs_of(SKELETON, feet_of(LIBRARY.clip("walk")))
EFFORTS = (Effort(0.8, -0.6, 0.5, -0.7), Effort(-0.8, 0.9, -1.0, 1.0), Effort(weight=0.4))


@pytest.mark.parametrize("name", ["punch", "roll", "turn_left", "jump", "walk", "crawl"])
def test_pieces_prepared_together_are_those_prepared_one_by_one(name):
    clip, travels = LIBRARY.clip(name), LIBRARY.action(name).travels
    clips = [
        clip,
        replace(clip, rotation_xyzw=clip.rotation_xyzw[::-1], contacts=clip.contacts[::-1]),
        replace(clip, translation_m=1.1 * clip.translation_m),
    ]
    given = {"travels": travels, "legs": LEGS, "mass": mass_of(SKELETON)}
    (neutral,) = pieces_of(clips[:1], **given)
    one_by_one = [pieces_of([clip], neutral=neutral, **given)[0] for clip in clips[1:]]
    for made, alone in zip(pieces_of(clips, **given), [neutral, *one_by_one], strict=True):
        assert made.clip is alone.clip
        assert (made.gait, made.near, made.touching) == (alone.gait, alone.near, alone.touching)
        np.testing.assert_array_equal(made.stands, alone.stands)
        assert (made.airborne is None) == (alone.airborne is None)
        for one, other in (
            (made.yaw_rad, alone.yaw_rad),
            (made.root.position_m, alone.root.position_m),
            (made.root.yaw_rad, alone.root.yaw_rad),
            *(
                (getattr(made.body, part), getattr(alone.body, part))
                for part in ("centre_m", "aside_m_s2", "up_m_s2", "down_m_s2")
            ),
        ):
            np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12)


def test_each_effort_of_a_phrase_has_a_piece_of_its_own():
    phrases = [
        Phrase(action, 2.0 * i, 2.0 * i + 1.0, effort)
        for i, (action, effort) in enumerate(
            (action, effort) for effort in EFFORTS for action in ("punch", "walk")
        )
    ]
    known = repertoire(LIBRARY, [*phrases, *phrases], expressiveness=1.0)
    for phrase in phrases:
        piece = known.of(phrase)
        assert piece is known.pieces[piece_name(phrase.action, phrase.effort, 1.0)]
        assert piece is not known.pieces[phrase.action]
        assert len(piece.clip) == len(LIBRARY.clip(phrase.action))
    assert len(set(map(id, known.pieces.values()))) == len(known.pieces)
