"""The fewest key frames there can be, by trying every gap: n² of them, each frame by frame."""

from __future__ import annotations

from collections.abc import Callable


def fewest_keys(count: int, good: Callable[[int, int], bool]) -> int:
    """Return how many of ``count`` frames must be kept when the gaps between them must be good."""
    needed = [1]
    for last in range(1, count):
        needed.append(1 + min(needed[first] for first in range(last) if good(first, last)))
    return needed[-1]
