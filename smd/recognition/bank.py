"""Bank: the patterns of a library, compiled to be measured all at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.automaton import FAR, compile_automaton
from smd.recognition.pattern import Pattern
from smd.recognition.token_costs import TokenCosts, codes_of, unit_costs
from smd.recognition.tokens import Token


class Front(NamedTuple):
    """How far a string has come in every automaton of a bank.

    ``cost (a, p)`` is the least cost of standing at each state; ``start (a, p)`` the token at
    which the part that does so begins, the last one where several cost the same.
    """

    cost: FloatArray
    start: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Bank:
    """The automata of a library side by side, each padded to p states.

    Attributes
    ----------
    names : of the a actions.
    token_costs : what it costs to take one token for another.
    tokens : (k,) int64, the codes of what the states read, state after state.
    first : (s,) int64, where each of the s states begins in ``tokens``.
    slot : (s,) int64, its place among the ``a * p`` padded ones.
    enter, leave : (a, p), tokens missing before a state that begins, and after one that ends;
        infinite for states that are padding.
    step : (p, a, p), ``step[b, i, c]`` tokens missing between states b and c of automaton i;
        infinite where no way leads.
    shortest : (a,), tokens of the shortest string.
    """

    names: tuple[str, ...]
    token_costs: TokenCosts
    tokens: IntArray
    first: IntArray
    slot: IntArray
    enter: FloatArray
    leave: FloatArray
    step: FloatArray
    shortest: FloatArray

    def __post_init__(self) -> None:
        for name in ("tokens", "first", "slot", "enter", "leave", "step", "shortest"):
            getattr(self, name).flags.writeable = False

    def __len__(self) -> int:
        return len(self.names)

    def reading(self, tokens: Iterable[Token]) -> FloatArray:
        """Return ``(n, a, p)``, the cost of taking each of n tokens for one that a state reads."""
        codes = codes_of(tokens)
        kinds, kind = np.unique(codes, return_inverse=True)
        read = np.zeros((len(kinds), self.enter.size))
        if len(self.first):
            each = self.token_costs.matrix[np.ix_(kinds, self.tokens)]
            read[:, self.slot] = np.minimum.reduceat(each, self.first, axis=1)
        return read[kind].reshape(len(codes), *self.enter.shape)

    def nowhere(self) -> Front:
        """Return the front before any token."""
        shape = self.enter.shape
        return Front(np.full(shape, np.inf), np.full(shape, -1, dtype=np.int64))

    def after(
        self, front: Front, *, entering: float, at: int, read: FloatArray, skip: float
    ) -> Front:
        """Return the front one token later.

        The token is left out of the part so far, or read by a state that the part comes to from
        another one (or from itself, since repetition does not count), or by a state at which a
        part begins::

            cost'(c) = min( cost(c) + skip,
                            min over b of cost(b) + step(b, c) + read(c),
                            entering + enter(c) + read(c) )

        Parameters
        ----------
        entering
            What it has cost to get to this token without any part.
        at
            The token's number.
        read
            ``(a, p)``, what it costs to take the token for one that a state reads.
        skip
            What it costs to leave the token out.
        """
        ways = front.cost.T[:, :, None] + self.step
        going_on = ways.min(axis=0)
        since = np.where(ways == going_on, front.start.T[:, :, None], -1).max(axis=0)
        beginning = entering + self.enter
        since[beginning <= going_on] = at
        arriving = np.minimum(beginning, going_on) + read
        skipping = front.cost + skip
        start = np.where(skipping < arriving, front.start, since)
        equal = skipping == arriving
        start[equal] = np.maximum(front.start, since)[equal]
        return Front(np.minimum(skipping, arriving), start)

    def leaving(self, front: Front) -> Front:
        """Return ``(a,)`` the least cost of ending here, and where the part that does so began."""
        ways = front.cost + self.leave
        least = ways.min(axis=1)
        start = np.where(ways == least[:, None], front.start, -1).max(axis=1)
        return Front(least, start)


@dataclass(frozen=True, slots=True, eq=False)
class Occurrences:
    """Where in a string something like each of a patterns ends.

    Attributes
    ----------
    distance : (n + 1, a), ``distance[j]`` the least distance of a part that ends before token j;
        the part may be empty.
    start : (n + 1, a) int64, where that part begins; the shortest one if several are as near.
    """

    distance: FloatArray
    start: IntArray


def compile_library(patterns: Mapping[str, Pattern], token_costs: TokenCosts | None = None) -> Bank:
    """Compile patterns by action; unit costs if none are given.

    See `compile_automaton` for what a state is. A step of the bank takes O(a p^2) operations for
    a patterns of at most p states each, all in a dozen array operations.
    """
    automata = [compile_automaton(pattern) for pattern in patterns.values()]
    a, p = len(automata), max(map(len, automata), default=0)
    enter, leave = np.full((2, a, p), np.inf)
    step = np.full((p, a, p), np.inf)
    reads: list[IntArray] = []
    slot: list[int] = []
    for i, automaton in enumerate(automata):
        own = slice(len(automaton))
        enter[i, own] = _reachable(automaton.enter)
        leave[i, own] = _reachable(automaton.leave)
        step[own, i, own] = _reachable(automaton.step)
        reads += [codes_of(sorted(tokens)) for tokens in automaton.tokens]
        slot += range(i * p, i * p + len(automaton))
    return Bank(
        names=tuple(patterns),
        token_costs=token_costs or unit_costs(),
        tokens=np.concatenate([np.zeros(0, np.int64), *reads]),
        first=np.cumsum([0, *map(len, reads)][:-1] if reads else [], dtype=np.int64),
        slot=np.array(slot, dtype=np.int64),
        enter=enter,
        leave=leave,
        step=step,
        shortest=np.array([automaton.shortest for automaton in automata], dtype=np.float64),
    )


def occurrences(bank: Bank, word: Sequence[Token]) -> Occurrences:
    """Find, for each action and each end in a string, the part that is nearest to the pattern.

    One pass over the string (Sellers' algorithm [1]_ on automata), exact. A token too many and a
    token missing cost 1, a wrong one what ``bank.token_costs`` say.

    References
    ----------
    .. [1] P. H. Sellers, "The Theory and Computation of Evolutionary Distances: Pattern
       Recognition", Journal of Algorithms 1(4), 1980.
    """
    distance = np.empty((len(word) + 1, len(bank)))
    start = np.empty((len(word) + 1, len(bank)), dtype=np.int64)
    if not len(bank):
        return Occurrences(distance, start)
    distance[0], start[0] = bank.shortest, 0
    front = bank.nowhere()
    for j, read in enumerate(bank.reading(word)):
        front = bank.after(front, entering=0.0, at=j, read=read, skip=1.0)
        ending = bank.leaving(front)
        # Nothing at all is a part too, and the shortest.
        distance[j + 1] = np.minimum(ending.cost, bank.shortest)
        start[j + 1] = np.where(bank.shortest <= ending.cost, j + 1, ending.start)
    return Occurrences(distance, start)


def distances(bank: Bank, word: Sequence[Token]) -> FloatArray:
    """Return ``(a,)``, the least cost of the edits that turn a string into one of each pattern."""
    return least_costs(bank, read=bank.reading(word), skip=np.ones(len(word)))


def least_costs(bank: Bank, *, read: FloatArray, skip: FloatArray) -> FloatArray:
    """Return ``(a,)``, the least cost of turning a string of n tokens into one of each pattern.

    Parameters
    ----------
    read
        ``(n, a, p)``, what it costs to take token i for one that a state reads.
    skip
        ``(n,)``, what it costs to leave token i out. A missing token costs 1.
    """
    return least_costs_by_end(bank, read=read, skip=skip)[-1]


def least_costs_by_end(bank: Bank, *, read: FloatArray, skip: FloatArray) -> FloatArray:
    """Return ``(n + 1, a)``, the `least_costs` of the first 0 to n tokens of a string."""
    costs = np.empty((len(read) + 1, len(bank)))
    costs[0] = bank.shortest
    if not len(bank):
        return costs
    unread = 0.0
    front = bank.nowhere()
    for j, (reading, skipping) in enumerate(zip(read, skip.tolist(), strict=True)):
        front = bank.after(front, entering=unread, at=j, read=reading, skip=skipping)
        unread += skipping
        costs[j + 1] = np.minimum(unread + bank.shortest, bank.leaving(front).cost)
    return costs


def _reachable(missing: IntArray) -> FloatArray:
    """Return numbers of missing tokens, infinite where no way leads."""
    return np.where(missing >= FAR, np.inf, missing)
