"""Languages: exact comparisons of the languages of two patterns, with a string that shows each.

All functions traverse two compiled automata in parallel (product construction). Strings have no
equal neighbours, since the repetition of a token does not matter.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from smd.geometry.arrays import BoolArray
from smd.recognition.automaton import compile_automaton
from smd.recognition.pattern import Pattern, merged
from smd.recognition.tokens import Token

Word = tuple[Token, ...]
Replaceable = Callable[[Sequence[Token], Sequence[Token]], BoolArray]


@dataclass(frozen=True, slots=True)
class NearestWords:
    """A string of each of two patterns, as near to each other as any.

    Attributes
    ----------
    distance : edits that turn one into the other, at least 0.
    first, second : the strings, without equal neighbours; equal at distance 0.
    """

    distance: int
    first: Word
    second: Word


def nearest_words(
    a: Pattern,
    b: Pattern,
    *,
    most: int,
    replaceable: Replaceable = lambda tokens, others: np.ones((len(tokens), len(others)), bool),
) -> NearestWords | None:
    """Return the least edit distance between any string of one pattern and any of the other.

    An edit inserts, deletes or replaces a token. Either string may repeat its tokens before it is
    edited: ``T_Z T_Y T_Z`` is one edit from ``T_Z``. The search is breadth-first by edits, over
    pairs of states.

    Parameters
    ----------
    most
        Largest distance to search, in edits.
    replaceable
        For tokens of the one and of the other pattern, ``(n, m)``: whether one edit replaces the
        first by the second; if not, it takes two.

    Returns
    -------
    NearestWords or None
        None if they are further apart. Strings of distance 0 are the shortest ones.
    """
    return _nearest(_walk(a), _walk(b), most, replaceable)


def inner_word(a: Pattern, part: Pattern) -> Word | None:
    """Return the shortest string of ``part`` that lies inside a string of ``a``; None if none.

    A string lies inside another one if its tokens follow each other there without a gap.
    """
    whole = _walk(a)
    anywhere = whole.step.copy()
    anywhere[-1, :-1] = True
    found = _nearest(_walk(part), _Walk(whole.reads, anywhere, ~whole.is_start), 0)
    return found.first if found else None


def extra_word(a: Pattern, b: Pattern) -> Word | None:
    """Return the shortest string of ``a`` that ``b`` does not accept; None if it accepts all.

    The set of states that ``b`` may be in is followed (subset construction); of several sets that
    meet the same state of ``a``, only those that contain no other are followed further, which
    keeps them few (antichains [1]_).

    References
    ----------
    .. [1] M. De Wulf et al., "Antichains: A New Algorithm for Checking Universality of Finite
       Automata", CAV 2006.
    """
    return _extra(_walk(a), _walk(b))


def word_without(a: Pattern, part: Pattern) -> Word | None:
    """Return the shortest string of ``a`` with none of ``part`` inside; None if all have one."""
    return _extra(_walk(a), _around(_walk(part), a))


def holding_word(a: Pattern, part: Pattern) -> Word | None:
    """Return the shortest string of ``a`` with one of ``part`` inside; None if none has."""
    found = _nearest(_walk(a), _around(_walk(part), a), 0)
    return found.first if found else None


@dataclass(frozen=True, slots=True, eq=False)
class _Walk:
    """Paths through a pattern's p states with no token missing; the last state is the start.

    Attributes
    ----------
    reads : the tokens that each state reads; none for the start.
    step : (p + 1, p + 1) bool, whether the second may follow the first.
    leave : (p + 1,) bool, whether a string may end there.
    """

    reads: tuple[frozenset[Token], ...]
    step: BoolArray
    leave: BoolArray

    @property
    def is_start(self) -> BoolArray:
        return np.arange(len(self.reads)) == len(self.reads) - 1


@lru_cache(maxsize=256)
def _readers(walk: _Walk) -> tuple[tuple[Token, ...], np.ndarray]:
    """Return the t tokens of a walk and ``(t, p + 1)`` float32: 1 where a state reads a token."""
    tokens = tuple(sorted(set().union(*walk.reads)))
    rows = [[token in reads for reads in walk.reads] for token in tokens]
    return tokens, np.array(rows, dtype=np.float32)


@lru_cache(maxsize=256)
def _ways_out(walk: _Walk) -> list[list[tuple[int, Token]]]:
    """Return for each state the states that may follow it, with each token they read."""
    plain = [sorted(reads, key=_plain) for reads in walk.reads]
    return [[(int(s), t) for s in np.flatnonzero(row) for t in plain[s]] for row in walk.step]


@lru_cache(maxsize=256)
def _walk(pattern: Pattern) -> _Walk:
    automaton = compile_automaton(pattern)
    p = len(automaton)
    step = np.zeros((p + 1, p + 1), bool)
    step[:p, :p] = automaton.step == 0
    step[p, :p] = automaton.enter == 0
    return _Walk((*automaton.tokens, frozenset()), step, np.append(automaton.leave == 0, False))


def _extra(ours: _Walk, theirs: _Walk) -> Word | None:
    """Return the shortest string of one walk that is none of the other."""
    step = [_bits(row) for row in theirs.step]
    leave = _bits(theirs.leave)
    readers = {token: _bits(row) for token, row in zip(*_readers(theirs), strict=True)}
    ways = _ways_out(ours)
    start = len(ways) - 1
    followed: list[list[int]] = [[] for _ in ways]
    queue: deque[tuple[int, int, Word]] = deque([(start, 1 << (len(step) - 1), ())])
    while queue:
        state, others, word = queue.popleft()
        if ours.leave[state] and not others & leave:
            return word
        after = 0
        for other in _states(others):
            after |= step[other]
        for there, token in ways[state]:
            if word and token == word[-1]:
                continue
            left = after & readers.get(token, 0)
            if not any(known & left == known for known in followed[there]):
                followed[there].append(left)
                queue.append((there, left, (*word, token)))
    return None


def _around(inner: _Walk, a: Pattern) -> _Walk:
    """Return the walk of all strings of a pattern's tokens with a string of ``inner`` inside."""
    p = len(inner.reads)
    # Any tokens before and after: state p reads on until the part begins, p + 1 once it has ended.
    step = np.zeros((p + 2, p + 2), bool)
    step[: p - 1, : p - 1] = inner.step[:-1, :-1]
    step[p - 1 : p + 1, : p - 1] = inner.step[-1, :-1]
    step[p - 1 : p + 1, p] = True
    step[: p - 1, p + 1] = inner.leave[:-1]
    step[p + 1, p + 1] = True
    any_token = frozenset(a.tokens())
    reads = (*inner.reads, any_token, any_token)
    leave = np.append(inner.leave, [False, True])
    order = [*range(p - 1), p, p + 1, p - 1]  # the start comes last
    return _Walk(tuple(reads[i] for i in order), step[np.ix_(order, order)], leave[order])


def _nearest(
    a: _Walk,
    b: _Walk,
    most: int,
    replaceable: Replaceable | None = None,
) -> NearestWords | None:
    """Return the nearest strings of two walks, at most ``most`` edits apart."""
    step_a, step_b = a.step.astype(np.float32), b.step.astype(np.float32)
    (tokens_a, rows_a), (tokens_b, rows_b) = _readers(a), _readers(b)
    known = {token: i for i, token in enumerate(tokens_b)}
    same = np.zeros((len(tokens_a), len(tokens_b)), np.float32)
    for i, token in enumerate(tokens_a):
        if token in known:
            same[i, known[token]] = 1.0
    alike = rows_a.T @ same @ rows_b > 0
    like = alike
    if most and replaceable:
        like = rows_a.T @ replaceable(tokens_a, tokens_b).astype(np.float32) @ rows_b > 0
    goal = a.leave[:, None] & b.leave
    reached = a.is_start[:, None] & b.is_start
    layers = [reached]
    for distance in range(most + 1):
        while True:
            if (reached & goal).any():
                end = np.argwhere(reached & goal)[0]
                return NearestWords(
                    distance, *_traced(a, b, alike | like, replaceable, layers, end)
                )
            more = reached | (_stepped(reached, step_a, step_b) & alike)
            if (more == reached).all():
                break
            reached = more
            layers.append(reached)
        if distance < most:
            now = reached.astype(np.float32)
            replaced = _stepped(reached, step_a, step_b) & like
            reached = reached | replaced | (step_a.T @ now > 0) | (now @ step_b > 0)
            layers.append(reached)
    return None


def _stepped(reached: BoolArray, step_a: np.ndarray, step_b: np.ndarray) -> BoolArray:
    """Return the pairs of states after a step of both."""
    return np.asarray(step_a.T @ reached.astype(np.float32) @ step_b > 0)


def _traced(
    a: _Walk,
    b: _Walk,
    paired: BoolArray,
    replaceable: Replaceable | None,
    layers: list[BoolArray],
    end: np.ndarray,
) -> tuple[Word, Word]:
    """Return the strings of a way back from a pair of states to the two starts."""
    p, q = (int(state) for state in end)
    first: list[Token] = []
    second: list[Token] = []
    while layer := next(k for k, reached in enumerate(layers) if reached[p, q]):
        before = layers[layer - 1]
        both = before & a.step[:, p, None] & b.step[:, q]
        if both.any() and paired[p, q]:
            ours, theirs = _pair(a.reads[p], b.reads[q], replaceable)
            first.append(ours)
            second.append(theirs)
            p, q = (int(state) for state in np.argwhere(both)[0])
        elif (alone := before[:, q] & a.step[:, p]).any():
            first.append(min(a.reads[p], key=_plain))
            p = int(alone.argmax())
        else:
            second.append(min(b.reads[q], key=_plain))
            q = int((before[p] & b.step[:, q]).argmax())
    return merged(tuple(first[::-1])), merged(tuple(second[::-1]))


def _pair(
    tokens: frozenset[Token], others: frozenset[Token], replaceable: Replaceable | None
) -> tuple[Token, Token]:
    """Return the plainest token of both, or else a token and one that may replace it."""
    if common := tokens & others:
        token = min(common, key=_plain)
        return token, token
    assert replaceable is not None  # else nothing but the same is paired
    rows, columns = sorted(tokens, key=_plain), sorted(others, key=_plain)
    i, j = np.argwhere(replaceable(rows, columns))[0]
    return rows[i], columns[j]


def _plain(token: Token) -> tuple[int, Token]:
    """Sort tokens along few axes first."""
    return sum(map(abs, (*token.translation, *token.rotation))), token


def _bits(row: BoolArray) -> int:
    """Return a set of states as an integer."""
    return sum(1 << int(state) for state in np.flatnonzero(row))


def _states(bits: int) -> Iterator[int]:
    """Yield the states of a set."""
    while bits:
        lowest = bits & -bits
        yield lowest.bit_length() - 1
        bits ^= lowest
