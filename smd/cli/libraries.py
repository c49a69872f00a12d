"""The options that say which library is performed, and what they name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from smd.cast import Cast
    from smd.score import Score

LibraryFolder = Annotated[
    Path | None,
    typer.Option(
        "--library", help="A library's folder, or its name if it is shipped. Default: humanoid."
    ),
]
ExtendedFolder = Annotated[
    Path, typer.Option("--library", help="The library to extend; made where there is none.")
]
Libraries = Annotated[
    list[str] | None,
    typer.Option(
        "--library",
        metavar="[DEVICE=]DIR",
        help="A library's folder, or its name if it is shipped; after DEVICE= for that performer "
        "alone, and may be repeated. Default: humanoid.",
    ),
]


@dataclass(frozen=True, slots=True)
class LibraryFolders:
    """Where the performers' libraries are.

    Attributes
    ----------
    shared : of those without one of their own; None for the shipped humanoid.
    own : by device.
    """

    shared: Path | None = None
    own: Mapping[str, Path] = field(default_factory=dict)

    @classmethod
    def from_options(cls, values: Iterable[str] | None) -> LibraryFolders:
        """Return what ``--library`` was given, or end as after wrong usage."""
        shared: list[Path] = []
        own: dict[str, Path] = {}
        for value in values or ():
            device, equals, folder = value.partition("=")
            if not equals or Path(value).is_dir():  # a folder's name may hold the sign
                shared.append(Path(value))
            elif not device or not folder or device in own:
                raise typer.BadParameter(f"expected DIR, or DEVICE=DIR once a device: {value!r}")
            else:
                own[device] = Path(folder)
        if len(shared) > 1:
            raise typer.BadParameter(
                f"expected one DIR, and DEVICE=DIR for others: {str(shared[1])!r}"
            )
        return cls(shared[0] if shared else None, own)

    def over(self, score: Score, score_file: Path) -> LibraryFolders:
        """Return these, and where they say nothing those that a Score names."""
        named = {part.device: part.library for part in score.performers if part.library}
        own = {device: _beside(score_file, folder) for device, folder in named.items()}
        shared = _beside(score_file, score.library) if score.library else None
        return LibraryFolders(self.shared or shared, {**own, **self.own})

    def load(self) -> Cast:
        """Read the libraries."""
        import smd

        own = {device: smd.load_library(folder) for device, folder in self.own.items()}
        return smd.Cast(smd.load_library(self.shared), own)

    def named_in(self, score: Score) -> Score:
        """Return a Score that names them."""
        parts = tuple(
            replace(part, library=str(self.own.get(part.device, ""))) for part in score.performers
        )
        return replace(score, performers=parts, library=str(self.shared or ""))


def _beside(score_file: Path, library: str) -> Path:
    """Return the library that a Score names: a folder beside it, or one that is shipped."""
    from actions_library.folder import shipped_libraries

    folder = score_file.parent / library
    return Path(library) if library in shipped_libraries() and not folder.is_dir() else folder
