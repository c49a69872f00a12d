"""Allotment: how the time of a take is shared out among its phrases and pauses.

Each phrase wishes for the time that a body needs. The beginning, the strike and the end of every
phrase are found together, as the minimum of one sum of squares: of what is missing from each wish,
as a share of it, and of how far each is from where it was drawn. Most terms are one-sided: a phrase
that has more time than it needs costs nothing. The sum is strictly convex, so that there is one
minimum, and each term ties neighbours, so that it is found in linear time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from smd.geometry.arrays import BoolArray, FloatArray, IntArray

WISHED = ((1.0, 1.0), (1.0 / 1.5, 8.0), (1.0 / 2.5, 60.0))
"""What a missing time costs: below each share of the wish, the weight of its square. To be twice as
fast as wished is worse than to be one and a half times as fast in two places."""

RETURN_WEIGHT = 0.3
"""Weight of the time to come to rest in: blending does without it better than a phrase."""

DRAWN_WEIGHT = 0.03
"""Weight of a second's distance, squared, of a phrase's beginning and end from the drawn ones."""

STRIKE_WEIGHT = 0.3
"""The same for a strike."""

STRIKE_S = ((0.1, 50.0), (0.2, 5000.0))
"""What a strike's distance from the drawn one costs besides: beyond each, the weight of its
square. So it comes within 0.1 s where pauses allow, and within 0.2 s otherwise."""

SHORTEST_S = 0.05
"""Least time of a part of a phrase, where it has none in what was drawn; none wishes for less."""

_FIRM = 1e6
"""Weight of what must hold: the order of phrases, and the ends of the take."""

_LEAST = 1e-3

_MOST_STEPS, _WHOLE_STEPS = 100, 30


@dataclass(frozen=True, slots=True)
class Wish:
    """What one phrase was given, and the time that it needs.

    Attributes
    ----------
    start_s, end_s : as drawn.
    before_s : time up to its strike; the whole phrase's, where nothing strikes.
    after_s : time from its strike to its end.
    return_s : time of the pause behind it in which the body comes to rest.
    strike_s : when it strikes, as drawn; None where nothing does.
    """

    start_s: float
    end_s: float
    before_s: float
    after_s: float = 0.0
    return_s: float = 0.0
    strike_s: float | None = None


@dataclass(frozen=True, slots=True)
class Share:
    """When a phrase is played.

    Attributes
    ----------
    start_s, end_s : on the take's clock.
    strike_s : None where nothing strikes.
    """

    start_s: float
    end_s: float
    strike_s: float | None


@dataclass(slots=True)
class _Terms:
    """A sum of weighted squares of ``x[right] - x[left] - at_s``; ``left`` may be -1, for zero."""

    left: list[int] = field(default_factory=list)
    right: list[int] = field(default_factory=list)
    at_s: list[float] = field(default_factory=list)
    weight: list[float] = field(default_factory=list)
    only_below: list[bool] = field(default_factory=list)

    def add(
        self, left: int, right: int, at_s: float, weight: float, *, only_below: bool = True
    ) -> None:
        """Add a term; by default it costs only where the difference is below ``at_s``."""
        self.left.append(left)
        self.right.append(right)
        self.at_s.append(at_s)
        self.weight.append(weight)
        self.only_below.append(only_below)

    def wish(self, left: int, right: int, needed_s: float, weight: float = 1.0) -> None:
        """Add the wish for a time between two moments."""
        for share, cost in WISHED:
            self.add(left, right, share * needed_s, weight * cost / needed_s**2)


def allotted(wishes: Sequence[Wish], start_s: float, end_s: float) -> list[Share]:
    """Share out the time of a take among its phrases, in their order.

    Parameters
    ----------
    wishes
        In time order, not overlapping.
    start_s, end_s
        Of the take; every phrase lies within.
    """
    if not wishes:
        return []
    terms, lasting_s = _Terms(), end_s - start_s
    drawn_s: list[float] = []  # from the take's start: seconds since 1970 have no digits to spare
    ends: list[tuple[int, int, int]] = []
    for wish in wishes:
        begin = len(drawn_s)
        moments = [wish.start_s, wish.end_s]
        if wish.strike_s is not None:
            moments.insert(1, wish.strike_s)
        drawn_s += [moment - start_s for moment in moments]
        end = len(drawn_s) - 1
        ends.append((begin, end if wish.strike_s is None else begin + 1, end))
    for i, (wish, (begin, strike, end)) in enumerate(zip(wishes, ends, strict=True)):
        for moment in (begin, end):
            terms.add(-1, moment, drawn_s[moment], DRAWN_WEIGHT, only_below=False)
        terms.wish(begin, strike, max(wish.before_s, SHORTEST_S))
        terms.add(begin, strike, min(SHORTEST_S, drawn_s[strike] - drawn_s[begin]), _FIRM)
        if strike != end:
            terms.wish(strike, end, max(wish.after_s, SHORTEST_S))
            terms.add(strike, end, min(SHORTEST_S, drawn_s[end] - drawn_s[strike]), _FIRM)
            _strike(terms, strike, drawn_s[strike])
        following = ends[i + 1][0] if i + 1 < len(ends) else None
        if following is not None:
            terms.add(end, following, 0.0, _FIRM)
            if wish.return_s > 0.0:
                terms.wish(end, following, wish.return_s, RETURN_WEIGHT)
        elif wish.return_s > 0.0:  # as above, up to the take's end
            for share, cost in WISHED:
                _below(
                    terms,
                    end,
                    lasting_s - share * wish.return_s,
                    RETURN_WEIGHT * cost / wish.return_s**2,
                )
    terms.add(-1, 0, 0.0, _FIRM)
    _below(terms, len(drawn_s) - 1, lasting_s, _FIRM)
    found_s = np.maximum.accumulate(np.clip(_least(terms, np.array(drawn_s)), 0.0, lasting_s))
    # Where there is no time at all, phrases still last a moment: they do where they were drawn.
    within_s = np.clip(np.array(drawn_s), 0.0, lasting_s)
    found_s += start_s + _LEAST * (within_s - found_s)
    return [
        Share(
            float(found_s[begin]),
            float(found_s[end]),
            None if wish.strike_s is None else float(found_s[strike]),
        )
        for wish, (begin, strike, end) in zip(wishes, ends, strict=True)
    ]


def _strike(terms: _Terms, moment: int, drawn_s: float) -> None:
    """Add what a strike's distance from the drawn one costs, to either side."""
    terms.add(-1, moment, drawn_s, STRIKE_WEIGHT, only_below=False)
    for beyond_s, weight in STRIKE_S:
        terms.add(-1, moment, drawn_s - beyond_s, weight)
        _below(terms, moment, drawn_s + beyond_s, weight)


def _below(terms: _Terms, moment: int, most_s: float, weight: float) -> None:
    """Add a term that costs where a moment is after a time: ``-x[moment] < -most_s``."""
    terms.left.append(moment)
    terms.right.append(-1)
    terms.at_s.append(-most_s)
    terms.weight.append(weight)
    terms.only_below.append(True)


def _least(terms: _Terms, first_s: FloatArray) -> FloatArray:
    """Return where the sum of squares is least, by Newton's method from a first guess.

    The sum is quadratic between the places where one-sided terms begin; a step leads to the minimum
    of the quadratic that holds where it starts. Its slope is continuous and piecewise linear, so
    that whole steps nearly always get there, most in less than ten (a semismooth Newton method
    [1]_); if they do not soon, they are halved until the sum falls.

    References
    ----------
    .. [1] L. Qi, J. Sun, "A nonsmooth version of Newton's method", Mathematical Programming 58,
       1993.
    """
    from scipy.linalg import solveh_banded

    left, right = np.array(terms.left), np.array(terms.right)
    at_s, weight = np.array(terms.at_s), np.array(terms.weight)
    one_sided = np.array(terms.only_below)

    def missing(x: FloatArray) -> FloatArray:
        padded = np.append(x, 0.0)  # index -1 is zero
        return padded[right] - padded[left] - at_s

    def cost(gap: FloatArray) -> float:
        return float(np.sum(weight * np.where(one_sided & (gap > 0.0), 0.0, gap) ** 2))

    x, gap = first_s.copy(), missing(first_s)
    for count in range(_MOST_STEPS):
        counts = ~one_sided | (gap < 0.0)
        slope = _slope(left, right, weight * gap, counts, len(x))
        step = -solveh_banded(_curvature(left, right, weight, counts, len(x)), slope, lower=True)
        if count >= _WHOLE_STEPS:
            before = cost(gap)
            while np.abs(step).max() > 1e-9 and cost(missing(x + step)) > before:
                step *= 0.5
        x = x + step
        gap = missing(x)
        if np.abs(step).max() < 1e-9:
            break
    return x


def _slope(
    left: IntArray, right: IntArray, force: FloatArray, counts: BoolArray, size: int
) -> FloatArray:
    """Return half the gradient of the sum ``(size,)``."""
    force = force[counts]
    pulls = np.bincount(right[counts] + 1, force, size + 1)
    return np.asarray(pulls - np.bincount(left[counts] + 1, force, size + 1))[1:]


def _curvature(
    left: IntArray, right: IntArray, weight: FloatArray, counts: BoolArray, size: int
) -> FloatArray:
    """Return half the sum's second derivatives, banded ``(3, size)``: no term spans more."""
    banded = np.zeros((3, size))
    for ends in (left[counts], right[counts]):
        banded[0] += np.bincount(ends + 1, weight[counts], size + 1)[1:]
    both = counts & (left >= 0) & (right >= 0)
    beside = left[both] + size * (right[both] - left[both])
    banded += np.bincount(beside, -weight[both], 3 * size).reshape(3, size)
    return banded
