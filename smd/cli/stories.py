"""The options that say how a story is understood and acted out while others are played."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from smd.cli.acting import FramesPerSecond
from smd.cli.parsing import FIGURE_HEIGHT_M, FigureHeight, Tolerance
from smd.cli.reading import Mount

if TYPE_CHECKING:
    from smd.formats import Mount as ParsedMount


@dataclass(frozen=True, slots=True)
class StoryOptions:
    """How the user said that what is played is to be understood and acted out."""

    figure_height_m: FigureHeight = FIGURE_HEIGHT_M
    tolerance: Tolerance = 1.0
    fps: FramesPerSecond = 24.0
    mount: Mount = None

    def mounted(self) -> ParsedMount | None:
        """Return how the prop sits on its tracker, or raise RecordingError."""
        from smd.formats import Mount

        return None if self.mount is None else Mount.parse(self.mount)
