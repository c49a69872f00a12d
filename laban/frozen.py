"""Frozen: types that stay read-only in another process."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any

import numpy as np


class Frozen:
    """Base of frozen dataclasses that hold read-only arrays or mappings.

    An unpickled array is writeable, and a read-only mapping does not pickle at all. So fields are
    pickled as they are, to the bit, with mappings as dictionaries, and frozen again on the other
    side. Nothing is checked again: pickles cross processes, and are never read from files.
    """

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        values = {
            field.name: getattr(self, field.name)
            for field in fields(self)  # type: ignore[arg-type]  # a dataclass, all of them
        }
        mappings = {
            name: dict(value) for name, value in values.items() if type(value) is MappingProxyType
        }
        plain = {name: value for name, value in values.items() if name not in mappings}
        return _restored, (type(self), plain, mappings)


def _restored(kind: type[Any], values: Mapping[str, Any], mappings: Mapping[str, Any]) -> Any:
    """Make what was pickled again, as frozen as it was."""
    restored = object.__new__(kind)
    for name, value in values.items():
        _freeze(value)
        object.__setattr__(restored, name, value)
    for name, mapping in mappings.items():
        _freeze(mapping)
        object.__setattr__(restored, name, MappingProxyType(mapping))
    return restored


def _freeze(value: Any) -> None:
    """Make arrays read-only, in tuples, lists and mappings too."""
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, tuple | list):
        for part in value:
            _freeze(part)
    elif isinstance(value, Mapping):
        for part in value.values():
            _freeze(part)
