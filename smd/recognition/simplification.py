"""Simplification: fewer groups of tokens for the same strings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from smd.recognition.tokens import Token


@dataclass(frozen=True, slots=True)
class Group:
    """Any of some tokens, any number of times: ``(a|b)+``, or ``(a|b)*`` if optional."""

    tokens: frozenset[Token]
    optional: bool


def simplified(groups: Iterable[Group]) -> tuple[Group, ...]:
    """Return groups, one after another, that accept the same strings; none of them is redundant.

    An optional group beside a group that has all its tokens is redundant: whatever it could read,
    the other one reads too. So is a mandatory one beside its equal, since a token may be read as
    both. (Beside a larger one it is not: it demands that one of its own tokens occurs there.)
    """
    kept = list(groups)
    while (at := _needless(kept)) is not None:
        del kept[at]
    return tuple(kept)


def _needless(groups: list[Group]) -> int | None:
    """Return the first group that a neighbour makes needless."""
    for i, group in enumerate(groups):
        for beside in (*groups[max(i - 1, 0) : i], *groups[i + 1 : i + 2]):
            if group.tokens <= beside.tokens and (group.optional or group == beside):
                return i
    return None
