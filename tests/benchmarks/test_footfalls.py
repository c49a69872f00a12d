"""What is read of footfalls: the dog's own diagrams, and what is written of the others."""

from __future__ import annotations

import numpy as np
import pytest

from actions_library.authoring.gait import LATERAL_WALK, ROTARY_GALLOP, TROT
from benchmarks import footfalls
from benchmarks.footfalls import ANIMALS, FEET, found_falls, print_falls


@pytest.fixture(scope="module")
def dog():
    return {one.gait: one for one in found_falls(ANIMALS[:1])}


@pytest.mark.parametrize(
    ("gait", "diagram"), [("walk", LATERAL_WALK), ("trot", TROT), ("gallop", ROTARY_GALLOP)]
)
def test_what_was_authored_is_read(dog, gait, diagram):
    for foot, name in enumerate(FEET):
        apart = dog[gait].landing(foot) - diagram[name.replace(" ", "_")]
        assert abs((apart + 0.5) % 1.0 - 0.5) < 0.04


def test_a_walk_never_flies_and_a_gallop_flies_twice(dog):
    assert dog["walk"].flights == []
    assert len(dog["gallop"].flights) == 2
    assert (dog["walk"].duty > 0.5).all() and (dog["gallop"].duty < 0.35).all()


def test_the_horse_walks_in_lateral_sequence_and_gallops_with_a_flight(shared_data):
    found = {one.gait: one for one in found_falls(ANIMALS[1:2])}
    assert found["walk"].order == "LH LF RH RF"
    # a horse's gallop is transverse: the fore feet land in the order of the hind ones
    hind, fore = ([found["gallop"].landing(foot) for foot in pair] for pair in ((0, 2), (1, 3)))
    assert np.sign((hind[0] - hind[1] + 0.5) % 1.0 - 0.5) == np.sign(fore[0] - fore[1])
    assert len(found["gallop"].flights) == 1


def test_what_is_absent_is_said(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(footfalls, "CLIPS", tmp_path)
    footfalls.main()
    said = capsys.readouterr().out
    assert said.count("dog") == 3 and "absent, and left out: horse-animations.glb" in said


def test_a_foot_that_never_lands_has_no_phase(dog, capsys):
    air = footfalls.Footfalls("bird", "flight", 1.0, np.zeros((footfalls.FRAMES, 4), dtype=bool))
    assert np.isnan(air.landing(0)) and air.flights == [1.0] and air.order == ""
    print_falls([air])
    assert "nan" in capsys.readouterr().out
