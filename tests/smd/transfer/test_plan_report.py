"""What a plan says of itself is true of it, parses, and fits a line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from smd.score import Phrase
from smd.transfer.path import GroundPath
from smd.transfer.plan import Plan, Planned
from smd.transfer.plan_report import (
    HURRIED,
    WARNED,
    hurried,
    plan_summary,
    plan_to_json,
    unmet,
)


def planned(
    action="walk", drawn=(1.0, 2.0), played=None, strike=None, acted=None, hurry=1.0
) -> Planned:
    return Planned(Phrase(action, *drawn), *(played or drawn), strike, acted or action, hurry)


def plan(*phrases: Planned) -> Plan:
    ends_s = np.array([0.0, 30.0])
    nowhere = GroundPath(ends_s, np.zeros((2, 2)), np.zeros(2))
    return Plan(tuple(phrases), (), nowhere, ends_s, ends_s)


@st.composite
def plans(draw: st.DrawFn) -> Plan:
    found, now_s = [], 0.0
    for _ in range(draw(st.integers(0, 6))):
        start_s = now_s + draw(st.floats(0.0, 3.0))
        now_s = start_s + draw(st.floats(0.1, 3.0))
        moved = draw(st.floats(-0.5, 0.5))
        strike = draw(st.none() | st.floats(-0.3, 0.3))
        hurry = draw(st.just(1.0) | st.floats(1.0, 9.0))
        action = draw(st.sampled_from(["walk", "punch", 'ein "Schlag"\n']))
        acted = draw(st.sampled_from([action, "run"]))
        found.append(
            planned(action, (start_s, now_s), (start_s + moved, now_s + 0.1), strike, acted, hurry)
        )
    return plan(*found)


@given(st.dictionaries(st.text(max_size=8), plans(), max_size=3), st.floats(0.1, 20.0))
def test_what_is_written_is_read_back(by_device, stretch):
    read = json.loads(plan_to_json(by_device, timing="feasible", stretch=stretch))
    assert read["timing"] == "feasible"
    assert read["stretch"] == pytest.approx(stretch, rel=1e-5)
    assert [part["device"] for part in read["performers"]] == list(by_device)
    for part, one in zip(read["performers"], by_device.values(), strict=True):
        assert len(part["phrases"]) == len(one.phrases)
        for row, phrase in zip(part["phrases"], one.phrases, strict=True):
            assert row["action"] == phrase.drawn.action
            drawn_s = [phrase.drawn.start_s, phrase.drawn.end_s]
            assert row["drawn_s"] == pytest.approx(drawn_s, abs=5e-4 + 1e-9)
            assert row["played_s"] == pytest.approx([phrase.start_s, phrase.end_s], abs=6e-4)
            assert ("strike_later_s" in row) == (phrase.strike_moved_s is not None)
            assert row.get("played_with", phrase.drawn.action) == phrase.action
            assert row.get("asks_for", 1.0) == pytest.approx(phrase.hurry, abs=6e-4)


@given(st.dictionaries(st.text(max_size=8), plans(), max_size=3), st.sampled_from([1.0, 2.0]))
def test_a_summary_is_one_line_and_says_how_far_phrases_moved(by_device, stretch):
    said = plan_summary(plan_to_json(by_device, timing="feasible", stretch=stretch))
    moves = [
        max(abs(p.start_s - p.drawn.start_s), abs(p.end_s - p.drawn.end_s))
        for one in by_device.values()
        for p in one.phrases
    ]
    if not any(move > 2e-3 for move in moves):
        return
    assert said is not None and said.startswith("plan: ")
    assert f"of {len(moves)} phrases moved" in said
    told = float(said.split("by up to ")[1].split(" s")[0])
    assert told == pytest.approx(max(moves), abs=6e-3)
    assert ("2 times as long as the recording" in said) == (stretch == 2.0)


def test_nothing_is_said_where_nothing_changed():
    same = {"fox": plan(planned(), planned("punch", (3.0, 4.0), strike=0.0)), "owl": plan()}
    for timing in ("drawn", "feasible"):
        assert plan_summary(plan_to_json(same, timing=timing, stretch=1.0)) is None
    assert plan_summary(plan_to_json({}, timing="feasible", stretch=1.0)) is None


def test_a_stretch_and_another_gait_are_said():
    one = {"fox": plan(planned(acted="run"), planned(drawn=(3.0, 4.0), acted="run"))}
    said = plan_summary(plan_to_json(one, timing="feasible", stretch=2.5))
    assert said == "plan: 2.5 times as long as the recording; walk as run"


def test_who_is_hurried_is_counted_over_all_performers():
    slow, fast = planned(hurry=HURRIED), planned(hurry=HURRIED + 0.01)
    assert hurried([plan(slow, fast), plan(slow), plan(fast)]) == 0.5
    assert hurried([plan()]) == hurried([]) == 0.0


def test_a_warning_names_what_a_body_needs_and_what_it_has_once_an_action():
    (line,) = unmet(
        "fox",
        plan(
            planned("punch", (1.0, 2.0), hurry=WARNED + 0.1),
            planned("punch", (5.0, 5.5), hurry=4.0),
            planned("walk", (7.0, 9.0), hurry=WARNED),
        ),
    )
    assert line.startswith("device 'fox': punch at 1.00 s: a body needs 2.0 s for it, and has 0.5")
    assert "the most of 2 phrases" in line
    assert "--stretch" in line
    assert "\n" not in line


def test_without_haste_there_is_no_warning():
    assert list(unmet("fox", plan(planned(), planned("punch", (3.0, 4.0))))) == []
