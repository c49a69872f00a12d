"""A rehearsal: actions that a library knows, and one's own takes of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.capturing import TakesFolder
from smd.cli.wording import count

if TYPE_CHECKING:
    from actions_library.library import Library
    from smd.doodle import Doodle
    from smd.recognition import Recognizer
    from smd.recognition.action import Action
    from smd.recognition.rehearsal import Likeness


@dataclass(frozen=True, slots=True)
class RehearsingOptions:
    """How the user said that actions are to be rehearsed."""

    take: Annotated[
        list[str] | None,
        typer.Option(
            "--take",
            metavar="ACTION=FILE",
            help="A recording of one performance of it, or a folder of such, instead of a device; "
            "may be repeated.",
        ),
    ] = None
    base: Annotated[
        str | None,
        typer.Option(
            "--from",
            help="Begin a new library with all actions of this one: a folder. Default: with the "
            "shipped ones.",
        ),
    ] = None
    times: Annotated[int, typer.Option(help="How often each action is drawn.", min=1, max=20)] = 1
    keep: Annotated[
        bool, typer.Option("--keep", help="Add takes that look like another action, too.")
    ] = False
    output: TakesFolder = Path("rehearsals")

    def given(self) -> list[tuple[str, Path]]:
        """Return actions and their files, or end as after wrong usage."""
        return [_given(one) for one in self.take or ()]


@dataclass(slots=True)
class Rehearsal:
    """Actions to rehearse, the library that has them, and the takes so far.

    Attributes
    ----------
    folder : of the library that is extended or made.
    start : what it is, or begins with.
    there : whether it is there already.
    names : of the actions, in the order in which they are asked for.
    keep : whether takes that look like another action are added, too.
    figure_height_m : of the figurine that the prop stands for.
    recognizer : of ``start``.
    takes : the action, file and doodle of each take that is to be added.
    """

    folder: Path
    start: Library
    there: bool
    names: list[str]
    keep: bool
    figure_height_m: float
    recognizer: Recognizer
    takes: list[tuple[str, Path, Doodle]] = field(default_factory=list)

    @classmethod
    def of(
        cls,
        folder: Path,
        names: Sequence[str],
        options: RehearsingOptions,
        *,
        figure_height_m: float,
    ) -> Rehearsal:
        """Return the rehearsal that a user asks for.

        Raises
        ------
        LibraryError
            If there is no such library, no place for one, or it has no such action to draw.
        """
        import smd
        from actions_library.extension import require_place
        from actions_library.manifest import MANIFEST
        from smd.errors import LibraryError
        from smd.recognition import Recognizer

        base = options.base
        there = (folder / MANIFEST).is_file()
        if there and base is not None:
            raise LibraryError(f"{folder}: expected no library there to begin one --from {base}")
        if not there:
            require_place(folder)
        shipped = smd.load_library()
        if there:
            start = smd.load_library(folder)
        else:
            start = shipped if base in (None, shipped.name) else smd.load_library(base)
        drawn = [action.name for action in start.actions if action.pattern is not None]
        for name in names:
            if start.action(name).pattern is None:
                raise LibraryError(
                    f"action {name!r}: expected one that is drawn, as {', '.join(drawn)}"
                )
        if not drawn:
            raise LibraryError(f"{start.folder}: expected actions that are drawn, found none")
        recognizer = Recognizer(start, figure_height_m=figure_height_m)
        asked = list(dict.fromkeys(names)) or drawn
        return cls(folder, start, there, asked, options.keep, figure_height_m, recognizer)

    def without_examples(self) -> str:
        """Return a line on actions that have no examples, the old way; empty if all have some."""
        bare = [name for name in self.names if self.start.action(name).exemplar is None]
        if not bare:
            return ""
        return (
            f"{', '.join(bare)}: no examples in {self.start.folder}: recognised by tokens alone, "
            "the old way; the patterns are widened to accept what you draw. A library with "
            "examples is begun where there is none, or with smd learn --replace"
        )

    def asked(self, number: int, of: Sequence[str]) -> str:
        """Return what the user is asked for; ``number`` counts from 0."""
        action = self.start.action(of[number])
        how = f" ({action.description.rstrip('.')})" if action.description else ""
        return f"{number + 1} of {len(of)}: hold the trigger, draw {action.name}{how}, let go"

    def offer(self, action: str, file: Path, doodle: Doodle) -> str:
        """Look at a take, add it if it may be one of the action, and return a line on it.

        Raises
        ------
        LearningError
            If it is still, too short, there already, or plainly of another action; then it says
            what it looked like.
        """
        from smd.errors import DoodleError, LearningError
        from smd.recognition.rehearsal import likeness

        try:
            looks = likeness(self.recognizer, action, doodle)
        except DoodleError as error:
            raise LearningError(f"{file.name}: {error}") from error
        if looks.is_still:
            raise LearningError(
                f"{file.name}: expected {action}, got {doodle.duration_s:.1f} s of stillness"
            )
        likeliest = looks.ranked[0]
        best = f"{likeliest.action} ({looks.share(likeliest):.2f} x the limit)"
        own = f"{action}: {_placed(looks.place)}, {looks.share():.2f} x the limit"
        if looks.is_another and not self.keep:
            raise LearningError(
                f"{file.name}: expected {action}, but that looked like {best}; {own}: again, or "
                "--keep"
            )
        self._with(action, [*self._taken(action), (file.name, doodle)])
        self.takes.append((action, file, doodle))
        other = "" if looks.place == 1 else f"; it looked most like {best}"
        return f"  {file.name}: {doodle.duration_s:.1f} s, {own}{other}"

    def written(self) -> Iterator[str]:
        """Write the library with the takes added, and yield lines on what got better."""
        from actions_library.extension import put_examples, rehearsed_library
        from smd.recognition.rehearsal import gains

        taken = {name: self._taken(name) for name in self.names}
        rehearsed = [self._with(name, own) for name, own in taken.items()]
        takes = {name: [doodle for _, doodle in own] for name, own in taken.items()}
        found = gains(self.start.actions, takes, figure_height_m=self.figure_height_m)
        if self.there:
            put_examples(self.start, rehearsed)
        else:
            rehearsed_library(self.folder, self.start, rehearsed)
        yield "as it was -> with your examples, each take judged by all but itself:"
        width = max(map(len, self.names))
        for gain in found:
            then = f" -> {_told(gain.after)}" if gain.after else ""
            yield f"  {gain.action:{width}}  {_told(gain.before)}{then}"
        alone = [gain.action for gain in found if not gain.after]
        if alone:
            yield (
                f"  {', '.join(alone)}: as it was; one take says nothing of itself: rehearse once "
                "more to see"
            )
        verb = "extended" if self.there else "made"
        examples = count(len(self.takes), "own example")
        yield f"{verb}: {self.folder}: {examples} of {', '.join(self.names)}"

    def _taken(self, action: str) -> list[tuple[str, Doodle]]:
        """Return the takes of an action so far, each with what it is called."""
        return [(file.name, doodle) for name, file, doodle in self.takes if name == action]

    def _with(self, action: str, takes: Sequence[tuple[str, Doodle]]) -> Action:
        """Return an action with takes as examples."""
        from smd.recognition import add_examples

        return add_examples(
            self.start.action(action),
            [doodle for _, doodle in takes],
            names=[name for name, _ in takes],
            figure_height_m=self.figure_height_m,
        )


def _told(looks: Sequence[Likeness]) -> str:
    """Return where an action came at worst, and what it cost as a geometric mean."""
    share = math.exp(sum(math.log(one.share()) for one in looks) / len(looks))
    return f"{_placed(max(one.place for one in looks))}, {share:.2f} x the limit"


def _placed(place: int) -> str:
    """Return a place among all actions in words."""
    return "first" if place == 1 else f"no. {place}"


def _given(text: str) -> tuple[str, Path]:
    """Return what ``--take`` was given, or end as after wrong usage."""
    action, equals, file = text.partition("=")
    if not equals or not action or not file:
        raise typer.BadParameter(f"--take: expected ACTION=FILE, got {text!r}")
    return action, Path(file)
