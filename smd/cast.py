"""Cast: which library each performer acts with, and what is asked of a library."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Protocol

from laban.frozen import Frozen
from smd.errors import LibraryError

if TYPE_CHECKING:
    from smd.character.character import Character
    from smd.character.clip import Clip
    from smd.recognition.action import Action

IDLE = "idle"
"""The action that is played where nothing was recognised; every library has it."""


class ActionLibrary(Protocol):
    """What recognition and transfer ask of a library; `actions_library.library` has one on disk."""

    @property
    def actions(self) -> tuple[Action, ...]:
        """What can be performed."""

    @property
    def character(self) -> Character:
        """Who performs it."""

    def action(self, name: str) -> Action:
        """Return the action of that name, or raise LibraryError."""

    def clip(self, name: str) -> Clip:
        """Return the clip of an action, or raise LibraryError."""


@dataclass(frozen=True, slots=True, eq=False)
class Cast(Frozen):
    """A library for all performers, and libraries of their own for some.

    Attributes
    ----------
    shared : of those that have none of their own; its character sets the scene's scale.
    own : by the performer's device.
    """

    shared: ActionLibrary
    own: Mapping[str, ActionLibrary] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "own", MappingProxyType(dict(self.own)))

    def of(self, device: str) -> ActionLibrary:
        """Return the library that a device's performer acts with."""
        return self.own.get(device, self.shared)

    def check(self, devices: Collection[str]) -> None:
        """Raise LibraryError where a library belongs to a device that is not there."""
        for device in self.own:
            if device not in devices:
                raise LibraryError(
                    f"libraries: expected devices of the recording ({', '.join(devices)}), "
                    f"found {device!r}"
                )


def cast_of(library: ActionLibrary | Cast) -> Cast:
    """Return a cast in which all act with one library, or the cast that was given."""
    return library if isinstance(library, Cast) else Cast(library)
