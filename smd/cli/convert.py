"""``smd convert``: recordings in, animations out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import acting, libraries, parsing, places, score_lines, writing
from smd.cli.batch import for_each, targets
from smd.cli.next_steps import next_steps
from smd.cli.option_groups import unfolded
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from smd.transfer.performance import Performance


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
    library: libraries.Libraries = None,
    figure_height: parsing.FigureHeight = parsing.FIGURE_HEIGHT_M,
    tolerance: parsing.Tolerance = 1.0,
    intent: parsing.Intent = None,
    unexplained: parsing.Unexplained = parsing.UnexplainedName.LEAVE,
    fps: acting.FramesPerSecond = 24.0,
    expressiveness: acting.Expressiveness = 1.0,
    heading: acting.Heading = acting.HeadingName.PROP,
    ground: acting.Ground = None,
    variants: writing.Variants = False,
    layers: writing.Layers = False,
    phrases: writing.Phrases = False,
    stage_up: writing.Up = writing.StageUp.Y,
    stage_unit: writing.Unit = writing.StageUnit.M,
    device: parsing.Device = None,
    reading: ReadingOptions,
) -> None:
    """Convert recordings to animations.

    A file in, a file out; a folder in, a folder out.
    """
    import smd
    from smd.transfer.terrain import read_terrain

    files = list(places.recording_files(recordings))
    suffix = suffix if suffix.startswith(".") else f".{suffix}"
    outputs = targets(recordings, files, output, suffix)
    written = writing.WritingOptions(stage_up, stage_unit, layers, phrases, variants)
    for path in outputs:
        written.check(path)
    folders = libraries.LibraryFolders.from_options(library)
    cast = folders.load()
    understood = parsing.understanding(
        reading,
        cast,
        folders,
        figure_height_m=figure_height,
        devices=device,
        tolerance=tolerance,
        intent=intent,
        unexplained=unexplained,
    )
    terrain = None if ground is None else read_terrain(ground)

    def one(index: int, file: Path) -> None:
        recording, score = understood(file)

        def act(how_much: float) -> Performance:
            return smd.animate(
                score,
                recording,
                cast,
                rate_hz=fps,
                expressiveness=how_much,
                heading=heading,
                ground=terrain,
            )

        performance = written.write(score, act, expressiveness, outputs[index])
        said = f"{outputs[index]}: {score_lines.summary(recording, score)}"
        typer.echo("\n".join([said, *(f"  {line}" for line in performance.score.warnings)]))
        for line in next_steps(file, recording, score, cast, options=reading, tolerance=tolerance):
            typer.echo(f"  {line}")

    for_each(files, one)
