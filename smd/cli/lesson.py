"""A lesson: an action to learn, the library to learn it into, and what is said of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.wording import count

if TYPE_CHECKING:
    from actions_library.library import Library
    from smd.doodle import Doodle
    from smd.recognition.action import Action
    from smd.recognition.learning import LearnedPattern

SHOWN_EXAMPLES = 10
"""More examples are not listed one by one."""

LONG_REST_S = 0.7
"""A rest within a gesture that is worth asking about."""

SHOWN_PATTERN = 1000
"""Characters of a pattern that are printed; that of a hundred examples fills pages."""

SHOWN_TOKENS = 8
"""Of more optional tokens, the others are counted; the pattern has them all."""


@dataclass(frozen=True, slots=True)
class LessonOptions:
    """How the user said that an action is to be learned, and beside which others."""

    clip: Annotated[
        str | None, typer.Option("--clip", help="Perform it with the clip of this action.")
    ] = None
    base: Annotated[
        str | None,
        typer.Option("--from", help="Begin a new library with all actions of this one."),
    ] = None
    replace: Annotated[
        bool, typer.Option("--replace", help="Learn an action anew that the library has.")
    ] = False


@dataclass(frozen=True, slots=True)
class Lesson:
    """An action to learn, and the library to learn it into, checked before anyone performs.

    Attributes
    ----------
    action : its name.
    folder : of the library.
    there : whether it is there already.
    start : the library that it extends, or that it begins with.
    kept : names of the actions that the library will have of ``start``.
    shelf, shown : the library and the action whose clip performs the new one.
    clip : the name that was asked for, if one was.
    """

    action: str
    folder: Path
    there: bool
    start: Library
    kept: list[str]
    shelf: Library
    shown: Action
    clip: str | None

    @classmethod
    def of(cls, action: str, folder: Path, options: LessonOptions) -> Lesson:
        """Return the lesson that a user asks for.

        Raises
        ------
        LibraryError
            If the name is no word or taken, or a library or clip is not there.
        """
        import smd
        from actions_library.extension import clip_source, require_name, require_new
        from actions_library.manifest import MANIFEST
        from smd.errors import LibraryError

        base = options.base
        require_name(action)
        shipped = smd.load_library()
        there = (folder / MANIFEST).is_file()
        if there and base is not None:
            raise LibraryError(f"{folder}: expected no library there to begin one --from {base}")
        if there:
            start = smd.load_library(folder)
        else:
            start = shipped if base in (None, shipped.name) else smd.load_library(base)
        kept = [known.name for known in start.actions] if there or base is not None else []
        if action in kept and not options.replace:
            require_new(start, action)
        shelf, shown = clip_source(action, options.clip, (start, shipped))
        return cls(action, folder, there, start, kept, shelf, shown, options.clip)

    def learned(
        self, files: list[Path], doodles: list[Doodle], description: str, figure_height_m: float
    ) -> Iterator[str]:
        """Learn from doodles, write the library, and yield lines on what was learned."""
        from actions_library.extension import add_action, new_library

        new, learned = _learned(self.action, files, doodles, figure_height_m)
        before = next((a for a in self.start.actions if a.name == self.action), None)
        before = before if self.action in self.kept else None
        new = replace(
            new,
            travels=self.shown.travels,
            cyclic=self.shown.cyclic,
            description=description or (before.description if before else ""),
            rest=before.rest if before else "",
        )
        report = [*_report(new, learned), *_rests(files, doodles, figure_height_m)]
        performed = replace(self.shelf.clip(self.shown.name), name=self.action)
        credit = self.shelf.credit(self.shown.name)
        if self.there:
            extended = add_action(self.start, new, performed, credit)
        else:
            extended = new_library(self.folder, self.start, self.kept, new, performed, credit)
        yield from report
        own = self.clip or self.shown.name == self.action
        why = "" if own else f"; there is no clip {self.action!r}, see --clip"
        yield f"  clip: {self.shown.name} of the library {self.shelf.name!r}{why}"
        for line in _collisions(extended, self.action):
            yield f"  {line}"
        verb = "extended" if self.there else "made"
        names = ", ".join(known.name for known in extended.actions)
        yield f"{verb}: {self.folder}: {names}"


def _learned(
    name: str, files: list[Path], doodles: list[Doodle], figure_height_m: float
) -> tuple[Action, LearnedPattern]:
    """Learn an action, and keep what to say of it; messages name files as the user did."""
    from smd.recognition import learn_action
    from smd.recognition.learning import learn_pattern

    learned = learn_pattern(
        doodles, names=[str(file) for file in files], figure_height_m=figure_height_m
    )
    own = [file.name for file in files]
    return learn_action(name, doodles, names=own, figure_height_m=figure_height_m), learned


def _report(action: Action, learned: LearnedPattern) -> Iterator[str]:
    """Yield lines on what was learned."""
    examples = len(learned.names)
    average = " and their average" if learned.average_sequence else ""
    yield f"{action.name}: learned from {count(examples, 'example')}{average}"
    for name, sequence, (start_s, end_s) in zip(
        learned.names, learned.sequences, learned.spans_s, strict=True
    ):
        if examples <= SHOWN_EXAMPLES:
            tokens = count(len(sequence), "token")
            yield f"  {name}: {start_s:.2f} – {end_s:.2f} s, {tokens}"
    if learned.mandatory:
        lengths = sorted(len(sequence) for sequence in learned.sequences)
        if examples > 1:
            of = f"{lengths[0]} to {lengths[-1]}"
            yield f"  agree in {count(len(learned.mandatory), 'token')} of {of}"
        yield from _tokens(learned)
    else:
        yield "  warning: no movement is in all examples; they show several ways to draw it"
    pattern = str(learned.pattern)
    if len(pattern) > SHOWN_PATTERN:
        pattern = f"{pattern[:SHOWN_PATTERN]}… and {len(pattern) - SHOWN_PATTERN} characters more"
    yield f"  pattern: {pattern}"


def _tokens(learned: LearnedPattern) -> Iterator[str]:
    """Yield lines on what must occur and what may."""
    yield "  must occur, in this order:"
    for tokens in learned.mandatory:
        yield f"    {' or '.join(map(str, sorted(tokens)))}"
    needed = frozenset().union(*learned.mandatory)
    optional = [str(token) for token in learned.pattern.tokens() if token not in needed]
    shown = ", ".join(optional[:SHOWN_TOKENS])
    more = f" and {len(optional) - SHOWN_TOKENS} more" if len(optional) > SHOWN_TOKENS else ""
    yield f"  may occur as well: {shown or 'nothing else'}{more}"


def _rests(files: list[Path], doodles: list[Doodle], figure_height_m: float) -> Iterator[str]:
    """Yield a line on each example that pauses so long that it may be several performances."""
    from smd.recognition.learning import doodle_runs, without_rest
    from smd.recognition.tokens import STILL

    for file, doodle in zip(files, doodles, strict=True):
        for run in without_rest(doodle_runs(doodle, figure_height_m)):
            if run.token == STILL and run.end_s - run.start_s >= LONG_REST_S:
                yield (
                    f"  warning: {file}: rests from {run.start_s:.2f} to {run.end_s:.2f} s; "
                    "expected one performance of the gesture"
                )


def _collisions(library: Library, name: str) -> Iterator[str]:
    """Yield lines on the other actions that the new one may be taken for."""
    from smd.recognition.collisions import collisions_of

    patterns = {action.name: action.pattern for action in library.actions if action.pattern}
    found = collisions_of(name, patterns)
    for collision in found:
        yield f"warning: {collision}"
    if not found and len(patterns) > 1:
        yield "collides with no other action of the library"
