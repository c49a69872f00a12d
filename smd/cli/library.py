"""``smd library``: what can be performed."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from smd.cli import reading

app = typer.Typer(no_args_is_help=True)


@app.callback()
def _library() -> None:
    pass


@app.command("list")
def list_(
    library: reading.LibraryFolder = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON list and nothing else.")
    ] = False,
) -> None:
    """List the actions, how each is drawn and what it does."""
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
    for action in actions:
        manner = "travels" if action.travels else "in place"
        typer.echo(f"{action.name}  ({manner}{', cyclic' if action.cyclic else ''})")
        if action.description:
            typer.echo(f"    {action.description}")
        if action.pattern:
            typer.echo(f"    {action.pattern}")
