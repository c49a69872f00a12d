"""The least cost of cutting a string into actions and nothing, by trying every pair of ends."""

from __future__ import annotations

import numpy as np

from smd.recognition.bank import Bank, least_costs


def segment_costs(
    bank: Bank, read: np.ndarray, skip: np.ndarray, action: float
) -> dict[tuple[int, int], np.ndarray]:
    """Return what each action costs from each token to each later one."""
    n = len(skip)
    return {
        (first, last): action + least_costs(bank, read=read[first:last], skip=skip[first:last])
        for first in range(n)
        for last in range(first + 1, n + 1)
    }


def least_total_cost(costs: dict[tuple[int, int], np.ndarray], unexplained: np.ndarray) -> float:
    best = [0.0]
    for last in range(1, len(unexplained) + 1):
        ways = [best[last - 1] + float(unexplained[last - 1])]
        ways += [best[first] + float(costs[first, last].min()) for first in range(last)]
        best.append(min(ways))
    return best[-1]
