"""Alignment: dynamic time warping of two sequences of points."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from smd.errors import DoodleError
from smd.geometry.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Alignment:
    """The pairing of the samples of two courses.

    Attributes
    ----------
    distance : as `distance` gives it.
    path : (k, 2) int64, pairs of a sample of the first course and one of the second, from the
        first of both to the last of both; no step goes back, and none goes further than to the
        next sample in either.
    """

    distance: float
    path: IntArray


def align(a: ArrayLike, b: ArrayLike, *, band: float | None = None) -> Alignment:
    """Pair the samples of two courses in order, with the least sum of squared distances.

    Parameters and errors are those of `distance`.
    """
    from dtaidistance import dtw

    first, second = _course("a", a), _course("b", b)
    options = _options(first, second, band)
    path, root = dtw.warping_path_fast(
        _as_c(first), _as_c(second), include_distance=True, **options
    )
    pairs = np.fromiter(chain.from_iterable(path), np.int64, 2 * len(path)).reshape(-1, 2)
    pairs.flags.writeable = False
    return Alignment(distance=_per_pair(root, first, second), path=pairs)


def distance(a: ArrayLike, b: ArrayLike, *, band: float | None = None) -> float:
    """Return the distance of two courses of points, independent of their timing.

    Dynamic time warping [1]_: every sample is paired with one or more of the other course, in
    order, so that the sum of the pairs' squared Euclidean distances is least. That sum is divided
    by the number of samples of the longer course (no pairing has fewer pairs) and the root is
    taken: the result is in the points' own unit, and it is the root mean square distance of
    simultaneous samples where warping does not help. The pairing is done in C by the package
    dtaidistance; distances are squared because its C code (2.5.1) has no paths for plain ones.

    Parameters
    ----------
    a, b
        ``(n, d)`` and ``(m, d)``, finite, at least one sample each.
    band
        How far apart paired samples may be, as a share of the longer course, besides the
        difference of the lengths [1]_; unlimited if absent. It saves time in proportion.

    Raises
    ------
    DoodleError
        If the arrays do not fit each other, or ``band`` is not a share.

    References
    ----------
    .. [1] H. Sakoe, S. Chiba, "Dynamic Programming Algorithm Optimization for Spoken Word
       Recognition", IEEE Transactions on Acoustics, Speech, and Signal Processing 26(1), 1978.
    """
    return float(distances(a, (b,), band=band)[0])


def distances(
    a: ArrayLike, others: Iterable[ArrayLike], *, band: float | None = None
) -> FloatArray:
    """Return the `distance` of one course to each of several."""
    from dtaidistance import dtw

    first = _course("a", a)
    ours = _as_c(first)
    found = []
    for b in others:
        second = _course("b", b)
        options = _options(first, second, band)
        root = dtw.distance_fast(ours, _as_c(second), **options)
        found.append(_per_pair(root, first, second))
    return np.array(found, dtype=np.float64)


def distance_table(a: FloatArray, b: FloatArray, *, band: float | None = None) -> FloatArray:
    """Return the `distance` of each of p courses to each of m, ``(p, m)``, in one call of C code.

    Parameters
    ----------
    a, b
        ``(p, n, d)`` and ``(m, n, d)``, d at least 2, finite.
    band
        As in `distance`.
    """
    from dtaidistance import dtw

    p, m = len(a), len(b)
    if not p or not m:
        return np.zeros((p, m))
    stacked = np.ascontiguousarray(np.concatenate([a, b]), dtype=np.float64)
    options = _options(stacked[0], stacked[-1], band)
    root = dtw.distance_matrix_fast(
        stacked, block=((0, p), (p, p + m)), compact=True, parallel=False, **options
    )
    return np.asarray(root, np.float64).reshape(p, m) / np.sqrt(stacked.shape[1])


def pair_distances(a: FloatArray, b: FloatArray, *, band: float | None = None) -> FloatArray:
    """Return ``(k,)``, the `distance` of each of k courses to the one of b in its place.

    Parameters
    ----------
    a, b
        ``(k, n, d)``, d at least 2, finite.
    band
        As in `distance`.
    """
    from dtaidistance import dtw_cc

    ours, theirs = (np.require(each, np.float64, ("C", "W")) for each in (a, b))
    # The package's own door to this function checks for longer than it computes.
    options = {} if band is None else {"window": widest_shift(a.shape[1], band) + 1}
    roots = [dtw_cc.distance_ndim(x, y, **options) for x, y in zip(ours, theirs, strict=True)]
    return np.array(roots, dtype=np.float64) / np.sqrt(a.shape[1])


def widest_shift(samples: int, band: float) -> int:
    """Return the largest difference of the indices of paired samples."""
    if not 0.0 <= band <= 1.0:
        raise DoodleError(f"band: expected a share in [0, 1], got {band!r}")
    return int(band * samples + 1e-9)


def _course(name: str, value: ArrayLike) -> FloatArray:
    """Return a checked ``(n, d)`` array that C code may read."""
    array: FloatArray = np.require(value, np.float64, ("C", "A", "W"))
    if array.ndim != 2 or 0 in array.shape:
        raise DoodleError(f"{name}: expected shape (any, any), none empty, got {array.shape}")
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise DoodleError(f"{name}: expected finite numbers, got {array[where]} at index {where}")
    return array


def _per_pair(root: float, a: FloatArray, b: FloatArray) -> float:
    """Return the root of a mean from the root of a sum over pairs."""
    return float(root / np.sqrt(max(len(a), len(b))))


def _as_c(course: FloatArray) -> FloatArray:
    """Return a course as the package wants it: without a second axis of length one."""
    return course[:, 0] if course.shape[1] == 1 else course


def _options(a: FloatArray, b: FloatArray, band: float | None) -> dict[str, Any]:
    """Return the package's options for two courses."""
    if a.shape[1] != b.shape[1]:
        raise DoodleError(f"b: expected {a.shape[1]} numbers a sample as in a, got {b.shape[1]}")
    # Pruning by the upper bound of the straight pairing would call a sum that equals it infinite.
    options: dict[str, Any] = {"use_pruning": False}
    if a.shape[1] > 1:
        options["use_ndim"] = True
    if band is not None:
        # The package allows shifts below its window.
        options["window"] = widest_shift(max(len(a), len(b)), band) + 1
    return options
