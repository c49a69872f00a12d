"""Spatial Motion Doodles: play with a tracked prop, get expressive character animation.

>>> import smd
>>> recording = smd.read_recording("take.csv")              # doctest: +SKIP
>>> library = smd.load_library()                            # doctest: +SKIP
>>> score = smd.parse(recording, library)                   # doctest: +SKIP
>>> performance = smd.animate(score, recording, library)    # doctest: +SKIP
>>> smd.write(performance, "take.usda")                     # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from smd.doodle import Doodle, Recording
    from smd.errors import SmdError

_HOME = {
    "Doodle": "smd.doodle",
    "Recording": "smd.doodle",
    "SmdError": "smd.errors",
}
"""Where each public name is defined; it is imported when it is first asked for."""

__all__ = ["Doodle", "Recording", "SmdError"]

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'smd' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
