"""JSON whose values know their place in the file, so that each error can name it."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from laban.faults import Fault


def read_json(path: Path, what: str, *, keys_once: bool = False) -> Node:
    """Return what a JSON file holds.

    Parameters
    ----------
    path
        The file.
    what
        What is expected there, for messages: "a Score file".
    keys_once
        As `parse_json`.

    Raises
    ------
    Fault
        If there is no such file, or it is not JSON.
    """
    if path.is_dir():
        raise Fault("", what, "a folder")
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise Fault("", what, "none") from None
    except OSError as error:
        raise Fault("", f"{what} that can be read", error.strerror or error) from error
    return parse_json(data, keys_once=keys_once)


def parse_json(data: bytes | str, *, keys_once: bool = False) -> Node:
    """Return what JSON says, in UTF-8 with or without a byte order mark.

    Parameters
    ----------
    data
        Bytes of a file, or its text.
    keys_once
        Refuse an object with a duplicate key; else the last one silently wins.

    Raises
    ------
    Fault
        If it is not JSON, or nested too deeply.
    """
    if isinstance(data, bytes):
        try:
            data = data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            found = f"byte 0x{data[error.start]:02x} at {error.start}"
            raise Fault("", "UTF-8 text", found) from None
    if "\0" in data:
        raise Fault("", "UTF-8 text", "zero bytes, as in UTF-16")
    try:
        return Node(json.loads(data, object_pairs_hook=_once if keys_once else None))
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        there = shown(data[error.pos]) if error.pos < len(data) else "the end"
        raise Fault(place, "JSON", f"{there} ({error.msg[:1].lower()}{error.msg[1:]})") from None
    except RecursionError:
        raise Fault("", "JSON", "JSON nested too deeply") from None
    except ValueError:  # Python reads no whole number of more than some thousand digits
        raise Fault("", "JSON", "a number of too many digits") from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object's members, or refuse them."""
    members = dict(pairs)
    if len(members) < len(pairs):
        keys = [key for key, _ in pairs]
        repeated = next(key for key in keys if keys.count(key) > 1)
        raise Fault("", "each key once", f"the key {shown(repeated)} twice in one object")
    return members


def shown(value: Any) -> str:
    """Return a value as a message shows it: on one line, cut short."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "a list"
    try:
        text = json.dumps(value)
    except ValueError:  # a whole number of thousands of digits
        text = "a number too long to show"
    return text if len(text) <= 60 else text[:57] + "..."


@dataclass(frozen=True, slots=True)
class Node:
    """A JSON value that knows its place in the file.

    Each method returns the value as the type that it is named for, or raises a `Fault` with the
    place, what was expected and what was found.
    """

    value: Any
    place: str = ""

    def fault(self, expected: str, found: str | None = None) -> Fault:
        """Return the fault at this place."""
        return Fault(self.place, expected, found or shown(self.value))

    def members(self, needed: Iterable[str], spare: Iterable[str] = ()) -> dict[str, Node]:
        """Return an object's members; needed ones must be there, unknown ones must not."""
        members = self.options()
        needed, known = tuple(needed), (*needed, *spare)
        for key in members:
            if key not in known:
                near = difflib.get_close_matches(key, known, n=1)
                expected = f'"{near[0]}"' if near else "one of " + ", ".join(known)
                raise self.fault(f"the key {expected}", f"the unknown key {shown(key)}")
        for key in needed:
            if key not in members:
                raise self._lack(key)
        return members

    def member(self, key: str) -> Node:
        """Return a member of an object, whatever its other members."""
        members = self._object()
        if key not in members:
            raise self._lack(key)
        return self._below(key, members[key])

    def options(self) -> dict[str, Node]:
        """Return an object's members, whatever their keys."""
        return {key: self._below(key, value) for key, value in self._object().items()}

    def items(self) -> list[Node]:
        """Return a list's items."""
        if not isinstance(self.value, list):
            raise self.fault("a list")
        return [Node(value, f"{self.place}[{i}]") for i, value in enumerate(self.value)]

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

    def positive(self) -> float:
        """Return a finite number above zero."""
        number = self.number()
        if number <= 0.0:
            raise self.fault("a positive number")
        return number

    def numbers(self, count: int) -> list[float]:
        """Return a list of so many finite numbers."""
        if not isinstance(self.value, list):
            raise self.fault("a list")
        if len(self.value) != count:
            raise self.fault(f"{count} numbers", f"{len(self.value)}")
        if all(type(value) is float for value in self.value) and all(
            map(math.isfinite, self.value)
        ):
            return list(self.value)  # without a place for each of thousands
        return [item.number() for item in self.items()]

    def whole(self) -> int:
        """Return a whole number."""
        if isinstance(self.value, bool) or not isinstance(self.value, int):
            raise self.fault("a whole number")
        return self.value

    def count(self) -> int:
        """Return a whole number, not negative."""
        if self.whole() < 0:
            raise self.fault("a count")
        return self.whole()

    def _object(self) -> dict[str, Any]:
        if not isinstance(self.value, dict):
            raise self.fault("an object")
        return self.value

    def _below(self, key: str, value: Any) -> Node:
        return Node(value, f"{self.place}.{key}" if self.place else key)

    def _lack(self, key: str) -> Fault:
        return self.fault(f'the key "{key}"', "none")
