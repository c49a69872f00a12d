"""Legs that are not people's: bent backward or outward, short, many."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.acting.act import grounded_actor
from smd.acting.legs import feet_of, legs_of
from smd.acting.move import Footwork
from smd.character.kinematics import forward_kinematics
from smd.character.poses import Poses

SHIPPED = Path(__file__).parents[3] / "actions_library"


def stood(name, *, aside_m=0.0):
    """An idle pose for a second, moved aside, put on the ground: poses before and after, legs."""
    library = load_library(SHIPPED / name)
    clip = library.clip("idle")
    legs = legs_of(clip.skeleton, feet_of(clip))
    rotation, translation = (
        np.repeat(part[:1], 61, axis=0) for part in (clip.rotation_xyzw, clip.translation_m)
    )
    translation[:, 1, 0] += aside_m * np.linspace(0.0, 1.0, 61)
    footwork = Footwork(np.ones((61, len(legs)), bool), np.zeros((61, len(legs))))
    before = Poses(rotation, translation)
    actor = grounded_actor(name, library.character, before, footwork, legs, rate_hz=60.0)
    return clip.skeleton, before, actor.poses, legs


@pytest.mark.parametrize("name", ["dog", "caterpillar", "humanoid"])
def test_knees_of_legs_that_stand_well_stay_where_they_are(name):
    skeleton, before, after, legs = stood(name)
    knees = [leg.lower for leg in legs]
    then, now = (forward_kinematics(skeleton, *poses)[1][:, knees] for poses in (before, after))
    np.testing.assert_allclose(now, then, atol=0.008)
