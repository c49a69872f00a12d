"""``smd play``: draw, see what was understood, get the animation, and again."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.capturing import CapturingOptions
from smd.cli.libraries import LibraryFolder
from smd.cli.option_groups import unfolded
from smd.cli.stories import StoryOptions

if TYPE_CHECKING:
    from smd.capture.beside import Beside
    from smd.capture.shelf import Shelf
    from smd.capture.source import Frame, Source


@unfolded
def play(
    *,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of the stories; made where missing.")
    ] = Path("stories"),
    suffix: Annotated[str, typer.Option("--as", help="Format of the animations.")] = ".usdc",
    picture: Annotated[
        bool, typer.Option("--picture", help="Draw a timeline of each story as well.")
    ] = False,
    library: LibraryFolder = None,
    capturing: CapturingOptions,
    story: StoryOptions,
) -> None:
    """Play stories: hold the trigger and draw.

    What is understood is printed as it is decided. When the trigger is let go, the recording, its
    Score and the animation are written under one name. The grip discards the last story; Ctrl-C
    ends.
    """
    from exporters import require_known_suffix
    from smd.capture.beside import Beside
    from smd.capture.hand import grips, stretches
    from smd.capture.selection import require_trigger
    from smd.capture.shelf import Shelf
    from smd.cli.understanding import Understanding

    capturing.require_rate()
    suffix = suffix if suffix.startswith(".") else f".{suffix}"
    require_known_suffix(Path(f"story{suffix}"))
    understanding = Understanding(
        folder=library,
        suffix=suffix,
        picture=picture,
        story=story,
        mount=story.mounted(),
    )
    with Beside(understanding.begun) as beside, capturing.opened() as opened:
        there = opened.devices()
        require_trigger(there)
        names = capturing.names_of(there)
        stories = Shelf(output, "story")
        typer.echo(f"{', '.join(names.values())}: hold the trigger and draw; Ctrl-C ends")
        sys.stdout.flush()
        game = _Game(opened, names, stories, beside)
        try:
            for held, frames in stretches(opened.poses()):
                if held:
                    game.story(frames)
                else:
                    for _ in grips(frames):
                        game.discard()
        except KeyboardInterrupt:
            pass  # the way to end


@dataclass(slots=True)
class _Game:
    """The stories that are played: this process records, the one beside understands."""

    source: Source
    names: dict[str, str]
    stories: Shelf
    beside: Beside
    played: list[Path] = field(default_factory=list)

    def story(self, frames: Iterator[Frame]) -> None:
        """Record a story, and have it understood, first as it comes and then as a whole."""
        from smd.capture.recorder import Recorder
        from smd.capture.take import rows_of

        take = self.stories.next()
        start_s: float | None = None
        drawn: set[str] = set()
        self._tick()
        self.beside.do("begin", take, self.names)
        with Recorder(take.with_suffix(".csv"), self.names) as recorder:
            try:
                for frame in frames:
                    start_s = frame.time_s if start_s is None else start_s
                    rows = rows_of(frame, self.names, hold_to_draw=True)
                    recorder.write(frame.time_s, rows)
                    drawn.update(serial for serial, (_, drawing) in rows.items() if drawing)
                    self.beside.do("follow", frame.time_s - start_s, rows)
            finally:
                self.played.append(take)
                devices = [name for serial, name in self.names.items() if serial in drawn]
                self.beside.do("end", take, devices)
        self._tick()

    def discard(self) -> None:
        """Remove the last story."""
        if self.played:
            take = self.played.pop()
            self.beside.do("discard", self.stories, take)

    def _tick(self) -> None:
        for serial in self.names:
            self.source.tick(serial)
