"""Steps: long work in short pieces, so that live input does not wait."""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeAlias, TypeVar

T = TypeVar("T")

Steps: TypeAlias = Generator[None, None, T]
"""Work that yields after each piece, and returns its result."""


def finished(steps: Steps[T]) -> T:
    """Run the remaining steps of some work, and return its result."""
    while True:
        try:
            next(steps)
        except StopIteration as done:
            result: T = done.value
            return result
