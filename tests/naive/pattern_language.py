"""What a pattern stands for, enumerated, and the edit distance to it, tried word by word."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable
from itertools import count

from smd.recognition import pattern as ast
from smd.recognition.pattern import Pattern
from smd.recognition.tokens import Token

Word = tuple[Token, ...]
Price = Callable[[Token, Token], float]
"""What it costs to take one token for another; 1 for any other one, if not given."""


def language(pattern: Pattern, longest: int) -> set[Word]:
    """Return the pattern's words of at most ``longest`` tokens, equal neighbours merged."""
    return words(pattern.root, longest) - {()}


def words(node: ast.Node, longest: int) -> set[Word]:
    if isinstance(node, Token):
        return {(node,)}
    if isinstance(node, ast.Choice):
        return set().union(*(words(option, longest) for option in node.options))
    if isinstance(node, ast.Sequence):
        found: set[Word] = {()}
        for part in node.parts:
            found = joined(found, words(part, longest), longest)
        return found
    once = words(node.body, longest)
    found = set(once)
    while True:  # once more round, until nothing new is short enough
        more = found | joined(found, once, longest)
        if more == found:
            return found | {()} if node.optional else found
        found = more


def joined(left: Iterable[Word], right: Iterable[Word], longest: int) -> set[Word]:
    right = list(right)
    both = (a + b[1:] if a and b and a[-1] == b[0] else a + b for a in left for b in right)
    return {word for word in both if len(word) <= longest}


def distance_to_word(given: Word, word: Word, price: Price = operator.ne) -> float:
    """Return the edit distance to the nearest string that is ``word`` when merged.

    Levenshtein's table, in which a letter of the word may be met again by the next token.
    """
    m = len(word)
    above: list[float] = list(range(m + 1))
    for token in given:
        row = [above[0] + 1]
        for j in range(1, m + 1):
            differs = price(token, word[j - 1])
            row.append(
                min(
                    above[j] + 1,  # the token is too much
                    row[j - 1] + 1,  # the letter is missing
                    above[j - 1] + differs,  # the token is the letter
                    above[j] + differs,  # the token is the letter, met again
                )
            )
        above = row
    return above[m]


def distance(given: Word, pattern: Pattern, price: Price = operator.ne) -> float:
    """Return the least distance from ``given`` to any string of the pattern.

    A nearest word has at most as many letters as ``given`` and, beyond those, as many as the
    distance, which is at most that of giving all up for the shortest word.
    """
    shortest = next(n for n in count(1) if language(pattern, n))
    longest = 2 * len(given) + shortest
    return min(distance_to_word(given, word, price) for word in language(pattern, longest))
