"""Committee: simple classifiers, each weighted by its likelihood on held-out performers.

Each member classifies by a family of entries (`laban.description.FAMILIES`), with logistic
regression or naive Bayes; one uses products of entries as well. A few takes cannot show which
member is best, and choosing one would be luck. So each has a share in the log odds that falls with
its loss on held-out performers (as in Bayesian model averaging [1]_). With many takes one member
has the whole share. All members are weighted sums, and so is the committee.

The committee is calibrated on the same held-out takes: its log odds are multiplied by the one
number that maximizes the likelihood of the labels ("temperature" [2]_). The sign, and with it the
decision, does not change.

References
----------
.. [1] J. A. Hoeting, D. Madigan, A. E. Raftery, C. T. Volinsky, "Bayesian Model Averaging: A
   Tutorial", Statistical Science 14(4), 1999.
.. [2] C. Guo, G. Pleiss, Y. Sun, K. Q. Weinberger, "On Calibration of Modern Neural Networks",
   ICML 2017.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from laban.description import FAMILIES, MULTIPLIED
from laban.linear import Linear, fit_linear, fit_shared_variance
from laban.motion import FloatArray

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]

MOST_FOLDS, FEW_TAKES = 12, 200
"""With at most so many performers and so many takes, folds are performers; else `GROUPS` groups."""

GROUPS = 5

POWER = 0.25
"""Power of the likelihood in a member's share, below 1 because takes of one person are not
independent. `benchmarks.effort_committee` compares powers where takes are few."""

LEAST_SHARE = 0.01
"""A member with a smaller share is dropped, so that a model stays small."""

PRODUCTS_RIDGE = 10.0
"""Ridge penalty of the member with hundreds of weights."""

FACTORS = np.geomspace(0.02, 10.0, 125)
"""Temperatures that are tried: factors of the log odds."""

ENTRY_NAMES: tuple[str, ...] = tuple(dict.fromkeys(n for names in FAMILIES.values() for n in names))
"""The entries that any member uses."""

PAIRS: IntArray = np.array(
    [
        (ENTRY_NAMES.index(one), ENTRY_NAMES.index(other))
        for i, one in enumerate(MULTIPLIED)
        for other in MULTIPLIED[i:]
    ],
    dtype=np.int64,
)
"""(p, 2) indices of entries whose products are used, squares among them."""

COUNT = len(ENTRY_NAMES) + len(PAIRS)
"""Number of entries and products."""


@dataclass(frozen=True, slots=True, eq=False)
class Member:
    """A classifier to be trained on some of the entries and products.

    Attributes
    ----------
    columns : indices of entries and products.
    fit : trains on ``(n, k)`` of these, and on which takes are of the high pole.
    least_takes : with fewer takes the member is left out.
    """

    columns: IntArray
    fit: Callable[[FloatArray, BoolArray], Linear]
    least_takes: int = 0

    def learned(self, seen: FloatArray, goal: FloatArray) -> Linear:
        """Train on the takes of either pole among ``(n, COUNT)``; with one pole alone, not."""
        poles = goal != 0
        high = goal[poles] > 0
        if high.all() or not high.any():
            return Linear(np.zeros(COUNT), 0.0)
        return self.fit(seen[poles][:, self.columns], high).among(self.columns, COUNT)


def _members() -> dict[str, Member]:
    members = {}
    for family, names in FAMILIES.items():
        columns = np.array([ENTRY_NAMES.index(name) for name in names], dtype=np.int64)
        members[family] = Member(columns, fit_linear)
        members[f"{family} (naive Bayes)"] = Member(columns, fit_shared_variance)
    products = np.arange(len(ENTRY_NAMES), COUNT, dtype=np.int64)
    members["products"] = Member(
        np.concatenate([members["everything"].columns, products]),
        lambda seen, high: fit_linear(seen, high, PRODUCTS_RIDGE),
        least_takes=COUNT,
    )
    return members


MEMBERS: Mapping[str, Member] = MappingProxyType(_members())
"""By name."""


@dataclass(frozen=True, slots=True, eq=False)
class Committee:
    """The weighted sum of the members.

    Attributes
    ----------
    classifier : on entries and products ``(COUNT,)``, calibrated.
    shares : by member, the largest first; dropped members are absent.
    """

    classifier: Linear
    shares: Mapping[str, float]


def folds(performers: IntArray) -> list[BoolArray]:
    """Return the folds of cross-validation, as masks of takes: performers, or groups of them."""
    names = np.unique(performers)
    few = len(names) <= MOST_FOLDS and len(performers) <= FEW_TAKES
    groups = np.arange(len(names)) % (len(names) if few else GROUPS)
    return [np.isin(performers, names[groups == g]) for g in np.unique(groups)]


def convened(seen: FloatArray, goal: FloatArray, whose: IntArray) -> Committee:
    """Train every member, its share and the calibration of the whole.

    Parameters
    ----------
    seen
        ``(n, COUNT)`` entries and products.
    goal
        ``(n,)``: -1 low pole, 1 high pole, 0 neither. Takes of neither are not used in training,
        but count half for each pole in the likelihood: so neutral movement reads near 0 where
        poles are easy to tell apart.
    whose
        ``(n,)`` indices of performers.
    """
    out = folds(whose)
    odds, factors, losses = {}, {}, {}
    for name, member in MEMBERS.items():
        if len(goal) < member.least_takes:
            continue
        odds[name] = held_out_odds(member, seen, goal, out)
        factors[name], losses[name] = temperature(odds[name], goal)
    best = min(losses.values())
    share = {name: float(np.exp(POWER * (best - loss))) for name, loss in losses.items()}
    whole = sum(share.values())
    share = {name: s / whole for name, s in share.items() if s / whole >= LEAST_SHARE}
    whole = sum(share.values())
    voice = {name: s / whole * factors[name] for name, s in share.items()}
    factor, _ = temperature(
        np.sum([voice[name] * odds[name] for name in share], axis=0, dtype=np.float64), goal
    )
    heard = [MEMBERS[name].learned(seen, goal).times(factor * voice[name]) for name in share]
    in_order = sorted(share, key=lambda name: -share[name])
    return Committee(
        Linear(np.sum([m.weight for m in heard], axis=0), sum(m.bias for m in heard)),
        {name: share[name] / whole for name in in_order},
    )


def temperature(log_odds: FloatArray, goal: FloatArray) -> tuple[float, float]:
    """Return the factor that calibrates held-out log odds, and the remaining loss.

    The loss is the negative log likelihood of the labels. One more take of either pole at even
    odds is counted with them (Laplace's rule).
    """
    odds = np.append(log_odds, [0.5, 0.5])
    high = 0.5 * (1.0 + np.append(goal, [1.0, -1.0]))
    scaled = FACTORS[:, None] * odds
    loss = (np.logaddexp(0.0, scaled) - high * scaled).sum(axis=1)
    best = int(np.argmin(loss))
    return float(FACTORS[best]), float(loss[best])


def held_out_odds(
    member: Member, seen: FloatArray, goal: FloatArray, out: list[BoolArray]
) -> FloatArray:
    """Return a member's held-out log odds: of each take, trained without its performer."""
    odds = np.zeros(len(goal))
    for asked in out:
        odds[asked] = member.learned(seen[~asked], goal[~asked]).log_odds(seen[asked])
    return odds
