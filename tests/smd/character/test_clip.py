from __future__ import annotations

import numpy as np
import pytest

from smd.character.clip import Clip
from smd.character.skeleton import Skeleton
from smd.character.tracks import Tracks
from smd.errors import CharacterError


def stick() -> Skeleton:
    """A ground root and one joint above it."""
    return Skeleton(
        joints=("root", "tip"),
        parents=np.array([-1, 0]),
        rest_rotation_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (2, 1)),
        rest_translation_m=np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        world_from_bind=np.tile(np.eye(4), (2, 1, 1)),
        roles=("root", "end_effector"),
    )


def parts(n: int = 4) -> dict[str, object]:
    return {
        "name": "nod",
        "skeleton": stick(),
        "rate_hz": 60.0,
        "rotation_xyzw": np.tile([0.0, 0.0, 0.0, 1.0], (n, 2, 1)),
        "translation_m": np.zeros((n, 2, 3)),
        "stage_end_frames": [0, 1, 2, 2, n - 1],
        "contact_joints": ("tip",),
        "contacts": np.ones((n, 1), bool),
    }


def test_a_clip_lasts_from_its_first_to_its_last_frame():
    assert Clip(**parts(n=61)).duration_s == 1.0


def test_travel_is_the_root_s_distance_over_the_ground():
    translation = np.zeros((4, 2, 3))
    translation[-1, 0] = [3.0, 9.0, 4.0]
    translation[-1, 1] = [7.0, 7.0, 7.0]
    assert Clip(**parts() | {"translation_m": translation}).travel_m == 5.0


def test_flipped_quaternions_are_made_continuous():
    rotation = np.tile([0.0, 0.0, 0.0, 1.0], (4, 2, 1))
    rotation[1::2] *= -1.0
    got = Clip(**parts() | {"rotation_xyzw": rotation}).rotation_xyzw
    assert (np.sum(got[1:] * got[:-1], axis=-1) > 0).all()


def test_a_clip_cannot_be_changed_through_its_arrays():
    given = parts()
    clip = Clip(**given)
    with pytest.raises(ValueError, match="read-only"):
        clip.translation_m[0] = 1.0
    given["translation_m"][:] = 5.0  # type: ignore[index]
    assert (clip.translation_m == 0.0).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rate_hz": 0.0}, "rate_hz"),
        ({"rate_hz": np.nan}, "rate_hz"),
        ({"rotation_xyzw": np.zeros((4, 2, 4))}, "unit length"),
        ({"rotation_xyzw": np.zeros((4, 3, 4))}, r"\(any, 2, 4\)"),
        ({"translation_m": np.full((4, 2, 3), np.inf)}, "finite"),
        ({"translation_m": np.zeros((3, 2, 3))}, r"\(4, 2, 3\)"),
        ({"stage_end_frames": [0, 2, 1, 2, 3]}, "in order"),
        ({"stage_end_frames": [0, 1, 2, 2, 4]}, "the last 3"),
        ({"stage_end_frames": [-1, 1, 2, 2, 3]}, "in order"),
        ({"contact_joints": ("toe",)}, "'toe'"),
        ({"contacts": np.ones((4, 2), bool)}, "contacts"),
        ({"tracks": Tracks(("smile",), np.zeros((5, 1)))}, "tracks: expected 4 frames, got 5"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(change, message):
    with pytest.raises(CharacterError, match=message):
        Clip(**parts() | change)


def test_a_single_pose_is_no_clip():
    with pytest.raises(CharacterError, match="at least 2 frames"):
        Clip(**parts(n=1) | {"stage_end_frames": [0, 0, 0, 0, 0]})


def test_a_clip_without_tracks_has_none_in_each_frame():
    assert Clip(**parts(n=7)).tracks.value.shape == (7, 0)
