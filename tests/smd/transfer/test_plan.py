"""A plan changes when phrases are played, never which, in which order, or within which time."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import smd
from smd.acting.flight import height_of
from smd.doodle import Doodle, Recording
from smd.errors import TransferError
from smd.geometry.rotations import quaternion_about
from smd.score import Part, Phrase, Score
from smd.transfer.limits import Limits
from smd.transfer.path import GroundPath, ground_path
from smd.transfer.plan import Plan, as_drawn, feasible
from smd.transfer.repertoire import repertoire, with_faster
from smd.transfer.scene import scene_scale
from smd.transfer.timeline import timeline
from tests.smd.acting.test_odd_characters import CHARACTERS, library_of

TRAVELLING = ["walk", "run", "side_step_left", "crawl"]
ON_THE_SPOT = ["punch", "bow", "wave", "turn_left", "slash", "jump"]


def drawn_take(seed: int, hand_m_s: float = 0.3) -> tuple[Doodle, Part]:
    """A prop that goes about and rests, and phrases over it, some of them back to back."""
    rng = np.random.default_rng(seed)
    now_s, phrases = float(rng.choice([0.0, 0.2, 1.0])), []
    for _ in range(rng.integers(2, 7)):
        action = str(rng.choice(TRAVELLING + ON_THE_SPOT))
        lasting_s = float(rng.uniform(0.3, 2.5))
        phrases.append(Phrase(action, round(now_s, 3), round(now_s + lasting_s, 3)))
        now_s = phrases[-1].end_s + float(rng.choice([0.0, 0.05, 0.4, 1.5]))
    end_s = now_s + float(rng.choice([0.0, 0.5]))
    time_s = np.arange(round(end_s * 90) + 2) / 90.0
    speed = np.zeros(len(time_s))
    for phrase in phrases:
        inside = (time_s > phrase.start_s) & (time_s < phrase.end_s)
        speed[inside] = hand_m_s * (phrase.action in TRAVELLING)
    yaw = 0.6 * np.sin(0.7 * time_s + rng.uniform(0.0, 6.0))
    step = speed[:, None] / 90.0 * np.stack([np.sin(yaw), 0.0 * yaw, np.cos(yaw)], axis=-1)
    place = np.cumsum(step, axis=0) + np.array([0.0, 0.8, 0.0])
    doodle = Doodle(time_s, place, quaternion_about([0.0, 1.0, 0.0], yaw), "fox")
    return doodle, Part("fox", tuple(phrases))


def planned(make, doodle, part, library, limits=None) -> tuple[Plan, GroundPath, float, float]:
    """Return what a planning makes of a part, its path as drawn, and the take's ends."""
    recording = Recording((doodle,), source="a take")
    score = Score((part,))
    scene = scene_scale(recording, library.character.height_m, score.figure_height_m)
    pieces = with_faster(repertoire(library, part.phrases, expressiveness=0.0), library)
    path = ground_path([doodle], scene)
    height = height_of([scene.placed_doodle(doodle)])
    ends_s = float(doodle.time_s[0]), float(doodle.time_s[-1])
    return make(part, path, height, pieces, *ends_s, limits or Limits()), path, *ends_s


def kept(plan: Plan, part: Part, start_s: float, end_s: float) -> None:
    """Check what every plan promises."""
    assert [one.drawn for one in plan.phrases] == list(part.phrases)
    assert all(one.end_s > one.start_s for one in plan.phrases)
    assert all(a.end_s <= b.start_s + 1e-9 for a, b in pairwise(plan.phrases))
    assert all(math.isfinite(one.hurry) and one.hurry >= 1.0 for one in plan.phrases)
    assert plan.spans[0].start_s == start_s and plan.spans[-1].end_s == pytest.approx(end_s)
    assert all(a.end_s == pytest.approx(b.start_s) for a, b in pairwise(plan.spans))
    assert all(span.end_s > span.start_s for span in plan.spans)
    played = [span.phrase for span in plan.spans if span.phrase is not None]
    assert [phrase.action for phrase in played] == [one.action for one in plan.phrases]
    for clock in (plan.drawn_s, plan.played_s):
        assert np.isfinite(clock).all()
        assert (np.diff(clock) > 0.0).all()
        assert clock[[0, -1]] == pytest.approx([start_s, end_s], abs=0.06)
    for array in (plan.path.time_s, plan.path.position_m, plan.path.heading_rad):
        assert np.isfinite(array).all()
    assert (np.diff(plan.path.time_s) > 0.0).all()


@pytest.mark.parametrize("seed", range(4))
def test_as_drawn_nothing_is_changed(library, seed):
    doodle, part = drawn_take(seed)
    plan, path, start_s, end_s = planned(as_drawn, doodle, part, library)
    assert plan.path is path
    assert plan.spans == timeline(part.phrases, start_s, end_s)
    assert [one.phrase for one in plan.phrases] == list(part.phrases)
    assert {one.hurry for one in plan.phrases} == {1.0}
    assert {one.strike_moved_s for one in plan.phrases} <= {0.0, None}
    assert plan.played(doodle) is doodle
    kept(plan, part, start_s, end_s)


@pytest.mark.parametrize("seed", range(12))
def test_a_feasible_plan_keeps_phrases_their_order_and_the_take_s_time(library, seed):
    doodle, part = drawn_take(seed)
    plan, _, start_s, end_s = planned(feasible, doodle, part, library)
    kept(plan, part, start_s, end_s)
    for one in plan.phrases:
        assert one.start_s >= start_s - 1e-9 and one.end_s <= end_s + 1e-9
        assert one.strike_moved_s is None or abs(one.strike_moved_s) < 0.25


@pytest.mark.parametrize("seed", range(6))
def test_where_it_ends_is_where_it_was_drawn_to_end(library, seed):
    doodle, part = drawn_take(seed)
    plan, path, start_s, end_s = planned(feasible, doodle, part, library)
    ends_s = np.array([start_s, end_s])
    assert plan.path.at(ends_s) == pytest.approx(path.at(ends_s), abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_a_doodle_is_played_by_the_plan_s_clock_and_stays_one(library, seed):
    doodle, part = drawn_take(seed)
    plan, _, start_s, end_s = planned(feasible, doodle, part, library)
    played = plan.played(doodle)
    assert (played.position_m == doodle.position_m).all()
    assert played.time_s[[0, -1]] == pytest.approx([start_s, end_s], abs=1e-5)
    back_s = np.interp(played.time_s, plan.played_s, plan.drawn_s)
    # Where many samples are shown at once, they are a hair apart.
    assert np.abs(back_s - doodle.time_s).mean() < 0.05


def test_slow_hands_are_played_as_they_are_drawn_or_nearly(library):
    """Walks at 0.12 m/s of a hand are 1.2 m/s of a body; and every phrase has room."""
    phrases = tuple(Phrase("walk", 2.0 + 8.0 * k, 7.0 + 8.0 * k) for k in range(3))
    time_s = np.arange(26 * 90) / 90.0
    inside = np.any([(time_s > p.start_s) & (time_s < p.end_s) for p in phrases], axis=0)
    way = np.cumsum(0.12 / 90.0 * inside)
    place = np.stack([0.0 * way, 0.8 + 0.0 * way, way], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(way), 1)), "fox")
    plan, path, *_ = planned(feasible, doodle, Part("fox", phrases), library)
    for one in plan.phrases:
        assert one.action == "walk" and one.hurry == 1.0
        assert [one.start_s, one.end_s] == pytest.approx(
            [one.drawn.start_s, one.drawn.end_s], abs=1e-6
        )
    at_s = np.linspace(0.0, 25.9, 500)
    assert np.abs(plan.path.at(at_s) - path.at(at_s)).max() < 0.5


@pytest.mark.parametrize("seed", [1, 3, 5])
@pytest.mark.parametrize("later_s", [1e4, 1.7e9])
def test_a_clock_that_began_long_ago_changes_nothing(library, seed, later_s):
    """Seconds since 1970 are told apart by no less than 0.24 millionths."""
    doodle, part = drawn_take(seed)
    moved = [
        replace(one, start_s=one.start_s + later_s, end_s=one.end_s + later_s)
        for one in part.phrases
    ]
    later = replace(doodle, time_s=doodle.time_s + later_s)
    own = smd.animate(Score((part,)), Recording((doodle,)), library)
    other = smd.animate(Score((Part("fox", tuple(moved)),)), Recording((later,)), library)
    (one,), (two,) = own.actors, other.actors
    assert two.poses.translation_m == pytest.approx(one.poses.translation_m, abs=0.02)


def test_the_same_is_planned_twice(library):
    doodle, part = drawn_take(3)
    one, other = (planned(feasible, doodle, part, library)[0] for _ in range(2))
    assert one.phrases == other.phrases
    assert (one.path.position_m == other.path.position_m).all()


def test_without_phrases_the_path_stays(library):
    doodle, _ = drawn_take(0)
    for make in (as_drawn, feasible):
        plan, path, start_s, end_s = planned(make, doodle, Part("fox"), library)
        kept(plan, Part("fox"), start_s, end_s)
        at_s = np.linspace(start_s, end_s, 50)
        assert plan.path.at(at_s) == pytest.approx(path.at(at_s), abs=0.02)


def test_phrases_that_leave_no_time_are_all_played_and_their_haste_is_told(library):
    """Twenty blows and walks of 0.2 s, one after the other; the hand goes 3 m/s."""
    names = ["punch", "walk"] * 10
    phrases = tuple(Phrase(a, 0.2 * k, 0.2 * (k + 1)) for k, a in enumerate(names))
    time_s = np.arange(4 * 90 + 1) / 90.0
    place = np.stack([3.0 * time_s, 0.0 * time_s, np.sin(9.0 * time_s)], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)), "fox")
    plan, _, start_s, end_s = planned(feasible, doodle, Part("fox", phrases), library)
    kept(plan, Part("fox", phrases), start_s, end_s)
    assert min(one.hurry for one in plan.phrases) > 1.1
    recording = Recording((doodle,), source="fast")
    found = smd.animate(Score((Part("fox", phrases),)), recording, library)
    assert np.isfinite(found.actors[0].poses.translation_m).all()
    assert np.isfinite(found.actors[0].poses.rotation_xyzw).all()
    told = [line for line in found.warnings if "a body needs" in line]
    assert any("punch" in line for line in told) and any("walk" in line for line in told)


EDGES = {
    "at the very start": [("walk", 0.0, 1.0)],
    "at the very end": [("walk", 3.0, 4.0)],
    "a hair before the start": [("walk", -0.04, 1.0)],
    "a hair beyond the end": [("walk", 3.0, 4.04)],
    "wholly beyond the end": [("walk", 1.0, 2.0), ("punch", 4.005, 4.04)],
    "wholly before the start": [("punch", -0.04, -0.01), ("walk", 1.0, 2.0)],
    "a blow a hair beyond the end": [("punch", 3.7, 4.04)],
    "the whole take": [("walk", 0.0, 4.0)],
    "back to back": [("walk", 0.5, 1.5), ("run", 1.5, 2.5), ("punch", 2.5, 3.0)],
    "one of a millisecond": [("wave", 1.0, 1.001), ("walk", 1.001, 2.0)],
    "nothing": [],
}


@pytest.mark.parametrize("timing", ["drawn", "feasible"])
@pytest.mark.parametrize("name", EDGES)
def test_phrases_at_the_edges_of_a_take_are_acted_in_numbers(library, name, timing):
    time_s = np.arange(4 * 90 + 1) / 90.0
    place = np.stack([0.1 * np.sin(time_s), 0.0 * time_s, 0.15 * time_s], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)), "fox")
    part = Part("fox", tuple(Phrase(*row) for row in EDGES[name]))
    recording = Recording((doodle,), source="edges")
    found = smd.animate(Score((part,)), recording, library, timing=timing)
    (actor,) = found.actors
    assert np.isfinite(actor.poses.translation_m).all()
    assert np.isfinite(actor.poses.rotation_xyzw).all()
    assert len(found) == 97
    read = json.loads(found.source["plan"])
    assert (read["timing"], read["stretch"]) == (timing, 1.0)
    (told,) = read["performers"]
    assert [row["action"] for row in told["phrases"]] == [row[0] for row in EDGES[name]]
    if timing == "drawn":
        assert all(row["played_s"] == row["drawn_s"] for row in told["phrases"])


@pytest.mark.parametrize("timing", ["drawn", "feasible"])
@pytest.mark.parametrize("name", CHARACTERS)
def test_a_character_without_legs_or_feet_has_a_plan_too(tmp_path, name, timing):
    library = library_of(tmp_path / "odd", *CHARACTERS[name])
    time_s = np.arange(4 * 90 + 1) / 90.0
    place = np.stack([0.0 * time_s, 0.0 * time_s, 0.3 * time_s], axis=-1)
    doodle = Doodle(time_s, place, np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1)), "fox")
    part = Part("fox", (Phrase("walk", 0.3, 1.5), Phrase("jump", 1.5, 2.0)))
    found = smd.animate(
        Score((part,)), Recording((doodle,), source="odd"), library, timing=timing, stretch="1.5"
    )
    assert np.isfinite(found.actors[0].poses.translation_m).all()
    assert json.loads(found.source["plan"])["stretch"] == 1.5


def test_stretched_a_take_is_longer_and_hurries_less(library):
    doodle, part = drawn_take(5, hand_m_s=1.2)
    score, recording = Score((part,)), Recording((doodle,), source="fast")
    asked, lasting_s = [], []
    for stretch in (1.0, 2.0, "auto"):
        found = smd.animate(score, recording, library, stretch=stretch)
        plan = json.loads(found.source["plan"])
        rows = plan["performers"][0]["phrases"]
        asked.append(sum(row.get("asks_for", 1.0) for row in rows))
        lasting_s.append((len(found) - 1) / found.rate_hz / plan["stretch"])
        assert [row["action"] for row in rows] == [one.action for one in part.phrases]
    assert lasting_s == pytest.approx([lasting_s[0]] * 3, abs=0.05)
    assert asked[1] < asked[0] and asked[2] < asked[0]


BAD_LIMITS = [
    {"acceleration_m_s2": 0.0},
    {"push_m_s2": -1.0},
    {"speed_m_s": math.nan},
    {"turning_rad_s": math.inf},
    {"turning_rad_s2": -0.5},
    {"detour": 0.0},
    {"detour": 1.0},
    {"shortening": 1},
    {"shortening": 2.5},
]


@pytest.mark.parametrize("bad", BAD_LIMITS, ids=str)
def test_wrong_limits_are_refused_by_name_in_a_line(bad):
    ((name, value),) = bad.items()
    with pytest.raises(TransferError, match=f"^{name}: expected a .*, got {value!r}$"):
        Limits(**bad)


BAD_OPTIONS = {
    "stretch x": ({"stretch": "x"}, "stretch: expected 'auto' or a number from 0.1 to 20, got 'x'"),
    "stretch nan": ({"stretch": math.nan}, "stretch: expected 'auto' or a number"),
    "stretch 0": ({"stretch": 0}, "stretch: expected 'auto' or a number"),
    "stretch below 0": ({"stretch": -2.0}, "stretch: expected 'auto' or a number"),
    "auto and drawn": ({"stretch": "auto", "timing": "drawn"}, "stretch: expected a number with"),
    "timing": ({"timing": "later"}, "timing: expected drawn or feasible, got 'later'"),
}


@pytest.mark.parametrize("name", BAD_OPTIONS)
def test_wrong_options_are_refused_in_a_line(library, name):
    options, said = BAD_OPTIONS[name]
    doodle, part = drawn_take(0)
    with pytest.raises(TransferError) as no:
        smd.animate(Score((part,)), Recording((doodle,)), library, **options)
    assert str(no.value).startswith(said)
    assert "\n" not in str(no.value)


def test_weaker_limits_hurry_more(library):
    doodle, part = drawn_take(7)
    asked = []
    for limits in (Limits(), Limits(acceleration_m_s2=0.2, push_m_s2=0.5, speed_m_s=0.5)):
        plan, _, start_s, end_s = planned(feasible, doodle, part, library, limits)
        kept(plan, part, start_s, end_s)
        asked.append(sum(one.hurry for one in plan.phrases))
    assert asked[1] > asked[0] + 1.0


def test_gaits_of_one_way_change_where_they_were_drawn_to_however_fast_they_are():
    """Short phrases on a long way: none ends before it starts, and each keeps its own places."""
    time_s = np.arange(0.0, 6.0, 1.0 / 60.0)
    rng = np.random.default_rng(4)
    steps_m = 0.004 * np.abs(rng.normal(size=len(time_s)))
    way_m = np.cumsum(np.where(time_s > 0.5, steps_m, 0.0))  # a gait walks through a short gap
    aside_m = 0.02 * np.sin(7.0 * np.maximum(time_s - 0.5, 0.0))
    place_m = np.stack([aside_m, 0.0875 + 0.0 * time_s, way_m], axis=-1)
    upright = np.tile([0.0, 0.0, 0.0, 1.0], (len(time_s), 1))
    recording = Recording((Doodle(time_s, place_m, upright, "prop"),))
    cuts_s = np.linspace(0.5, 5.5, 11)
    names = ["walk", "run"] * 5
    phrases = tuple(
        Phrase(name, float(a), float(b))
        for name, a, b in zip(names, cuts_s[:-1], cuts_s[1:], strict=True)
    )
    performance = smd.animate(Score((Part("prop", phrases),)), recording, smd.load_library())
    (actor,) = performance.actors
    assert [phrase.action for phrase in actor.phrases] == names
    edges_s = [actor.phrases[0].start_s, *(phrase.end_s for phrase in actor.phrases)]
    assert (np.diff(edges_s) > 0.0).all()
    root_m = actor.poses.translation_m[:, 0, 2]
    film_s = performance.start_s + np.arange(len(performance)) / performance.rate_hz
    went_m = np.diff(np.interp(edges_s, film_s, root_m))
    drawn_m = 10.0 * np.diff(np.interp(cuts_s, time_s, way_m))
    assert went_m == pytest.approx(drawn_m, rel=0.1, abs=0.15)


def test_a_faster_gait_is_of_the_same_manner():
    dog = smd.load_library("dog")
    slow = ("walk", "walk_happy", "walk_sad")
    phrases = [Phrase(name, float(k), k + 0.5) for k, name in enumerate(slow)]
    faster = with_faster(repertoire(dog, phrases, expressiveness=0.0), dog).faster
    assert faster["walk"] == ("trot", "run")
    assert faster["walk_happy"] == ("trot_happy", "run_happy")
    assert faster["walk_sad"] == ("trot_sad", "run_sad")


def test_a_gait_that_goes_another_way_is_no_manner(library):
    phrases = [Phrase("walk_backward", 0.0, 0.5), Phrase("walk", 1.0, 1.5)]
    faster = with_faster(repertoire(library, phrases, expressiveness=0.0), library).faster
    assert faster["walk_backward"] == ("run_backward", "sneak", "walk", "run")
    assert faster["walk"] == ("run",)
