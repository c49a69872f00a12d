"""``smd animate``: a Score, perhaps corrected by hand, acted out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from smd.cli import score_lines
from smd.cli.acting import ActingOptions, said_about
from smd.cli.libraries import Libraries, LibraryFolders
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions
from smd.cli.writing import WritingOptions


@unfolded
def animate(
    score_file: Annotated[Path, typer.Argument(metavar="SCORE", help="A Score from `smd parse`.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="OUT.usda, OUT.usdc or OUT.usdz.")],
    *,
    recording: Annotated[
        Path | None,
        typer.Option(help="The recording. Default: the one the Score names, beside the Score."),
    ] = None,
    library: Libraries = None,
    acting: ActingOptions,
    writing: WritingOptions,
) -> None:
    """Act out a Score, perhaps corrected by hand.

    It is played on its recording's path and in its timing.
    """
    from smd.errors import ScoreError
    from smd.score_file import read_score

    writing.check(output)
    score = read_score(score_file)
    if recording is None:
        if not score.recording:
            raise ScoreError(f"{score_file}: recording: expected a path, or --recording FILE")
        recording = score_file.parent / score.recording
    take = ReadingOptions.from_pairs(score.reading).read(recording)
    cast = LibraryFolders.from_options(library).over(score, score_file).load()
    act = acting.acts_out(score, take, cast, acting.terrain())
    performance = writing.write(score, act, acting.expressiveness, output)
    said = f"{output}: {score_lines.summary(take, score)}"
    typer.echo("\n".join([said, *(f"  {line}" for line in said_about(performance))]))
