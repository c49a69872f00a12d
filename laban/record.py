"""Record: an object in a JSON file whose entries are checked as they are taken."""

from __future__ import annotations

import math
from typing import Any

from laban.effort import LabanError


class Record:
    """A JSON object with a name for messages, whose entries are checked as they are taken."""

    def __init__(self, content: object, source: str, name: str) -> None:
        if not isinstance(content, dict):
            raise LabanError(f"{source}: {name}: expected an object, got {_kind(content)}")
        self.content: dict[str, Any] = content
        self._source = source
        self._name = name

    def get(self, key: str, kind: Any) -> Any:
        """Return an entry of the given type."""
        if key not in self.content:
            raise self.fault(key, "it is missing")
        value = self.content[key]
        if not isinstance(value, kind) or isinstance(value, bool):
            raise self.fault(key, f"got {_kind(value)}")
        return value

    def number(
        self,
        key: str,
        low: float = -math.inf,
        high: float = math.inf,
        *,
        open_ends: bool = False,
    ) -> float:
        """Return a finite number from ``low`` to ``high``, strictly between with open ends."""
        value = self.get(key, int | float)
        inside = low < value < high if open_ends else low <= value <= high
        if not (math.isfinite(value) and inside):
            raise self.fault(key, f"expected a number from {low:g} to {high:g}, got {value!r}")
        return float(value)

    def count(self, key: str) -> int:
        """Return a whole number, not negative."""
        value = int(self.get(key, int))
        if value < 0:
            raise self.fault(key, f"expected a count, got {value}")
        return value

    def pair(self, key: str) -> tuple[float, float]:
        """Return two finite numbers."""
        low, high = self.numbers(key, 2)
        return low, high

    def numbers(self, key: str, count: int) -> list[float]:
        """Return a list of so many finite numbers."""
        values = self.get(key, list)
        if len(values) != count or not all(_is_number(value) for value in values):
            raise self.fault(key, f"expected {count} numbers, got {values!r}")
        return [float(value) for value in values]

    def record(self, key: str) -> Record:
        """Return an object in this one."""
        return Record(self.get(key, dict), self._source, self._path(key))

    def records(self, key: str) -> list[Record]:
        """Return a list of objects."""
        return [
            Record(one, self._source, f"{self._path(key)}[{i}]")
            for i, one in enumerate(self.get(key, list))
        ]

    def fault(self, key: str, what: str) -> LabanError:
        """Return the error for an entry."""
        return LabanError(f"{self._source}: {self._path(key)}: {what}")

    def _path(self, key: str) -> str:
        return f"{self._name}.{key}"


def _is_number(value: object) -> bool:
    """Return whether a JSON value is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _kind(value: object) -> str:
    """Return the JSON name of a value's type."""
    names = {dict: "an object", list: "a list", str: "a string", bool: "true or false"}
    if value is None:
        return "null"
    return names.get(type(value), f"the number {value!r}")
