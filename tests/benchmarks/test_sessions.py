"""The benchmark of sessions counts what it says it counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from benchmarks import guards, sessions
from benchmarks.composed import Teaching, sessions_of
from benchmarks.sessions import DRAWN, DRAWN_STRICT, FREE, LIMITS, OURS, PLAIN, Trial, TrialSet
from benchmarks.tally import Named, Tally
from benchmarks.variants import VARIANTS
from smd.doodle import Doodle

OWN_2 = Teaching(own=2)


@pytest.fixture(scope="module")
def found(people, idle):
    one = next(sessions_of(people, idle, [OWN_2], seed=1))
    return one, sessions.trials([one], idle)


def test_every_form_is_tried_free_and_drawn(found):
    session, trials = found
    assert [(one.form, one.said) for one in trials.every] == [
        *((form, said) for form in (OURS, LIMITS, *VARIANTS, PLAIN) for said in (FREE, DRAWN)),
        (OURS, DRAWN_STRICT),
        (LIMITS, DRAWN_STRICT),
    ]
    known = sum(one.action is not None for one in session.gestures)
    for one in trials.every:
        assert (one.teaching, one.small, one.person) == (OWN_2, True, session.person)
        assert one.counts.known == known
        assert one.counts.known + one.counts.others == len(session.gestures)
        assert one.spotting_s > 0.0
        assert (one.idle_minutes > 0.0) == (one.said == FREE and one.form not in VARIANTS)


def test_with_the_trigger_held_made_up_gestures_are_found(found):
    assert found[1].of(LIMITS, DRAWN, OWN_2).counts.recall > 0.8


def test_variants_are_tried_beside_the_forms(people, idle, monkeypatch):
    class Silent:
        def spot(self, doodle: Doodle) -> Sequence[Named]:
            return []

    monkeypatch.setattr(sessions, "FORMS", {})
    monkeypatch.setattr(sessions, "VARIANTS", {"silent": lambda actions: Silent()})
    one = next(sessions_of(people, idle, [OWN_2], seed=1))
    found = sessions.trials([one], idle)
    for said in (FREE, DRAWN):
        counts = found.of("silent", said, OWN_2).counts
        assert (counts.hits, counts.false, counts.left_alone) == (0, 0, 1.0)


def test_trials_are_added_up_by_what_is_asked_for():
    def trial(person: int, said: str, small: bool, hits: int) -> Trial:
        return Trial(OURS, said, OWN_2, small, person, Tally(known=4, hits=hits), 0.0, 0.0)

    free = (trial(2, FREE, True, 1), trial(1, FREE, False, 2), trial(2, FREE, False, 3))
    trials = TrialSet((*free, trial(1, DRAWN, True, 4)))
    chosen = trials.of(OURS, FREE, OWN_2)
    assert chosen.counts.hits == 6
    assert [one.hits for one in chosen.by_person] == [2, 4]
    assert trials.of(OURS, FREE, OWN_2, True).counts.hits == 1
    assert trials.of(OURS, FREE, Teaching(own=3)).every == ()


def test_free_play_is_that_of_controllers_and_never_both_chosen_by_and_reported(shared_data):
    chosen, reported = (guards.free_play(develop=develop) for develop in (True, False))
    assert len(chosen) >= 4 and len(reported) >= 6
    assert {one.device for one in (*chosen, *reported)} <= {
        "left",
        "right",
        "leftHand",
        "rightHand",
    }
    starts = [{(len(one), *one.position_m[0]) for one in part} for part in (chosen, reported)]
    assert not starts[0] & starts[1]


def test_a_guard_tells_what_was_seen_a_minute(idle, capsys):
    class Eager:
        def spot(self, doodle: Doodle) -> Sequence[Named]:
            return [Named("wave", 0.0, 1.0)] * 2

    guards.print_guard({"eager": lambda actions: Eager()}, (), idle, idle[:1])
    out = capsys.readouterr().out
    assert "idle hands, 1.0 min, eager" in out
    assert "6.00 (2.20 to 13.0" in out  # of 6 in a minute; exact, after Garwood
    assert "wave 6" in out


def test_every_table_has_a_row_for_each_form(found, capsys, monkeypatch):
    monkeypatch.setattr(sessions, "TEACHINGS", (OWN_2,))
    small = found[1].every
    both = TrialSet((*small, *(replace(one, small=False) for one in small)))
    for show, rows in (
        (
            lambda: sessions.print_found(both, FREE),
            3 + len(VARIANTS) + 2,
        ),  # and two of what ours gains
        (lambda: sessions.print_drawn(both), 4),
        (lambda: sessions.print_idle(both), 3),
        (lambda: sessions.print_times(both), 3 + len(VARIANTS)),
    ):
        show()
        out = capsys.readouterr().out
        assert out.count("\n  own 2") == rows, out
