"""Checking: faults of a library, and what in it is likely to surprise."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from actions_library.library import Library
from actions_library.storage import read_clip_file
from smd.cast import IDLE
from smd.character.quality import flaws
from smd.errors import LibraryError
from smd.recognition.collisions import collisions


@dataclass(frozen=True, slots=True)
class Findings:
    """What a check of a library found.

    Attributes
    ----------
    faults : what is broken; such a library cannot be performed with.
    warnings : what works, but perhaps not as meant.
    """

    faults: tuple[str, ...]
    warnings: tuple[str, ...]


def check_library(library: Library) -> Findings:
    """Read every file of a library and compare its parts; one line per finding."""
    return Findings(tuple(_faults(library)), tuple(_warnings(library)))


def _faults(library: Library) -> Iterator[str]:
    """Yield what is missing, damaged or does not fit."""
    try:
        character = library.character
    except LibraryError as error:
        yield str(error)
        return
    for action in library.actions:
        file = library.clip_files[action.name]
        try:
            read_clip_file(library.folder / file, action.name, character)
        except LibraryError as error:
            yield f"action {action.name!r}: {error}"


def _warnings(library: Library) -> Iterator[str]:
    """Yield what is likely to surprise."""
    drawn = [action.name for action in library.actions if action.pattern is not None]
    if not drawn:
        yield f"{library.folder}: no action has a pattern: nothing will be recognised"
    if IDLE not in {action.name for action in library.actions}:
        yield (
            f"{library.folder}: no action {IDLE!r}, which is played where nothing is drawn: "
            "recordings can be parsed, but not animated"
        )
    rests = {IDLE, *(action.rest for action in library.actions)}
    for action in library.actions:
        # An undrawn action that is described is meant to be so.
        if action.pattern is None and not action.description and action.name not in rests:
            yield f"action {action.name!r}: no pattern: it will not be recognised"
    yield from _clip_warnings(library)
    patterns = {action.name: action.pattern for action in library.actions if action.pattern}
    verified = {action.name for action in library.actions if action.exemplar is not None}
    told = 0
    for collision in collisions(patterns):
        both = {collision.first, collision.second} <= verified
        if both and collision.kind not in ("equal", "contained"):
            told += 1
        else:
            yield str(collision)
    if told:
        yield f"{told} pairs of gestures overlap in their tokens; their examples tell them apart"


def _clip_warnings(library: Library) -> Iterator[str]:
    """Yield what is not right in clips that can be read, by `smd.character.quality`."""
    try:
        character = library.character
    except LibraryError:
        return
    for action in library.actions:
        try:
            clip = read_clip_file(
                library.folder / library.clip_files[action.name], action.name, character
            )
        except LibraryError:
            continue
        for flaw in flaws(clip, travels=action.travels):
            yield f"action {action.name!r}: its clip {flaw}"
