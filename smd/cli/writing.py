"""The options that say how an animation is written, shared by the commands that write one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from smd.score import Score
    from smd.transfer.performance import Performance


class StageUp(StrEnum):
    """Axis of the stage that points up."""

    Y = "y"
    Z = "z"


class StageUnit(StrEnum):
    """Unit of the stage."""

    M = "m"
    CM = "cm"


Up = Annotated[
    StageUp, typer.Option("--stage-up", help="Up axis of the animation written: y or z.")
]
Unit = Annotated[
    StageUnit, typer.Option("--stage-unit", help="Unit of the animation written: m or cm.")
]
Layers = Annotated[
    bool,
    typer.Option(
        "--layers",
        help="Each performer in a file of its own, OUT.<device>.usdc, referenced by OUT.",
    ),
]
Phrases = Annotated[
    bool,
    typer.Option("--phrases", help="Also write the phrases as a table, OUT.phrases.csv."),
]
Variants = Annotated[
    bool,
    typer.Option(
        "--variants",
        help="Also act it out without Effort: a variant set 'expression' on each character.",
    ),
]


@dataclass(frozen=True, slots=True)
class WritingOptions:
    """How the user said that an animation is to be written."""

    up: StageUp = StageUp.Y
    unit: StageUnit = StageUnit.M
    layers: bool = False
    phrases: bool = False
    variants: bool = False

    def check(self, path: Path) -> None:
        """Raise ExportError if no animation can be written so under this name."""
        from exporters import require_known_suffix
        from smd.errors import ExportError

        require_known_suffix(path)
        if self.layers and path.suffix.lower() == ".usdz":
            raise ExportError(f"{path}: expected .usda or .usdc with --layers, found .usdz")

    def write(
        self, score: Score, act: Callable[[float], Performance], expressiveness: float, path: Path
    ) -> Performance:
        """Act out a Score, write it with what goes with it, all or nothing, and return it.

        ``act`` acts it out with an expressiveness.
        """
        from actions_library.stage_frame import StageFrame
        from exporters.phrases import write_phrase_table
        from exporters.usd import usd_file, usd_layers
        from smd.files import write_together

        performance = act(expressiveness)
        neutral = act(0.0) if self.variants and has_effort(score) else None
        frame = StageFrame.named(self.up, self.unit)
        plan = usd_layers if self.layers else usd_file
        files = plan(performance, path, neutral=neutral, frame=frame)
        if self.phrases:
            table = path.with_name(f"{path.stem}.phrases.csv")
            files = {table: lambda to: write_phrase_table(performance, to), **files}
        write_together(files)
        return performance


def has_effort(score: Score) -> bool:
    """Return whether a Score says anything of how its phrases are played."""
    from exporters.phrases import effort_read

    return any(effort_read(phrase.effort) for part in score.performers for phrase in part.phrases)
