"""Effort changes when tracks are played, and nothing else of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import Effort
from smd.character.tracks import Tracks
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import study_of

LIBRARY = load_library()
BODY = body_of(LIBRARY.clip("idle"))


@pytest.mark.parametrize("name", ["punch", "bow", "jump", "walk"])
@pytest.mark.parametrize("effort", [Effort(1.0, 1.0), Effort(-1.0, -1.0), Effort(0.5, -0.5)])
def test_tracks_go_through_the_timing_of_their_clip(name, effort):
    """A track that counts frames tells which of them is shown: stages end where they did."""
    clip, travels = LIBRARY.clip(name), LIBRARY.action(name).travels
    count = np.arange(len(clip), dtype=float)
    counting = replace(clip, tracks=Tracks(("frame",), count[:, None]))
    (played,) = expressive(study_of(counting, BODY), [effort], travels=travels)
    (without,) = expressive(study_of(clip, BODY), [effort], travels=travels)
    np.testing.assert_allclose(played.rotation_xyzw, without.rotation_xyzw, atol=1e-9)
    (shown,) = played.tracks.value.T
    assert shown[[0, -1]] == pytest.approx([0.0, len(clip) - 1.0])
    assert (np.diff(shown) >= 0.0).all()
    if not clip.cyclic:
        assert np.abs(shown - count).max() > 2.0
        step = np.diff(shown).max()
        assert shown[played.stage_end_frames] == pytest.approx(clip.stage_end_frames, abs=step)
