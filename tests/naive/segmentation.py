"""The least cost of cutting a string into actions and nothing, by trying every pair of ends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.recognition.automaton import Automaton, least_cost


def cost_of_segment(
    automaton: Automaton, read: np.ndarray, skip: np.ndarray, first: int, last: int, action: float
) -> float:
    return action + least_cost(automaton, read=read[first:last], skip=skip[first:last])


def least_total_cost(
    automata: Sequence[Automaton],
    read: Sequence[np.ndarray],
    skip: np.ndarray,
    unexplained: np.ndarray,
    action: float,
) -> float:
    best = [0.0]
    for last in range(1, len(skip) + 1):
        ways = [best[last - 1] + float(unexplained[last - 1])]
        for first in range(last):
            for automaton, reading in zip(automata, read, strict=True):
                cost = cost_of_segment(automaton, reading, skip, first, last, action)
                ways.append(best[first] + cost)
        best.append(min(ways))
    return best[-1]
