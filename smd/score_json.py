"""JSON whose values know where they stand, so that each complaint can name the place."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from smd.errors import ScoreError


def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object's members; the last of two equal keys would win unseen."""
    members = dict(pairs)
    if len(members) < len(pairs):
        keys = [key for key, _ in pairs]
        repeated = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {shown(repeated)} twice in one object")
    return members


def shown(value: Any) -> str:
    """Return a value as a message shows it: on one line, cut short."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "a list"
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


@dataclass(frozen=True, slots=True)
class Node:
    """A JSON value that knows where it stands.

    Each method returns the value as what it is named for, or raises ScoreError with the place,
    what was expected and what was found.
    """

    value: Any
    source: str
    path: str = ""

    def fault(self, expected: str, found: str | None = None) -> ScoreError:
        """Return the error that names this place."""
        place = f"{self.source}: {self.path}" if self.path else self.source
        return ScoreError(f"{place}: expected {expected}, found {found or shown(self.value)}")

    def members(self, needed: Iterable[str], spare: Iterable[str] = ()) -> dict[str, Node]:
        """Return an object's members, all those needed and no unknown ones."""
        members = self.options()
        needed, known = tuple(needed), (*needed, *spare)
        for key in members:
            if key not in known:
                near = difflib.get_close_matches(key, known, n=1)
                expected = f'"{near[0]}"' if near else "one of " + ", ".join(known)
                raise self.fault(f"the key {expected}", f"the unknown key {shown(key)}")
        for key in needed:
            if key not in members:
                raise self.fault(f'the key "{key}"', "none")
        return members

    def options(self) -> dict[str, Node]:
        """Return an object's members, whatever their keys."""
        if not isinstance(self.value, dict):
            raise self.fault("an object")
        prefix = f"{self.path}." if self.path else ""
        return {
            key: Node(value, self.source, f"{prefix}{key}") for key, value in self.value.items()
        }

    def items(self) -> list[Node]:
        """Return a list's items."""
        if not isinstance(self.value, list):
            raise self.fault("a list")
        return [Node(value, self.source, f"{self.path}[{i}]") for i, value in enumerate(self.value)]

    def text(self) -> str:
        """Return text."""
        if not isinstance(self.value, str):
            raise self.fault("text in quotes")
        return self.value

    def name(self) -> str:
        """Return text that is not blank."""
        text = self.text()
        if not text.strip():
            raise self.fault("a name")
        return text

    def one_of(self, known: Sequence[str]) -> str:
        """Return text that is one of those known."""
        text = self.text()
        if text not in known:
            raise self.fault(" or ".join(f'"{each}"' for each in known))
        return text

    def truth(self) -> bool:
        """Return true or false."""
        if not isinstance(self.value, bool):
            raise self.fault("true or false")
        return self.value

    def number(self, low: float = -math.inf, high: float = math.inf) -> float:
        """Return a finite number within two bounds."""
        expected = "a number" if math.isinf(high) else f"a number in [{low:g}, {high:g}]"
        if isinstance(self.value, bool) or not isinstance(self.value, int | float):
            raise self.fault(expected)
        try:
            number = float(self.value)
        except OverflowError:
            raise self.fault("a finite number") from None
        if not math.isfinite(number):
            raise self.fault("a finite number")
        if not low <= number <= high:
            raise self.fault(expected)
        return number
