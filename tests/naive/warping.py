"""Dynamic time warping by its table, and by trying every path."""

from __future__ import annotations

import numpy as np


def table_distance(a, b, band=None):
    """The root of the least sum of squared distances over the longer length, by the plain table."""
    n, m = len(a), len(b)
    most = max(n, m) if band is None else int(band * max(n, m) + 1e-9)
    total = np.full((n + 1, m + 1), np.inf)
    total[0, 0] = 0.0
    for i in range(1, n + 1):
        for j in range(1, m + 1):
            if -most - max(m - n, 0) <= i - j <= most + max(n - m, 0):
                before = min(total[i - 1, j], total[i, j - 1], total[i - 1, j - 1])
                total[i, j] = before + np.sum((a[i - 1] - b[j - 1]) ** 2)
    return np.sqrt(total[n, m] / max(n, m))


def every_path(n, m):
    """All ways from (0, 0) to (n - 1, m - 1) by steps to the next sample of either or both."""
    if n == 1 and m == 1:
        return [[(0, 0)]]
    ways = []
    for di, dj in ((1, 0), (0, 1), (1, 1)):
        if n > di and m > dj:
            ways += [[*path, (n - 1, m - 1)] for path in every_path(n - di, m - dj)]
    return ways
