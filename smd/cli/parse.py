"""``smd parse``: what was recognised, as a table, as a Score, as JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import places, score_lines
from smd.cli.batch import for_each, targets
from smd.cli.next_steps import next_steps
from smd.cli.option_groups import unfolded
from smd.cli.parsing import Device, ParsingOptions
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from smd.score import Score


@unfolded
def parse(
    recordings: places.Recordings,
    *,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write the Score here; a folder for several."),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the Score as JSON and nothing else.")
    ] = False,
    explain: Annotated[
        bool, typer.Option("--explain", help="Print what each phrase was weighed by.")
    ] = False,
    parsing: ParsingOptions,
    device: Device = None,
    reading: ReadingOptions,
) -> None:
    """Recognise actions and their Effort.

    They are printed, or written as a Score that can be corrected by hand.
    """
    from smd.score_file import score_to_json, write_score

    files = list(places.recording_files(recordings))
    outputs = targets(recordings, files, output, places.SCORE_SUFFIX) if output else []
    cast = parsing.folders.load()
    scores: list[Score] = []

    def one(index: int, file: Path) -> None:
        recording, score = parsing.parse(file, reading, cast, device)
        scores.append(score)
        if outputs:
            write_score(places.beside(score, outputs[index]), outputs[index])
        if not as_json:
            typer.echo(f"{file}: {score_lines.summary(recording, score)}")
            typer.echo("\n".join(score_lines.table(score)))
            if explain:
                from smd.cli.explain import explanation

                typer.echo("\n".join(explanation(score, recording, cast)))
            for line in next_steps(
                file, recording, score, cast, options=reading, tolerance=parsing.tolerance
            ):
                typer.echo(f"  {line}")
            if outputs:
                typer.echo(f"written: {outputs[index]}")

    try:
        for_each(files, one)
    finally:
        if as_json and len(files) == 1 and scores:
            typer.echo(score_to_json(scores[0]), nl=False)
        elif as_json and len(files) > 1:
            typer.echo(json.dumps([json.loads(score_to_json(score)) for score in scores]))
