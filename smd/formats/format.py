"""What every format of recordings has: how its files are known, and how they are read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from smd.formats.file import RecordingFile
from smd.formats.tracks import Content


@dataclass(frozen=True, slots=True)
class RecordingFormat:
    """A kind of recording file, text or binary alike.

    Attributes
    ----------
    name : as docs/formats.md has it.
    suffixes : of its files, in lower case; a folder is searched for them.
    only_named : suffixes of files that are read when they are named, and else passed over, since
        they may as well hold something else.
    read : returns the poses as they stand in a file; a `Fault` says what is wrong with it.
    matches : says of a text's beginning whether it is one of its own. None where the suffix alone
        decides, as for what is no text.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[RecordingFile], Content]
    matches: Callable[[str], bool] | None = None
    only_named: tuple[str, ...] = ()
