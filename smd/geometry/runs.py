"""Runs: the stretches of a signal in which it stays true."""

from __future__ import annotations

import numpy as np

from smd.geometry.arrays import BoolArray, IntArray


def runs_of_true(signal: BoolArray) -> IntArray:
    """Return the runs of true of a signal ``(n,)``: first index and one past the last, ``(r, 2)``.

    Examples
    --------
    >>> runs_of_true(np.array([True, False, False, True, True]))
    array([[0, 1],
           [3, 5]])
    """
    steps = np.diff(signal.astype(np.int8), prepend=0, append=0)
    return np.stack([np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)], axis=-1)
