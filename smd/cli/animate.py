"""``smd animate``: a Score, perhaps corrected by hand, acted out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import acting, libraries, reading, score_lines, writing

if TYPE_CHECKING:
    from smd.transfer.performance import Performance


def animate(
    score_file: Annotated[Path, typer.Argument(metavar="SCORE", help="A Score from `smd parse`.")],
    output: Annotated[Path, typer.Option("-o", "--output", help="OUT.usda, OUT.usdc or OUT.usdz.")],
    recording: Annotated[
        Path | None,
        typer.Option(help="The recording. Default: the one the Score names, beside the Score."),
    ] = None,
    library: libraries.Libraries = None,
    fps: acting.FramesPerSecond = 24.0,
    expressiveness: acting.Expressiveness = 1.0,
    heading: acting.Heading = acting.HeadingName.PROP,
    ground: acting.Ground = None,
    variants: writing.Variants = False,
    layers: writing.Layers = False,
    phrases: writing.Phrases = False,
    stage_up: writing.Up = writing.StageUp.Y,
    stage_unit: writing.Unit = writing.StageUnit.M,
) -> None:
    """Act out a Score, perhaps corrected by hand.

    It is played on its recording's path and in its timing.
    """
    import smd
    from smd.errors import ScoreError
    from smd.score_file import read_score
    from smd.transfer.terrain import read_terrain

    written = writing.WritingOptions(stage_up, stage_unit, layers, phrases, variants)
    written.check(output)
    score = read_score(score_file)
    if recording is None:
        if not score.recording:
            raise ScoreError(f"{score_file}: recording: expected a path, or --recording FILE")
        recording = score_file.parent / score.recording
    options = reading.ReadingOptions.from_pairs(score.reading)
    take = options.read(recording)
    cast = libraries.LibraryFolders.from_options(library).over(score, score_file).load()
    terrain = None if ground is None else read_terrain(ground)

    def act(how_much: float) -> Performance:
        return smd.animate(
            score,
            take,
            cast,
            rate_hz=fps,
            expressiveness=how_much,
            heading=heading,
            ground=terrain,
        )

    performance = written.write(score, act, expressiveness, output)
    said = f"{output}: {score_lines.summary(take, score)}"
    typer.echo("\n".join([said, *(f"  {line}" for line in performance.score.warnings)]))
