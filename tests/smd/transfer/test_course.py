from __future__ import annotations

import numpy as np
import pytest

from smd.score import Part, Phrase
from smd.transfer.course import course
from smd.transfer.pacing import core_frame
from smd.transfer.path import GroundPath
from smd.transfer.repertoire import Repertoire
from smd.transfer.timeline import timeline
from tests.naive.running_offset import transferred


@pytest.fixture(scope="module")
def pieces(make_piece) -> Repertoire:
    gait = {"cyclic": True, "travels": True, "left_stands": (0.0, 0.6), "right_stands": (0.5, 0.98)}
    never = {"left_stands": (2.0, 3.0), "right_stands": (2.0, 3.0)}
    made = [
        make_piece("idle", frames=121, cyclic=True),
        make_piece("walk", ahead_m=1.4, **gait),
        make_piece("run", frames=43, ahead_m=2.4, **gait),
        make_piece("fly", ahead_m=3.0, cyclic=True, travels=True, **never),
        make_piece("jump", ahead_m=1.2, travels=True, stages=(0.1, 0.4, 0.7, 0.8)),
        make_piece("punch", frames=91),
        make_piece("turn_left", turn_rad=1.6),
    ]
    return Repertoire({piece.clip.name: piece for piece in made}, ())


def wandering(seed: int, seconds: float = 20.0) -> GroundPath:
    rng = np.random.default_rng(seed)
    time_s = np.linspace(0.0, seconds, round(seconds * 60) + 1)
    waves = [
        rng.normal(size=2) * np.sin(w * time_s[:, None] + rng.uniform(0.0, 6.0, 2))
        for w in (0.5, 1.1, 1.9)
    ]
    return GroundPath(time_s, sum(waves), 0.8 * np.sin(0.7 * time_s) + rng.normal())


def random_part(rng: np.random.Generator, seconds: float = 20.0) -> Part:
    actions = ["walk", "run", "fly", "jump", "punch"]
    cuts = np.sort(rng.uniform(0.0, seconds, 16)).round(3)
    phrases = [
        Phrase(str(rng.choice(actions)), a, b)
        for a, b in zip(cuts[::2], cuts[1::2], strict=True)
        if b - a > 0.2
    ]
    return Part("fox", tuple(phrases))


def moves_of(part: Part, path: GroundPath, pieces: Repertoire):
    return course(timeline(part.phrases, 0.0, 20.0), path, pieces, clock_s=0.0)


@pytest.mark.parametrize("seed", range(10))
def test_places_are_those_of_the_paper_s_running_offset(pieces, seed):
    rng = np.random.default_rng(seed)
    path, part = wandering(seed), random_part(rng)
    moves = moves_of(part, path, pieces)
    starts = [0.0, *(move.end_s for move in moves[:-1])]
    # A short gap before a phrase is waited through, unless a gait fills it.
    chunks, edges = [], []
    phrases = iter(part.phrases)
    for start_s, move in zip(starts, moves, strict=True):
        if move.start_s > start_s:
            chunks.append((False, [start_s, move.start_s]))
        first = len(chunks)
        # A jump has gone its way by the phrase's end; the body comes back in the pause.
        until_s = move.end_s if move.idles else min(next(phrases).end_s, move.end_s)
        chunks.append((move.piece.travels and not move.idles, [move.start_s, until_s]))
        if until_s < move.end_s:
            chunks.append((False, [until_s, move.end_s]))
        edges.append((first, len(chunks) - 1))
    points = transferred([(travels, path.at(np.array(t)).tolist()) for travels, t in chunks])
    for move, (first, last) in zip(moves, edges, strict=True):
        assert move.root_m[0] == pytest.approx(points[first][0], abs=1e-9)
        assert move.root_m[-1] == pytest.approx(points[last][-1], abs=1e-9)


def test_after_an_in_place_action_the_character_goes_on_from_where_it_stood(pieces):
    time_s = np.linspace(0.0, 20.0, 1201)
    way = time_s + 3.0 * np.clip(time_s - 5.0, 0.0, 2.0)  # the punch drags the prop 6 m along
    path = GroundPath(time_s, np.stack([0.0 * way, way], axis=-1), 0.0 * way)
    part = Part("fox", (Phrase("walk", 0, 5), Phrase("punch", 5, 7), Phrase("walk", 7, 10)))
    walk, punch, onward, _ = moves_of(part, path, pieces)
    assert walk.end.position_m == pytest.approx([0.0, 5.0])
    assert (punch.root_m == walk.end.position_m).all()
    assert onward.root_m[0] == pytest.approx(walk.end.position_m)
    assert onward.end.position_m == pytest.approx([0.0, 8.0])


def test_what_the_prop_does_unrecognised_moves_nobody(pieces):
    path = wandering(3)
    (idling,) = moves_of(Part("fox"), path, pieces)
    assert (idling.root_m == path.at(0.0)).all()
    assert np.ptp(idling.heading_rad) == 0.0


@pytest.mark.parametrize("seed", range(10))
def test_every_phrase_lasts_exactly_as_long_as_its_span(pieces, seed):
    part = random_part(np.random.default_rng(seed))
    moves = [m for m in moves_of(part, wandering(seed), pieces) if not m.idles]
    for i, (move, phrase) in enumerate(zip(moves, part.phrases, strict=True)):
        core = core_frame(move.piece.clip)
        if move.end_s != phrase.end_s:  # the body comes back in the pause
            after = [later.start_s for later in part.phrases[i + 1 :]]
            pause_s = min(after, default=20.0) - phrase.end_s
            assert phrase.end_s < move.end_s < phrase.end_s + 0.61 * pause_s
            assert move.frame_at(np.array([phrase.end_s]))[0] > core - 1e-6
        assert move.piece.clip.name == phrase.action
        gap_s = phrase.start_s - move.start_s
        assert gap_s == 0.0 or (move.piece.gait and 0.0 < gap_s < 0.3)


@pytest.mark.parametrize("seed", range(10))
def test_a_travelling_phrase_faces_where_the_prop_faces(pieces, seed):
    path = wandering(seed)
    part = random_part(np.random.default_rng(seed))
    for move in moves_of(part, path, pieces):
        if move.piece.travels and not move.idles:
            until_s = next((p.end_s for p in part.phrases if p.end_s > move.start_s), move.end_s)
            ends_s = np.array([move.start_s, min(until_s, move.end_s)])
            at = move.heading_at(ends_s) - path.heading_at(ends_s)
            assert np.exp(1j * at) == pytest.approx(np.ones(2), abs=1e-9)


def test_a_gesture_faces_where_the_prop_faces_at_its_start(pieces):
    path = wandering(4)
    part = Part("fox", (Phrase("punch", 3.0, 4.5),))
    before, punch, after = moves_of(part, path, pieces)
    assert before.heading_rad[-1] == pytest.approx(path.heading_at(3.0))
    assert punch.heading_rad == pytest.approx(np.full(len(punch.heading_rad), path.heading_at(3.0)))
    assert after.heading_rad == pytest.approx(np.full(len(after.heading_rad), path.heading_at(3.0)))


@pytest.mark.parametrize("turn_rad", [0.5, 1.4, 3.0, 5.0])
def test_a_turn_ends_where_the_prop_faces(pieces, turn_rad):
    time_s = np.linspace(0.0, 20.0, 1201)
    heading = turn_rad * np.clip((time_s - 4.0) / 2.0, 0.0, 1.0) + 1.0
    path = GroundPath(time_s, np.zeros((1201, 2)), heading)
    moves = moves_of(Part("fox", (Phrase("turn_left", 4.0, 6.0),)), path, pieces)
    turns = [move for move in moves if not move.idles]
    assert turns[0].start_s == 4.0
    assert turns[-1].end_s == pytest.approx(6.0)
    assert moves[-1].heading_rad[0] == pytest.approx(1.0 + turn_rad)


def test_from_walk_into_run_the_same_foot_passes_and_the_pace_is_kept(pieces, straight_path):
    part = Part("fox", (Phrase("walk", 2.0, 5.0), Phrase("run", 5.0, 8.0)))
    _, walk, run, _ = moves_of(part, straight_path, pieces)
    walked, ran = walk.frame[-1] / walk.piece.last_frame, run.frame[0] / run.piece.last_frame
    feet = [
        min(gait.passings, key=lambda p, at=at: abs((p.phase - at + 0.5) % 1.0 - 0.5)).foot
        for gait, at in ((walk.piece.gait, walked), (run.piece.gait, ran))
    ]
    assert feet[0] == feet[1]
    speeds = [np.linalg.norm(np.diff(m.root_m, axis=0), axis=-1) * 120.0 for m in (walk, run)]
    assert speeds[0][-1] == pytest.approx(speeds[1][0], rel=0.15)


def test_a_gait_fills_the_short_gap_after_another(pieces, straight_path):
    part = Part("fox", (Phrase("walk", 2.0, 5.0), Phrase("walk", 5.2, 8.0)))
    _, _, second, _ = moves_of(part, straight_path, pieces)
    assert second.start_s == 5.0
    assert second.end.position_m == pytest.approx([0.0, 8.0 - 2.0 + 0.0])
