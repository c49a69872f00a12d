"""The options that say how a recording is understood, and what reads its Score so."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.libraries import LibraryFolders
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from actions_library.cast import Cast
    from actions_library.library import Library
    from smd.doodle import Recording
    from smd.score import Score

Device = Annotated[
    list[str] | None,
    typer.Option(help="Perform this device only; may be repeated. Default: all but headsets."),
]
FIGURE_HEIGHT_M = 0.175  # smd.doodle's default, said here so that --help need not load NumPy
FigureHeight = Annotated[
    float,
    typer.Option(help="Height in metres of the figurine the prop stands for; it sets the scale."),
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


Intent = Annotated[
    IntentName | None,
    typer.Option(
        help="Whether movement was meant: drawn, where a trigger was held, or free, where most is "
        "not. Default: drawn where the recording says when the user drew."
    ),
]


class UnexplainedName(StrEnum):
    """What is made of travel in which nothing is recognised."""

    LEAVE = "leave"
    FOLLOW = "follow"


Unexplained = Annotated[
    UnexplainedName,
    typer.Option(
        help="Where nothing is recognised and the prop travels: leave the character standing, or "
        "let it follow in the gait that suits."
    ),
]


def understanding(
    options: ReadingOptions,
    library: Library | Cast,
    folders: LibraryFolders,
    *,
    figure_height_m: float,
    devices: list[str] | None,
    tolerance: float,
    intent: str | None = None,
    unexplained: str = UnexplainedName.LEAVE,
) -> Callable[[Path], tuple[Recording, Score]]:
    """Return what reads a recording and its Score; the Score keeps how it was read."""

    def understood(file: Path) -> tuple[Recording, Score]:
        import smd

        recording = options.read(file)
        score = smd.parse(
            recording,
            library,
            figure_height_m=figure_height_m,
            devices=devices,
            tolerance=tolerance,
            intent=intent,
            unexplained=unexplained,
        )
        return recording, folders.named_in(replace(score, reading=options.pairs))

    return understood
