from __future__ import annotations

import numpy as np
import pytest

from exporters.bounds import body_boxes
from smd.character.kinematics import forward_kinematics
from smd.character.skinning import skin_points
from smd.character.tracks import Tracks
from smd.geometry.rotations import normalized
from tests.naive.puppet import puppet
from tests.naive.shaped import NAMES, shaped_puppet, weights_of


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


@pytest.mark.parametrize("seed", range(10))
def test_the_box_holds_what_shapes_make_of_the_skin(seed):
    rng = np.random.default_rng(seed)
    character = shaped_puppet()
    skeleton = character.skeleton
    rotation = normalized(rng.normal(size=(3, len(skeleton), 4)))
    translation = np.tile(skeleton.rest_translation_m, (3, 1, 1))
    tracks = Tracks((*NAMES, "gear"), rng.normal(size=(3, 4)))
    pose = forward_kinematics(skeleton, rotation, translation)
    boxes = body_boxes(character, rotation, translation, tracks)
    for mesh in character.meshes:
        points = skin_points(mesh, skeleton, *pose, weights_of(mesh, tracks))
        assert (boxes[:, 0] <= points.min(axis=1) + 1e-6).all()
        assert (boxes[:, 1] >= points.max(axis=1) - 1e-6).all()
