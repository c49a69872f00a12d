"""What is understood of the stories that are played, in a process beside the one that records."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from smd.cli import places, score_lines
from smd.cli.next_steps import LIVE, next_steps
from smd.cli.parsing import ParsingOptions
from smd.cli.reading import ReadingOptions

if TYPE_CHECKING:
    from actions_library.library import Library
    from laban import EffortModel
    from smd.capture.live import Decided, LiveRecognition
    from smd.capture.shelf import Shelf
    from smd.capture.source import Row
    from smd.cli.stories import StoryOptions
    from smd.formats import Mount
    from smd.recognition import Recognizer

SHOWN_OTHERS = 2
"""So many alternatives are shown to each phrase."""


@dataclass(frozen=True, slots=True)
class Understanding:
    """How stories are to be understood and acted out.

    Attributes
    ----------
    folder : of the library; None for the shipped one.
    suffix : format of the animations.
    picture : whether a timeline of each story is drawn.
    story : what the user said of each.
    mount : how the prop sits on its tracker, as ``story`` says it.
    """

    folder: Path | None
    suffix: str
    picture: bool
    story: StoryOptions
    mount: Mount | None

    def begun(self) -> Understander:
        """Load what is needed to understand."""
        import smd
        from laban import load_effort_model
        from smd.recognition.recognizers import recognizer_of

        library = smd.load_library(self.folder)
        recognizer = recognizer_of(
            library, figure_height_m=self.story.figure_height_m, tolerance=self.story.tolerance
        )
        return Understander(self, library, recognizer, load_effort_model())


class Understander:
    """Understands one story after another: first as it comes, then as a whole.

    Parameters
    ----------
    how
        Stories are to be understood.
    library, recognizer, model
        What was loaded for it.
    """

    def __init__(
        self, how: Understanding, library: Library, recognizer: Recognizer, model: EffortModel
    ) -> None:
        self._how = how
        self._library = library
        self._recognizer = recognizer
        self._model = model
        self._live: LiveRecognition | None = None

    def begin(self, take: Path, names: dict[str, str]) -> None:
        """Begin with a story of some devices, named by serial."""
        from smd.capture.live import LiveRecognition

        self._live = LiveRecognition(self._recognizer, self._model, names, self._how.mount)
        _say(f"{take.name}:")

    def follow(self, time_s: float, rows: dict[str, Row]) -> None:
        """Take a moment of the story, and print the phrases that it decides."""
        if self._live is not None:
            _print(self._live.push(time_s, rows))

    def end(self, take: Path, devices: list[str]) -> None:
        """Print what was left to decide; write Score and animation, and print what they hold.

        A story of which nothing can be made costs one line, and its recording stays.
        """
        from laban import LabanError
        from smd.errors import SmdError

        if self._live is not None:
            _print(self._live.finish())
            self._live = None
        try:
            self._act_out(take, devices)
        except (SmdError, LabanError) as error:
            _say(f"{take.with_suffix('.csv')}: kept, but not acted out: {error}")

    def discard(self, stories: Shelf, take: Path) -> None:
        """Remove a story."""
        stories.discard(take)
        _say(f"{take.name}: discarded")

    def _act_out(self, take: Path, devices: list[str]) -> None:
        import smd
        from smd.cli.score_lines import table
        from smd.score_file import write_score

        how = self._how
        options = ReadingOptions(mount=None if how.mount is None else str(how.mount))
        parsing = ParsingOptions(
            library=None if how.folder is None else [str(how.folder)],
            figure_height_m=how.story.figure_height_m,
            tolerance=how.story.tolerance,
        )
        recording, score = parsing.parse(take.with_suffix(".csv"), options, self._library, devices)
        score_file = take.with_suffix(places.SCORE_SUFFIX)
        write_score(places.beside(score, score_file), score_file)
        _say(f"{take.with_suffix(how.suffix)}: {score_lines.summary(recording, score)}")
        for line in table(score, others=SHOWN_OTHERS):
            _say(line)
        for line in next_steps(
            take.with_suffix(".csv"),
            recording,
            score,
            smd.Cast(self._library),
            options=options,
            tolerance=how.story.tolerance,
            only=LIVE,
        ):
            _say(f"  {line}")
        performance = None
        try:
            performance = smd.animate(score, recording, self._library, rate_hz=how.story.fps)
            smd.write(performance, take.with_suffix(how.suffix))
        finally:  # what was understood is shown though it cannot be acted out
            if how.picture:
                from exporters.timeline import write_timeline

                picture = take.with_suffix(".timeline.png")
                write_timeline(recording, score, picture, performance)


def _print(decided: list[Decided]) -> None:
    """Print phrases as they are decided."""
    from smd.cli.score_lines import row

    for device, span, effort in decided:
        line = row(span.start_s, span.end_s, span.action, span.confidence, effort)
        _say(f"  {line}  {device}")


def _say(line: str) -> None:
    """Print a line at once: who plays is waiting for it."""
    print(line, flush=True)
