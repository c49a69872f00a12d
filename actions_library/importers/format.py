"""What every format of characters and clips has: its suffixes, and how a file is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from actions_library.importers.imported import Imported


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """What the user says of a file; None leaves a question to the file or its format.

    Attributes
    ----------
    up : the file's axis that points up, one of ``x -x y -y z -z``.
    unit_m : metres per unit of the file.
    skeleton : name or path of one of its skeletons, where a format keeps several.
    """

    up: str | None = None
    unit_m: float | None = None
    skeleton: str | None = None


class Importer(Protocol):
    """A module that reads one format."""

    def read(self, path: Path, asked: ImportOptions) -> Imported:
        """Return what a file holds, in metres, +Y up.

        Raises
        ------
        Fault
            If it is damaged or holds no skeleton; the file's name is added by whoever was asked to
            import it.
        """


@dataclass(frozen=True, slots=True)
class ImportFormat:
    """A kind of file with characters or clips.

    Attributes
    ----------
    name : as docs/importing.md has it.
    suffixes : of its files, in lower case.
    importer : returns the module that reads them; what it needs is loaded only then.
    has_skeletons : whether a file may hold several, of which one can be chosen.
    """

    name: str
    suffixes: tuple[str, ...]
    importer: Callable[[], Importer]
    has_skeletons: bool = False
