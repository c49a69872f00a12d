"""Performers of any difficulty can play every gesture."""

import pytest

from benchmarks.performers import eased, performer
from smd.synthetic.gestures import gesture
from smd.synthetic.person import STEADY


@pytest.mark.parametrize("difficulty", [0.0, 0.25, 1.0])
def test_every_difficulty_waves(difficulty):
    person, _ = performer(0, difficulty)
    assert gesture("wave", person=person)
    assert eased(person, 0.0).swings == STEADY.swings
