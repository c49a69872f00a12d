"""``smd demo``: the main job on a shipped recording, with pictures of what was understood."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.option_groups import unfolded
from smd.cli.writing import WritingOptions

if TYPE_CHECKING:
    from smd.acting.performance import Performance
    from smd.doodle import Recording
    from smd.score import Score

STORY = "duel"


@unfolded
def demo(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The folder to write into; made where missing.")
    ] = Path("smd-demo"),
    *,
    writing: WritingOptions,
) -> None:
    """Convert a shipped recording, with pictures.

    The pictures show what was understood.
    """
    import smd
    from smd.cli.score_lines import summary, table
    from smd.errors import ExportError

    stage = output / f"{STORY}.usda"
    writing.check(stage)
    try:
        output.mkdir(exist_ok=True)
    except OSError as error:
        raise ExportError(f"{output}: expected a folder, got: {error.strerror}") from error
    source = shipped_recording(STORY)
    recording = smd.read_recording(source)
    library = smd.load_library()
    score = smd.parse(recording, library)
    typer.echo(f"{source.name}: {summary(recording, score)}")
    typer.echo("\n".join(table(score)))

    def act(expressiveness: float) -> Performance:
        return smd.animate(score, recording, library, expressiveness=expressiveness)

    performance = writing.write(score, act, 1.0, stage)
    typer.echo(f"{stage}: the animation; open it in Blender, usdview or Unreal")
    _draw(stage, recording, score, performance, output)


def _draw(
    stage: Path, recording: Recording, score: Score, performance: Performance, output: Path
) -> None:
    """Write the pictures; a machine that cannot render is told so and keeps its animation."""
    from exporters.filmstrip import write_filmstrip
    from exporters.timeline import write_timeline
    from smd.errors import ExportError

    timeline, filmstrip = output / f"{STORY}.timeline.png", output / f"{STORY}.filmstrip.png"
    write_timeline(recording, score, timeline, performance)
    typer.echo(f"{timeline}: tokens, phrases and Effort under the trajectory")
    try:
        write_filmstrip(stage, filmstrip)
    except ExportError as error:
        typer.echo(f"no filmstrip: {error}")
    else:
        typer.echo(f"{filmstrip}: the performance, a row per phrase")


def shipped_recording(story: str) -> Path:
    """Return one of the recordings that ship with the program.

    They stand in ``recordings/`` beside the packages in a checkout, and inside ``smd`` once
    installed (pyproject.toml maps the one to the other).
    """
    package = Path(__file__).parents[1]
    installed, checkout = package / "recordings", package.parent / "recordings"
    return (installed if installed.is_dir() else checkout) / f"{story}.csv"
