"""A creature's library: drawn as people's actions of the same name are."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from actions_library.folder import load_library, write_library
from actions_library.gestures import with_gestures
from actions_library.library import Credit, Library
from smd.character.character import Character
from smd.character.clip import Clip
from smd.recognition.action import Action


def write_creature(
    folder: Path, character: Character, clips: Iterable[Clip], actions: tuple[Action, ...]
) -> Library:
    """Write a creature's library, called as its character, with the humanoid's gestures."""
    by_name = {clip.name: clip for clip in clips}
    return write_library(
        folder,
        name=character.name,
        character=character,
        clips=by_name,
        actions=with_gestures(actions, load_library()),
        credits=dict.fromkeys(by_name, Credit("Spatial Motion Doodles", "MIT")),
    )
