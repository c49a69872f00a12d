"""``smd play``: draw, see what was understood, get the animation, and again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import capturing, reading

if TYPE_CHECKING:
    from actions_library.library import Library
    from laban import EffortModel
    from smd.capture.beside import Beside
    from smd.capture.live import Decided, LiveRecognition
    from smd.capture.shelf import Shelf
    from smd.capture.source import Frame, Pose, Source
    from smd.formats import Mount
    from smd.recognition import Recognizer

SHOWN_OTHERS = 2
"""So many alternatives are shown to each phrase."""


def play(
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of the stories; made where missing.")
    ] = Path("stories"),
    suffix: Annotated[str, typer.Option("--as", help="Format of the animations.")] = ".usdc",
    picture: Annotated[
        bool, typer.Option("--picture", help="Draw a timeline of each story as well.")
    ] = False,
    library: reading.LibraryFolder = None,
    device: capturing.Devices = None,
    rate: capturing.Rate = 90.0,
    source: capturing.Source = "openvr",
    figure_height: reading.FigureHeight = reading.FIGURE_HEIGHT_M,
    tolerance: reading.Tolerance = 1.0,
    fps: reading.FramesPerSecond = 24.0,
    mount: reading.Mount = None,
) -> None:
    """Play stories: hold the trigger and draw.

    What is understood is printed as it is decided. When the trigger is let go, the recording, its
    Score and the animation are written under one name. The grip discards the last story; Ctrl-C
    ends.
    """
    import smd
    from exporters import require_known_suffix
    from laban import load_effort_model
    from smd.capture.beside import Beside
    from smd.capture.hand import grips, stretches
    from smd.capture.opening import open_source
    from smd.capture.selection import chosen_devices, require_trigger
    from smd.capture.shelf import Shelf
    from smd.capture.take import require_rate
    from smd.formats import Mount
    from smd.recognition import Recognizer

    require_rate(rate)
    suffix = suffix if suffix.startswith(".") else f".{suffix}"
    require_known_suffix(Path(f"story{suffix}"))
    shelf = smd.load_library(library)
    understanding = _Understanding(
        library=shelf,
        recognizer=Recognizer(shelf, figure_height_m=figure_height, tolerance=tolerance),
        model=load_effort_model(),
        folder=library,
        suffix=suffix,
        picture=picture,
        figure_height_m=figure_height,
        tolerance=tolerance,
        fps=fps,
        mount=None if mount is None else Mount.parse(mount),
    )
    with open_source(source, rate) as opened:
        there = opened.devices()
        require_trigger(there)
        names = {each.serial: each.name for each in chosen_devices(there, device or ())}
        stories = Shelf(output, "story")
        typer.echo(f"{', '.join(names.values())}: hold the trigger and draw; Ctrl-C ends")
        with Beside() as beside:
            game = _Game(opened, names, stories, understanding, beside)
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
    """The stories that are played: this thread records, the one beside understands."""

    source: Source
    names: dict[str, str]
    stories: Shelf
    understanding: _Understanding
    beside: Beside
    played: list[Path] = field(default_factory=list)

    def story(self, frames: Iterator[Frame]) -> None:
        """Record a story, and have it understood, first as it comes and then as a whole."""
        from smd.capture.recorder import Recorder
        from smd.capture.take import rows_of

        take = self.stories.next()
        live = self.understanding.live(self.names)
        start_s: float | None = None
        drawn: set[str] = set()
        self._tick()
        self.beside.do(lambda: typer.echo(f"{take.name}:"))
        with Recorder(take.with_suffix(".csv"), self.names) as recorder:
            try:
                for frame in frames:
                    start_s = frame.time_s if start_s is None else start_s
                    rows = rows_of(frame, self.names, hold_to_draw=True)
                    recorder.write(frame.time_s, rows)
                    drawn.update(serial for serial, (_, drawing) in rows.items() if drawing)
                    self.beside.do(_pushing(live, frame.time_s - start_s, rows))
            finally:
                self.played.append(take)
                devices = [name for serial, name in self.names.items() if serial in drawn]
                self.beside.do(lambda: _print(live.finish()))
                self.beside.do(lambda: self.understanding.whole(take, devices))
        self._tick()

    def discard(self) -> None:
        """Remove the last story."""
        if self.played:
            take = self.played.pop()
            self.beside.do(lambda: self.stories.discard(take))
            self.beside.do(lambda: typer.echo(f"{take.name}: discarded"))

    def _tick(self) -> None:
        for serial in self.names:
            self.source.tick(serial)


def _pushing(
    live: LiveRecognition, time_s: float, rows: dict[str, tuple[Pose | None, bool]]
) -> Callable[[], None]:
    """Return the job that recognises one more moment."""
    return lambda: _print(live.push(time_s, rows))


def _print(decided: list[Decided]) -> None:
    """Print phrases as they are decided."""
    from smd.cli.parse import row

    for device, span, effort in decided:
        line = row(span.start_s, span.end_s, span.action, span.confidence, effort)
        typer.echo(f"  {line}  {device}")


@dataclass(frozen=True, slots=True)
class _Understanding:
    """How stories are understood and acted out."""

    library: Library
    recognizer: Recognizer
    model: EffortModel
    folder: Path | None
    suffix: str
    picture: bool
    figure_height_m: float
    tolerance: float
    fps: float
    mount: Mount | None

    def live(self, names: dict[str, str]) -> LiveRecognition:
        """Return what recognises one story as it comes."""
        from smd.capture.live import LiveRecognition

        return LiveRecognition(self.recognizer, self.model, names, self.mount)

    def whole(self, take: Path, devices: list[str]) -> None:
        """Write a story's Score and animation, and print what was understood.

        A story of which nothing can be made costs one line, and its recording stays.
        """
        import smd
        from laban import LabanError
        from smd.cli.parse import table
        from smd.errors import SmdError
        from smd.score import write_score

        understood = reading.understanding(
            reading.ReadingOptions(mount=None if self.mount is None else str(self.mount)),
            self.library,
            reading.LibraryFolders(self.folder),
            figure_height_m=self.figure_height_m,
            devices=devices,
            tolerance=self.tolerance,
        )
        try:
            recording, score = understood(take.with_suffix(".csv"))
            score_file = take.with_suffix(reading.SCORE_SUFFIX)
            write_score(reading.beside(score, score_file), score_file)
            typer.echo(f"{take.with_suffix(self.suffix)}: {reading.summary(recording, score)}")
            typer.echo("\n".join(table(score, others=SHOWN_OTHERS)))
            if self.picture:
                from exporters.timeline import write_timeline

                write_timeline(recording, score, take.with_suffix(".timeline.png"))
            performance = smd.animate(score, recording, self.library, rate_hz=self.fps)
            smd.write(performance, take.with_suffix(self.suffix))
        except (SmdError, LabanError) as error:
            typer.echo(f"{take.with_suffix('.csv')}: kept, but not acted out: {error}")
