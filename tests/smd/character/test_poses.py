from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from smd.character.poses import Poses, mixed, sampled, sampled_tracks
from smd.geometry.rotations import inverse as inverse_of
from smd.geometry.rotations import multiply, rotvec_from_quaternion, slerp
from tests.naive.shaped import shaped_clip


def angle(a, b):
    return np.linalg.norm(rotvec_from_quaternion(multiply(inverse_of(a), b)), axis=-1)


def test_whole_frames_are_the_clip_s_own_with_the_root_in_place(library):
    clip = library.clip("throw")
    poses = sampled(clip, np.arange(len(clip), dtype=float))
    assert poses.rotation_xyzw[:, 1:] == pytest.approx(clip.rotation_xyzw[:, 1:], abs=1e-9)
    assert poses.translation_m[:, 1:] == pytest.approx(clip.translation_m[:, 1:], abs=1e-9)
    assert (poses.translation_m[:, 0, [0, 2]] == 0.0).all()
    assert (poses.rotation_xyzw[:, 0] == [0.0, 0.0, 0.0, 1.0]).all()


def test_between_frames_the_linear_mix_is_the_spherical_one(library):
    clip = library.clip("punch")
    half = sampled(clip, np.arange(len(clip) - 1) + 0.5).rotation_xyzw[:, 1:]
    exact = slerp(clip.rotation_xyzw[:-1, 1:], clip.rotation_xyzw[1:, 1:], np.array(0.5))
    assert angle(half, exact).max() < 1e-6


def test_a_cyclic_clip_goes_on_and_any_other_holds_its_ends(library):
    walk, bow = library.clip("walk"), library.clip("bow")
    last = len(walk) - 1
    once, again = sampled(walk, np.array([7.25])), sampled(walk, np.array([7.25 + 3 * last]))
    assert again.rotation_xyzw == pytest.approx(once.rotation_xyzw, abs=1e-9)
    held = sampled(bow, np.array([-5.0, 1e6]))
    ends = sampled(bow, np.array([0.0, len(bow) - 1.0]))
    assert held.rotation_xyzw == pytest.approx(ends.rotation_xyzw)


def test_a_mix_goes_the_shorter_way_from_one_pose_to_the_other(library):
    a, b = (sampled(library.clip(name), np.array([20.0] * 3)) for name in ("walk", "bow"))
    flipped = Poses(-b.rotation_xyzw, b.translation_m)
    for other in (b, flipped):
        mix = mixed(a, other, np.array([0.0, 0.5, 1.0]))
        assert angle(mix.rotation_xyzw[0], a.rotation_xyzw[0]).max() < 1e-7
        assert angle(mix.rotation_xyzw[2], b.rotation_xyzw[2]).max() < 1e-7
        whole = angle(a.rotation_xyzw[1], b.rotation_xyzw[1])
        assert angle(a.rotation_xyzw[1], mix.rotation_xyzw[1]) == pytest.approx(whole / 2, abs=1e-7)
    assert mix.translation_m[1] == pytest.approx(0.5 * (a.translation_m[1] + b.translation_m[1]))


def test_tracks_are_sampled_where_the_poses_are():
    clip = shaped_clip(frames=31)
    frame = np.array([-3.0, 0.0, 7.5, 30.0, 99.0])
    once = sampled_tracks(clip, frame).value
    value = clip.tracks.value
    assert once == pytest.approx(
        np.array([value[0], value[0], 0.5 * (value[7] + value[8]), value[30], value[30]])
    )
    cycle = sampled_tracks(replace(clip, cyclic=True), frame + 60.0).value
    assert cycle[2] == pytest.approx(once[2])
