"""Cast: which library each performer acts with."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from actions_library.library import Library
from smd.errors import LibraryError


@dataclass(frozen=True, slots=True, eq=False)
class Cast:
    """A library for all performers, and libraries of their own for some.

    Attributes
    ----------
    shared : of those that have none of their own; its character sets the stage's scale.
    own : by the performer's device.
    """

    shared: Library
    own: Mapping[str, Library] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "own", dict(self.own))

    def of(self, device: str) -> Library:
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


def cast_of(library: Library | Cast) -> Cast:
    """Return a cast in which all act with one library, or the cast that was given."""
    return library if isinstance(library, Cast) else Cast(library)
