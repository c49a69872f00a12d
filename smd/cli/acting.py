"""The options that say how a Score is acted out, shared by the commands that act one out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from smd.acting.performance import Performance
    from smd.acting.terrain import Terrain
    from smd.cast import Cast
    from smd.doodle import Recording
    from smd.score import Score

FramesPerSecond = Annotated[
    float, typer.Option("--fps", help="Frames per second of the animation.", min=1.0, max=240.0)
]


class HeadingName(StrEnum):
    """What characters face by."""

    PROP = "prop"
    PATH = "path"


class TimingName(StrEnum):
    """When phrases are played."""

    FEASIBLE = "feasible"
    DRAWN = "drawn"


@dataclass(frozen=True, slots=True)
class ActingOptions:
    """How the user said that Scores are to be acted out."""

    fps: FramesPerSecond = 24.0
    expressiveness: Annotated[
        float,
        typer.Option(
            help="How much of the Effort is played: 0 neutral clips, 1 as read, up to 2.",
            min=0.0,
            max=2.0,
        ),
    ] = 1.0
    heading: Annotated[
        HeadingName,
        typer.Option(help="What characters face by: prop, where it faces, or path, where it goes."),
    ] = HeadingName.PROP
    timing: Annotated[
        TimingName,
        typer.Option(
            help="When phrases are played: feasible, as a body can, with the pauses beside them; "
            "or drawn, as in the Score."
        ),
    ] = TimingName.FEASIBLE
    stretch: Annotated[
        str,
        typer.Option(
            metavar="K|auto",
            help="How many times as long as the recording the animation lasts; auto: as long as "
            "most phrases need.",
        ),
    ] = "1"
    hold: Annotated[
        bool,
        typer.Option("--hold", help="Characters hold their props in a hand."),
    ] = False
    ground: Annotated[
        Path | None,
        typer.Option(
            help="What they walk on: a USD file of meshes; its origin is the middle of the "
            "devices' first places. Default: the level ground."
        ),
    ] = None

    def terrain(self) -> Terrain | None:
        """Read what the characters walk on; None for the level ground."""
        from actions_library.importers.usd_ground import read_terrain

        return None if self.ground is None else read_terrain(self.ground)

    def acts_out(
        self, score: Score, recording: Recording, cast: Cast, terrain: Terrain | None
    ) -> Callable[[float], Performance]:
        """Return what acts out a Score with as much of its Effort as it is told."""
        import smd

        def act(expressiveness: float) -> Performance:
            return smd.animate(
                score,
                recording,
                cast,
                rate_hz=self.fps,
                expressiveness=expressiveness,
                heading=self.heading,
                timing=self.timing,
                stretch=self.stretch,
                hold=self.hold,
                ground=terrain,
            )

        return act


def said_about(performance: Performance) -> list[str]:
    """Return what a person is told about a performance: what its plan changed, and warnings."""
    from smd.transfer.plan_report import plan_summary

    planned = plan_summary(performance.source["plan"])
    return [*([planned] if planned else []), *performance.warnings]
