"""Recognizers that were made before: compiling a library takes as long as reading a short story."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from weakref import WeakKeyDictionary

from smd.recognition.acceptance import Intent
from smd.recognition.compiled_actions import HasActions
from smd.recognition.recognizer import Recognizer

KEPT = 16
"""So many recognizers are kept of a library: those of the sizes that advice tries, and more."""

_RECOGNIZER_OF: WeakKeyDictionary[HasActions, Callable[..., Recognizer]] = WeakKeyDictionary()
"""What makes a library's recognizers, and keeps them as long as the library is there."""


def recognizer_of(
    library: HasActions,
    *,
    figure_height_m: float,
    tolerance: float = 1.0,
    intent: Intent | None = None,
) -> Recognizer:
    """Return the recognizer of a library, the one that was made before where it is the same.

    Parameters are those of `Recognizer`. A recognizer never changes, so all may share it; libraries
    are told apart as objects, for what is frozen cannot come to hold other actions.
    """
    if library not in _RECOGNIZER_OF:
        # Of its actions alone: what held the library would keep it, clips and all, for ever.
        make = partial(Recognizer, library.actions)
        _RECOGNIZER_OF[library] = lru_cache(maxsize=KEPT)(make)
    return _RECOGNIZER_OF[library](
        figure_height_m=figure_height_m, tolerance=tolerance, intent=intent
    )
