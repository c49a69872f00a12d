"""``smd render``: pictures of a performance, without a screen."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def render(
    performance: Annotated[
        Path, typer.Argument(metavar="OUT", help="A USD file with skinned characters.")
    ],
    picture: Annotated[Path, typer.Option("-o", "--output", help="PICTURE.png")],
) -> None:
    """Draw a filmstrip of a performance.

    A row per phrase, eight moments a row, without a screen.
    """
    from exporters.filmstrip import write_filmstrip

    write_filmstrip(performance, picture)
    typer.echo(f"{picture}")
