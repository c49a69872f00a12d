"""Frozen: types that check and freeze what they are made of, in other processes too."""

from __future__ import annotations

from dataclasses import fields
from types import MappingProxyType
from typing import Any


class Frozen:
    """Base of frozen dataclasses whose constructor makes read-only copies.

    An unpickled array is writeable, and a read-only mapping does not pickle at all. So such an
    object is pickled as the arguments of its constructor, which checks and freezes them again.
    """

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        values = {
            field.name: getattr(self, field.name)
            for field in fields(self)  # type: ignore[arg-type]  # a dataclass, all of them
            if field.init
        }
        plain = {
            name: dict(value) if isinstance(value, MappingProxyType) else value
            for name, value in values.items()
        }
        return _made, (type(self), plain)


def _made(kind: type[Any], values: dict[str, Any]) -> Any:
    return kind(**values)
