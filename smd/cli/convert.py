"""``smd convert``: recordings in, animations out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import reading, writing
from smd.cli.batch import for_each, targets
from smd.cli.next_steps import next_steps

if TYPE_CHECKING:
    from smd.acting.performance import Performance


def convert(
    recordings: reading.Recordings,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="OUT.usda, .usdc or .usdz; or a folder for several."),
    ],
    suffix: Annotated[
        str, typer.Option("--as", help="Format of the files written into a folder.")
    ] = ".usdc",
    library: reading.Libraries = None,
    figure_height: reading.FigureHeight = reading.FIGURE_HEIGHT_M,
    tolerance: reading.Tolerance = 1.0,
    intent: reading.Intent = None,
    unexplained: reading.Unexplained = reading.UnexplainedName.LEAVE,
    fps: reading.FramesPerSecond = 24.0,
    expressiveness: reading.Expressiveness = 1.0,
    heading: reading.Heading = reading.HeadingName.PROP,
    ground: reading.Ground = None,
    variants: writing.Variants = False,
    layers: writing.Layers = False,
    phrases: writing.Phrases = False,
    stage_up: writing.Up = writing.StageUp.Y,
    stage_unit: writing.Unit = writing.StageUnit.M,
    device: reading.Device = None,
    up: reading.Up = None,
    front: reading.Front = None,
    handedness: reading.Handedness = None,
    unit: reading.Unit = None,
    quaternion: reading.Quaternion = None,
    mount: reading.Mount = None,
) -> None:
    """Convert recordings to animations.

    A file in, a file out; a folder in, a folder out.
    """
    import smd
    from actions_library.importers.usd_ground import read_terrain

    files = list(reading.recording_files(recordings))
    suffix = suffix if suffix.startswith(".") else f".{suffix}"
    outputs = targets(recordings, files, output, suffix)
    written = writing.WritingOptions(stage_up, stage_unit, layers, phrases, variants)
    for path in outputs:
        written.check(path)
    options = reading.ReadingOptions(up, front, handedness, unit, quaternion, mount)
    folders = reading.LibraryFolders.from_options(library)
    cast = folders.load()
    understood = reading.understanding(
        options,
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
        said = f"{outputs[index]}: {reading.summary(recording, score)}"
        typer.echo("\n".join([said, *(f"  {line}" for line in performance.warnings)]))
        for line in next_steps(file, recording, score, cast, options=options, tolerance=tolerance):
            typer.echo(f"  {line}")

    for_each(files, one)
