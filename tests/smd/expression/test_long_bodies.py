"""Effort of a body whose feet hang from its trunk, as a caterpillar's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library
from laban import Effort
from smd.character.kinematics import forward_kinematics
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import study_of

FOLDER = Path(__file__).parents[3] / "actions_library" / "caterpillar"
LIBRARY = load_library(FOLDER)


@pytest.mark.parametrize("axis", ["time", "weight", "space", "flow"])
@pytest.mark.parametrize("pole", [-1.0, 1.0])
def test_no_effort_bends_the_trunk_into_the_ground(axis, pole):
    clip = LIBRARY.clip("hump")
    study = study_of(clip, body_of(LIBRARY.clip("idle")))
    (shown,) = expressive(study, [Effort(**{axis: pole})], travels=True)
    segments = [j for j, name in enumerate(clip.skeleton.joints) if name.startswith("segment_")]

    def lowest_m(one):
        place = forward_kinematics(one.skeleton, one.rotation_xyzw, one.translation_m)[1]
        return place[:, segments, 1].min(axis=0)

    np.testing.assert_allclose(lowest_m(shown), lowest_m(clip), atol=0.002)


def test_weight_shows_in_both_feelers_alike():
    clip = LIBRARY.clip("walk")
    study = study_of(clip, body_of(LIBRARY.clip("idle")))
    (shown,) = expressive(study, [Effort(weight=1.0)], travels=True)
    left, right = (clip.skeleton.index(f"{side}_feeler") for side in ("left", "right"))

    def changed_deg(j):
        same = np.abs(np.sum(shown.rotation_xyzw[:, j] * clip.rotation_xyzw[:, j], axis=1))
        return np.degrees(2.0 * np.arccos(np.clip(same, 0.0, 1.0))).max()

    assert changed_deg(left) > 1.0
    assert changed_deg(left) == pytest.approx(changed_deg(right), rel=0.01)
