"""The options that say how a Score is acted out, shared by the commands that act one out."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

Expressiveness = Annotated[
    float,
    typer.Option(
        help="How much of the Effort is played: 0 neutral clips, 1 as read, up to 2.",
        min=0.0,
        max=2.0,
    ),
]


class HeadingName(StrEnum):
    """What characters face by."""

    PROP = "prop"
    PATH = "path"


Heading = Annotated[
    HeadingName,
    typer.Option(help="What characters face by: prop, where it faces, or path, where it goes."),
]
Ground = Annotated[
    Path | None,
    typer.Option(
        help="What they walk on: a USD file of meshes; its origin is the middle of the devices' "
        "first places. Default: the level ground."
    ),
]
FramesPerSecond = Annotated[
    float, typer.Option("--fps", help="Frames per second of the animation.", min=1.0, max=240.0)
]
