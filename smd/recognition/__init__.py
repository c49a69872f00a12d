"""From a doodle to detected actions: tokens, patterns, automata, verification."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from smd.recognition.matching import Match as Match
    from smd.recognition.recognizer import Recognizer as Recognizer
    from smd.recognition.rehearsal import add_examples as add_examples
    from smd.recognition.teaching import learn_action as learn_action

__all__ = ["Match", "Recognizer", "add_examples", "learn_action"]

_HOMES = {
    "Match": "matching",
    "Recognizer": "recognizer",
    "add_examples": "rehearsal",
    "learn_action": "teaching",
}


def __getattr__(name: str) -> Any:
    """Load a name when it is first asked for: importing the package stays light."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"smd.recognition.{_HOMES[name]}"), name)
