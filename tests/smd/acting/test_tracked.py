"""Tracks follow the moves: their timing, their blend weights, and from one to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from smd.acting.act import grounded_actor
from smd.acting.move import Footwork, Move
from smd.acting.moving import Idling, tracked
from smd.acting.performance import Actor
from smd.character.clip import Clip
from smd.character.poses import Poses, sampled, sampled_tracks
from smd.character.tracks import NO_TRACKS, Tracks
from smd.errors import TransferError
from tests.naive.puppet import puppet, wave, waving_clip

FRAMES = 31


@dataclass(frozen=True, eq=False)
class Shown:
    """A clip of 31 frames that is played as it is."""

    clip: Clip

    def sampled(self, frame: np.ndarray) -> Poses:
        return sampled(self.clip, frame)

    def tracks_at(self, frame: np.ndarray) -> Tracks:
        return sampled_tracks(self.clip, frame)

    def stands_at(self, frame: np.ndarray) -> Footwork:
        return Footwork(np.zeros((len(frame), 2), bool), np.zeros((len(frame), 2)))


def shown(**value: np.ndarray) -> Shown:
    column = [np.broadcast_to(np.asarray(each, float), FRAMES) for each in value.values()]
    tracks = Tracks(tuple(value), np.stack(column, axis=-1)) if value else NO_TRACKS
    return Shown(replace(waving_clip(frames=FRAMES), tracks=tracks))


def move(piece: Shown, start_s: float, end_s: float, presence: float = 1.0) -> Move[Shown]:
    time_s = np.array([start_s, end_s])
    ends = np.zeros((2, 2))
    frame = np.array([0.0, FRAMES - 1.0])
    return Move(piece, start_s, end_s, time_s, ends, ends[:, 0], frame, np.full(2, presence))


RAMP = np.linspace(0.0, 1.0, FRAMES)
NOTHING = Idling(shown(), 30.0, 0.0)
TIME_S = np.linspace(0.0, 4.0, 401)


def test_tracks_are_played_at_the_move_s_own_pace():
    tracks = tracked([move(shown(smile=RAMP), 0.0, 4.0)], TIME_S, NOTHING)
    assert tracks.names == ("smile",)
    assert tracks.value[:, 0] == pytest.approx(TIME_S / 4.0, abs=1e-12)


def test_between_moves_a_track_leads_from_one_to_the_other_without_a_jump():
    moves = [move(shown(smile=RAMP), 0.0, 2.0), move(shown(jaw=0.5 + 0.5 * RAMP), 2.0, 4.0)]
    tracks = tracked(moves, TIME_S, NOTHING)
    assert tracks.names == ("smile", "jaw")
    smile, jaw = tracks.value.T
    assert smile[:200] == pytest.approx(TIME_S[:200] / 2.0)
    assert smile[200] == pytest.approx(1.0)
    assert jaw[199:201] == pytest.approx([0.0, 0.0])
    own = 0.5 + 0.5 * (TIME_S - 2.0) / 2.0
    late = TIME_S > 2.0 + 0.7  # a third of a move is the most that a transition takes
    assert jaw[late] == pytest.approx(own[late])
    assert smile[late] == pytest.approx(0.0)
    assert np.abs(np.diff(tracks.value, axis=0)).max() < 0.1


@pytest.mark.parametrize("seed", range(5))
def test_a_transition_never_leaves_the_values_that_it_leads_between(seed):
    """A smile at 1 and a rising one must not add up to 2."""
    rng = np.random.default_rng(seed)
    one, two = rng.uniform(size=(2, FRAMES))
    tracks = tracked([move(shown(a=one), 0, 2), move(shown(a=two), 2, 4)], TIME_S, NOTHING)
    own = np.interp((TIME_S[200:] - 2.0) / 2.0, np.linspace(0.0, 1.0, FRAMES), two)
    low, high = np.minimum(own, one[-1]), np.maximum(own, one[-1])
    assert (tracks.value[200:, 0] >= low - 1e-12).all()
    assert (tracks.value[200:, 0] <= high + 1e-12).all()


def test_where_a_move_is_faint_the_idle_clip_s_tracks_are_seen():
    idling = Idling(shown(smile=0.2, breath=1.0), 30.0, 0.0)
    tracks = tracked([move(shown(smile=1.0), 0.0, 4.0, presence=0.25)], TIME_S, idling)
    assert tracks.of(["smile"]) == pytest.approx(0.25 * 1.0 + 0.75 * 0.2)
    assert tracks.of(["breath"]) == pytest.approx(0.75)


def test_clips_without_tracks_give_none():
    assert tracked([move(shown(), 0.0, 4.0)], TIME_S, NOTHING).names == ()


def test_tracks_of_another_length_are_no_actor_s():
    poses = Poses(*wave(12))
    footwork = Footwork(np.ones((12, 0), bool), np.zeros((12, 0)))
    tracks = Tracks(("smile",), np.zeros((11, 1)))
    with pytest.raises(TransferError, match="tracks: expected 12 frames, got 11"):
        Actor("a", puppet(), poses, tracks=tracks)
    with pytest.raises(TransferError, match="tracks: expected 12 frames, got 11"):
        grounded_actor("a", puppet(), poses, footwork, (), rate_hz=30.0, tracks=tracks)
    whole = Tracks(("smile",), np.ones((12, 1)))
    actor = grounded_actor("a", puppet(), poses, footwork, (), rate_hz=30.0, tracks=whole)
    assert actor.tracks.of(["smile"]).tolist() == [[1.0]] * 12
