"""Library: actions, their clips and the character."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from laban.frozen import Frozen
from smd.errors import LibraryError
from smd.recognition.action import Action

if TYPE_CHECKING:
    from smd.character.character import Character
    from smd.character.clip import Clip


@dataclass(frozen=True, slots=True)
class Credit:
    """Author and licence of a clip; empty where they are not known."""

    author: str = ""
    licence: str = ""


@dataclass(frozen=True, eq=False)
class Library(Frozen):
    """Actions, and the character and clips that show them; a folder on disk.

    The character and the clips are read when they are first asked for: to recognise an action
    takes its pattern alone.

    Attributes
    ----------
    name : of the library.
    folder : where it was read from.
    actions : unique names.
    character_file : of the character, relative to the folder.
    clip_files : of each action's clip, by the action's name.
    exemplar_files : of those actions' exemplars that have one.
    credits : of each action's clip, where somebody said.
    """

    name: str
    folder: Path
    actions: tuple[Action, ...]
    character_file: str
    clip_files: Mapping[str, str]
    exemplar_files: Mapping[str, str] = field(default_factory=dict)
    credits: Mapping[str, Credit] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names = [action.name for action in self.actions]
        for name in names:
            if names.count(name) > 1:
                raise LibraryError(f"{self.folder}: action {name!r} appears twice")
            if name not in self.clip_files:
                raise LibraryError(f"{self.folder}: action {name!r}: expected a clip, found none")
        for action in self.actions:
            if action.rest and action.rest not in names:
                raise LibraryError(
                    f"{self.folder}: action {action.name!r}: rest: expected an action of the "
                    f"library, got {action.rest!r}"
                )
            if (action.exemplar is None) == (action.name in self.exemplar_files):
                raise LibraryError(
                    f"{self.folder}: action {action.name!r}: expected a file for its exemplar, "
                    "and none without one"
                )
        object.__setattr__(self, "actions", tuple(self.actions))
        for name in ("clip_files", "exemplar_files", "credits"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @cached_property
    def character(self) -> Character:
        """The character that the clips move.

        Raises
        ------
        LibraryError
            If its file is missing or holds no character.
        """
        from actions_library.storage import read_character_file

        return read_character_file(self.folder / self.character_file)

    @cached_property
    def clips(self) -> Mapping[str, Clip]:
        """The clip of each action, by the action's name.

        Raises
        ------
        LibraryError
            If a file is missing, or holds no clip of this character.
        """
        from actions_library.storage import read_clip_file

        return MappingProxyType(
            {
                name: read_clip_file(self.folder / file, name, self.character)
                for name, file in self.clip_files.items()
            }
        )

    def action(self, name: str) -> Action:
        """Return the action of that name, or raise LibraryError naming those there are."""
        for action in self.actions:
            if action.name == name:
                return action
        known = ", ".join(action.name for action in self.actions)
        raise LibraryError(f"library {self.name!r}: expected one of {known}; got {name!r}")

    def credit(self, name: str) -> Credit:
        """Return author and licence of an action's clip."""
        return self.credits.get(name, Credit())

    def clip(self, name: str) -> Clip:
        """Return the clip of an action, or raise LibraryError naming those there are."""
        return self.clips[self.action(name).name]
