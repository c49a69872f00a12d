"""Words that several commands print."""

from __future__ import annotations


def count(number: int, noun: str) -> str:
    """Return a number with its noun: 1 phrase, 2 phrases."""
    return f"{number} {noun}{'' if number == 1 else 's'}"
