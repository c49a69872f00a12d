"""``smd convert``: recordings in, animations out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from smd.cli import places, score_lines
from smd.cli.acting import ActingOptions, said_about
from smd.cli.batch import for_each, targets
from smd.cli.next_steps import next_steps
from smd.cli.option_groups import unfolded
from smd.cli.parsing import Device, ParsingOptions
from smd.cli.reading import ReadingOptions
from smd.cli.writing import WritingOptions


@unfolded
def convert(
    recordings: places.Recordings,
    *,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="OUT.usda, .usdc or .usdz; or a folder for several."),
    ],
    suffix: Annotated[
        str, typer.Option("--as", help="Format of the files written into a folder.")
    ] = ".usdc",
    parsing: ParsingOptions,
    acting: ActingOptions,
    writing: WritingOptions,
    device: Device = None,
    reading: ReadingOptions,
) -> None:
    """Convert recordings to animations.

    A file in, a file out; a folder in, a folder out.
    """
    files = list(places.recording_files(recordings))
    suffix = suffix if suffix.startswith(".") else f".{suffix}"
    outputs = targets(recordings, files, output, suffix)
    for path in outputs:
        writing.check(path)
    cast = parsing.folders.load()
    terrain = acting.terrain()

    def one(index: int, file: Path) -> None:
        recording, score = parsing.parse(file, reading, cast, device)
        act = acting.acts_out(score, recording, cast, terrain)
        performance = writing.write(score, act, acting.expressiveness, outputs[index])
        said = f"{outputs[index]}: {score_lines.summary(recording, score)}"
        typer.echo("\n".join([said, *(f"  {line}" for line in said_about(performance))]))
        for line in next_steps(
            file, recording, score, cast, options=reading, tolerance=parsing.tolerance
        ):
            typer.echo(f"  {line}")

    for_each(files, one)
