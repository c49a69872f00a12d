"""Segmentation: the cheapest way to cut a token string into actions and nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from smd.geometry.arrays import FloatArray
from smd.recognition.automaton import FAR, Automaton


@dataclass(frozen=True, slots=True)
class Segment:
    """Tokens ``first`` (included) to ``last`` (excluded) are like automaton ``index``'s pattern."""

    index: int
    first: int
    last: int


def least_cost_segments(
    automata: Sequence[Automaton],
    *,
    read: Sequence[FloatArray],
    skip: FloatArray,
    unexplained: FloatArray,
    action: float,
) -> tuple[Segment, ...]:
    """Cut a string of n tokens into actions and unexplained tokens at the least total cost.

    A segment costs ``action`` and its distance to its pattern. Since both add up token by token,
    one pass over the string that carries the states of all automata is exact (Viterbi's algorithm
    [1]_); no pair of ends is tried by itself. Where several ways cost the same, less is explained,
    then the earlier automaton is taken.

    Parameters
    ----------
    read
        For each automaton ``(n, p)``: what it costs to take token i for one that a state
        reads.
    skip
        ``(n,)``, what it costs to leave token i out of a segment around it.
    unexplained
        ``(n,)``, what it costs to leave token i outside of all segments; at most ``skip``.
    action
        What each segment costs besides its distance.

    References
    ----------
    .. [1] A. J. Viterbi, "Error Bounds for Convolutional Codes and an Asymptotically Optimum
       Decoding Algorithm", IEEE Transactions on Information Theory 13(2), 1967.
    """
    if not automata:
        return ()
    reading = _stacked(read)
    enter = _stacked([one.enter for one in automata])
    leave = _stacked([one.leave for one in automata])
    step = _stacked([_padded(one.step, enter.shape[1]) for one in automata])
    rows, columns = np.indices(enter.shape)
    # Per state: the least cost of getting there, and the token at which its segment began.
    reached = np.full(enter.shape, float(FAR))
    start = np.zeros(enter.shape, dtype=np.int64)
    best = 0.0
    ending: list[Segment | None] = []
    for j in range(len(skip)):
        ways = reached[:, :, None] + step
        source = ways.argmin(axis=1)
        going_on = ways[rows, source, columns]
        entering = best + action + enter
        arriving = np.minimum(entering, going_on) + reading[:, j]
        skipping = reached + skip[j]
        start_if_read = np.where(entering < going_on, j, start[rows, source])
        start = np.where(skipping <= arriving, start, start_if_read)
        reached = np.minimum(skipping, arriving)
        leaving = reached + leave
        index, position = divmod(int(leaving.argmin()), leaving.shape[1])
        best += float(unexplained[j])
        if leaving[index, position] < best:
            best = float(leaving[index, position])
            ending.append(Segment(index, int(start[index, position]), j + 1))
        else:
            ending.append(None)
    return _traced(ending)


def _stacked(arrays: Sequence[np.ndarray]) -> FloatArray:
    """Stack arrays whose last axes differ in length; what is missing no way reaches."""
    width = max(array.shape[-1] for array in arrays)
    stack = np.full((len(arrays), *arrays[0].shape[:-1], width), float(FAR))
    for i, array in enumerate(arrays):
        stack[i, ..., : array.shape[-1]] = array
    return stack


def _padded(step: np.ndarray, p: int) -> FloatArray:
    """Return a square matrix of p rows; from the rows added no way leads anywhere."""
    padded = np.full((p, step.shape[1]), float(FAR))
    padded[: len(step)] = step
    return padded


def _traced(ending: Sequence[Segment | None]) -> tuple[Segment, ...]:
    """Return the segments on the best way, followed back from the string's end.

    ``ending[j]`` is the segment that ends after token j on the best way there, if one does.
    """
    segments = []
    j = len(ending)
    while j:
        segment = ending[j - 1]
        if segment is None:
            j -= 1
        else:
            segments.append(segment)
            j = segment.first
    return tuple(reversed(segments))
