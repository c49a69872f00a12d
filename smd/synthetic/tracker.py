"""A tracker: the uneven times at which it reports, and the frames that it loses."""

from __future__ import annotations

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.synthetic.curves import even_times


def tracker_times(
    start_s: float, end_s: float, rate_hz: float, rng: np.random.Generator
) -> FloatArray:
    """Return the uneven times at which a tracker reports: 0.5 ms of jitter, 1 % frames lost."""
    time_s = start_s + even_times(end_s - start_s, rate_hz)
    n = len(time_s)
    # A third of a period at most: times must increase.
    jitter_s = np.clip(rng.normal(0.0, 5e-4, n), -1.0 / (3.0 * rate_hz), 1.0 / (3.0 * rate_hz))
    kept = rng.random(n) > 0.01
    kept[[0, -1]] = True
    jitter_s[[0, -1]] = 0.0
    return (time_s + jitter_s)[kept]
