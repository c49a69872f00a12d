"""``smd learn``: an action's gesture from examples, into a library."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import typer

from smd.cli import one_doodle, parsing, places
from smd.cli.lesson import Lesson, LessonOptions
from smd.cli.libraries import ExtendedFolder
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions


@dataclass(frozen=True, slots=True)
class LearnOptions(LessonOptions):
    """The same options, told at more length."""

    clip: Annotated[
        str | None,
        typer.Option(
            "--clip",
            help="Perform it with the clip of this action, of the library's or the shipped ones. "
            "Default: that of the same name, else idle.",
        ),
    ] = None
    base: Annotated[
        str | None,
        typer.Option(
            "--from",
            help="Begin a new library with all actions of this one: a folder, or `humanoid` for "
            "the shipped one. Default: with its character and idling alone.",
        ),
    ] = None


@unfolded
def learn(
    action: Annotated[str, typer.Argument(metavar="ACTION", help="A lower-case word.")],
    recordings: places.Recordings,
    *,
    library: ExtendedFolder,
    learning: LearnOptions,
    description: Annotated[
        str, typer.Option(help="What the gesture looks like, in one sentence.")
    ] = "",
    figure_height_m: parsing.FigureHeight = parsing.FIGURE_HEIGHT_M,
    device: one_doodle.OneDevice = None,
    reading: ReadingOptions,
) -> None:
    """Learn an action's gesture from examples.

    Each RECORDING is one performance of it; three to five are a good number. Extends a library,
    or makes one.
    """
    lesson = Lesson.of(action, library, learning)
    files = list(places.recording_files(recordings))
    doodles = [one_doodle.one_example(file, reading, device) for file in files]
    typer.echo("\n".join(lesson.learned(files, doodles, description, figure_height_m)))
