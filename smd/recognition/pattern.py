"""Pattern: a regular expression over tokens.

The grammar, in the operators of the paper's section 4.2 (``docs/recognition.md`` explains it)::

    pattern  = sequence { "|" sequence }
    sequence = item { item }                       (white space between items)
    item     = ( token | "(" pattern ")" ) { "+" | "*" }
    token    = "STILL" | "T" axes | "R" axes | "T" axes "/" "R" axes
    axes     = [ "_X" | "_N_X" ] [ "_Y" | "_N_Y" ] [ "_Z" | "_N_Z" ]      (one at least)

A token means exactly itself: ``T_Z`` is moving ahead *without turning*.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from smd.errors import PatternError
from smd.recognition.tokens import Token

MAX_NESTING = 50
"""Deepest nesting of groups; a library file must not exhaust the interpreter's stack."""


@dataclass(frozen=True, slots=True)
class Sequence:
    """Parts one after another; at least two, none of them a sequence."""

    parts: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several options; at least two, none of them a choice, none twice."""

    options: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Repeat:
    """A body any number of times: at least once (``+``), or never as well (``*``).

    The body is not a repeat itself.
    """

    body: Node
    optional: bool


Node: TypeAlias = Token | Sequence | Choice | Repeat


@dataclass(frozen=True, slots=True)
class Pattern:
    """What an action looks like in tokens: a regular expression with ``+``, ``*``, ``|``, groups.

    Patterns are matched against strings without equal neighbours (each run of equal tokens is
    one token), so ``T_Z+`` and ``T_Z`` match the same. Two patterns are equal when they are
    written the same, not when they match the same.

    Attributes
    ----------
    root : the expression; nested sequences, nested choices and nested repeats are flattened. It
        does not accept the empty string.

    References
    ----------
    .. [1] M. Garcia, R. Ronfard, M.-P. Cani, "Spatial Motion Doodles", MIG 2019, section 4.2.
    """

    root: Node

    def __post_init__(self) -> None:
        root = _normalised(self.root)
        if accepts_empty(root):
            raise PatternError(
                f"pattern {_excerpt(_printed(root))}: expected at least one token that must "
                "occur, got a pattern that nothing at all would match"
            )
        object.__setattr__(self, "root", root)

    def __str__(self) -> str:
        return _printed(self.root)

    @classmethod
    def parse(cls, text: str) -> Pattern:
        """Read a pattern.

        Raises
        ------
        PatternError
            If the text does not follow the grammar or the pattern accepts the empty string.

        Examples
        --------
        >>> str(Pattern.parse("T_Z+ ((T_Y|T_Y_Z))*  T_N_Y+"))
        'T_Z+ (T_Y|T_Y_Z)* T_N_Y+'
        """
        return cls(_Parser(text).read())

    def tokens(self) -> tuple[Token, ...]:
        """Return the tokens that occur in the pattern, each once, sorted."""
        return tuple(sorted(set(_tokens(self.root))))

    def words(self, repeats: int = 1) -> tuple[tuple[Token, ...], ...]:
        """Enumerate the strings the pattern stands for (the expansion of section 4.2).

        Equal neighbours are merged, so the repetition of a token does not count. A group of
        different tokens, as in ``(T_Y|T_Y_Z)*``, is repeated up to ``repeats`` times: the
        result is all of the language where no such group is repeated, and part of an infinite
        one otherwise (the automaton, not this, is exact there).

        Parameters
        ----------
        repeats
            At least 1. The number of words can grow exponentially with it and with the number
            of choices.

        Returns
        -------
        tuple of tuple of Token
            Each word once, none empty, the short ones first.
        """
        words = {word for word in _words(self.root, repeats) if word}
        return tuple(sorted(words, key=lambda word: (len(word), word)))


def merged(word: tuple[Token, ...]) -> tuple[Token, ...]:
    """Return a token string with each run of equal tokens as one."""
    return tuple(b for a, b in zip((None, *word), word, strict=False) if a != b)


def accepts_empty(node: Node) -> bool:
    """Tell whether an expression matches the empty string."""
    match node:
        case Token():
            return False
        case Sequence(parts):
            return all(accepts_empty(part) for part in parts)
        case Choice(options):
            return any(accepts_empty(option) for option in options)
        case Repeat(body, optional):
            return optional or accepts_empty(body)


def _normalised(node: Node, depth: int = 0) -> Node:
    """Return the expression flattened: one form for everything that is printed the same."""
    if depth > 3 * MAX_NESTING:
        raise PatternError(f"pattern: expected at most {MAX_NESTING} nested groups, got more")
    match node:
        case Token():
            return node
        case Sequence(parts):
            flat: list[Node] = []
            for part in (_normalised(part, depth + 1) for part in parts):
                flat.extend(part.parts if isinstance(part, Sequence) else (part,))
            return _one_or(flat, "sequence", Sequence)
        case Choice(options):
            flat = []
            for option in (_normalised(option, depth + 1) for option in options):
                flat.extend(option.options if isinstance(option, Choice) else (option,))
            return _one_or(list(dict.fromkeys(flat)), "choice", Choice)
        case Repeat(body, optional):
            body = _normalised(body, depth + 1)
            if isinstance(body, Repeat):
                return Repeat(body.body, optional or body.optional)
            return Repeat(body, optional)


def _one_or(nodes: list[Node], name: str, several: type[Sequence] | type[Choice]) -> Node:
    """Return a single node as itself and several ones as a group."""
    if not nodes:
        raise PatternError(f"pattern: expected a {name} of at least one part, got none")
    return nodes[0] if len(nodes) == 1 else several(tuple(nodes))


def _printed(node: Node) -> str:
    """Return the expression in the grammar, with no more parentheses than needed."""
    match node:
        case Token():
            return str(node)
        case Sequence(parts):
            return " ".join(_grouped(part, Choice) for part in parts)
        case Choice(options):
            return "|".join(_printed(option) for option in options)
        case Repeat(body, optional):
            return _grouped(body, Choice, Sequence) + ("*" if optional else "+")


def _grouped(node: Node, *in_parentheses: type[Node]) -> str:
    """Return the printed expression, in parentheses if it is of one of these kinds."""
    text = _printed(node)
    return f"({text})" if isinstance(node, in_parentheses) else text


def _tokens(node: Node) -> Iterator[Token]:
    """Yield every token, from left to right."""
    match node:
        case Token():
            yield node
        case Sequence(nodes) | Choice(nodes):
            for part in nodes:
                yield from _tokens(part)
        case Repeat(body, _):
            yield from _tokens(body)


def _words(node: Node, repeats: int) -> set[tuple[Token, ...]]:
    """Return the merged words of an expression, groups repeated at most ``repeats`` times."""
    match node:
        case Token():
            return {(node,)}
        case Sequence(parts):
            words: set[tuple[Token, ...]] = {()}
            for part in parts:
                words = _joined(words, _words(part, repeats))
            return words
        case Choice(options):
            return set().union(*(_words(option, repeats) for option in options))
        case Repeat(body, optional):
            once = _words(body, repeats)
            words = set(once)
            for _ in range(repeats - 1):
                words |= _joined(words, once)
            return words | {()} if optional else words


def _joined(left: set[tuple[Token, ...]], right: set[tuple[Token, ...]]) -> set[tuple[Token, ...]]:
    """Return every word of ``left`` followed by every word of ``right``, merged."""
    return {merged((*a, *b)) for a in left for b in right}


_LEXEME = re.compile(r"[()|+*]|[A-Za-z0-9_/]+")


class _Parser:
    """Recursive descent over the grammar in the module's docstring."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._depth = 0

    def read(self) -> Node:
        """Read the whole text."""
        node = self._choice()
        if self._peek():
            raise self._error("expected a token, '(', '|', '+' or '*'")
        return node

    def _choice(self) -> Node:
        options = [self._sequence()]
        while self._peek() == "|":
            self._at += 1
            options.append(self._sequence())
        return options[0] if len(options) == 1 else Choice(tuple(options))

    def _sequence(self) -> Node:
        items = [self._item()]
        while self._peek() not in ("", "|", ")"):
            items.append(self._item())
        return items[0] if len(items) == 1 else Sequence(tuple(items))

    def _item(self) -> Node:
        node = self._group() if self._peek() == "(" else self._token()
        operators = set()
        while (operator := self._peek()) in ("+", "*"):
            self._at += 1
            operators.add(operator)
        return Repeat(node, optional="*" in operators) if operators else node

    def _group(self) -> Node:
        if self._depth == MAX_NESTING:
            raise self._error(f"expected at most {MAX_NESTING} nested groups")
        opened = self._at
        self._at += 1
        self._depth += 1
        node = self._choice()
        if self._peek() != ")":
            raise self._error(f"expected ')' for the '(' at character {opened + 1}")
        self._at += 1
        self._depth -= 1
        return node

    def _token(self) -> Token:
        lexeme = self._peek()
        if not lexeme or lexeme in "()|+*":
            raise self._error("expected a token or '('")
        try:
            token = Token.parse(lexeme)
        except PatternError:
            raise self._error("expected a token such as T_Z, R_N_Y, T_Y_Z/R_X or STILL") from None
        self._at += len(lexeme)
        return token

    def _peek(self) -> str:
        """Return the next lexeme without taking it, empty at the end; skips white space."""
        while self._at < len(self._text) and self._text[self._at].isspace():
            self._at += 1
        if self._at == len(self._text):
            return ""
        found = _LEXEME.match(self._text, self._at)
        return found.group() if found else self._text[self._at]

    def _error(self, expected: str) -> PatternError:
        """Return the error for what stands at the current place."""
        lexeme = self._peek()
        found = _excerpt(lexeme) if lexeme else "the end"
        where = f"at character {self._at + 1}"
        return PatternError(
            f"pattern {_excerpt(self._text)}: {expected} {where}, found {found}", self._at
        )


def _excerpt(text: str, most: int = 60) -> str:
    """Return quoted text on one line, shortened."""
    return repr(text if len(text) <= most else text[: most - 1] + "…")
