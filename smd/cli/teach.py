"""``smd teach``: an action by three performances, with the prop in the hand."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import one_doodle, parsing
from smd.cli.capturing import CapturingOptions, TakesFolder, held_takes
from smd.cli.lesson import Lesson, LessonOptions
from smd.cli.libraries import ExtendedFolder
from smd.cli.option_groups import unfolded
from smd.cli.reading import Mount, ReadingOptions

if TYPE_CHECKING:
    from smd.doodle import Doodle


@unfolded
def teach(
    action: Annotated[str, typer.Argument(metavar="ACTION", help="A lower-case word.")],
    library: ExtendedFolder,
    *,
    output: TakesFolder = Path("lessons"),
    performances: Annotated[
        int, typer.Option(help="How often the gesture is drawn.", min=1, max=20)
    ] = 3,
    learning: LessonOptions,
    capturing: CapturingOptions,
    figure_height_m: parsing.FigureHeight = parsing.FIGURE_HEIGHT_M,
    mount: Mount = None,
) -> None:
    """Teach an action by three performances.

    Hold the trigger during each. The grip discards the last one; their recordings are kept.
    """
    from smd.capture.selection import require_trigger
    from smd.capture.shelf import Shelf
    from smd.errors import CaptureError, SmdError
    from smd.formats import Mount as ParsedMount

    capturing.require_rate()
    lesson = Lesson.of(action, library, learning)
    options = ReadingOptions(mount=None if mount is None else str(ParsedMount.parse(mount)))
    taken: list[tuple[Path, Doodle]] = []
    with capturing.opened() as opened:
        there = opened.devices()
        require_trigger(there)
        names = capturing.names_of(there)
        shelf = Shelf(output, action)
        typer.echo(_asked(action, 1, performances))
        for path in held_takes(opened, names, lambda: shelf.next().with_suffix(".csv")):
            if path is None:
                if taken:
                    last, _doodle = taken.pop()
                    shelf.discard(last.with_suffix(""))
                    typer.echo(f"  {last.name}: discarded")
                continue
            try:
                doodle = one_doodle.drawn_doodle(path, options)
                typer.echo(_told(path, doodle, figure_height_m))
                taken.append((path, doodle))
            except SmdError as error:
                typer.echo(f"  not counted: {error}")
            if len(taken) == performances:
                break
            typer.echo(_asked(action, len(taken) + 1, performances))
    if len(taken) < performances:
        raise CaptureError(
            f"expected {performances} performances of {action!r}, got {len(taken)}: "
            "perform it again, or ask for fewer with --performances"
        )
    files, doodles = ([one[i] for one in taken] for i in (0, 1))
    typer.echo("\n".join(lesson.learned(files, doodles, "", figure_height_m)))  # type: ignore[arg-type]


def _asked(action: str, number: int, of: int) -> str:
    """Return what the user is asked for."""
    return f"{number} of {of}: hold the trigger, draw {action}, let go"


def _told(path: Path, doodle: Doodle, figure_height_m: float) -> str:
    """Return one line on the tokens of a performance."""
    from smd.recognition.learning import doodle_runs, without_rest

    tokens = [str(run.token) for run in without_rest(doodle_runs(doodle, figure_height_m))]
    return f"  {path.name}: {doodle.duration_s:.1f} s, {' '.join(tokens) or 'no movement'}"
