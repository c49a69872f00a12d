"""``smd library``: what can be performed."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli import libraries, library_making, wording

if TYPE_CHECKING:
    from smd.recognition.action import Action

app = typer.Typer(no_args_is_help=True)


@app.callback()
def _library() -> None:
    pass


app.command("new")(library_making.new)
app.command("import")(library_making.import_)


@app.command("list")
def list_(
    library: libraries.LibraryFolder = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list and nothing else.")
    ] = False,
) -> None:
    """List the actions, what each does and how it is drawn."""
    import smd

    actions = smd.load_library(library).actions
    if as_json:
        rows = [
            {
                "name": action.name,
                "pattern": str(action.pattern) if action.pattern else None,
                "travels": action.travels,
                "cyclic": action.cyclic,
                "description": action.description,
            }
            for action in actions
        ]
        typer.echo(json.dumps(rows, indent=1))
        return
    width = max((len(action.name) for action in actions), default=0)
    for action in actions:
        drawn = action.description or ("not drawn" if action.pattern is None else "")
        typer.echo(f"{action.name:{width}}  {_manner(action):17}  {drawn}".rstrip())
    typer.echo(f"{wording.count(len(actions), 'action')}; smd library show ACTION says more")


@app.command()
def show(
    action: Annotated[str, typer.Argument(metavar="ACTION", help="The action's name.")],
    library: libraries.LibraryFolder = None,
    picture: Annotated[
        Path | None, typer.Option("-o", "--output", help="Draw gesture and clip: PICTURE.png")
    ] = None,
) -> None:
    """Show an action: its gesture, its clip, and what it was learned from."""
    import smd

    shelf = smd.load_library(library)
    known = shelf.action(action)
    typer.echo("\n".join(_lines(known)))
    clip, credit = shelf.clip(action), shelf.credit(action)
    typer.echo(
        f"    clip: {shelf.clip_files[action]}, {clip.duration_s:.2f} s, {clip.travel_m:.2f} m"
    )
    if credit.author or credit.licence:
        typer.echo(f"    by {credit.author or 'nobody named'}, {credit.licence or 'no licence'}")
    if known.exemplar is not None:
        examples = wording.count(len(known.exemplar), "example")
        own = int(known.exemplar.own.sum())
        of_them = f", {own} of them your own" if 0 < own < len(known.exemplar) else ""
        typer.echo(f"    verified against {examples}{of_them}: {shelf.exemplar_files[action]}")
    if known.learned_from:
        typer.echo(f"    learned from: {', '.join(known.learned_from)}")
    elif known.pattern is not None:
        typer.echo("    written by hand")
    if picture is not None:
        from exporters.action_picture import write_action_picture

        write_action_picture(shelf, action, picture)
        typer.echo(f"    drawn: {picture}")


@app.command()
def check(library: libraries.LibraryFolder = None) -> None:
    """Read all of a library's files, and warn of gestures that are too much alike.

    Exit code 3 if anything is broken; warnings alone are no failure.
    """
    import smd
    from actions_library.checking import check_library

    shelf = smd.load_library(library)
    found = check_library(shelf)
    for line in found.warnings:
        typer.echo(f"warning: {line}")
    for line in found.faults:
        print(f"smd: {line}", file=sys.stderr)
    counts = [
        wording.count(len(shelf.actions), "action"),
        wording.count(len(found.faults), "fault"),
        wording.count(len(found.warnings), "warning"),
    ]
    typer.echo(f"{shelf.folder}: {', '.join(counts)}")
    if found.faults:
        raise typer.Exit(3)


def _manner(action: Action) -> str:
    """Return how an action moves."""
    return f"{'travels' if action.travels else 'in place'}{', cyclic' if action.cyclic else ''}"


def _lines(action: Action) -> Iterator[str]:
    """Yield what an action does and how it is drawn."""
    yield f"{action.name}  ({_manner(action)})"
    if action.description:
        yield f"    {action.description}"
    if action.pattern:
        yield f"    {action.pattern}"
