from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from smd.recognition.cutting import best_cut


def total(chosen, first, last, cost, unexplained):
    covered = np.zeros(len(unexplained), bool)
    for i in chosen:
        if covered[first[i] : last[i]].any():
            return np.inf
        covered[first[i] : last[i]] = True
    return sum(cost[i] for i in chosen) + unexplained[~covered].sum()


@pytest.mark.parametrize("seed", range(30))
def test_no_other_choice_costs_less(seed):
    rng = np.random.default_rng(seed)
    n, m = 8, 7
    first = rng.integers(0, n, m).tolist()
    last = [int(rng.integers(f + 1, n + 1)) for f in first]
    cost = rng.uniform(0.0, 4.0, m).tolist()
    unexplained = rng.uniform(0.0, 2.0, n)
    chosen = best_cut(first, last, cost, unexplained)
    least = min(
        total(some, first, last, cost, unexplained)
        for k in range(m + 1)
        for some in combinations(range(m), k)
    )
    assert total(chosen, first, last, cost, unexplained) == pytest.approx(least)
    assert list(chosen) == sorted(chosen, key=lambda i: first[i])


def test_nothing_is_chosen_where_it_costs_as_much_to_leave_alone():
    assert best_cut([0], [2], [2.0], np.array([1.0, 1.0])) == ()
    assert best_cut([], [], [], np.array([1.0])) == ()
