"""Cutting: the best choice of stretches that do not overlap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from smd.geometry.arrays import FloatArray


def best_cut(
    first: Sequence[int], last: Sequence[int], cost: Sequence[float], unexplained: FloatArray
) -> tuple[int, ...]:
    """Choose stretches of n tokens that minimize their costs plus those of all tokens between.

    Weighted interval scheduling: the best choice up to a token leaves it unexplained, or ends with
    a stretch and extends the best choice up to where that began. Exact, in time linear in tokens
    and stretches.

    Parameters
    ----------
    first, last
        Each stretch covers tokens ``first`` (included) to ``last`` (excluded); not empty.
    cost
        Of each stretch.
    unexplained
        ``(n,)``, of each token that no stretch covers.

    Returns
    -------
    tuple of int
        The chosen stretches, by their place in the lists, from first to last. Where several
        choices cost the same, less is explained, then the earlier stretch is taken.
    """
    n = len(unexplained)
    ending: list[list[int]] = [[] for _ in range(n + 1)]
    for i, end in enumerate(last):
        ending[end].append(i)
    best = np.zeros(n + 1)
    taken = [-1] * (n + 1)
    for j in range(1, n + 1):
        best[j] = best[j - 1] + unexplained[j - 1]
        for i in ending[j]:
            total = best[first[i]] + cost[i]
            if total < best[j] - 1e-9:
                best[j], taken[j] = total, i
    chosen: list[int] = []
    j = n
    while j:
        if taken[j] < 0:
            j -= 1
        else:
            chosen.append(taken[j])
            j = first[taken[j]]
    return tuple(reversed(chosen))
