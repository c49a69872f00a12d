"""Collisions: patterns of a library that can be confused, and what tells them apart."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

from smd.geometry.arrays import BoolArray
from smd.recognition import pattern as ast
from smd.recognition.languages import (
    Word,
    extra_word,
    holding_word,
    inner_word,
    nearest_words,
    word_without,
)
from smd.recognition.pattern import Pattern
from smd.recognition.progressive_alignment import UNLIKE, token_distances
from smd.recognition.tokens import Token

Kind = Literal["equal", "contained", "shared", "part", "near"]

_SEVERITY: tuple[Kind, ...] = ("equal", "contained", "shared", "part", "near")


@dataclass(frozen=True, slots=True)
class Collision:
    """Two actions that can be confused with one another.

    Attributes
    ----------
    first, second : their names.
    kind : ``equal``: the same strings; ``contained``: every string of the first is one of the
        second; ``shared``: some strings are of both; ``part``: every string of the second has one
        of the first inside; ``near``: a string of one is ``distance`` edits from one of the other.
    distance : least edits between a string of one and a string of the other; for a part that is
        not near, the tokens around it.
    witness : the string of the first that shows it, a shortest one. Both accept it where the kind
        is equal, contained or shared; it lies inside a string of the second where it is a part.
    counterpart : the string of the second that shows it.
    suggestion : what would tell them apart.
    """

    first: str
    second: str
    kind: Kind
    distance: int
    witness: Word
    counterpart: Word
    suggestion: str

    def __str__(self) -> str:
        """Return what collides and what would tell it apart, in one line."""
        shown, other = _shown(self.witness), _shown(self.counterpart)
        match self.kind:
            case "equal":
                said = f"{self.first} and {self.second} are drawn alike: both accept {shown}"
            case "contained":
                said = f"{self.first} is contained in {self.second}: both accept {shown}"
            case "shared":
                said = f"{self.first} and {self.second} overlap: both accept {shown}"
            case "part":
                said = f"{self.first} lies inside {self.second}: {shown} inside {other}"
            case "near":
                edits = "1 edit" if self.distance == 1 else f"{self.distance} edits"
                said = f"{self.first} and {self.second} are {edits} apart: {shown} against {other}"
        return f"{said}; {self.suggestion}"


def collisions(patterns: Mapping[str, Pattern], *, within: int = 1) -> tuple[Collision, ...]:
    """Return the pairs of actions that can be confused with one another, the worst first.

    Exact for all strings of both patterns, for any repetition (`languages`); each pair is listed
    once, with the worst kind that applies.

    Parameters
    ----------
    patterns
        By action.
    within
        Edits up to which two actions are near; with 0, near ones are not listed. Replacing a token
        is one edit if the two are less than a right angle apart (`token_distances`), else two.
    """
    return _worst_first(patterns, combinations(patterns, 2), within)


def collisions_of(
    name: str, patterns: Mapping[str, Pattern], *, within: int = 1
) -> tuple[Collision, ...]:
    """Return the collisions of one of several actions with the others, as `collisions` does."""
    return _worst_first(patterns, ((name, b) for b in patterns if b != name), within)


def _worst_first(
    patterns: Mapping[str, Pattern], pairs: Iterable[tuple[str, str]], within: int
) -> tuple[Collision, ...]:
    """Return the collisions among some pairs."""
    each = (_collision(a, patterns[a], b, patterns[b], within) for a, b in pairs)
    found = [collision for collision in each if collision]
    return tuple(sorted(found, key=lambda one: (_SEVERITY.index(one.kind), one.distance)))


def _collision(
    a: str, pattern_a: Pattern, b: str, pattern_b: Pattern, within: int
) -> Collision | None:
    """Return the worst that holds of a pair."""
    nearest = nearest_words(pattern_a, pattern_b, most=within, replaceable=_are_like)
    if nearest and nearest.distance == 0:
        return _overlap(a, pattern_a, b, pattern_b, nearest.first)
    for part, part_pattern, whole, whole_pattern in (
        (a, pattern_a, b, pattern_b),
        (b, pattern_b, a, pattern_a),
    ):
        inner = inner_word(whole_pattern, part_pattern)
        if inner and word_without(whole_pattern, part_pattern) is None:
            suggestion = (
                f"pause before and after {part}, or add to it a movement that {whole} never has"
            )
            holder = holding_word(whole_pattern, Pattern(ast.Sequence(inner))) or inner
            distance = nearest.distance if nearest else len(holder) - len(inner)
            return Collision(part, whole, "part", distance, inner, holder, suggestion)
    if nearest:
        differs = sorted(set(nearest.first) ^ set(nearest.second), key=str)
        suggestion = f"draw {_listed(differs)} large and clear"
        return Collision(a, b, "near", nearest.distance, nearest.first, nearest.second, suggestion)
    return None


def _overlap(a: str, pattern_a: Pattern, b: str, pattern_b: Pattern, both: Word) -> Collision:
    """Return the collision of two actions that share a string."""
    a_alone, b_alone = extra_word(pattern_a, pattern_b), extra_word(pattern_b, pattern_a)
    if a_alone is None and b_alone is None:
        return Collision(a, b, "equal", 0, both, both, "draw one of them with another movement")
    if a_alone is None or b_alone is None:
        inner, outer, alone = (a, b, b_alone) if a_alone is None else (b, a, a_alone)
        inside, outside = (pattern_a, pattern_b) if a_alone is None else (pattern_b, pattern_a)
        never = sorted(set(outside.tokens()) - set(inside.tokens()), key=str)
        told = f", where {inner} never has {_listed(never)}" if never else ""
        return Collision(
            inner,
            outer,
            "contained",
            0,
            both,
            both,
            f"add to {inner} a movement that {outer} never has, "
            f"or draw {outer} as {_shown(alone or ())}{told}",
        )
    return Collision(
        a,
        b,
        "shared",
        0,
        both,
        both,
        f"only {a} is drawn as {_shown(a_alone)}, only {b} as {_shown(b_alone)}",
    )


def _are_like(tokens: Sequence[Token], others: Sequence[Token]) -> BoolArray:
    """Return which tokens may be taken for which others."""
    return token_distances(tokens, others) < UNLIKE


def _shown(word: Word) -> str:
    """Return a string of tokens for reading."""
    return " ".join(map(str, word))


def _listed(tokens: Sequence[Token], most: int = 3) -> str:
    """Return a few tokens for reading."""
    return " or ".join(map(str, tokens[:most])) or "the changes of direction"
