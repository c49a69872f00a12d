"""The options that say how an animation is written, shared by the commands that write one."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.places import PHRASES_SUFFIX

if TYPE_CHECKING:
    from smd.acting.performance import Performance
    from smd.score import Score


_USD = (".usda", ".usdc", ".usdz")


class StageUp(StrEnum):
    """Axis of the stage that points up."""

    Y = "y"
    Z = "z"


class StageUnit(StrEnum):
    """Unit of the stage."""

    M = "m"
    CM = "cm"


class Keys(StrEnum):
    """Frames that get a key."""

    ALL = "all"
    REDUCED = "reduced"


WITHIN_MM = 1.0
"""How far reduced keys may lead the skin away, unless the user says."""


@dataclass(frozen=True, slots=True)
class WritingOptions:
    """How the user said that an animation is to be written."""

    variants: Annotated[
        bool,
        typer.Option(
            "--variants",
            help="Also act it out without Effort: a variant set 'expression' on each character.",
        ),
    ] = False
    layers: Annotated[
        bool,
        typer.Option(
            "--layers",
            help="Each performer in a file of its own, OUT.<device>.usdc, referenced by OUT.",
        ),
    ] = False
    phrases: Annotated[
        bool,
        typer.Option("--phrases", help="Also write the phrases as a table, OUT.phrases.csv."),
    ] = False
    stage_up: Annotated[StageUp, typer.Option(help="Up axis of the animation written: y or z.")] = (
        StageUp.Y
    )
    stage_unit: Annotated[
        StageUnit, typer.Option(help="Unit of the animation written: m or cm.")
    ] = StageUnit.M
    keys: Annotated[
        Keys, typer.Option(help="A key each frame: all; or as few as --within allows: reduced.")
    ] = Keys.ALL
    within: Annotated[
        float | None,
        typer.Option(
            metavar="MM",
            help=f"Millimetres that reduced keys may lead the skin away. Default: {WITHIN_MM:g}.",
        ),
    ] = None

    def check(self, path: Path) -> None:
        """Raise ExportError if no animation can be written so under this name."""
        from exporters import require_known_suffix
        from smd.errors import ExportError

        require_known_suffix(path)
        suffix = path.suffix.lower()
        asked = [option for option, value in self._of_usd().items() if value]
        if asked and suffix not in _USD:
            raise ExportError(f"{path}: expected {', '.join(_USD)} with {asked[0]}, found {suffix}")
        if self.layers and suffix == ".usdz":
            raise ExportError(f"{path}: expected .usda or .usdc with --layers, found .usdz")
        if self.within is not None:
            if self.keys is Keys.ALL:
                raise ExportError("--within: expected --keys reduced with it, found --keys all")
            if not (math.isfinite(self.within) and self.within > 0):
                raise ExportError(f"--within: expected millimetres above 0, found {self.within:g}")

    def _of_usd(self) -> dict[str, bool]:
        """Return whether each option that USD alone has was asked for."""
        return {
            "--layers": self.layers,
            "--variants": self.variants,
            "--stage-up": self.stage_up is not StageUp.Y,
            "--stage-unit": self.stage_unit is not StageUnit.M,
            "--keys": self.keys is not Keys.ALL,
        }

    def write(
        self, score: Score, act: Callable[[float], Performance], expressiveness: float, path: Path
    ) -> Performance:
        """Act out a Score, write it with what goes with it, all or nothing, and return it.

        ``act`` acts it out with an expressiveness.
        """
        from exporters.phrases import write_phrase_table
        from smd.files import write_together

        performance = act(expressiveness)
        neutral = act(0.0) if self.variants and has_effort(score) else None
        files = self._files(performance, neutral, path)
        if self.phrases:
            table = path.with_name(f"{path.stem}{PHRASES_SUFFIX}")
            files = {table: lambda to: write_phrase_table(performance, to), **files}
        write_together(files)
        return performance

    def _files(
        self, performance: Performance, neutral: Performance | None, path: Path
    ) -> dict[Path, Callable[[Path], None]]:
        """Return what writes each file of the animation itself."""
        import exporters

        if path.suffix.lower() not in _USD:
            return {path: lambda to: exporters.write(performance, to)}
        from actions_library.stage_frame import StageFrame
        from exporters.usd import usd_file, usd_layers

        plan = usd_layers if self.layers else usd_file
        frame = StageFrame.named(self.stage_up, self.stage_unit)
        within_m = None
        if self.keys is Keys.REDUCED:
            within_m = 0.001 * (WITHIN_MM if self.within is None else self.within)
        return plan(performance, path, neutral=neutral, frame=frame, keys_within_m=within_m)


def has_effort(score: Score) -> bool:
    """Return whether a Score says anything of how its phrases are played."""
    from exporters.phrases import effort_read

    return any(effort_read(phrase.effort) for part in score.performers for phrase in part.phrases)
