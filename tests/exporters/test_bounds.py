from __future__ import annotations

import numpy as np
import pytest

from exporters.bounds import body_boxes
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from tests.naive.puppet import puppet


@pytest.mark.parametrize("seed", range(10))
def test_the_box_holds_the_skin_in_any_pose(seed):
    rng = np.random.default_rng(seed)
    character = puppet()
    skeleton = character.skeleton
    rotation = rng.normal(size=(len(skeleton), 4))
    rotation /= np.linalg.norm(rotation, axis=-1, keepdims=True)
    translation = skeleton.rest_translation_m.copy()
    translation[0] = rng.normal(size=3)
    pose = forward_kinematics(skeleton, rotation, translation)
    points = skin_points(character.meshes[0], skeleton, *pose)
    ((low, high),) = body_boxes(character, rotation[None], translation[None])
    assert (low <= points.min(axis=0) + 1e-12).all()
    assert (high >= points.max(axis=0) - 1e-12).all()
