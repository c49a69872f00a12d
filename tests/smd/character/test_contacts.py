from __future__ import annotations

import numpy as np
import pytest

from actions_library.folder import load_library
from smd.character.contacts import contacts
from smd.character.kinematics import forward_kinematics

RATE_HZ, LEG_M = 60.0, 0.9


def test_a_foot_that_stands_lifts_and_lands():
    t = np.arange(120) / RATE_HZ
    up = np.clip((t - 0.5) / 0.5, 0.0, 1.0)
    path = np.zeros((120, 1, 3))
    path[:, 0, 1] = 0.1 + 0.3 * np.sin(np.pi * up)
    path[:, 0, 2] = 0.8 * up
    touching = contacts(path, [0.1], RATE_HZ, LEG_M)[:, 0]
    assert touching[:29].all() and touching[62:].all()
    assert not touching[33:57].any()


@pytest.mark.parametrize("scale", [0.1, 1.0, 10.0])
def test_the_size_of_the_body_does_not_matter(scale):
    rng = np.random.default_rng(0)
    path = np.cumsum(rng.normal(0.0, 0.002, (200, 2, 3)), axis=0)
    one = contacts(path, [0.0, 0.0], RATE_HZ, LEG_M)
    np.testing.assert_array_equal(contacts(scale * path, [0.0, 0.0], RATE_HZ, scale * LEG_M), one)


def test_a_flicker_is_none():
    path = np.zeros((60, 1, 3))
    path[30, 0, 1] = 0.5
    assert contacts(path, [0.0], RATE_HZ, LEG_M).all()


def test_the_shipped_clips_labels_are_found_again():
    """Authored labels are of whole soles and rolled toes; what is found is a little more."""
    library = load_library()
    right = found = wanted = 0
    for clip in library.clips.values():
        feet = [j for j in clip.contact_joints if "foot" in j or "toes" in j]
        if not feet:
            continue
        _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
        at = [clip.skeleton.index(joint) for joint in feet]
        rest = clip.skeleton.world_from_bind[at, 1, 3]
        said = contacts(place[:, at], rest, clip.rate_hz, 0.87)
        authored = clip.contacts[:, [clip.contact_joints.index(joint) for joint in feet]]
        right += int((said & authored).sum())
        found += int(said.sum())
        wanted += int(authored.sum())
    assert right / found > 0.85
    assert right / wanted > 0.98


def test_without_joints_nothing_touches():
    assert contacts(np.zeros((5, 0, 3)), [], 30.0, 1.0).shape == (5, 0)
