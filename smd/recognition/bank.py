"""Bank: the patterns of a library, compiled so that all distances are computed at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from laban.frozen import Frozen
from smd.geometry.arrays import FloatArray, IntArray
from smd.recognition.automaton import FAR, compile_automaton
from smd.recognition.pattern import Pattern
from smd.recognition.token_costs import TokenCosts, unit_costs
from smd.recognition.tokens import Token, codes_of


class Front(NamedTuple):
    """The states of every automaton of a bank after the tokens so far.

    ``cost (s,)`` is the least cost of being at each state; ``start (s,)`` the token at which the
    substring with that cost begins, the last one if several cost the same.
    """

    cost: FloatArray
    start: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Bank(Frozen):
    """The automata of a library side by side: s states in all, action after action.

    Attributes
    ----------
    names : of the a actions.
    token_costs : the costs of substituting one token for another.
    tokens : (k,) int64, the codes of what the states read, state after state.
    first : (s,) int64, where each state begins in ``tokens``.
    state : (a,) int64, where each action begins among the states.
    enter, leave : (s,), tokens missing before a state that begins, and after one that ends.
    source, missing : (w,), the source state of each transition (int64), and the tokens missing on
        it; ordered by target state.
    way : (s,) int64, where the transitions to each state begin; each has one from itself.
    shortest : (a,), tokens of the shortest string.
    """

    names: tuple[str, ...]
    token_costs: TokenCosts
    tokens: IntArray
    first: IntArray
    state: IntArray
    enter: FloatArray
    leave: FloatArray
    source: IntArray
    missing: FloatArray
    way: IntArray
    shortest: FloatArray

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, np.ndarray):
                value.flags.writeable = False

    def __len__(self) -> int:
        return len(self.names)

    def reading(self, tokens: Iterable[Token]) -> FloatArray:
        """Return ``(n, s)``, the cost of taking each of n tokens for one that a state reads."""
        codes = codes_of(tokens)
        kinds, kind = np.unique(codes, return_inverse=True)
        if not len(self.first):
            return np.zeros((len(codes), 0))
        return self.token_costs.to_nearest(kinds, self.tokens, self.first)[kind]

    def nowhere(self) -> Front:
        """Return the front before any token."""
        shape = self.enter.shape
        return Front(np.full(shape, np.inf), np.full(shape, -1, dtype=np.int64))

    def after(
        self, front: Front, *, entering: float, at: int, read: FloatArray, skip: float
    ) -> Front:
        """Return the front one token later.

        The token is deleted from the substring so far, or read by a state that is reached from
        another one (or from itself, since repetition does not count), or by a state at which a
        substring begins::

            cost'(c) = min( cost(c) + skip,
                            min over b of cost(b) + missing(b, c) + read(c),
                            entering + enter(c) + read(c) )

        Parameters
        ----------
        entering
            The cost of everything before this token, if a substring begins here.
        at
            The token's number.
        read
            ``(s,)``, the cost of reading the token at each state.
        skip
            The cost of deleting the token.
        """
        ways = front.cost[self.source] + self.missing
        going_on = np.minimum.reduceat(ways, self.way)
        count = np.diff(self.way, append=len(ways))
        best = ways == np.repeat(going_on, count)
        since = np.maximum.reduceat(np.where(best, front.start[self.source], -1), self.way)
        beginning = entering + self.enter
        since[beginning <= going_on] = at
        arriving = np.minimum(beginning, going_on) + read
        skipping = front.cost + skip
        start = np.where(skipping < arriving, front.start, since)
        equal = skipping == arriving
        start[equal] = np.maximum(front.start, since)[equal]
        return Front(np.minimum(skipping, arriving), start)

    def leaving(self, front: Front) -> Front:
        """Return ``(a,)`` the least cost of ending here, and where that substring began."""
        ways = front.cost + self.leave
        least = np.minimum.reduceat(ways, self.state)
        best = ways == np.repeat(least, np.diff(self.state, append=len(ways)))
        return Front(least, np.maximum.reduceat(np.where(best, front.start, -1), self.state))


@dataclass(frozen=True, slots=True, eq=False)
class Occurrences:
    """The nearest substrings to each of ``a`` patterns, by their ends.

    Attributes
    ----------
    distance : (n + 1, a), ``distance[j]`` the least distance of a substring that ends before
        token j; it may be empty.
    start : (n + 1, a) int64, where that substring begins; the shortest one if several are as near.
    """

    distance: FloatArray
    start: IntArray


def compile_library(patterns: Mapping[str, Pattern], token_costs: TokenCosts | None = None) -> Bank:
    """Compile patterns by action; unit costs if none are given.

    See `compile_automaton` for what a state is. A step of the bank takes O(w) operations for w
    transitions, all in a dozen array operations.
    """
    automata = [compile_automaton(pattern) for pattern in patterns.values()]
    reads = [codes_of(sorted(tokens)) for each in automata for tokens in each.tokens]
    begins = _begins([len(each) for each in automata])
    # By where they lead, then by where they come from: the transposed tables' order.
    ways = [np.argwhere(each.step.T < FAR) for each in automata]
    leads = [int(begin) + way[:, 0] for begin, way in zip(begins, ways, strict=True)]
    comes = [int(begin) + way[:, 1] for begin, way in zip(begins, ways, strict=True)]
    missing = [each.step[way[:, 1], way[:, 0]] for each, way in zip(automata, ways, strict=True)]
    states = sum(map(len, automata))
    return Bank(
        names=tuple(patterns),
        token_costs=token_costs or unit_costs(),
        tokens=_joined(reads),
        first=_begins([len(codes) for codes in reads]),
        state=begins,
        enter=_reachable([each.enter for each in automata]),
        leave=_reachable([each.leave for each in automata]),
        source=_joined(comes),
        missing=_joined(missing).astype(np.float64),
        way=np.searchsorted(_joined(leads), np.arange(states)),
        shortest=np.array([each.shortest for each in automata], dtype=np.float64),
    )


def occurrences(bank: Bank, word: Sequence[Token]) -> Occurrences:
    """Find, for each action and each end in a string, the substring nearest to the pattern.

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
        ``(n, s)``, the cost of reading token i at each state.
    skip
        ``(n,)``, the cost of deleting token i. A missing token costs 1.
    """
    return least_costs_of_parts(bank, [(0, len(read))], read=read, skip=skip)[0]


def least_costs_of_parts(
    bank: Bank, parts: Sequence[tuple[int, int]], *, read: FloatArray, skip: FloatArray
) -> FloatArray:
    """Return ``(k, a)``, the `least_costs` of k parts of a string, all at once.

    Parameters
    ----------
    parts
        Each the number of its first token and of the one after its last. Those that begin
        together are measured together.
    read, skip
        Of the whole string, as in `least_costs`.
    """
    costs = np.tile(bank.shortest, (len(parts), 1))  # of a part without a token
    wanted: dict[int, dict[int, list[int]]] = {}
    for number, (first, last) in enumerate(parts):
        if last > first:
            wanted.setdefault(first, {}).setdefault(last - first, []).append(number)
    if not len(bank) or not wanted:
        return costs
    longest = {first: max(lengths) for first, lengths in wanted.items()}
    firsts = np.array(sorted(longest, key=longest.__getitem__, reverse=True))
    lengths = np.array([longest[first] for first in firsts.tolist()])
    ends: dict[int, list[tuple[int, int]]] = {}  # by length: whose it is, and which part
    for lane, first in enumerate(firsts.tolist()):
        for length, numbers in wanted[first].items():
            ends.setdefault(length, []).extend((lane, number) for number in numbers)
    enter, leave, missing = (a[:, None] for a in (bank.enter, bank.leave, bank.missing))
    cost = np.full((len(bank.enter), len(firsts)), np.inf)
    unread = np.zeros(len(firsts))
    for j in range(int(lengths[0])):
        still = int(np.searchsorted(-lengths, -j))  # lanes that have a token j
        at = firsts[:still] + j
        cost, unread = cost[:, :still], unread[:still]
        going_on = np.minimum.reduceat(cost[bank.source] + missing, bank.way, axis=0)
        arriving = np.minimum(unread + enter, going_on) + read[at].T
        cost = np.minimum(cost + skip[at], arriving)
        unread = unread + skip[at]
        if j + 1 in ends:
            lanes, numbers = np.array(ends[j + 1]).T
            ending = np.minimum.reduceat(cost[:, lanes] + leave, bank.state, axis=0)
            costs[numbers] = np.minimum(unread[lanes] + bank.shortest[:, None], ending).T
    return costs


def _begins(lengths: Sequence[int]) -> IntArray:
    """Return where each of several parts begins, one after the other."""
    return np.cumsum([0, *lengths], dtype=np.int64)[:-1]


def _joined(parts: Sequence[IntArray]) -> IntArray:
    """Return parts one after the other."""
    return np.concatenate([np.zeros(0, np.int64), *parts])


def _reachable(missing: Sequence[IntArray]) -> FloatArray:
    """Return numbers of missing tokens, infinite where no way leads."""
    joined = _joined(missing)
    return np.where(joined >= FAR, np.inf, joined)
