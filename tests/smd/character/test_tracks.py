from __future__ import annotations

import pickle

import numpy as np
import pytest

from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import CharacterError, TransferError


def two() -> Tracks:
    return Tracks(("smile", "jaw"), np.array([[0.0, 1.0], [0.5, 1.0], [0.5, 0.0]]))


def test_a_track_that_is_not_there_is_zero():
    assert two().of(["jaw", "brow"]).tolist() == [[1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]


def test_whole_frames_are_the_tracks_own_and_others_lie_on_straight_lines():
    assert two().at(np.array([0.0, 1.0, 2.0])).value.tolist() == two().value.tolist()
    between = two().at(np.array([0.5, 1.25]))
    assert between.names == ("smile", "jaw")
    assert between.value == pytest.approx(np.array([[0.25, 1.0], [0.5, 0.75]]))


def test_one_frame_is_held():
    one = Tracks(("smile",), np.array([[0.3]]))
    assert one.at(np.array([0.0, 0.0])).value.tolist() == [[0.3], [0.3]]


def test_tracks_are_parted_by_name():
    assert two().among(["jaw", "brow"]).names == ("jaw",)
    assert two().among(["jaw"]).value[:, 0].tolist() == [1.0, 1.0, 0.0]
    assert two().without(["jaw", "brow"]).names == ("smile",)


def test_without_names_they_fit_any_number_of_frames():
    assert NO_TRACKS.over(7).value.shape == (7, 0)
    assert NO_TRACKS.at(np.zeros(4)).value.shape == (4, 0)
    assert two().over(3) is not None


def test_tracks_of_another_length_are_refused():
    with pytest.raises(CharacterError, match="tracks: expected 4 frames, got 3"):
        two().over(4)
    with pytest.raises(TransferError, match="tracks: expected 4 frames, got 3"):
        two().over(4, TransferError)


@pytest.mark.parametrize(
    ("names", "value", "message"),
    [
        (("smile", "smile"), np.zeros((3, 2)), "'smile' appears twice"),
        (("smile",), np.zeros((3, 2)), r"expected shape \(any, 1\), got \(3, 2\)"),
        (("smile",), np.full((3, 1), np.nan), "expected finite numbers, got nan"),
        (("smile",), np.zeros(3), "expected shape"),
    ],
)
def test_what_is_no_track_is_refused(names, value, message):
    with pytest.raises(CharacterError, match=message):
        Tracks(names, value)


def test_tracks_are_frozen_here_and_in_another_process():
    given = np.zeros((2, 1))
    tracks = Tracks(("smile",), given)
    given[:] = 1.0
    for one in (tracks, pickle.loads(pickle.dumps(tracks))):
        assert one.value.tolist() == [[0.0], [0.0]]
        with pytest.raises(ValueError, match="read-only"):
            one.value[0] = 1.0


def test_ten_thousand_tracks_are_no_trouble():
    names = tuple(map(str, range(10_000)))
    many = Tracks(names, np.zeros((100, len(names))))
    assert many.of(names[::-1]).shape == (100, 10_000)
