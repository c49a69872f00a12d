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
    from actions_library.folder import load_library
    from actions_library.importers.usd_ground import read_terrain
    from actions_library.stage_frame import StageFrame
    from exporters import write
    from smd.acting.performance import Performance
    from smd.cast import Cast
    from smd.doodle import Doodle, Recording
    from smd.errors import SmdError
    from smd.formats import SourceFrame, read_recording, write_recording
    from smd.parsing import Parser
    from smd.pipeline import animate, parse
    from smd.score import Phrase, Score
    from smd.score_file import read_score, write_score
    from smd.smoothing import smooth

_HOME = {
    "Cast": "smd.cast",
    "Doodle": "smd.doodle",
    "Parser": "smd.parsing",
    "Performance": "smd.acting.performance",
    "Phrase": "smd.score",
    "Recording": "smd.doodle",
    "Score": "smd.score",
    "SmdError": "smd.errors",
    "SourceFrame": "smd.formats",
    "StageFrame": "actions_library.stage_frame",
    "animate": "smd.pipeline",
    "load_library": "actions_library.folder",
    "parse": "smd.pipeline",
    "read_recording": "smd.formats",
    "read_score": "smd.score_file",
    "read_terrain": "actions_library.importers.usd_ground",
    "smooth": "smd.smoothing",
    "write": "exporters",
    "write_recording": "smd.formats",
    "write_score": "smd.score_file",
}
"""Where each public name is defined; it is imported when it is first asked for."""

__all__ = [
    "Cast",
    "Doodle",
    "Parser",
    "Performance",
    "Phrase",
    "Recording",
    "Score",
    "SmdError",
    "SourceFrame",
    "StageFrame",
    "animate",
    "load_library",
    "parse",
    "read_recording",
    "read_score",
    "read_terrain",
    "smooth",
    "write",
    "write_recording",
    "write_score",
]

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'smd' has no attribute {name!r}")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
