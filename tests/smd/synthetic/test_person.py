from __future__ import annotations

import numpy as np

from smd.synthetic.person import simulated_person


def test_people_differ_and_the_same_seed_gives_the_same_person():
    people = [simulated_person(np.random.default_rng(seed)) for seed in (1, 1, 2)]
    assert people[0] == people[1]
    assert people[0] != people[2]
