"""``smd rehearse``: one's own examples of actions that a library knows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import parsing, places
from smd.cli.capturing import CapturingOptions, held_takes
from smd.cli.libraries import ExtendedFolder
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions
from smd.cli.rehearsal import Rehearsal, RehearsingOptions

if TYPE_CHECKING:
    from smd.formats import SourceFrame


@unfolded
def rehearse(
    library: ExtendedFolder,
    *,
    actions: Annotated[
        list[str] | None,
        typer.Argument(metavar="[ACTION…]", help="Default: all that are drawn, in their order."),
    ] = None,
    rehearsing: RehearsingOptions,
    capturing: CapturingOptions,
    figure_height_m: parsing.FigureHeight = parsing.FIGURE_HEIGHT_M,
    reading: ReadingOptions,
) -> None:
    """Add your own examples to actions that a library knows, and say what got better.

    Hold the trigger during each performance; the grip discards the last one. A take that does not
    move, or looks like another action, is asked for again.
    """
    from smd.formats import SourceFrame

    if rehearsing.take and actions:
        raise typer.BadParameter("expected ACTION, or --take ACTION=FILE, not both")
    SourceFrame.from_options(**dict(reading.pairs))  # what is wrong is told before anyone performs
    given = rehearsing.given()
    names = [name for name, _ in given] or actions or []
    rehearsal = Rehearsal.of(library, names, rehearsing, figure_height_m=figure_height_m)
    if bare := rehearsal.without_examples():
        typer.echo(bare)
    if given:
        _from_files(rehearsal, given, reading, capturing.devices or [])
    else:
        # A replay is read as the options say; its takes are in our frame, the mount apart.
        frame = SourceFrame.from_options(
            **{name: value for name, value in reading.pairs if name != "mount"}
        )
        kept = ReadingOptions(mount=reading.mount)
        _from_source(rehearsal, rehearsing, capturing, frame, kept)
    typer.echo("\n".join(rehearsal.written()))


def _from_files(
    rehearsal: Rehearsal,
    given: Sequence[tuple[str, Path]],
    reading: ReadingOptions,
    devices: Sequence[str],
) -> None:
    """Look at recordings; all of them are added, or none."""
    from smd.cli.one_doodle import one_example
    from smd.errors import LearningError

    if len(devices) > 1:
        raise typer.BadParameter("--device: expected the one that performs in the recordings")
    device = devices[0] if devices else None
    refused = []
    for action, place in given:
        for file in places.recording_files([place]):
            doodle = one_example(file, reading, device)
            try:
                typer.echo(rehearsal.offer(action, file, doodle))
            except LearningError as error:
                refused.append(str(error))
    if refused:
        raise LearningError(f"nothing was added: {'; '.join(refused)}")


def _from_source(
    rehearsal: Rehearsal,
    options: RehearsingOptions,
    capturing: CapturingOptions,
    frame: SourceFrame,
    reading: ReadingOptions,
) -> None:
    """Lead through the actions, one round after another, and look at each take at once."""
    from smd.capture.selection import require_trigger
    from smd.capture.shelf import Shelf
    from smd.cli.one_doodle import drawn_doodle
    from smd.errors import CaptureError, SmdError

    capturing.require_rate()
    asked, taken = rehearsal.names * options.times, rehearsal.takes
    with capturing.opened(frame) as opened:
        there = opened.devices()
        require_trigger(there)
        names = capturing.names_of(there)
        shelves = {name: Shelf(options.output, name) for name in rehearsal.names}

        def place() -> Path:
            return shelves[asked[len(taken)]].next().with_suffix(".csv")

        typer.echo(rehearsal.asked(0, asked))
        for path in held_takes(opened, names, place):
            if path is not None:
                try:
                    doodle = drawn_doodle(path, reading)
                    typer.echo(rehearsal.offer(asked[len(taken)], path, doodle))
                except SmdError as error:
                    typer.echo(f"  not added: {error}")
            elif taken:
                action, last, _ = taken.pop()
                shelves[action].discard(last.with_suffix(""))
                typer.echo(f"  {last.name}: discarded")
            else:
                continue  # a grip, and nothing to discard
            if len(taken) == len(asked):
                break
            typer.echo(rehearsal.asked(len(taken), asked))
    if len(taken) < len(asked):
        raise CaptureError(
            f"expected {len(asked)} performances, got {len(taken)}, and added none: rehearse fewer "
            f"actions, or give those in {options.output} with --take ACTION=FILE"
        )
