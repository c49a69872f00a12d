"""Warping: distances of many courses to the nearest examples of their actions, all at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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

CELLS = 1 << 20
"""Costs of pairs of samples that are held at a time, 4 MiB: enough of them to amortize the overhead
of array operations, few enough that most stay in the processor's caches."""

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
        inside = np.maximum(courses, self._low[action])
        np.minimum(inside, self._high[action], out=inside)
        outside = np.subtract(courses, inside, out=inside)
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
        """Yield parts of p pairs, in order, of about `CELLS` costs each."""
        lanes = np.cumsum(np.diff(self._first)[action])
        most = CELLS // (self._all.shape[1] * (2 * self._shift + 1))
        first = 0
        while first < len(action):
            before = lanes[first - 1] if first else 0
            last = max(int(np.searchsorted(lanes, before + most, side="right")), first + 1)
            yield slice(first, last)
            first = last

    def _blocks(self, action: IntArray) -> Iterator[slice]:
        """Yield stretches of pairs of one action, each small enough for one thread of BLAS."""
        edges = [0, *(np.flatnonzero(np.diff(action)) + 1).tolist(), len(action)]
        for first, last in pairwise(edges):
            _, numbers, costs = self._windows[int(action[first])].shape
            count = max(ONE_THREAD // (costs * numbers), 1)
            for begin in range(first, last, count):
                yield slice(begin, min(begin + count, last))

    def _totals(self, courses: FloatArray, action: IntArray) -> FloatArray:
        """Return ``(p, m)``, the least sums of p courses to their actions' examples, at most m.

        They are those of single precision, and infinite where there are fewer examples.
        """
        p, n, d = courses.shape
        # (a, 1, |a|^2) times (-2 b, |b|^2, 1) is the square of the distance of a and b
        ours = np.empty((n, p, d + 2), np.float32)
        ours[..., :d] = courses.transpose(1, 0, 2)
        ours[..., d] = 1.0
        ours[..., d + 1] = np.square(courses).sum(axis=-1).T
        counts = np.diff(self._first)
        lanes = np.concatenate([[0], np.cumsum(counts[action])])
        width = 2 * self._shift + 1
        costs = np.empty((n, width, int(lanes[-1])), np.float32)
        blocks = list(self._blocks(action))
        for own in blocks:
            part = costs[:, :, lanes[own.start] : lanes[own.stop]]
            _pair_costs(ours[:, own], self._windows[int(action[own.start])], part)
        sums = _least_sums(costs)
        totals = np.full((p, int(counts.max())), np.inf)
        for own in blocks:
            m = int(counts[action[own.start]])
            least = sums[lanes[own.start] : lanes[own.stop]]
            totals[own, :m] = _by_course(least, own.stop - own.start, m)
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
    """Return ``(n, d + 2, (2 shift + 1) m)``, which samples of m examples each may be paired with.

    What is paired with sample i is sample i - shift to i + shift of each example; the parts share
    their memory.
    """
    m, n, d = examples.shape
    rows = np.zeros((d + 2, n + 2 * shift, m), np.float32)
    rows[d] = _OUT_OF_REACH
    inside = rows[:, shift : shift + n]
    inside[:d] = -2.0 * examples.transpose(2, 1, 0)
    inside[d] = np.square(examples).sum(axis=-1).T
    inside[d + 1] = 1.0
    rows.flags.writeable = False
    number, sample, one = rows.strides
    shape = (n, d + 2, (2 * shift + 1) * m)
    return as_strided(rows, shape, (sample, number, one), writeable=False)


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


def _pair_costs(ours: Single, window: Single, costs: Single) -> None:
    """Write ``(n, width, p m)``, what pairing samples costs, for p courses and m examples.

    The longer the rows of a matrix product are, the faster it is. So they are of the examples'
    samples where there are more of these than courses, and else of the courses'.
    """
    n, p, _ = ours.shape
    width = costs.shape[1]
    m = window.shape[2] // width
    if p < m:
        each = np.matmul(ours, window).reshape(n, p, width, m).swapaxes(1, 2)
    else:
        each = np.matmul(window.swapaxes(1, 2), ours.swapaxes(1, 2)).reshape(n, width, m, p)
    costs.reshape(each.shape)[...] = each


def _by_course(lanes: Single, p: int, m: int) -> Single:
    """Return ``(p, m)``, what was found for the lanes that `_pair_costs` wrote."""
    return lanes.reshape(p, m) if p < m else lanes.reshape(m, p).T


def _least_sums(costs: Single) -> Single:
    """Return ``(lanes,)``, the least sum of costs on a path from the first pair to the last one.

    The table of dynamic time warping, all lanes at once::

        sum(i, j) = cost(i, j) + min(sum(i - 1, j), sum(i, j - 1), sum(i - 1, j - 1))

    It is filled along its diagonals, on which i + j is the same: none of their sums depends on
    another of them, so they are computed together.

    Parameters
    ----------
    costs
        ``(n, width, lanes)``, of pairing sample i with sample i + k - width // 2.
    """
    n, width, lanes = costs.shape
    cost = costs.reshape(n * width, lanes)
    shift = width // 2
    # The last sum for each k: row k + 1 of those between the two beyond which there is no way. Even
    # and odd rows lie apart, since each diagonal has rows of one kind, and reads the other kind.
    rows = np.full((2, shift + 2, lanes), np.inf, np.float32)
    rows[(shift + 1) % 2, (shift + 1) // 2] = 0.0
    for diagonal in range(2 * n - 1):
        reach = min(shift, diagonal, 2 * (n - 1) - diagonal)
        reach -= (reach - diagonal) % 2
        first, count = shift - reach + 1, reach + 1
        here = rows[first % 2, first // 2 :][:count]
        other = rows[1 - first % 2]
        np.minimum(here, other[(first - 1) // 2 :][:count], out=here)
        np.minimum(here, other[(first + 1) // 2 :][:count], out=here)
        i = (diagonal + reach) // 2
        here += cost[i * width + shift - reach :: 2 - width][:count]
    return rows[(shift + 1) % 2, (shift + 1) // 2]
