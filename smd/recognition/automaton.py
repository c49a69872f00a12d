"""Automaton: the least edit distance from a token string to the language of a pattern."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from laban.frozen import Frozen
from smd.errors import PatternError
from smd.geometry.arrays import FloatArray, IntArray, frozen_array
from smd.recognition import pattern as ast
from smd.recognition.pattern import Pattern
from smd.recognition.token_costs import TokenCosts, unit_costs
from smd.recognition.tokens import Token, codes_of

FAR = 1 << 30
"""More edits than any string needs: there is no path."""


@dataclass(frozen=True, slots=True, eq=False)
class Automaton(Frozen):
    """A pattern compiled for edit distances: its states, and the number of tokens between them.

    Each occurrence of a token in the pattern is a position (Glushkov's construction [1]_), and
    positions with the same past and future share a state, as all of ``(T_Z|T_X_Z)+`` does. A
    string follows a path through states and may stay at each for any number of tokens, since
    repetition of a token does not count; for the same reason neighbouring positions of one token
    can be read as one. The counts are the least number of tokens that a path passes without
    reading them, which are the tokens missing from the string.

    Attributes
    ----------
    tokens : the tokens that each of the p states reads.
    enter : (p,) int64, tokens missing if a string begins at a state.
    step : (p, p) int64, ``step[a, b]`` tokens missing if state b reads after a; `FAR` where there
        is no path from a to b.
    leave : (p,) int64, tokens missing if a string ends at a state.

    References
    ----------
    .. [1] V. M. Glushkov, "The Abstract Theory of Automata", Russian Mathematical Surveys 16(5),
       1961.
    """

    tokens: tuple[frozenset[Token], ...]
    enter: IntArray
    step: IntArray
    leave: IntArray

    def __post_init__(self) -> None:
        p = len(self.tokens)
        for name, shape in (("enter", (p,)), ("step", (p, p)), ("leave", (p,))):
            array = frozen_array(name, getattr(self, name), shape, PatternError, np.int64)
            object.__setattr__(self, name, array)

    def __len__(self) -> int:
        return len(self.tokens)

    @property
    def shortest(self) -> int:
        """Number of tokens in the shortest string of the pattern."""
        return int((self.enter + self.leave).min()) + 1


@lru_cache(maxsize=256)
def compile_automaton(pattern: Pattern) -> Automaton:
    """Compile a pattern; for m occurrences of tokens this takes O(m^3) time, once."""
    tokens: list[Token] = []
    follow: list[tuple[set[int], set[int]]] = []
    first, last, _ = _glushkov(pattern.root, tokens, follow)
    changes = _least_changes(tokens, follow)
    enter = changes[sorted(first)].min(axis=0)
    step = np.maximum(changes - 1, 0)
    leave = changes[:, sorted(last)].min(axis=1)
    alike: dict[bytes, list[int]] = {}
    for i in range(len(tokens)):
        key = np.concatenate([[enter[i], leave[i]], step[i], step[:, i]]).tobytes()
        alike.setdefault(key, []).append(i)
    kept = [positions[0] for positions in alike.values()]
    return Automaton(
        tokens=tuple(frozenset(tokens[i] for i in positions) for positions in alike.values()),
        enter=enter[kept],
        step=step[np.ix_(kept, kept)],
        leave=leave[kept],
    )


def edit_distance(
    automaton: Automaton, word: Sequence[Token], token_costs: TokenCosts | None = None
) -> float:
    """Return the least cost of the edits that turn ``word`` into a string of the pattern.

    An edit inserts or deletes a token at the cost of 1, or replaces one at its cost in
    ``token_costs``, which is 1 if none are given. A string belongs to the pattern if, with runs of
    equal tokens merged, it is one of the pattern's words (the Levenshtein distance of section 4.2
    of the paper, exact for any repetition). `bank.distances` is the fast form, for many patterns.
    """
    read = reading(automaton, word, token_costs or unit_costs())
    return least_cost(automaton, read=read, skip=np.ones(len(word)))


def least_cost(automaton: Automaton, *, read: FloatArray, skip: FloatArray) -> float:
    """Return the least cost of turning a string of n tokens into one of the pattern.

    Parameters
    ----------
    read
        ``(n, p)``, the cost of reading token i at each state.
    skip
        ``(n,)``, the cost of deleting token i. A missing token costs 1.
    """
    unread = 0.0
    reached = np.full(len(automaton), float(FAR))
    for reading, skipping in zip(read, skip, strict=True):
        arriving = np.minimum(unread + automaton.enter, _arrivals(reached, automaton.step))
        reached = np.minimum(reached + skipping, arriving + reading)
        unread += skipping
    return min(unread + automaton.shortest, float((reached + automaton.leave).min()))


def reading(automaton: Automaton, word: Sequence[Token], token_costs: TokenCosts) -> FloatArray:
    """Return ``(n, p)``, the cost of reading each token at each state."""
    columns = [token_costs.between(word, tokens).min(axis=1) for tokens in automaton.tokens]
    return np.stack(columns, axis=1)


def _arrivals(reached: FloatArray, step: IntArray) -> FloatArray:
    """Return the least cost of standing before each position, coming from any other."""
    return (reached[:, None] + step).min(axis=0)


def _glushkov(
    node: ast.Node, tokens: list[Token], follow: list[tuple[set[int], set[int]]]
) -> tuple[set[int], set[int], bool]:
    """Return an expression's first and last positions and whether it may be empty.

    Its positions are added to ``tokens``; to ``follow``, sets of positions each of which may
    stand before each of another set.
    """
    match node:
        case Token():
            tokens.append(node)
            here = {len(tokens) - 1}
            return here, here, False
        case ast.Sequence(parts):
            first, last, empty = _glushkov(parts[0], tokens, follow)
            for part in parts[1:]:
                part_first, part_last, part_empty = _glushkov(part, tokens, follow)
                follow.append((last, part_first))
                first = first | part_first if empty else first
                last = last | part_last if part_empty else part_last
                empty = empty and part_empty
            return first, last, empty
        case ast.Choice(options):
            read = [_glushkov(option, tokens, follow) for option in options]
            return (
                set().union(*(first for first, _, _ in read)),
                set().union(*(last for _, last, _ in read)),
                any(empty for _, _, empty in read),
            )
        case ast.Repeat(body, optional):
            first, last, empty = _glushkov(body, tokens, follow)
            follow.append((last, first))
            return first, last, empty or optional


def _least_changes(tokens: list[Token], follow: Sequence[tuple[set[int], set[int]]]) -> IntArray:
    """Return ``(p, p)``: the least number of changes of token on a way between two positions."""
    p = len(tokens)
    # No path has p changes; the smaller the numbers, the more of them are added at once.
    changes = np.full((p, p), p, dtype=np.min_scalar_type(2 * p))
    codes = codes_of(tokens)
    for before, after in follow:
        pairs = np.ix_(sorted(before), sorted(after))
        changes[pairs] = codes[pairs[0]] != codes[pairs[1]]
    np.fill_diagonal(changes, 0)
    for via in range(p):  # Floyd and Warshall
        np.minimum(changes, changes[:, via, None] + changes[via], out=changes)
    return np.where(changes < p, changes.astype(np.int64), FAR)
