"""Warping: distances of many courses to the nearest examples of their actions, all at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from laban.frozen import Frozen
from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.alignment import pair_distances, widest_shift

Single: TypeAlias = NDArray[np.float32]

LANES = 8192
"""Pairs of a course and an example that are warped together: enough to amortize the overhead of
array operations, few enough that their costs stay in the processor's cache."""

CELLS = 1 << 17
"""Costs of pairs of samples that are computed at a time: they stay in the cache as well."""

ONE_THREAD = 1 << 18
"""Multiplications in a matrix product up to which OpenBLAS leaves it to one thread. Products of
thousandths of a second gain nothing from more, and lose much where other programs run: on two
busy cores threads that wait for each other took three times as long."""

_OUT_OF_REACH = np.float32(1e9)
_ROUNDING = float(np.finfo(np.float32).eps)


@dataclass(frozen=True, slots=True, eq=False)
class Templates(Frozen):
    """Templates for dynamic time warping: courses of the examples of several actions.

    Attributes
    ----------
    courses : of each action ``(m, n, d)``, n and d the same for all, n at least 4.
    band : largest shift of the warping, as a share of n, at least 1 / n.
    factors : of each action ``(m,)``, the factors on the distances to its examples, at least 1;
        if empty, all are 1.
    """

    courses: tuple[FloatArray, ...]
    band: float
    factors: tuple[FloatArray, ...] = ()
    _first: IntArray = field(init=False)
    _all: FloatArray = field(init=False)
    _size: FloatArray = field(init=False)
    _factor: FloatArray = field(init=False)
    _shift: int = field(init=False)
    _windows: tuple[Single, ...] = field(init=False)
    _low: FloatArray = field(init=False)
    _high: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        every = np.concatenate(self.courses)
        shift = widest_shift(every.shape[1], self.band)
        low, high = (
            np.stack([end(each, axis=0) for each in self.courses]) for end in (np.min, np.max)
        )
        for name, value in {
            "_first": np.cumsum([0, *map(len, self.courses)]),
            "_all": every,
            "_size": np.array([_size(each).max() for each in self.courses]),
            "_factor": _in_rows(self.factors or tuple(np.ones(len(each)) for each in self.courses)),
            "_shift": shift,
            "_windows": tuple(_windows(each, shift) for each in self.courses),
            "_low": _least_in_reach(low, shift),
            "_high": -_least_in_reach(-high, shift),
        }.items():
            object.__setattr__(self, name, value)
        # Once for nothing: what is loaded when it is first used is not to keep a player waiting.
        self.nearest(every[:1], np.zeros(1, np.int64), np.zeros(1))

    def at_least(self, courses: FloatArray, action: IntArray) -> FloatArray:
        """Return ``(p,)``, a lower bound of the `nearest` distance of each, in far less time.

        Each sample is paired with one within reach, and so is no nearer than the box around all
        of those of all examples (Keogh's bound [1]_, one for all examples).

        References
        ----------
        .. [1] E. Keogh, C. A. Ratanamahatana, "Exact Indexing of Dynamic Time Warping",
           Knowledge and Information Systems 7, 2005.
        """
        outside = courses - np.clip(courses, self._low[action], self._high[action])
        total = np.einsum("pnd,pnd->p", outside, outside)
        # A little less, or rounding would lose an example that is just as far.
        return (1.0 - 1e-9) * np.sqrt(total / courses.shape[1])

    def nearest(
        self,
        courses: FloatArray,
        action: IntArray,
        most: FloatArray,
    ) -> FloatArray:
        """Return ``(p,)``, the `alignment.distance` of p courses to the nearest example.

        Each distance is multiplied by the example's factor.

        First all examples are warped in single precision. Those that may be nearest, within its
        rounding error, are then warped in double precision.

        Parameters
        ----------
        courses
            ``(p, n, d)``.
        action
            ``(p,)``, the action whose examples each is compared with; it is faster the fewer
            changes there are from one to the next.
        most
            ``(p,)``, thresholds; a larger distance comes out as infinity.
        """
        nearest = np.full(len(courses), np.inf)
        for part in self._slabs(action):
            ours, own = courses[part], action[part]
            factor = self._factor[own]
            total = self._totals(ours, own) * np.square(factor)
            # A sample's cost is a scalar product of d + 2 numbers, whose terms add up to no more
            # than twice the squares of both sizes; a way adds up fewer than 2 n costs.
            n, d = ours.shape[1:]
            size = (_size(ours) + self._size[own])[:, None]
            share = 2 * n * _ROUNDING
            error = share * 2 * (d + 3) * size * np.square(factor)
            nearest_at_most = ((1.0 + share) * total + error).min(axis=1)
            wanted = np.minimum(nearest_at_most, n * np.square(most[part]))[:, None]
            pair, example = np.nonzero((1.0 - share) * total - error <= wanted)
            theirs = self._all[self._first[own[pair]] + example]
            exact = pair_distances(ours[pair], theirs, band=self.band) * factor[pair, example]
            np.minimum.at(nearest, part.start + pair, exact)
        nearest[nearest > most] = np.inf
        return nearest

    def _slabs(self, action: IntArray) -> Iterator[slice]:
        """Yield parts of p pairs, in order, of about `LANES` lanes each."""
        lanes = np.cumsum(np.diff(self._first)[action])
        first = 0
        while first < len(action):
            before = lanes[first - 1] if first else 0
            last = max(int(np.searchsorted(lanes, before + LANES, side="right")), first + 1)
            yield slice(first, last)
            first = last

    def _blocks(self, action: IntArray) -> Iterator[slice]:
        """Yield stretches of pairs of one action, each small enough for one thread of BLAS."""
        edges = [0, *(np.flatnonzero(np.diff(action)) + 1).tolist(), len(action)]
        for first, last in pairwise(edges):
            _, costs, numbers = self._windows[int(action[first])].shape
            count = max(ONE_THREAD // (costs * numbers), 1)
            for begin in range(first, last, count):
                yield slice(begin, min(begin + count, last))

    def _totals(self, courses: FloatArray, action: IntArray) -> FloatArray:
        """Return ``(p, m)``, the least sums of p courses to their actions' examples, at most m.

        They are those of single precision, and infinite where there are fewer examples.
        """
        p, n, d = courses.shape
        # (a, 1, |a|^2) times (-2 b, |b|^2, 1) is the square of the distance of a and b
        ours = np.empty((n, d + 2, p), np.float32)
        ours[:, :d] = courses.transpose(1, 2, 0)
        ours[:, d] = 1.0
        ours[:, d + 1] = np.square(courses).sum(axis=-1).T
        blocks = list(self._blocks(action))
        windows = [self._windows[int(action[own.start])] for own in blocks]
        width = 2 * self._shift + 1
        lanes = [
            (own.stop - own.start) * window.shape[1] // width
            for own, window in zip(blocks, windows, strict=True)
        ]
        rows = max(CELLS // (width * sum(lanes)), 1)

        def costs() -> Iterator[Single]:
            for begin in range(0, n, rows):
                some = slice(begin, begin + rows)
                each = [
                    np.matmul(window[some], ours[some, :, own]).reshape(-1, width, lane)
                    for window, own, lane in zip(windows, blocks, lanes, strict=True)
                ]
                yield from each[0] if len(each) == 1 else np.concatenate(each, axis=2)

        sums = np.split(_least_sums(costs(), width, sum(lanes)), np.cumsum(lanes)[:-1])
        totals = np.full((p, int(np.diff(self._first).max())), np.inf)
        for own, least in zip(blocks, sums, strict=True):
            count = own.stop - own.start
            totals[own, : len(least) // count] = least.reshape(-1, count).T
        return totals


def _size(courses: FloatArray) -> FloatArray:
    """Return ``(m,)``, the largest square of a sample's distance from the origin."""
    return np.asarray(np.square(courses).sum(axis=-1).max(axis=-1))


def _in_rows(factors: Sequence[FloatArray]) -> FloatArray:
    """Return the factors ``(a, m)`` of actions with at most m examples, 1 beyond the last."""
    rows = np.ones((len(factors), max(map(len, factors))))
    for row, own in zip(rows, factors, strict=True):
        row[: len(own)] = own
    return rows


def _windows(examples: FloatArray, shift: int) -> Single:
    """Return ``(n, (2 shift + 1) m, d + 2)``, which samples of m examples each may be paired with.

    What is paired with sample i is sample i - shift to i + shift of each example; the parts share
    their memory.
    """
    m, n, d = examples.shape
    rows = np.zeros((n + 2 * shift, m, d + 2), np.float32)
    rows[..., d] = _OUT_OF_REACH
    inside = rows[shift : shift + n]
    inside[..., :d] = -2.0 * examples.transpose(1, 0, 2)
    inside[..., d] = np.square(examples).sum(axis=-1).T
    inside[..., d + 1] = 1.0
    rows.flags.writeable = False
    return as_strided(rows, (n, (2 * shift + 1) * m, d + 2), rows.strides, writeable=False)


def _least_in_reach(values: FloatArray, shift: int) -> FloatArray:
    """Return ``(a, n, d)``, the least of what each of n samples may be paired with.

    The first sample is always paired with the first one, and the last with the last.
    """
    least = values.copy()
    for by in range(1, shift + 1):
        np.minimum(least[:, by:], values[:, :-by], out=least[:, by:])
        np.minimum(least[:, :-by], values[:, by:], out=least[:, :-by])
    least[:, [0, -1]] = values[:, [0, -1]]
    return least


def _least_sums(costs: Iterable[Single], width: int, lanes: int) -> Single:
    """Return ``(lanes,)``, the least sum of costs on a path from the first pair to the last one.

    The table of dynamic time warping, row by row, all lanes at once::

        sum(i, j) = cost(i, j) + min(sum(i - 1, j), sum(i, j - 1), sum(i - 1, j - 1))

    Parameters
    ----------
    costs
        For each sample i, ``(width, lanes)``, of pairing it with sample i + k - width // 2.
    """
    # One more, beyond which there is no way; from row to row, sample j moves one place down.
    sums, before = np.full((2, width + 1, lanes), np.inf, np.float32)
    sums[width // 2] = 0.0
    for number, cost in enumerate(costs):
        if number:
            sums, before = before, sums
            np.minimum(before[:-1], before[1:], out=sums[:-1])
        left = sums[0]
        left += cost[0]
        for here, own in zip(sums[1:-1], cost[1:], strict=True):
            np.minimum(here, left, out=here)
            here += own
            left = here
    return np.asarray(sums[width // 2])
