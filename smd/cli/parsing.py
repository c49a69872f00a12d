"""The options that say how a recording is understood, shared by the commands that parse."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.libraries import Libraries, LibraryFolders
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from actions_library.library import Library
    from smd.cast import Cast
    from smd.doodle import Recording
    from smd.score import Score

Device = Annotated[
    list[str] | None,
    typer.Option(help="Perform this device only; may be repeated. Default: all but headsets."),
]
FIGURE_HEIGHT_M = 0.175  # smd.doodle's default, said here so that --help need not load NumPy
FigureHeight = Annotated[
    float,
    typer.Option(
        "--figure-height",
        help="Height in metres of the figurine the prop stands for; it sets the scale.",
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        help="How unlike its examples a gesture may be: below 1 more is rejected, above it less.",
        min=0.05,
        max=20.0,
    ),
]


class IntentName(StrEnum):
    """Whether movement was meant."""

    DRAWN = "drawn"
    FREE = "free"


class UnexplainedName(StrEnum):
    """What is made of travel in which nothing is recognised."""

    LEAVE = "leave"
    FOLLOW = "follow"


@dataclass(frozen=True, slots=True)
class ParsingOptions:
    """How the user said that recordings are to be understood."""

    library: Libraries = None
    figure_height_m: FigureHeight = FIGURE_HEIGHT_M
    tolerance: Tolerance = 1.0
    intent: Annotated[
        IntentName | None,
        typer.Option(
            help="Whether movement was meant: drawn, where a trigger was held, or free, where "
            "most is not. Default: drawn where the recording says when the user drew."
        ),
    ] = None
    unexplained: Annotated[
        UnexplainedName,
        typer.Option(
            help="Where nothing is recognised and the prop travels: leave the character standing, "
            "or let it follow in the gait that suits."
        ),
    ] = UnexplainedName.LEAVE

    @property
    def folders(self) -> LibraryFolders:
        """Where the libraries are; contradictory ones end the program as after wrong usage."""
        return LibraryFolders.from_options(self.library)

    def parse(
        self,
        file: Path,
        reading: ReadingOptions,
        library: Library | Cast,
        devices: list[str] | None,
    ) -> tuple[Recording, Score]:
        """Return a recording and its Score; the Score keeps how it was read."""
        import smd

        recording = reading.read(file)
        score = smd.parse(
            recording,
            library,
            figure_height_m=self.figure_height_m,
            devices=devices,
            tolerance=self.tolerance,
            intent=self.intent,
            unexplained=self.unexplained,
        )
        return recording, self.folders.named_in(replace(score, reading=reading.pairs))
