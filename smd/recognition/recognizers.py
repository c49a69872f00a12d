"""Recognizers that were made before: compiling a library takes as long as reading a short story."""

from __future__ import annotations

from functools import lru_cache
from typing import Protocol

from smd.recognition.acceptance import Intent
from smd.recognition.spotting import HasActions, Recognizer

KEPT = 16
"""So many recognizers are kept: those of a cast, and of the sizes that advice tries."""


class FrozenActions(HasActions, Protocol):
    """A library that never changes."""

    def __hash__(self) -> int:
        """Return the same of the same object."""


def recognizer_of(
    library: FrozenActions,
    *,
    figure_height_m: float,
    tolerance: float = 1.0,
    intent: Intent | None = None,
) -> Recognizer:
    """Return the recognizer of a library, the one that was made before where it is the same.

    Parameters are those of `Recognizer`. A recognizer never changes, so all may share it; libraries
    are told apart as objects, for what is frozen cannot come to hold other actions.
    """
    return _made(library, figure_height_m, tolerance, intent)


@lru_cache(maxsize=KEPT)
def _made(
    library: FrozenActions, figure_height_m: float, tolerance: float, intent: Intent | None
) -> Recognizer:
    return Recognizer(library, figure_height_m=figure_height_m, tolerance=tolerance, intent=intent)
