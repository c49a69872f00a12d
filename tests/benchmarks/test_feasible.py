"""What the table of feasible movement says is true of people, and of what was drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from actions_library.folder import load_library
from benchmarks.acted import acted, in_order, kind_of
from benchmarks.culprits import frames_of, print_culprits
from benchmarks.feasible import (
    GUARDS,
    PHYSICS,
    POP_M,
    figures_of,
    guards_of,
    physics_of,
)
from benchmarks.references import own_pace, real_takes
from benchmarks.transfer import stories
from smd.score import Score
from smd.transfer.pacing import EASED_S


def named(columns, numbers):
    """Return numbers by their columns' names; the first of each name."""
    found = {}
    for column, number in zip(columns, numbers, strict=True):
        found.setdefault(column.name, number)
    return found


@pytest.fixture(scope="module")
def library():
    return load_library()


@pytest.fixture(scope="module")
def duel(library):
    recording, score = next(stories())
    return recording, score, list(acted(recording, score, library, {"timing": "drawn"}))


def test_people_do_what_people_can(library, shared_data):
    takes = [one for _, one in real_takes(shared_data, library)]
    assert len(takes) == 4
    found = named(PHYSICS, physics_of(takes))
    assert found["acc"] < 8.0
    assert found["zmp"] < 35.0
    assert found[">20"] < 8.0
    assert found["fall"] == pytest.approx(1.0, abs=0.15)
    assert found["pop"] < 100.0 * POP_M


def test_a_clip_that_walks_needs_no_more_than_people_do(library):
    walk = named(PHYSICS, physics_of([dict(own_pace(library))["walk"]]))
    assert walk["acc"] < 4.0
    assert walk["feet"] < 35.0
    assert walk["root"] == pytest.approx(library.clip("walk").travel_m / 1.0, rel=0.5)


def test_every_drawn_phrase_has_its_moves(duel):
    _, score, performers = duel
    assert [one.moves != () for one in performers] == [True, True]
    for one, part in zip(performers, score.performers, strict=True):
        assert [beat.drawn for beat in one.beats] == list(part.phrases)
        assert all(beat.moves for beat in one.beats)
        assert one.misplaced == 0
        for beat in one.beats:
            assert {move.piece.clip.name for move in beat.moves} == {beat.drawn.action}


def test_drawn_timing_keeps_what_was_drawn(duel):
    _, _, performers = duel
    found = named(GUARDS, guards_of(performers))
    assert found["path"] < 1.0
    assert found["plan"] < 1.0
    assert found["way"] == pytest.approx(1.0, abs=0.05)
    assert found["moved"] < EASED_S
    assert found["lasts"] <= 1.0
    assert found["lost"] == 0
    assert len(physics_of([figures_of(one) for one in performers])) == len(PHYSICS)


def test_frames_belong_to_the_move_that_acts_then(duel):
    _, _, performers = duel
    for one in performers:
        now_s = one.start_s + one.mechanics.time_s
        for at, s in zip(one.at, now_s, strict=True):
            assert one.moves[at].start_s - 1e-9 <= s <= one.moves[at].end_s + 1e-9
        paused = np.array([kind_of(move) == "pause" for move in one.moves])[one.at]
        phrases = [beat.drawn for beat in one.beats]
        within = [any(p.start_s + 0.5 < s < p.end_s for p in phrases) for s in now_s]
        assert not (paused & np.array(within)).any()


def test_a_move_joins_for_a_third_of_a_phrase_and_no_longer_than_a_transition(duel):
    _, _, performers = duel
    for one in performers:
        now_s = one.start_s + one.mechanics.time_s
        for i, move in enumerate(one.moves[1:], start=1):
            since_s = now_s[one.joins & (one.at == i)] - move.start_s
            over_s = min(0.3, (move.end_s - move.start_s) / (1.0 if move.idles else 3.0))
            assert len(since_s) >= int(over_s * 24.0)
            assert since_s.max(initial=0.0) < over_s
        assert not one.joins[one.at == 0].any()


def test_what_is_drawn_elsewhere_is_off_its_path(library, duel):
    recording, score, performers = duel
    still = replace(
        recording,
        doodles=tuple(
            replace(doodle, position_m=doodle.position_m[:1] + 0.0 * doodle.position_m)
            for doodle in recording.doodles
        ),
    )
    held = list(acted(still, score, library, {"timing": "drawn"}))
    assert np.isnan(named(GUARDS, guards_of(held))["path"])  # no way was drawn
    assert named(GUARDS, guards_of(held))["gaits"] == 0
    assert named(GUARDS, guards_of(performers))["gaits"] > 0
    calm = physics_of([figures_of(one) for one in held])
    drawn = physics_of([figures_of(one) for one in performers])
    assert named(PHYSICS, calm)["root"] < 0.1 < named(PHYSICS, drawn)["root"]


def test_missing_and_swapped_phrases_are_counted():
    assert in_order(["walk", "punch", "walk"], ["walk", "punch", "walk"]) == 3
    assert in_order(["walk", "punch", "walk"], ["walk", "walk"]) == 2
    assert in_order(["walk", "punch"], ["punch", "walk"]) == 1


def test_the_culprits_are_named(duel, capsys):
    _, _, performers = duel
    print_culprits(performers, 3)
    lines = capsys.readouterr().out.splitlines()
    assert sum("worst moves" in line for line in lines) == 1
    worst = lines[-3:]
    assert all("m/s2" in line and " at " in line for line in worst)
    accelerations = [float(line.split()[0]) for line in worst]
    assert accelerations == sorted(accelerations, reverse=True)
    tops = [one.mechanics.level_m_s2.max() for one in performers]
    assert accelerations[0] == pytest.approx(max(tops), abs=0.05)


def test_every_frame_is_somebodys(duel):
    _, _, performers = duel
    frames = frames_of(performers)
    assert sum(map(len, frames.values())) == sum(len(one.at) for one in performers)
    paused = np.concatenate([of for deed, of in frames.items() if deed.kind == "pause"])
    acting = np.concatenate([of for deed, of in frames.items() if deed.kind != "pause"])
    assert np.quantile(paused[:, 0], 0.99) < np.quantile(acting[:, 0], 0.99)


def test_a_score_without_phrases_has_no_gaits_and_no_culprits(library, duel):
    recording, score, _ = duel
    empty = Score(tuple(replace(part, phrases=()) for part in score.performers))
    performers = list(acted(recording, empty, library, {"timing": "drawn"}))
    found = named(GUARDS, guards_of(performers))
    assert (found["gaits"], found["lost"]) == (0, 0)
    assert np.isnan(found["over"])
    assert named(PHYSICS, physics_of([figures_of(one) for one in performers]))["acc"] < 1.0
